#pragma once
// The ways to go on in a stage, whatever their equations: what a run asks of each.

#include <memory>
#include <optional>
#include <string>

#include "talus/run/run_result.h"

namespace talus {

/// Where a stage stands when a step is asked for.
struct StageStand {
  const StageInput& stage;
  const StagePlan& plan;
  double begin = 0;  // of the stage [s]
  double goal = 0;   // to which its histories go on, at the pace of its path, or where they stand [s]
};

class Stepper {
 public:
  Stepper(const Scene& scene, StepWork& work, State& state) : scene_(scene), work_(work), state_(state) {}
  virtual ~Stepper() = default;

  /// The state of a run begins with what such steps carry on.
  virtual void begin() {}
  /// A stage is entered, or gone on with.
  virtual void settle(const StageInput& /*stage*/) {}
  /// Rows and places are made ready for its first step, of `dt` [s].
  virtual void stand(double /*dt*/) {}

  /// Forces at the instant, and rates half a step later. Nothing, with the state as before, where no step can be taken:
  /// why_not() tells.
  /// @param dt       length that is asked for; out: that of the step taken, which may be shorter [s]
  /// @param advance  out: by how much the clock goes on, where it does not go by dt [s]
  virtual std::optional<StepReport> kick(const StageStand& at, StepSettings& settings, double& dt,
                                         double& advance) = 0;
  virtual std::string why_not() const { return ""; }

  /// The blocks go on to `end` [s]. Throws NumericalError.
  virtual void move(double end, const StepSettings& settings, StepReport& report);

  /// Forces as they are at the last instant of a run, on a copy of its state.
  virtual StepReport look(const StepSettings& settings, double dt, State& copy);

  /// Whether what has no balance goes faster and faster.
  virtual bool has_inertia() const { return false; }

 protected:
  const Scene& scene_;
  StepWork& work_;
  State& state_;
};

/// Explicit steps of central differences.
class ExplicitSteps : public Stepper {
 public:
  using Stepper::Stepper;

  /// A step, or of one that no solver solves the longest of its halves, quarters and so on that one does; the shortest as
  /// it is.
  std::optional<StepReport> kick(const StageStand& at, StepSettings& settings, double& dt,
                                 double& advance) override;
  bool has_inertia() const override { return true; }
};

/// Steps of conventional DDA. Theory: docs/theory.md 13.
std::unique_ptr<Stepper> make_penalty_stepper(const Scene& scene, StepWork& work, State& state,
                                              RunResult& result);

}  // namespace talus
