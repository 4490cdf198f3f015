#include "talus/model/joint_law.h"

namespace talus {

// A kind with keys or a strength of its own is a file of its own: a function that returns it, declared here
// and called in the list. What else asks for the strength of a joint, and takes it to be Coulomb's of the
// properties that all joints have: the audit (run/auditor.cpp), the factor of safety (reduced()), `auto` of
// elasticity (step/scene.cpp). Kinds share no key.

const std::vector<JointKind>& joint_kinds() {
  static const std::vector<JointKind> kinds{
      {.name = "frictional", .doc = "opens and slips by the strengths below."},
      {.name = "bonded",
       .doc = "an artificial joint that never opens or slips (sub-division of one body).",
       .bonded = true},
  };
  return kinds;
}

}  // namespace talus
