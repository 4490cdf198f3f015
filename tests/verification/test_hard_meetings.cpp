// How hard blocks meet that a step brings past a corner or on to a face: no blow where nothing is struck, no overlap
// where something is. Forces follow from the sides that face each other; numbers from free motion.

#include <random>

#include "support/junction_models.h"

namespace test_hard_meetings {

using namespace talus;
using namespace talus::test;
using namespace talus::test::junction;

namespace {

std::vector<Vec2> corners_now(const Scene& scene, const State& state, int block) {
  std::vector<Vec2> out;
  for (int v = 0; v < scene.blocks.vertex_count(block); ++v)
    out.push_back(scene.blocks.centroid[block] + offset_now(state, block, scene.blocks.corner({block, v})));
  return out;
}

// How deep two convex polygons are in each other, by the side that is the nearest way out; < 0: apart [m].
double depth(const std::vector<Vec2>& p, const std::vector<Vec2>& q) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [own, other] : {std::pair(&p, &q), std::pair(&q, &p)})
    for (size_t k = 0; k < own->size(); ++k) {
      const Vec2 from = (*own)[k], side = (*own)[(k + 1) % own->size()] - from;
      double most = -std::numeric_limits<double>::infinity();
      for (const Vec2 x : *other) most = std::max(most, cross(side, x - from) / norm(side));
      least = std::min(least, most);
    }
  return least;
}

}  // namespace

// Steps of 2 m/s from 40 to 2000 micrometres, so that the joint is passed by far more and far less than what a contact
// of 1 m may be level by (1e-4 of it), at four places of a step.
TEST_CASE("a hard block is not struck by the slanted face under the corner that it slides over") {
  constexpr double kSpeed = 2;
  for (const double lean : {15, 30, 45, 60, 90, 120, 150, 165})
    for (const double dt : {1e-3, 2e-4, 2e-5})
      for (const double phase : {0.1, 0.35, 0.6, 0.85}) {
        CAPTURE(lean);
        CAPTURE(dt);
        CAPTURE(phase);
        const double way = kSpeed * dt, back = 1 / std::tan(lean * kDegree), right = -(8 + phase) * way;
        const CaseResult r = audited(
            head(kHard, kG, 0) + block_text("f0", {{-3 - back, -1}, {-back, -1}, {0, 0}, {-3, 0}}, "fixed") +
            block_text("f1", {{-back, -1}, {3 - back, -1}, {3, 0}, {0, 0}}, "fixed") +
            block_text("b", {{right - 1, 0}, {right, 0}, {right, 1}, {right - 1, 1}}, "rigid",
                       fmt::format("velocity = [{}, 0]", kSpeed)) +
            stage("slide", true, 20 * dt, dt) + "[[monitor]]\nname = \"b\"\ncentroid = \"b\"\n");
        double off = 0;
        const auto &x = r.column("b.velocity_x"), &y = r.column("b.velocity_y");
        for (size_t i = 0; i < x.size(); ++i) off = std::max({off, std::abs(x[i] - kSpeed), std::abs(y[i])});
        // a thousandth of the weight's work in a step: what a contact gives until it bears the block
        check_below("slides over a slanted joint: change of velocity [m/s]", off, 2e-3 * kG * dt, 1e-9);
      }
}

// Faces that are turned by less than they close in a step: one corner comes first, and the other way of the two is
// left by then. Of a step of 4 to 10 mm nothing but what the turn of a step bends (turn^2/2 of 0.3 m) may be let in.
TEST_CASE("hard faces that close on each other in one step are met in that step") {
  std::mt19937 random(7);
  const auto between_two = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  constexpr double kStep = 1.25e-3, kMostSpin = 40;
  double worst = 0;
  for (int seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const double turn = between_two(-1.5, 1.5) * kDegree, aside = between_two(-0.29, 0.29),
                 gap = between_two(1e-4, 1e-3), speed = between_two(3, 8), spin = between_two(-5, 5);
    const auto at = [&](double x, double y) {
      return Vec2{x * std::cos(turn) - y * std::sin(turn), x * std::sin(turn) + y * std::cos(turn)};
    };
    std::vector<Vec2> b{at(-0.15, -0.15), at(0.15, -0.15), at(0.15, 0.15), at(-0.15, 0.15)};
    const double low = std::min(b[0].y, b[1].y);
    for (Vec2& x : b) x += Vec2{aside, gap - low};
    const std::string joint = fmt::format("velocity = [0, {}]\nspin = {}", -speed, spin);
    double deepest = 0, fastest = 0;
    audited(head(kHard, kG, 20) + block_text("a", box_polygon(-0.15, -0.3, 0.15, 0), "rigid") +
                block_text("b", b, "rigid", joint) + stage("fall", true, 8 * kStep, kStep),
            [&](const Instant& i) {
              deepest = std::max(deepest,
                                 depth(corners_now(i.scene, i.state, 0), corners_now(i.scene, i.state, 1)));
              for (const BlockRate& v : i.state.rate) fastest = std::max(fastest, std::abs(v.G.xy));
            });
    CHECK(fastest < kMostSpin);
    worst = std::max(worst, deepest);
  }
  const double bent = 0.5 * kMostSpin * kStep * kMostSpin * kStep * 0.3;
  check_below("faces that close in one step: overlap [m]", worst, bent, 1e-6);
}

// Further off than 2 % of the block, and nearer than it goes in a step: it is seen coming, and met.
TEST_CASE("a fast block does not end its step in what it hits") {
  constexpr double kStep = 1e-3, kSpeed = 20, kSize = 0.3;
  for (const double share : {0.4, 0.6, 0.9}) {  // of the step's way, 20 mm: more than 6 mm
    CAPTURE(share);
    const double gap = share * kSpeed * kStep;
    double deepest = 0;
    audited(head(kHard, 0, 0) + block_text("a", box_polygon(-1, -1, 1, 0), "fixed") +
                block_text("b", box_polygon(0, gap, kSize, gap + kSize), "rigid",
                           fmt::format("velocity = [0, {}]", -kSpeed)) +
                stage("fall", true, 4 * kStep, kStep),
            [&](const Instant& i) {
              deepest = std::max(deepest,
                                 depth(corners_now(i.scene, i.state, 0), corners_now(i.scene, i.state, 1)));
            });
    check_below("a fast block: overlap [m]", deepest, 1e-9, 1e-13);  // of 20 mm
  }
}

}  // namespace test_hard_meetings
