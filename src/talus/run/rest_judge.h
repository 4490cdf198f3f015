#pragma once
// Whether a static stage has come to rest, and whether it still makes progress towards it. Theory: docs/theory.md 4.8.

#include "talus/run/unrest.h"

namespace talus {

class RestJudge {
 public:
  RestJudge(const Scene& scene, const StepWork& work, State& state)
      : scene_(scene), work_(work), state_(state) {}

  /// A stage begins, or goes on in another way.
  void begin() { look_ = latest_look_ = {}; }

  /// Velocity left, as share of its peak in the stage or, where nothing ever moved that fast, of what the forces on blocks
  /// would give them in half a step that is stable without implicit elasticity.
  /// @param steps_of_bound  length of the step over that of such a one
  double speed_left(const StepReport& report, double steps_of_bound) const;

  /// Forces in balance is not enough: a block that swings through its rest position is in balance there.
  bool is_at_rest(const StageInput& stage, const StepReport& report) const;

  /// Where a stage makes no progress its steps are solved more sharply: errors that the solver leaves are forces. Whether
  /// that has not helped either, and nothing is on its way anywhere.
  /// @param relaxed  nothing is left to be let go of
  /// @param left     of the stage [s]
  bool stalls(const StageInput& stage, const StepReport& report, bool relaxed, double left);

  /// Where blocks were at the look before the latest.
  const RestLook& look() const { return look_; }

 private:
  const Scene& scene_;
  const StepWork& work_;
  State& state_;
  RestLook look_, latest_look_;
};

}  // namespace talus
