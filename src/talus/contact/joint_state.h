#pragma once
// What has become of a joint at a point: whether it holds, slipped or opened. Theory:
// docs/theory.md sections 3.5 and 4.19.

#include <algorithm>

#include "talus/blocks/state.h"

namespace talus {

/// Slip and opening of a joint below this share of the smaller block are none [m].
inline double noticeable(const BlockSet& blocks, size_t a, size_t b) {
  return 1e-6 * std::min(blocks.size[a], blocks.size[b]);
}

/// kApart: near each other, but never in touch.
enum class JointState { kIntact, kSlipped, kOpen, kApart };
constexpr JointState last_of(JointState) { return JointState::kApart; }

/// @param normal_force  > 0 pressing [N]
/// @param opening       gap less the rise [m]
/// @param noticed       noticeable() of the two blocks [m]
JointState joint_state(bool touched, double normal_force, double slip, double opening, double noticed);

}  // namespace talus
