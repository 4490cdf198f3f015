// How far the forces of a step are from those of where it ends: would a second look at the patches pay?
//
// A step has one look: its rows begin with the patches of its beginning and go on linearly (theory 3.3, 4.6). After it each
// patch of an elastic joint is compared with itself a step later: the normal force that its closure then says, and the one that
// the closure and velocity of the step said it would. What both differ by, summed over all patches, over the sum of the
// forces is what a second look could mend. What it would cost is the part of a step that is search, rows and solution.
//
// Usage: second_look SCENE... (of talus-bench), each 0.2 s of settling and 0.6 s of shaking with 0.3 g at 2 Hz, joints of
// 20 GPa/m, steps of 0.2, 0.1 and 0.05 ms by two threads.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <tuple>
#include <vector>

#include "talus_engine.h"

namespace {

using namespace talus;
using namespace talus::bench;

using Key = std::tuple<int, int, int, int, int>;

Key key_of(const Patch& p) { return {p.block_a, p.block_b, p.side_a, p.side_b, p.way}; }

struct Look {
  double apart = 0, all = 0;  // sums over patches [N]
};

class SecondLook {
 public:
  explicit SecondLook(double stiffness) : stiffness_(stiffness) {}

  // Before the drift of a step: what its patches will bear at its end.
  void foresee(TalusEngine& engine, double dt) {
    expected_.clear();
    const RowSet& rows = engine.work().rows;
    const size_t first = rows.range(Family::kContact).begin;
    const State& state = engine.state();
    for (size_t i = 0; i < state.patches.size(); ++i) {
      const Patch& p = state.patches[i];
      if (!p.overlaps) continue;
      double mean = 0;
      for (size_t end = 0; end < 2; ++end)
        mean +=
            0.5 * (p.closure[end] - dt * relative_velocity(rows.points[first + 2 * i + end], state.rate)[0]);
      expected_[key_of(p)] += stiffness_ * p.length * mean;
    }
  }

  // A step later: patches that are still there.
  Look look(const State& state) const {
    std::map<Key, double> now;
    for (const Patch& p : state.patches)
      if (p.overlaps) now[key_of(p)] += stiffness_ * p.length * 0.5 * (p.closure[0] + p.closure[1]);
    Look out;
    for (const auto& [key, force] : now) {
      const auto then = expected_.find(key);
      out.all += std::abs(force);
      if (then != expected_.end()) out.apart += std::abs(force - then->second);
    }
    return out;
  }

 private:
  double stiffness_;
  std::map<Key, double> expected_;
};

}  // namespace

int main(int argc, char** argv) {
  fmt::print("{:<12} {:>6} {:>8} {:>10} {:>10} {:>10} {:>8} {:>8}\n", "scene", "blocks", "step [s]", "median",
             "of 99 %", "worst", "look", "solve");
  for (int k = 1; k < argc; ++k)
    for (const double dt : {2e-4, 1e-4, 5e-5}) {
      const BenchScene scene = named_scene(argv[k]);
      EngineOptions options;
      options.stiffness = 20e9, options.threads = 2, options.sweeps = 200;
      TalusEngine engine(scene, options);
      SecondLook second(options.stiffness);
      std::vector<double> share;
      const int settle = static_cast<int>(std::lround(0.2 / dt)),
                shake = static_cast<int>(std::lround(0.6 / dt));
      bool seen = false;
      for (int n = 0; n < settle + shake; ++n) {
        const double t = (n - settle) * dt;
        if (n >= settle) engine.set_gravity({0.3 * kGravity * std::sin(4 * std::numbers::pi * t), -kGravity});
        engine.step(dt);
        const bool asked = n >= settle && n % 10 < 2;
        if (asked && seen) {
          const Look l = second.look(engine.state());
          if (l.all > 0) share.push_back(l.apart / l.all);
        }
        seen = asked && n % 10 == 0;
        if (seen) second.foresee(engine, dt);
      }
      std::sort(share.begin(), share.end());
      const Profile& p = engine.work().profile;
      const double all = p.total();
      const auto part = [&](std::initializer_list<Profile::Part> parts) {
        double sum = 0;
        for (const Profile::Part of : parts) sum += p.seconds[of];
        return sum / all;
      };
      fmt::print(
          "{:<12} {:>6} {:>8} {:>10.2e} {:>10.2e} {:>10.2e} {:>8.2f} {:>8.2f}\n", argv[k], scene.moving(), dt,
          share[share.size() / 2], share[share.size() * 99 / 100], share.back(),
          part({Profile::kMargins, Profile::kSearch, Profile::kRows, Profile::kLayout, Profile::kRecords}),
          part({Profile::kSweeps, Profile::kAsks, Profile::kNewton, Profile::kJudge}));
      std::fflush(stdout);
    }
}
