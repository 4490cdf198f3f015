// Strength that scatters from face to face: the draws against their distribution, and what stands against the draws.

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/base/angle.h"
#include "talus/model/strength_scatter.h"

namespace test_scattered_strength {

using namespace talus;
using namespace talus::test;

TEST_CASE("strengths drawn from face to face have the mean and the deviation asked for") {
  constexpr int kFaces = 40000;
  for (const auto kind : {StrengthScatter::kNormal, StrengthScatter::kLognormal}) {
    const StrengthScatter s{kind, 5, 1.5, 0, 1e9, strength_seed(7, "bed", "cohesion")};
    double sum = 0, squares = 0, least = 1e9;
    for (int i = 0; i < kFaces; ++i) {
      const double v = s.draw(i, i + 1);
      sum += v, squares += v * v, least = std::min(least, v);
      CHECK(v <= s.largest());
    }
    const double mean = sum / kFaces, deviation = std::sqrt(squares / kFaces - mean * mean);
    // errors of means and deviations of so many draws, four of theirs: 4 x 1.5 / 200, and twice that of heavy tails;
    // normal draws below 0 are drawn anew (0.04 %: +0.002)
    check_below("mean", std::abs(mean - 5), 0.033, 0);
    check_below("deviation", std::abs(deviation - 1.5), 0.06, 0);
    CHECK(least > 0);
    CHECK(s.draw(3, 8) == s.draw(8, 3));
    CHECK(s.draw(3, 8) != s.draw(3, 9));
  }
  const StrengthScatter one{StrengthScatter::kNormal, 5, 1, 0, 1e9, strength_seed(1, "bed", "cohesion")},
      two{StrengthScatter::kNormal, 5, 1, 0, 1e9, strength_seed(2, "bed", "cohesion")},
      other{StrengthScatter::kNormal, 5, 1, 0, 1e9, strength_seed(1, "head", "cohesion")};
  CHECK(one.draw(0, 1) != two.draw(0, 1));
  CHECK(one.draw(0, 1) != other.draw(0, 1));
}

TEST_CASE("stones on a tilted floor slide where the drawn friction says so") {
  // friction angle 30 +- 3 deg, slope 30 deg by the direction of gravity
  constexpr int kStones = 60;
  std::string text = R"(talus = 1
[model]
gravity = [4.905, -8.4957]
[material.m]
density = 2000
[joint.bed]
friction_angle = { mean = "30 deg", lognormal = "3 deg", seed = 5 }
[contact]
joint = "bed"
[[block]]
name = "floor"
polygon = [[-10, -1], [400, -1], [400, 0], [-10, 0]]
material = "m"
kind = "fixed"
[[stage]]
name = "go"
kind = "dynamic"
duration = 1
time_step = "5 ms"
)";
  for (int i = 0; i < kStones; ++i)
    text += fmt::format(
        "[[block]]\nname = \"s{0}\"\npolygon = [[{1}, 0], [{2}, 0], [{2}, 0.5], [{1}, 0.5]]\nmaterial = \"m\"\nkind = "
        "\"rigid\"\n[[monitor]]\nname = \"s{0}\"\ncentroid = \"s{0}\"\n",
        i, 6 * i, 6 * i + 1);
  const CaseResult r = run_case(text);
  const StrengthScatter s{StrengthScatter::kLognormal,
                          30 * kDegree,
                          3 * kDegree,
                          0,
                          2,
                          strength_seed(5, "bed", "friction_angle")};
  const double g = std::hypot(4.905, 8.4957);
  int slid = 0;
  for (int i = 0; i < kStones; ++i) {
    const double phi = s.draw(0, i + 1), moved = r.column(fmt::format("s{}.displacement_x", i)).back();
    // a = g (sin 30 - cos 30 tan phi), for 1 s
    const double expected = std::max(0.0, 0.5 * (4.905 - 8.4957 * std::tan(phi)));
    INFO(i, ", friction ", phi / kDegree);
    // one step of 5 ms of the first second; give of hard contacts
    CHECK(std::abs(moved - expected) <= 0.01 * expected + 1e-5 * g);
    slid += expected > 0;
  }
  // P(phi < 30 deg) of a lognormal of this mean and deviation is 0.52: 31 of 60, four deviations of 3.9
  CHECK(slid > 15);
  CHECK(slid < 47);
}

}  // namespace test_scattered_strength
