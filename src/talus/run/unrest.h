#pragma once
// Why a static stage does not come to rest: texts of its end. Theory: docs/theory.md 4.8.

#include <string>
#include <vector>

#include "talus/step/step.h"

namespace talus {

/// Where blocks were when rest was looked for.
struct RestLook {
  double time = 0;  // [s]
  std::vector<Vec2> place;
};

/// The force that the error of a step is on the block with the largest unbalanced force [N].
/// @param dt  length of the step [s]
double solver_leaves(const BlockSet& blocks, const StepReport& report, double dt);

/// A stage after its last step.
struct Unrest {
  const Scene& scene;
  const State& state;
  const StepReport& last;
  const RestLook& look;     // the look before the latest
  double dt = 0, step = 0;  // length of the steps of the plan, of the last one [s]

  /// That it ended without coming to rest, where, what keeps it from it, and the key to change.
  /// @param elapsed  since it began [s]
  /// @param on_path  where on its path, after a comma; "": it has none
  std::string text(const StageInput& stage, double elapsed, int64_t steps, const std::string& on_path) const;

 private:
  std::string why_no_rest(const StageInput& stage, double elapsed) const;
  bool goes_anywhere(double time) const;
  int fastest_block() const;
  std::string chatter(const StageInput& stage, size_t fastest) const;
};

}  // namespace talus
