#include <algorithm>

#include "talus/penalty/penalty_settings.h"
#include "talus/penalty/penalty_step.h"
#include "talus/run/stepper.h"

namespace talus {

namespace {

class PenaltyStepper : public Stepper {
 public:
  PenaltyStepper(const Scene& scene, StepWork& work, State& state, RunResult& result)
      : Stepper(scene, work, state), steps_(scene, work), result_(result) {}

  void begin() override {
    if (state_.carried_stress.empty())
      begin_penalty(scene_, penalty_settings(scene_, scene_.model.stages[0]).scheme, state_);
  }
  void settle(const StageInput& stage) override { settings_ = penalty_settings(scene_, stage); }
  void stand(double dt) override { steps_.stand(settings_, dt, state_); }

  std::optional<StepReport> kick(const StageStand&, StepSettings&, double&, double&) override {
    return steps_.report(state_);
  }

  void move(double end, const StepSettings& settings, StepReport&) override {
    const PenaltyReport p = steps_.step(settings_, end, settings.dynamic, state_);
    result_.penalty = settings_.stiffness[0];
    result_.cut_steps += p.parts > 1, result_.parts += p.parts;
    result_.penetration = std::max(result_.penetration, p.penetration);
    result_.condition = std::max(result_.condition, p.condition);
  }

  StepReport look(const StepSettings&, double dt, State& copy) override {
    // a run that goes on behind its last stage has shown nothing yet
    if (work_.rate_before.size() != state_.rate.size()) steps_.stand(settings_, dt, state_), copy = state_;
    return steps_.report(copy);
  }

 private:
  PenaltySteps steps_;
  PenaltySettings settings_;
  RunResult& result_;
};

}  // namespace

std::unique_ptr<Stepper> make_penalty_stepper(const Scene& scene, StepWork& work, State& state,
                                              RunResult& result) {
  return std::make_unique<PenaltyStepper>(scene, work, state, result);
}

}  // namespace talus
