#include "talus/model/joint_law.h"

namespace talus {

// A new kind is a file of its own that defines it as a function, and that function's name here, twice.

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
