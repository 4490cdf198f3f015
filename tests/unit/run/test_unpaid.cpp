// A step from rest ends where joints hold no more than was done on them: a corner that goes into a face finds more of it than
// its first row had (theory 14.2).

#include <fmt/format.h>

#include <algorithm>

#include "support/relative.h"
#include "support/run_case.h"

namespace test_unpaid {

using namespace talus;
using namespace talus::test;

namespace {

std::string block_text(const char* name, const char* polygon, const char* kind) {
  return fmt::format("[[block]]\nname = \"{}\"\npolygon = {}\nmaterial = \"m\"\nkind = \"{}\"\n", name,
                     polygon, kind);
}

// A block on two feet, which touch a floor by their corners alone.
std::string two_feet(double stiffness, double time_step, const std::string& beside = {}) {
  return fmt::format(
             "talus = 1\n[model]\ngravity = [0, -10]\n[material.m]\ndensity = 2500\n[joint.j]\n"
             "friction_angle = \"30 deg\"\nnormal_stiffness = {0}\nshear_stiffness = {0}\n[contact]\njoint = \"j\"\n",
             stiffness) +
         block_text("floor", "[[-3, -1], [3, -1], [3, 0], [-3, 0]]", "fixed") +
         block_text("trestle", "[[-1, 0], [0, 0.5], [1, 0], [1.5, 1], [-1.5, 1]]", "rigid") +
         fmt::format(
             "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 10\ntime_step = {}\nunbalanced = 1e-9\n",
             time_step) +
         beside;
}

// On a floor and a joint of its own, far from all else: a square, or a block that leans out and stands on a part of its foot.
std::string heavy_block(double side, double leans) {
  const std::string low = fmt::format("[[10, -1], [{0}, -1], [{0}, 0], [10, 0]]", 12 + side),
                    high = fmt::format("[[11, 0], [{0}, 0], [{1}, {2}], [{3}, {2}]]", 11 + side,
                                       11 + side + leans, side, 11 + leans);
  return "[joint.w]\nfriction_angle = \"30 deg\"\nnormal_stiffness = 1e8\nshear_stiffness = 1e8\n[[contact_pair]]\n"
         "between = [\"ground\", \"heavy\"]\njoint = \"w\"\n" +
         block_text("ground", low.c_str(), "fixed") + block_text("heavy", high.c_str(), "rigid");
}

struct Stood {
  double sunk = 0, farthest = 0, given = 0;
  int64_t steps = 0;
};

Stood stood(double stiffness, double time_step, const std::string& beside = {}) {
  Stood out;
  double largest = 0;
  const CaseResult r = run_case(two_feet(stiffness, time_step, beside), {}, [&](const Instant& i) {
    const Energy& e = i.report.energy;
    largest = std::max(largest, e.largest());
    out.given = std::max(out.given, e.work[Cause::kJoints]);
    out.farthest = std::max(out.farthest, -i.state.displacement[1].y);
  });
  const StageResult& stage = r.run.stages.at(0);
  CHECK(stage.at_rest);
  CHECK(!stage.followed());
  out.sunk = -r.state.displacement[1].y, out.steps = stage.steps, out.given /= largest;
  return out;
}

}  // namespace

TEST_CASE("joints of corners that go into a face from rest hold no more than was done on them") {
  // from a softer floor, into which the feet go as far as the first step takes them, to one a hundred times stiffer
  for (const double stiffness : {1e9, 1e10, 1e11}) {
    CAPTURE(stiffness);
    const Stood whole = stood(stiffness, 0.02), half = stood(stiffness, 0.01);
    CHECK(whole.given <= 1e-3);
    CHECK(whole.steps <= 40);
    CHECK(half.sunk == approx(whole.sunk).epsilon(1e-6));
  }
}

TEST_CASE("no ordinary block beside hides a corner that goes in further than it is paid for") {
  for (const double stiffness : {1e9, 1e10, 1e11})
    for (const double leans : {0.0, 0.3, 0.6, 0.8}) {
      CAPTURE(stiffness);
      CAPTURE(leans);
      const double side = 6;
      const Stood alone = stood(stiffness, 0.02),
                  beside = stood(stiffness, 0.02, heavy_block(side, leans * side));
      CHECK(beside.sunk == approx(alone.sunk).epsilon(1e-6));
      CHECK(beside.farthest <= 1.1 * alone.sunk);
    }
}

TEST_CASE("a face that breaks at the end of a step from rest has borne its joint until then") {
  // a block whose foot breaks in shear and slides against a soft stop
  const std::string text =
      "talus = 1\n[model]\ngravity = [3, -10]\n[material.m]\ndensity = 2500\n[joint.foot]\n"
      "friction_angle = \"10 deg\"\ncohesion = 100\nnormal_stiffness = 1e9\nshear_stiffness = 1e9\n"
      "[joint.stop]\nfriction_angle = 0\nnormal_stiffness = 1e7\nshear_stiffness = 1e7\n[contact]\njoint = \"stop\"\n"
      "[[contact_pair]]\nbetween = [\"floor\", \"block\"]\njoint = \"foot\"\n" +
      block_text("floor", "[[0, -1], [3, -1], [3, 0], [0, 0]]", "fixed") +
      block_text("block", "[[1, 0], [2, 0], [2, 1], [1, 1]]", "rigid") +
      block_text("stop", "[[2, 0], [3, 0], [3, 1], [2, 1]]", "fixed") +
      "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 10\n";
  double shortest = 1;
  const CaseResult r =
      run_case(text, {}, [&](const Instant& i) { shortest = std::min(shortest, i.work.clock.dt); });
  CHECK(r.run.stages.at(0).at_rest);
  CHECK(r.state.face.at(0).broken);
  CHECK(shortest == 0.02);
}

}  // namespace test_unpaid
