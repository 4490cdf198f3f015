#pragma once
// The table of the model file (schema.h) in its parts, one file each.

#include "talus/base/angle.h"
#include "talus/model/map_input.h"
#include "talus/model/model.h"
#include "talus/schema/schema.h"

namespace talus {

// short names for the rows of the tables
using D = Dimension;
using K = KeyType;

inline constexpr Range kUsualDensity{.min = 50, .max = 2.3e4};  // foam to lead and gold
inline constexpr Range kUsualYoung{.min = 1e5, .max = 1.2e12};  // loose soil to diamond
inline constexpr Range kUsualDiameter{.min = 5e-4, .max = 1};   // of a model's wire and a pile
inline constexpr Range kUsualBar{.min = 1e8, .max = 1e12};      // of fibres and steel
inline constexpr Range kGroundStress{.max = 1e9};               // of the crust
inline constexpr Range kPositive{.min = 0, .min_open = true};
inline constexpr Range kNonNegative{.min = 0};

std::vector<SectionSpec> model_sections();
std::vector<SectionSpec> block_sections();
std::vector<SectionSpec> cut_sections();
std::vector<SectionSpec> map_sections();
std::vector<SectionSpec> action_sections();
std::vector<SectionSpec> boundary_sections();
std::vector<SectionSpec> stage_sections();
std::vector<SectionSpec> bolt_sections();
std::vector<SectionSpec> run_sections();

/// The key `stages` of what acts in some stages only.
inline KeySpec stages_key() {
  return key("stages", K::kTexts, RefersTo{"stage"}, "Names of the stages in which it acts; none: all.");
}

/// The key `use` of what a variant of a model leaves out.
inline KeySpec use_key() {
  return key("use", K::kBool, Default{"true"}, "`false`: left out, as if it were not in the file.");
}

/// The keys `rotate`, `rotate_about` and `move` of what has a shape.
inline KeySpec rotate_key() {
  return key("rotate", D::kAngle, Default{"\"0 deg\""},
             "Turned by this angle, counter-clockwise; directions in other keys are not.");
}
inline KeySpec rotate_about_key(std::string_view doc = "Point it is turned about; none: its centroid.") {
  return key("rotate_about", K::kVector, D::kLength, doc);
}
inline KeySpec move_key() {
  return key("move", K::kVector, D::kLength, Default{"[0, 0]"}, "Moved by this, after it has been turned.");
}

/// The choices of a table of { name, doc }.
std::vector<std::string> names_of_choices(const auto& table) {
  std::vector<std::string> names;
  for (const auto& entry : table) names.emplace_back(entry.name);
  return names;
}

/// What each choice of a table of { name, doc } means.
std::string doc_of_choices(const auto& table) {
  std::string text;
  for (const auto& entry : table)
    text += (text.empty() ? "`" : " `") + std::string(entry.name) + "`: " + std::string(entry.doc);
  return text;
}

/// What a block can be without a motion of its own.
inline std::vector<std::string> undriven_kinds() { return {"deformable", "rigid", "fixed"}; }

/// What a block can be, in the order of BlockKind.
inline const std::vector<std::string>& block_kinds() {
  static const std::vector<std::string> kinds{"deformable", "rigid", "fixed", "driven"};
  return kinds;
}

}  // namespace talus
