#include "talus/contact/joint_state.h"

namespace talus {

// Theory 4.19.
JointState joint_state(bool touched, double normal_force, double slip, double opening, double noticed) {
  if (!touched) return JointState::kApart;
  if (normal_force <= 0 && opening > noticed) return JointState::kOpen;
  return slip > noticed ? JointState::kSlipped : JointState::kIntact;
}

}  // namespace talus
