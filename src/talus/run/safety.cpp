#include "talus/run/safety.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/model/joint_law.h"

namespace talus {

namespace {

// Displacement at which a trial has failed, as share of the smallest block's size, unless the model says.
constexpr double kFailed = 0.1;

// Sees how far blocks move within each stage, and ends the trial when one has moved too far.
class Watch : public Observer {
 public:
  explicit Watch(double limit) : limit_(limit) {}

  void at(const Instant& i) override {
    if (i.stage_start) start_ = i.state.displacement;
    farthest_ = 0;
    for (size_t k = 0; k < start_.size(); ++k) {
      const double moved = norm(i.state.displacement[k] - start_[k]);
      if (moved > farthest_) farthest_ = moved, block_ = k;
    }
  }
  bool stop() override { return farthest_ > limit_; }

  double farthest() const { return farthest_; }
  size_t block() const { return block_; }

 private:
  double limit_, farthest_ = 0;
  size_t block_ = 0;
  std::vector<Vec2> start_;
};

size_t leading_static_stages(const Model& model) {
  size_t n = 0;
  while (n < model.stages.size() && model.stages[n].kind == StageKind::kStatic) ++n;
  return n;
}

// The scene of a trial. Its faces stay: strength divided by a factor is still strength.
Scene weakened(const PreparedRun& prepared, double factor) {
  Scene scene = prepared.scene;
  const std::vector<int>& chosen = scene.model.safety.joints;
  for (size_t i = 0; i < scene.model.joints.size(); ++i)
    if (chosen.empty() || std::find(chosen.begin(), chosen.end(), static_cast<int>(i)) != chosen.end())
      scene.model.joints[i] = reduced(scene.model.joints[i], factor);
  return scene;
}

SafetyTrial run_trial(const PreparedRun& prepared, double factor, const Workers& workers) {
  Scene scene = weakened(prepared, factor);
  const size_t stages = leading_static_stages(scene.model);
  scene.model.stages.resize(stages);
  const std::vector<StagePlan> plans(prepared.plans.begin(),
                                     prepared.plans.begin() + static_cast<std::ptrdiff_t>(stages));
  const double limit = std::isnan(scene.model.safety.displacement) ? kFailed * smallest_size(scene.blocks)
                                                                   : scene.model.safety.displacement;
  Watch watch(limit);
  State state = start_state(scene);
  const RunResult run = run_stages(scene, plans, state, watch, workers);
  const StageResult& last = run.stages.back();

  SafetyTrial trial;
  trial.factor = factor;
  trial.stage = last.name;
  trial.time = state.time;
  trial.steps = state.step;
  trial.displacement = watch.farthest();
  trial.block = scene.blocks.name[watch.block()];
  trial.unbalanced = last.unbalanced;
  trial.closure = run.closure();
  trial.stands = run.failure.empty() && !run.interrupted && watch.farthest() <= limit;
  if (!trial.stands && !run.interrupted && run.failure.empty())
    trial.outcome = "displacement limit";  // reached in the last step
  else if (!trial.stands && !run.interrupted && !run.no_rest)
    throw NumericalError(fmt::format("trial at factor {:g} says nothing of safety: {}", factor, run.failure));
  else
    trial.outcome = trial.stands ? "at rest" : run.interrupted ? "displacement limit" : "no rest";
  return trial;
}

}  // namespace

SafetyResult seek_safety(const PreparedRun& prepared, const Workers& workers,
                         const std::function<void(const SafetyTrial&)>& told) {
  const Model& model = prepared.scene.model;
  if (leading_static_stages(model) == 0) {
    Findings findings(model.file, model.text);
    findings.error(model.stages.empty() ? model.safety.where : model.stages[0].where, "stage",
                   "the first stage is not static: there is no rest by which a trial could be judged",
                   "begin with a stage of kind = \"static\"");
    findings.throw_if_errors();
  }
  SafetyResult result;
  const auto stands = [&](double factor) {
    result.trials.push_back(run_trial(prepared, factor, workers));
    if (told) told(result.trials.back());
    (result.trials.back().stands ? result.stands : result.fails) = factor;
    return result.trials.back().stands;
  };
  if (!stands(model.safety.lowest)) {
    result.status = SafetyStatus::kBelow;
    return result;
  }
  if (stands(model.safety.highest)) {
    result.status = SafetyStatus::kAbove;
    return result;
  }
  while (result.fails - result.stands > model.safety.tolerance) stands(result.factor());
  return result;
}

}  // namespace talus
