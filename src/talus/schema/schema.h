#pragma once
// The model file format: every section and key with type, unit, range, default and meaning, in one table.
// The reader validates with it, the documentation tables and the published JSON schema are printed from it.

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "talus/model/units.h"

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

/// All sections in the order of the documentation.
const std::vector<SectionSpec>& model_schema();

/// @pre the section exists
const SectionSpec& section_spec(std::string_view name);

/// Markdown tables of sections and their keys.
std::string sections_markdown(const std::vector<SectionSpec>& sections);

/// Markdown tables of all sections, keys and units (a generated part of docs/file_format.md).
std::string schema_markdown();

/// JSON Schema (draft 2020-12) for editors.
std::string schema_json();

}  // namespace talus
