#pragma once
// Units of motion that headers and column titles may name, and how a title names its unit.

#include <optional>
#include <string>
#include <string_view>

namespace talus::record {

/// Standard gravity [m/s2], what "g" means in every record.
inline constexpr double kStandardGravity = 9.80665;

enum class Quantity { kAcceleration, kVelocity, kDisplacement };

/// "acceleration", "velocity", "displacement"
std::string_view name_of(Quantity quantity);
/// "m/s2", "m/s", "m"
std::string_view si_symbol(Quantity quantity);
/// The quantity that a word means ("a", "acc", "Acceleration", "vel", "d" ...), if any.
std::optional<Quantity> quantity_called(std::string_view word);

struct MotionUnit {
  std::string_view symbol;
  Quantity quantity;
  double factor;  // SI value of one unit
};

/// The unit written as `text` in any usual way ("GAL", "cm/sec2", "m_s2", "cm/s/s"), nullptr when unknown.
const MotionUnit* find_unit(std::string_view text);

/// "m/s2, cm/s2, mm/s2, gal, g, m/s, ..."
std::string known_units();

/// A column title in its parts: "a_gal", "acceleration [m/s2]", "acc (g)".
struct Title {
  std::string name;                      // "a", "acceleration", "acc"
  std::optional<std::string> unit_text;  // as written, "" for empty brackets; absent when none is named
  std::string second_unit;               // a different unit named beside it, "" when there is none
};
Title parse_title(std::string_view title);

/// Text in lower case (ASCII letters only).
std::string lower_case(std::string_view text);

}  // namespace talus::record
