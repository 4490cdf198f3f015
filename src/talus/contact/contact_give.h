#pragma once
// What contacts give whose joint has no stiffness: so little that nobody sees it, and enough for redundant
// contacts to share a load in one way only. Theory: docs/theory.md 4.22.

#include "talus/blocks/state.h"
#include "talus/model/joint_law.h"
#include "talus/rows/step_clock.h"

namespace talus {

/// Closure of a hard contact under the stress that it is measured by, as share of the length of its face: less
/// than rock itself yields.
inline constexpr double kGiveClosure = 1e-5;

/// Of the smaller block, ten times that: two blocks that are level within it are not in each other's way, and what
/// faces the other over less is a corner against a corner (theory 3.3).
inline constexpr double kLevel = 10 * kGiveClosure;

/// Blocks yield at least so many times more to a force than contacts give within the shortest step: with less
/// they would swing on them.
inline constexpr double kLeastYield = 1000;

/// The same for all hard contacts, for all of a run and whatever the step.
struct ContactGive {
  double stress = 0;         // that closes a face by kGiveClosure of its length [Pa], 0: no give
  const char* cause = "";    // what has it
  double shortest_step = 0;  // of the run [s], 0: the present one

  /// Displacement of one contact point under a force, along the normal and along the tangent, at most [m/N].
  double per_force(double thickness) const;
};

/// The same as compliance of rows in a step.
class RowGive {
 public:
  RowGive(const ContactGive& give, const BlockSet& blocks, const StepClock& clock);

  /// Between two blocks: no more than kLeastYield of them allows [1/kg].
  double between(int a, int b) const;

 private:
  const BlockSet& blocks_;
  double give_, per_yield_;  // [1/kg], [-]
};

/// By the largest stress that the model gives to be foreseen: of the ground, of its weight and of accelerations
/// given, of loads, of velocities given (of deformable blocks). None with the smoothed law, and where the model
/// asks for none.
ContactGive contact_give(const Model& model, const Layout& layout, const BlockSet& blocks);

/// About what a block yields at a corner, as mass over it [-].
inline constexpr double kYield = 4;

/// Whether two blocks may meet over a joint without normal or shear stiffness.
bool meets_hard(const Layout& layout, const std::vector<JointLaw>& laws);

}  // namespace talus
