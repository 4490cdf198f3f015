#pragma once
// The kinds of joints that a model can name, one line of a table each.

#include <string_view>
#include <vector>

#include "talus/model/joint_law.h"
#include "talus/model/schema.h"

namespace talus {

/// What a kind adds to the properties that all joints have.
struct JointKind {
  std::string_view name, doc;
  bool bonded = false;             // never opens or slips
  std::vector<KeySpec> keys = {};  // of its own, numbers; in the order of JointProperty::own
  /// Adds what keeps them from being a law; none: nothing does.
  void (*check)(const JointProperty& joint, std::vector<JointDefect>& out) = nullptr;
  /// JointLaw::worn; none: the residual strength.
  JointStrength (*worn)(const JointLaw& law, const JointWear& wear) = nullptr;
};

/// All kinds; JointProperty::kind is an index. The first is that of joints that name none, the second is bonded.
const std::vector<JointKind>& joint_kinds();
inline constexpr int kFrictionalJoint = 0, kBondedJoint = 1;

}  // namespace talus
