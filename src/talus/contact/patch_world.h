#pragma once
// What the patches of a model hang on and do not change.

#include "talus/contact/bonds.h"
#include "talus/contact/joint_state.h"
#include "talus/contact/outlines.h"
#include "talus/model/joint_law.h"

namespace talus {

/// What the search for patches is told.
struct PatchWorld {
  const BlockSet& blocks;
  const Outlines& outlines;
  const BondSet& bonds;
  const Layout& layout;
  const Model& model;
  const std::vector<JointLaw>& laws;
};

/// Stiffness of a patch along the normal (0) or the tangent (1) [N/m]: of its joint, mixed with the other one's where two
/// meet (theory 3.8).
/// @pre  its joint is elastic in that direction
inline double mixed_stiffness(const std::vector<JointLaw>& laws, const Patch& patch, int i, double area) {
  const double one = laws[patch.joint].stiffness(i, area);
  if (patch.other_share == 0 || patch.other_joint < 0) return one;
  const JointLaw& other = laws[patch.other_joint];
  return other.is_soft(i) ? (1 - patch.other_share) * one + patch.other_share * other.stiffness(i, area)
                          : one;
}

/// Damping time of the same [s]: that at which its dashpots take what those of the two joints would. What is apart has none, and
/// is not slowed down ahead of what it is to hit.
/// @pre  its joint is elastic in that direction
inline double mixed_damping_time(const BlockSet& blocks, const std::vector<JointLaw>& laws,
                                 const Patch& patch, int i) {
  const double closed = -noticeable(blocks, patch.block_a, patch.block_b);
  if (patch.closure[0] < closed && patch.closure[1] < closed) return 0;
  const JointLaw& law = laws[patch.joint];
  if (patch.other_share == 0 || patch.other_joint < 0) return law.damping_time();
  const JointLaw& other = laws[patch.other_joint];
  if (!other.is_soft(i)) return law.damping_time();
  const double one = (1 - patch.other_share) * law.stiffness(i), two = patch.other_share * other.stiffness(i);
  return (one * law.damping_time() + two * other.damping_time()) / (one + two);
}

}  // namespace talus
