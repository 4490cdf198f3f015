// Forces between blocks that press each other do not vanish for a step: what searches for contact points finds the same face
// whichever of its corners passes the other.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <map>

#include "support/run_case.h"
#include "support/shaken_bricks.h"

namespace test_vanishing_forces {

using namespace talus;
using namespace talus::test;

namespace {

using Pair = std::pair<int, int>;

// The normal forces of pairs of blocks at the last three instants.
class Watch {
 public:
  void operator()(const Instant& now) {
    std::map<Pair, double> force, overlap;
    for (const FramePoint& p : frame_points(now.scene, now)) {
      if (p.kind != 0) continue;
      const Pair pair = std::minmax(p.block_a, p.block_b);
      force[pair] += p.normal_force;
      overlap[pair] = std::max(overlap[pair], -p.gap);
    }
    last_[0] = std::move(last_[1]), last_[1] = std::move(last_[2]);
    last_[2] = {std::move(force), std::move(overlap)};
    // pressed as much before as after, and as deep in between: it cannot have been free
    for (const auto& [pair, before] : last_[0].force) {
      const double after = last_[2].of(last_[2].force, pair), weight = 9.81 * now.scene.blocks.mass[0];
      ++pressed;
      if (std::min(before, after) < 0.1 * weight || std::max(before, after) > 1.5 * std::min(before, after))
        continue;
      if (last_[1].of(last_[1].force, pair) > 0.5 * std::min(before, after)) continue;
      const double deep = std::min(last_[0].of(last_[0].overlap, pair), last_[2].of(last_[2].overlap, pair));
      if (last_[1].of(last_[1].overlap, pair) < 0.5 * deep) continue;
      if (lost.size() < 5)
        lost.push_back(fmt::format("{} and {} before t = {:g} s: {:.3g} N, {:.3g} N, {:.3g} N",
                                   now.scene.blocks.name[pair.first], now.scene.blocks.name[pair.second],
                                   now.state.time, before, last_[1].of(last_[1].force, pair), after));
    }
  }

  std::vector<std::string> lost;
  int64_t pressed = 0;

 private:
  struct Forces {
    std::map<Pair, double> force, overlap;
    static double of(const std::map<Pair, double>& list, const Pair& pair) {
      const auto at = list.find(pair);
      return at == list.end() ? 0 : at->second;
    }
  };
  std::array<Forces, 3> last_;
};

}  // namespace

TEST_CASE("forces of a shaken wall do not vanish for a step where corners pass each other") {
  // as it stands, and of softer joints that open wider
  for (const double stiffness : {5e9, 2e9, 6e8}) {
    Watch watch;
    const CaseResult r = run_case(kShakenBricks,
                                  {fmt::format("joint.face.normal_stiffness={}", stiffness),
                                   fmt::format("joint.face.shear_stiffness={}", stiffness)},
                                  [&](const Instant& now) { watch(now); });
    INFO("stiffness " << stiffness);
    CHECK(r.run.failure.empty());
    CHECK(watch.pressed > 20 * r.run.steps);  // of some forty pairs: the watch has seen them
    std::string lost;
    for (const std::string& line : watch.lost) lost += line + "\n";
    CHECK(lost == "");
  }
}

}  // namespace test_vanishing_forces
