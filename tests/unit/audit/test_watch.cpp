#include "talus/audit/watch.h"

#include <doctest/doctest.h>

#include <cmath>
#include "support/box_polygon.h"

namespace test_watch {

using namespace talus;
using namespace talus::test;
using namespace talus::audit;

namespace {

// A floor and a block of 1 m on it, whose place is given step by step.
struct Two {
  Rules rules;
  Report report;
  Watch watch{rules};
  std::vector<StepBlock> blocks{{std::sqrt(3.0), 2, 0.75, Hold::kPrescribed}, {1, 0.8, 0.625, Hold::kFree}};

  Two() { rules.names = {"floor", "block"}, rules.slop = 1e-7; }
  void step(Vec2 foot, const std::vector<StepPoint>& points, double time = 1) {
    const std::vector<Vec2> centroid{{0.5, -0.5}, foot + Vec2{0.5, 0.5}};
    watch.look({time, 1e-3, points, centroid, blocks,
                [foot](int i) {
                  return Block{Hold::kFree,
                               i == 0 ? box_polygon(-1, -1, 2, 0)
                                      : box_polygon(foot.x, foot.y, foot.x + 1, foot.y + 1),
                               {}};
                }},
               report);
  }
  int64_t count(Defect d) const { return report.of(d).count; }
};

StepPoint point(int corner, double force, double gap) { return {1, corner, 0, 2, force, gap}; }

}  // namespace

TEST_CASE("audit watch: a force that goes while the two overlap") {
  const double d = 0.01;
  SUBCASE("the point is gone") {
    Two t;
    t.step({0, -d}, {point(0, 1e5, -d), point(1, 1e5, -d)});
    t.step({0, -d}, {point(1, 1e5, -d)}, 2);
    CHECK(t.count(Defect::kForceVanished) == 1);
    const Finding& f = t.report.of(Defect::kForceVanished).worst;
    CHECK(f.invalid);
    CHECK(f.time == 2);
    CHECK(f.place.x == 0);
    CHECK(f.place.y == -d);
    CHECK(!t.report.valid());
  }
  SUBCASE("the point is there, the force is not") {
    Two t;
    t.step({0, -d}, {point(0, 1e5, -d)});
    t.step({0, -d}, {point(0, 0, -d)});
    CHECK(t.count(Defect::kForceVanished) == 1);
  }
  SUBCASE("the two have parted") {
    Two t;
    t.step({0, -d}, {point(0, 1e5, -d)});
    t.step({0, 1e-3}, {});
    CHECK(t.count(Defect::kForceVanished) == 0);
  }
  SUBCASE("another point at the same place has it, under another name") {
    Two t;
    t.step({0, -d}, {point(0, 1e5, -d)});
    t.step({0, -d}, {{1, 0, 0, 1, 1e5, -d}});
    CHECK(t.count(Defect::kForceVanished) == 0);
  }
  SUBCASE("a new stage asks nothing of the one before") {
    Two t;
    t.step({0, -d}, {point(0, 1e5, -d)});
    t.watch.forget();
    t.step({0, -d}, {});
    CHECK(t.count(Defect::kForceVanished) == 0);
    CHECK(t.report.steps == 0);
  }
}

TEST_CASE(
    "audit watch: a hard patch that keeps an overlap lets go as the two part, but for the arc of the step") {
  // the block turns by 5 mrad a step about its centroid: its corners leave their tangents by 0.5 (5e-3)^2 0.8 = 1e-5 m
  const double d = 0.02;
  const auto vanished = [&](double closing, double spin, bool hard, double damping_time = 0) {
    Two t;
    const StepPoint end{0, 2, 1, -2, 1e5, -d, hard, {0.5, -0.5 * d}, {0, -1}, damping_time};
    for (const bool held : {true, false}) {
      std::vector<StepPoint> points;
      if (held) points.push_back(end);
      const std::vector<Vec2> centroid{{0.5, -0.5}, {0.5, 0.5 - d}};
      t.watch.look(
          {held ? 1.0 : 2.0, 1e-3, points, centroid, t.blocks,
           [&](int i) {
             Block block{Hold::kFree, i == 0 ? box_polygon(-1, -1, 2, 0) : box_polygon(0, -d, 1, 1 - d), {}};
             if (i == 0) return block;
             for (const Vec2 x : block.polygon)
               block.next.push_back(Vec2{0, -closing} +
                                    spin * Vec2{-(x - centroid[1]).y, (x - centroid[1]).x});
             return block;
           }},
          t.report);
    }
    return t.count(Defect::kForceVanished) == 1;
  };
  CHECK(!vanished(-1e-3, 0, true));
  CHECK(vanished(-1e-3, 0, false));
  CHECK(vanished(1e-3, 0, true));
  CHECK(!vanished(5e-3, 5, true));
  CHECK(vanished(20e-3, 5, true));
  // of an elastic joint dashpots take as much of the overlap as they part in the damping time, beside three steps of any way
  CHECK(vanished(-1, 0, false));
  CHECK(vanished(-1, 0, false, 0.016));
  CHECK(!vanished(-1, 0, false, 0.018));
  CHECK(vanished(1, 0, false, 0.018));
}

TEST_CASE(
    "audit watch: a hard patch that keeps an overlap is judged where the blocks have carried it, along its normal there") {
  // both move by 8 mm a step; the block turns by 5 mrad a step about its centroid
  const double d = 0.02, spin = 5, dt = 1e-3;
  const Vec2 along{8, 0};
  const auto vanished = [&](double closing, double tilt, bool normal_turns) {
    Two t;
    const Vec2 at{0.5, -0.5 * d};
    for (const bool held : {true, false}) {
      const Vec2 gone = held ? Vec2{} : dt * along;
      const double angle = held || !normal_turns ? 0 : tilt;
      const std::vector<StepPoint> points{
          {0, 2, 1, -2, held ? 1e5 : 0, -d, true, at + gone, {std::sin(angle), -std::cos(angle)}}};
      const std::vector<Vec2> centroid{Vec2{0.5, -0.5} + gone, Vec2{0.5, 0.5 - d} + gone};
      t.watch.look({held ? 1.0 : 2.0, dt, points, centroid, t.blocks,
                    [&](int i) {
                      Block block{Hold::kFree,
                                  i == 0 ? box_polygon(-1 + gone.x, -1, 2 + gone.x, 0)
                                         : box_polygon(gone.x, -d, 1 + gone.x, 1 - d),
                                  {}};
                      for (const Vec2 x : block.polygon) {
                        // the block turns about the place of the patch, and slides to the left
                        const Vec2 turns = spin * Vec2{-(x - at - gone).y, (x - at - gone).x};
                        block.velocity.push_back(i == 0 ? along : along + turns);
                        block.next.push_back(i == 0 ? along : along + turns + Vec2{-2, -closing});
                      }
                      return block;
                    }},
                   t.report);
    }
    return t.count(Defect::kForceVanished) == 1;
  };
  // seen at the place of the step before it closes by 8 mm x 5 / s
  CHECK(!vanished(0, 0, true));
  CHECK(vanished(15e-3, 0, true));
  // a normal that has turned by 4 mrad: what slides at 2 m/s parts along it by 8 mm/s
  CHECK(!vanished(15e-3, 4e-3, true));
  CHECK(vanished(15e-3, 4e-3, false));
  // not so a normal that has turned by more than the blocks
  CHECK(vanished(15e-3, 30e-3, true));
}

TEST_CASE(
    "audit watch: how deep the two are in each other, and how large the force was, says whether it counts") {
  struct Gone {
    double depth, force;  // of a block of 1 m, with another force of 1e5 N
    bool invalid;
  };
  for (const auto& [depth, force, invalid] :
       {Gone{3e-5, 1e5, false}, Gone{5e-4, 1e5, true}, Gone{5e-4, 4e3, false}, Gone{2e-3, 4e3, true}}) {
    CAPTURE(depth);
    CAPTURE(force);
    Two t;
    t.step({0, -depth}, {point(0, force, -depth), point(1, 1e5, -depth)});
    t.step({0, -depth}, {point(1, 1e5, -depth)}, 2);
    CHECK(t.count(Defect::kForceVanished) == 1);
    CHECK(t.report.of(Defect::kForceVanished).worst.invalid == invalid);
  }
}

TEST_CASE("audit watch: a block that goes through another within a step") {
  Two t;
  t.step({0, 0.2}, {});
  t.step({0, -0.1}, {});  // a tenth of the floor
  CHECK(t.count(Defect::kCrossed) == 0);
  t.step({0, 0.2}, {});
  t.step({0, -0.4}, {});  // to the middle of it
  CHECK(t.count(Defect::kCrossed) == 1);
  t.step({0, 0.1}, {});
  t.step({0, -3}, {});  // out on the other side
  CHECK(t.report.of(Defect::kCrossed).worst.block_a == 0);
  CHECK(t.count(Defect::kCrossed) == 2);
  // past it, and along its top
  Two along;
  along.step({-0.9, 0}, {});
  along.step({0.9, 0}, {});
  CHECK(along.count(Defect::kCrossed) == 0);
}

}  // namespace test_watch
