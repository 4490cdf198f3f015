#include "talus/run/safety.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/rank.h"
#include "talus/model/joint_law.h"

namespace talus {

namespace {

// Way at which a block has failed, as share of its size or, where that is larger, the median block's; and at
// most, as share of its own: a wedge in solid rock falls by less than the rock is large.
constexpr double kFailed = 0.1, kFarthest = 0.5;

// A block still moves when it is faster than this share of its mean speed so far.
constexpr double kStillMoves = 0.1;

// Needles, which do not vote: below these shares of the median block's area or thickness.
constexpr double kNeedleArea = 1e-4, kNeedleThickness = 2e-3;

// Who votes in a trial, and how far each may go.
struct Electorate {
  explicit Electorate(const Scene& scene) : votes(scene.blocks.size.size(), false) {
    const BlockSet& b = scene.blocks;
    std::vector<double> size, thickness;
    for (size_t k = 0; k < votes.size(); ++k)
      if (can_move(b.kind[k])) size.push_back(b.size[k]), thickness.push_back(b.thinness[k]);
    const double median_size = lower_median(size), median_thickness = lower_median(thickness);
    const double told = scene.model.safety.displacement;
    for (size_t k = 0; k < votes.size(); ++k) {
      const double area = b.size[k] * b.size[k];
      const bool is_needle = area < kNeedleArea * median_size * median_size ||
                             b.thinness[k] < kNeedleThickness * median_thickness;
      votes[k] = can_move(b.kind[k]) && (!is_needle || !std::isnan(told));
      limit.push_back(!std::isnan(told)
                          ? told
                          : std::min(kFailed * std::max(b.size[k], median_size), kFarthest * b.size[k]));
    }
    may_rest_beyond = std::isnan(told);
  }

  static bool can_move(BlockKind kind) { return kind == BlockKind::kDeformable || kind == BlockKind::kRigid; }

  // of two the smaller: a wedge in solid rock is no crumb
  static double lower_median(const std::vector<double>& v) {
    return v.empty() ? 0 : value_at_rank(v, (v.size() - 1) / 2);
  }

  std::vector<bool> votes;
  std::vector<double> limit;     // [m]
  bool may_rest_beyond = false;  // past its limit a block has failed only while it moves
};

// Sees how far blocks move within each stage, and ends the trial when one has moved too far.
class Watch : public Observer {
 public:
  Watch(const Scene& scene, const Electorate& electorate) : electorate_(electorate), scene_(scene) {}

  void at(const Instant& i) override {
    if (i.stage_start) start_ = i.state.displacement, begin_ = i.state.time, peak_ = 0;
    const double elapsed = i.state.time - begin_;
    double share = 0, moving = 0;
    failed_ = false;
    for (size_t k = 0; k < start_.size(); ++k) {
      if (!electorate_.votes[k]) continue;
      const double moved = norm(i.state.displacement[k] - start_[k]), speed = norm(i.state.rate[k].a);
      moving += 0.5 * scene_.blocks.mass[k] * speed * speed;
      if (moved > share * electorate_.limit[k]) {
        share = moved / electorate_.limit[k];
        farthest_ = moved, block_ = k;
      }
      failed_ = failed_ || (moved > electorate_.limit[k] &&
                            (!electorate_.may_rest_beyond || speed * elapsed > kStillMoves * moved));
    }
    peak_ = std::max(peak_, moving);
    speed_left_ = peak_ > 0 ? std::sqrt(moving / peak_) : 0;
    worst_ = i.report.worst_block;
  }
  bool stop() override { return failed_; }

  bool failed() const { return failed_; }
  // Whether nothing that votes keeps the last stage from rest.
  bool only_needles_move(double unbalanced) const {
    return !failed_ && speed_left_ <= unbalanced &&
           (worst_ < 0 || !electorate_.votes[static_cast<size_t>(worst_)]);
  }
  double farthest() const { return farthest_; }
  size_t block() const { return block_; }

 private:
  const Electorate& electorate_;
  const Scene& scene_;
  bool failed_ = false;
  double farthest_ = 0, begin_ = 0, peak_ = 0, speed_left_ = 0;
  int worst_ = -1;
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
  scene.laws = joint_laws(scene.model.joints);
  return scene;
}

SafetyTrial run_trial(const PreparedRun& prepared, double factor, const Workers& workers) {
  Scene scene = weakened(prepared, factor);
  const size_t stages = leading_static_stages(scene.model);
  scene.model.stages.resize(stages);
  const std::vector<StagePlan> plans(prepared.plans.begin(),
                                     prepared.plans.begin() + static_cast<std::ptrdiff_t>(stages));
  const Electorate electorate(scene);
  Watch watch(scene, electorate);
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
  if (watch.failed()) {
    trial.outcome = "displacement limit";
  } else if (run.failure.empty() && !run.interrupted) {
    trial.outcome = "at rest", trial.stands = true;
  } else if (!run.no_rest) {
    throw NumericalError(fmt::format("trial at factor {:g} says nothing of safety: {}", factor, run.failure));
  } else {
    trial.stands = watch.only_needles_move(scene.model.stages.back().unbalanced);
    trial.outcome = trial.stands ? "needles move" : "no rest";
  }
  return trial;
}

}  // namespace

void check_safety(const PreparedRun& prepared) {
  const Model& model = prepared.scene.model;
  if (leading_static_stages(model) == 0) {
    Findings findings(model.file, model.text);
    findings.error(model.stages.empty() ? model.safety.where : model.stages[0].where, "stage",
                   "the first stage is not static: there is no rest by which a trial could be judged",
                   "begin with a stage of kind = \"static\"");
    findings.throw_if_errors();
  }
  const Layout& cut = prepared.scene.layout;
  if (cut.slivers_merged + cut.slivers_deleted > 0 && !model.safety.accept_merged) {
    Findings findings(model.file, model.text);
    findings.error(model.cut.where_slivers, "cut.slivers",
                   fmt::format("{} slivers are merged and {} deleted: the block that fails may be among them",
                               cut.slivers_merged, cut.slivers_deleted),
                   "use slivers = \"keep\", with elasticity = \"implicit\" if the step is too short; or, if "
                   "you know that they do not matter, safety.accept_merged = true");
    findings.throw_if_errors();
  }
}

SafetyResult seek_safety(const PreparedRun& prepared, const Workers& workers,
                         const std::function<void(const SafetyTrial&)>& told) {
  const Model& model = prepared.scene.model;
  check_safety(prepared);
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
