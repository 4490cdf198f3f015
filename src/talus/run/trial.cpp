#include "talus/run/trial.h"

#include <algorithm>
#include <numeric>

#include "talus/base/clock.h"

namespace talus {

namespace {

// Steps that set up what later ones keep, and steps that count at least.
constexpr int kWarmUp = 2, kLeast = 2;

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

std::vector<double> time_steps(const PreparedRun& run, double seconds, int threads) {
  const size_t stages = run.plans.size();
  std::vector<double> cost;
  for (size_t k = 0; k < stages; ++k) {
    Scene scene = run.scene;
    scene.model.stages = {run.scene.model.stages[k]};
    const std::vector<StagePlan> plan{run.plans[k]};
    State state = start_state(scene);
    Stopwatch watch(seconds / static_cast<double>(stages));
    run_stages(scene, plan, state, watch, Workers(threads));
    cost.push_back(watch.per_step());
  }
  const auto measured =
      static_cast<double>(std::count_if(cost.begin(), cost.end(), [](double c) { return c > 0; }));
  const double mean = measured > 0 ? std::accumulate(cost.begin(), cost.end(), 0.0) / measured : 0;
  for (double& c : cost)
    if (c == 0) c = mean;
  return cost;
}

}  // namespace talus
