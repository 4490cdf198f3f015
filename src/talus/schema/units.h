#pragma once
// Physical dimensions and the unit symbols that model files may use. Inside talus everything is SI.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

enum class Dimension {
  kNone,
  kLength,
  kArea,
  kTime,
  kVelocity,
  kAcceleration,
  kAngle,
  kAngularVelocity,
  kRate,
  kDensity,
  kStress,
  kForce,
  kStiffness,
  kLineForce,
};

struct Unit {
  std::string_view symbol;
  Dimension dimension;
  double factor;  // SI value of one unit
};

/// All units, ordered by dimension, the SI unit of each dimension first.
const std::vector<Unit>& all_units();

/// Symbol of the SI unit of `dimension`, "" for plain numbers.
std::string_view si_symbol(Dimension dimension);

/// "a stress (Pa, kPa, MPa, GPa)"
std::string describe(Dimension dimension);

struct Quantity {
  double value = 0;   // SI
  std::string error;  // "" when the text was understood
};

/// Reads "5 GPa", "35 deg", "0.4 g", "12" as a quantity of `dimension`; a text without unit is SI.
/// A bare angle other than 0 is refused: degrees and radians are too easily confused.
Quantity parse_quantity(std::string_view text, Dimension dimension);

/// A number with a unit of any dimension, or none.
struct AnyQuantity {
  double number = 0;
  std::string unit;  // symbol, "" for none
  double value = 0;  // SI
};
/// Reads "5 GPa", "12"; none of anything else.
std::optional<AnyQuantity> parse_any_quantity(std::string_view text);

/// `value` [SI] with its SI unit, for messages: "2700 kg/m3".
std::string with_unit(double value, Dimension dimension);

}  // namespace talus
