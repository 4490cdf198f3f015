#include "talus/run/trial.h"

#include <algorithm>

#include "talus/base/clock.h"

namespace talus {

namespace {

// Steps that set up what later ones keep, and steps that count at least.
constexpr int kWarmUp = 2, kLeast = 2;
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

std::vector<StepCost> time_steps(const PreparedRun& run, double seconds, int threads) {
  const size_t stages = run.plans.size();
  std::vector<StepCost> cost;
  Scene scene = run.scene;
  State state = start_state(scene);
  Standing standing;
  for (size_t k = 0; k < stages; ++k) {
    scene = run.scene;
    SolverInput& solver = scene.model.solver;
    solver.max_sweeps = std::min(solver.max_sweeps, most_sweeps(scene.blocks.count));
    solver.second_solver = solver.stop_on_failure = false;
    solver.limit = solver.tolerance;  // what so few sweeps leave is no loose step
    const std::vector<StagePlan> plans(run.plans.begin(),
                                       run.plans.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    Stopwatch watch(seconds / static_cast<double>(stages));
    const Workers workers(threads);
    const int64_t failed = standing.result.failed_steps;
    standing = {k == 0 ? run_stages(scene, plans, state, watch, workers)
                       : continue_stages(scene, plans, standing, state, watch, workers),
                true};
    standing.result.failure.clear();  // a stage that has not come to rest in the time of a trial
    cost.push_back({watch.per_step(), standing.result.failed_steps > failed});
  }
  double sum = 0;
  int measured = 0;
  for (const StepCost& c : cost) sum += c.seconds, measured += c.seconds > 0;
  for (StepCost& c : cost)
    if (c.seconds == 0 && measured > 0) c.seconds = sum / measured;
  return cost;
}

}  // namespace talus
