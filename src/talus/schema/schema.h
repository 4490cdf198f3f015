#pragma once
// What a file of sections may hold: every section and key with type, unit, range, default and meaning, in one table.
// The reader validates with it, the documentation tables and the published JSON schema are printed from it.

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "talus/schema/units.h"

namespace talus {

enum class KeyType {
  kBool,
  kInteger,
  kQuantity,      // number, or text with unit
  kQuantityAuto,  // the same, or "auto" (read as NaN)
  kText,
  kChoice,     // one of `choices`
  kSignal,     // quantity, or name of a history
  kName,       // name of something defined elsewhere in the file: `refers_to`
  kNames,      // list of two names
  kVector,     // [x, y], each a quantity
  kIntegers,   // [nx, ny]
  kPoints,     // list of [x, y]
  kLines,      // list of lists of [x, y]
  kNumbers,    // list of plain numbers
  kTexts,      // list of texts, any number
  kCurve,      // list of [time, number]
  kScattered,  // quantity, { mean, normal }, { mean, uniform } or { exponential }
  kStrength,   // quantity, or { mean, normal | lognormal, seed }
  kMotion,     // "fixed", "free", { velocity = "history" } or { displacement = "history" }
};

struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false, max_open = false;

  bool holds(double v) const { return (min_open ? v > min : v >= min) && (max_open ? v < max : v <= max); }
  bool given() const { return std::isfinite(min) || std::isfinite(max); }
  /// "> 0", "from 0 to below 1", "" when anything is allowed; with the unit of `dimension`.
  std::string describe(Dimension dimension) const;
};

struct KeySpec {
  std::string_view name;
  KeyType type = KeyType::kQuantity;
  Dimension dimension = Dimension::kNone;
  Range range = {};
  Range usual = {};  // of magnitudes but 0; what lies outside is legal and warned of
  bool required = false;
  std::string_view default_text = {};  // as it would be written in the file; "" = none
  std::vector<std::string> choices = {};
  std::string_view refers_to = {};  // "material", "joint", "history", "block or grid"
  std::string_view doc = {};
};

// Parts of a key, in any order: key("window", D::kTime, Range{.min = 0}, Default{"\"0 s\""}, "What it is.")
struct Usual {
  Range range;
};
struct Default {
  std::string_view text;
};
struct Choices {
  std::vector<std::string> names;
};
struct RefersTo {
  std::string_view what;
};
struct Required {};
inline constexpr Required kRequired;

namespace schema_detail {

inline void put(KeySpec& k, KeyType type) { k.type = type; }
inline void put(KeySpec& k, Dimension dimension) { k.dimension = dimension; }
inline void put(KeySpec& k, const Range& range) { k.range = range; }
inline void put(KeySpec& k, const Usual& usual) { k.usual = usual.range; }
inline void put(KeySpec& k, const Default& value) { k.default_text = value.text; }
inline void put(KeySpec& k, const Choices& choices) { k.type = KeyType::kChoice, k.choices = choices.names; }
inline void put(KeySpec& k, const RefersTo& to) { k.refers_to = to.what; }
inline void put(KeySpec& k, Required) { k.required = true; }
inline void put(KeySpec& k, std::string_view doc) { k.doc = doc; }

}  // namespace schema_detail

/// A quantity, where no part says otherwise.
template <class... Parts>
KeySpec key(std::string_view name, const Parts&... parts) {
  KeySpec k;
  k.name = name;
  (schema_detail::put(k, parts), ...);
  return k;
}

enum class SectionShape {
  kTop,    // keys at the top of the file
  kFree,   // [section] with keys of the user's own
  kTable,  // [section]
  kNamed,  // [section.NAME], any number
  kList,   // [[section]], any number
};

struct SectionSpec {
  std::string_view name;
  SectionShape shape;
  std::string_view doc;
  std::vector<KeySpec> keys;
};

/// All sections of a kind of file, in the order of its documentation.
using Schema = std::vector<SectionSpec>;

/// @pre  the section exists
const SectionSpec& section_spec(const Schema& schema, std::string_view name);

/// Markdown tables of sections and their keys.
std::string schema_markdown(const Schema& schema);

/// A markdown table of all units.
std::string units_markdown();

/// JSON Schema (draft 2020-12) for editors. @pre  the first section is the top of the file
std::string schema_json(const Schema& schema, std::string_view title);

}  // namespace talus
