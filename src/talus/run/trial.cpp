#include "talus/run/trial.h"

#include <algorithm>

#include "talus/base/clock.h"

namespace talus {

namespace {

// Steps that set up what later ones keep, and steps that count at least.
constexpr int kWarmUp = 2, kLeast = 2;

// How far the mean of the first steps may be from that of all, as contacts open and solvers have more to do; steps in which
// nearly all stages from rest have theirs, or have said why not.
constexpr double kApart = 3, kLongRest = 300;

// Sweeps of a step take half a second at most, of some six points a block at 10 ns: that the solver wants
// more is all one needs to know, and nobody wants to wait to be told.
int most_sweeps(int blocks) { return std::max(100, static_cast<int>(5e7 / (6.0 * std::max(blocks, 1)))); }

class Stopwatch : public Observer {
 public:
  explicit Stopwatch(double seconds) : seconds_(seconds), begin_(wall_now()) {}

  void at(const Instant&) override {  // of the start, too
    last_ = wall_now();
    if (seen_++ <= kWarmUp) first_ = last_;
  }
  bool stop() override { return seen_ > kWarmUp + kLeast && wall_now() - begin_ > seconds_; }

  // 0 when there were too few steps
  double per_step() const {
    const int steps = seen_ - kWarmUp - 1;
    return steps < 1 ? 0 : (last_ - first_) / steps;
  }

 private:
  double seconds_, begin_, first_ = 0, last_ = 0;
  int seen_ = 0;
};

}  // namespace

std::vector<StageCost> time_stages(const PreparedRun& run, double seconds, int threads, int most_whole) {
  const size_t stages = run.plans.size();
  const double begun = wall_now();
  std::vector<StageCost> cost;
  Scene scene = run.scene;
  State state = start_state(scene);
  Standing standing;
  for (size_t k = 0; k < stages; ++k) {
    scene = run.scene;
    SolverInput& solver = scene.model.solver;
    solver.stop_on_failure = false;
    if (scene.blocks.count > most_whole) {
      solver.max_sweeps = std::min(solver.max_sweeps, most_sweeps(scene.blocks.count));
      solver.second_solver = false;
      solver.limit = solver.tolerance;  // what so few sweeps leave is no loose step
    }
    const std::vector<StagePlan> plans(run.plans.begin(), run.plans.begin() + k + 1);
    // what earlier stages have left of the time is there for the others
    Stopwatch watch((begun + seconds - wall_now()) / static_cast<double>(stages - k));
    const Workers workers(threads);
    const int64_t failed = standing.result.failed_steps;
    const double begin = wall_now();
    standing = {k == 0 ? run_stages(scene, plans, state, watch, workers)
                       : continue_stages(scene, plans, standing, state, watch, workers),
                true};
    standing.result.failure.clear();  // a stage that has not come to rest in the time of a trial
    StageCost c;
    c.step = watch.per_step(), c.at_least = standing.result.failed_steps > failed;
    c.low = c.high = wall_now() - begin;
    if (!standing.result.stages.empty()) {
      const StageResult& stage = standing.result.stages.back();
      if (stage.kind == StageKind::kStatic && stage.at_rest && stage.steps < plans[k].steps)
        c.steps_to_rest = stage.steps;
      c.ended = stage.kind == StageKind::kDynamic && stage.steps == plans[k].steps;
      if (c.step == 0 && stage.steps > 0) c.step = c.low / static_cast<double>(stage.steps);
    }
    cost.push_back(c);
  }
  double sum = 0;
  int measured = 0;
  for (const StageCost& c : cost) sum += c.step, measured += c.step > 0;
  for (size_t k = 0; k < stages; ++k) {
    StageCost& c = cost[k];
    if (c.step == 0 && measured > 0) c.step = sum / measured;
    if (c.steps_to_rest > 0) continue;
    const StageInput& stage = run.scene.model.stages[k];
    const auto all = static_cast<double>(run.plans[k].steps);
    if (c.ended) continue;
    if (stage.kind == StageKind::kDynamic)
      c.low = c.step * all / kApart, c.high = c.step * all * kApart;
    else if (stage.from_rest)
      c.high = std::max(c.low, c.step * std::min(all, kLongRest * std::max(1, run.plans[k].balances)));
    else
      c.high = std::max(c.low, c.step * all);
  }
  return cost;
}

}  // namespace talus
