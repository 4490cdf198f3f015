#pragma once
// How a static stage goes on in steps from rest. Theory: docs/theory.md 14.1.

#include <optional>
#include <string>

#include "talus/contact/pairs.h"
#include "talus/run/stepper.h"

namespace talus {

/// Takes the kicks of a stage from rest: chooses their lengths, and takes a step again where blocks went too far.
class StepsFromRest : public Stepper {
 public:
  using Stepper::Stepper;

  /// What the search for a balance begins with: steps of this length [s].
  static RestWatch first_look(double length);

  /// The next balance of a path is looked for, with steps as long as they are by now: in the first the histories reach the
  /// goal, unless it is shorter than the first of the stage.
  /// @param goal   of the histories [s]
  /// @param steps  of the stage so far
  void go_on(double goal, double first, int64_t steps);

  /// A step of backward Euler, of state.rest.length or of as much of it as can be taken. Where blocks go too far in the
  /// shortest one, or it is not solved: nothing, with the state as before, if the stage may follow them (why_not() tells);
  /// else NumericalError, or a report that has failed.
  std::optional<StepReport> kick(const StageStand& at, StepSettings& settings, double& dt,
                                 double& advance) override;

  /// Sets the clock of histories that are there but for round-off to their goal.
  void arrive(double goal);

  std::string why_not() const override { return why_not_; }

  /// Sets state.rest.length for the step after: longer, but not soon after one that had to be shortened.
  /// @param relaxed  nothing is left to be let go of
  void lengthen(double first, bool relaxed);

  /// Whether no block went anywhere in the last kick; on a path, in which histories stood still in it, by no more than
  /// would be seen in the table of its balances.
  bool stands(bool on_path) const;

  /// Way that a block may still go, as share of its size, and yet count as standing.
  static constexpr double kFarToGo = 1e-3;

 private:
  enum class AtEnd { kAsForcesSay, kUnseen, kTooFar };
  AtEnd at_end(double time_end, const StepReport& report);
  bool is_far(const Approach& approach) const;
  double longest_way(double length, double less) const;
  double history_dt(double goal, double length) const;
  void restore(const State& before, bool expect);
  std::string way_text(const Approach& approach) const;
  std::string too_far(const StageInput& stage, const Approach& approach, double length) const;

  double way_ = 0;  // the longest of a block, as share of its size
  std::string why_not_;
};

}  // namespace talus
