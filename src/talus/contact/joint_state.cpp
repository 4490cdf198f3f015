#include "talus/contact/joint_state.h"

namespace talus {

double largest_rise(const Model& model, const State& state) {
  if (std::all_of(model.joints.begin(), model.joints.end(),
                  [](const JointProperty& j) { return j.dilation_angle == 0; }))
    return 0;
  double rise = 0;
  for (const Contact& c : state.contacts)
    if (c.joint >= 0)
      rise = std::max(rise, dilation_rise(model.joints[static_cast<size_t>(c.joint)], c.slip));
  return rise;
}

const char* state_name(JointState state) {
  constexpr const char* kName[] = {"intact", "slipped", "open", "apart"};
  return kName[static_cast<int>(state)];
}

JointState joint_state(bool touched, double normal_force, double slip, double opening, double noticed) {
  if (!touched) return JointState::kApart;
  if (normal_force <= 0 && opening > noticed) return JointState::kOpen;
  return slip > noticed ? JointState::kSlipped : JointState::kIntact;
}

}  // namespace talus
