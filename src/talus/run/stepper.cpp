#include "talus/run/stepper.h"

namespace talus {

namespace {

// Into how many parts a dynamic step may be cut that no solver solves.
constexpr int kMostParts = 64;

}  // namespace

void Stepper::move(double end, const StepSettings&, StepReport& report) {
  drift(scene_, end, work_, state_, report);
}

StepReport Stepper::look(const StepSettings& settings, double dt, State& copy) {
  return talus::kick(scene_, settings, dt, work_, copy);
}

std::optional<StepReport> ExplicitSteps::kick(const StageStand& at, StepSettings& settings, double& dt,
                                              double& /*advance*/) {
  const double shortest = at.plan.dt / kMostParts;
  for (;; dt *= 0.5) {
    settings.may_shorten = at.stage.kind == StageKind::kDynamic && scene_.by_patches() && dt > shortest;
    StepReport report = talus::kick(scene_, settings, dt, work_, state_);
    settings.may_shorten = false;  // nobody else could go on with less
    if (report.taken) return report;
  }
}

}  // namespace talus
