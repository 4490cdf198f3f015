// A tip between two hard blocks: a way out that a third block fills is none.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/convex_parts.h"
#include "talus/base/angle.h"

namespace test_corner {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kIn = 1e-6;  // what a tip is in [m]

bool lies_in(const Body& body, Vec2 place) {
  for (size_t k = 0; k < body.corner.size(); ++k)
    if (cross(body.at(k + 1) - body.at(k), place - body.at(k)) < 0) return false;
  return true;
}

// How two hard parts meet where others fill the places behind their sides: apart, if they do not.
// @param behind  ways that are so much worse than the best are none
PartsMet meet_beside(const Body& a, const Body& b, const std::vector<Body>& thirds, double behind = kLevel) {
  PartsMeeting meeting;
  const Seen one(a), two(b);
  const PartsMet& met =
      meeting.look(one.now(), two.now(), b.origin - a.origin, kMargin, kRounding, {.behind = behind});
  if (met.kind == PartsMet::kFar) return met;
  const WayBefore before{0, kLevel};
  meeting.choose_way({}, {}, before);
  const auto is_in_third = [&](Vec2 x) {
    return std::any_of(thirds.begin(), thirds.end(),
                       [&](const Body& third) { return lies_in(third, a.origin + x); });
  };
  for (CornerSide& s : meeting.sides_at_corner(kLevel))
    s.filled = is_in_third(s.behind[0]) && is_in_third(s.behind[1]);
  if (meeting.leave_out_filled()) meeting.choose_way({}, {}, before);
  return met;
}

// Of the force on the tip, whichever of the two is a; none where they do not meet.
Vec2 normal(const Body& tip, const Body& own, const std::vector<Body>& thirds) {
  const PartsMet met = meet_beside(tip, own, thirds), back = meet_beside(own, tip, thirds);
  CHECK(met.kind == back.kind);
  if (met.kind == PartsMet::kFar) return {};
  CHECK(norm(met.normal + back.normal) < 1e-12);
  return met.normal;
}

// A tip of `angle` [deg] in the corner at the origin, its lower side `lean` [deg] above the horizontal.
Body wedge(double lean, double angle) {
  return {{{0, 0}, turned({1, 0}, lean * kDegree), turned({1, 0}, (lean + angle) * kDegree)}, {-kIn, -kIn}};
}

const Body kFloor{box_polygon(-1, -1, 2, 0), {}}, kWall{box_polygon(-1, 0, 0, 2), {}},
    kThird{box_polygon(-1, -1, 0, 0), {}}, kHalfFloor{box_polygon(0, -1, 2, 0), {}},
    kTall{box_polygon(-1, -1, 0, 2), {}}, kMitredFloor{{{0, 0}, {-1, -1}, {2, -1}, {2, 0}}, {}},
    kMitredWall{{{0, 0}, {0, 2}, {-1, 2}, {-1, -1}}, {}};

}  // namespace

TEST_CASE(
    "hard contacts: a tip in the corner of two blocks meets each along its normal, and nothing behind") {
  for (const double lean : {0.0, 15.0, 25.0, 35.0}) {
    CAPTURE(lean);
    const Body tip = wedge(lean, 40);
    CHECK(norm(normal(tip, kWall, {kFloor}) - Vec2{1, 0}) < 1e-12);
    CHECK(norm(normal(tip, kFloor, {kWall}) - Vec2{0, 1}) < 1e-12);
    CHECK(norm(normal(tip, kHalfFloor, {kTall}) - Vec2{0, 1}) < 1e-12);
    CHECK(norm(normal(tip, kTall, {kHalfFloor}) - Vec2{1, 0}) < 1e-12);
    CHECK(norm(normal(tip, kWall, {kHalfFloor, kThird}) - Vec2{1, 0}) < 1e-12);
    CHECK(norm(normal(tip, kHalfFloor, {kWall, kThird}) - Vec2{0, 1}) < 1e-12);
    // flat on the floor the tip's upper side goes on within a tenth of the mitre, as a bed that the wall slides onto
    if (lean > 0) CHECK(norm(normal(tip, kMitredWall, {kMitredFloor}) - Vec2{1, 0}) < 1e-12);
    CHECK(norm(normal(tip, kMitredFloor, {kMitredWall}) - Vec2{0, 1}) < 1e-12);
    if (lean == 0) continue;  // in line: two corners, with nothing of two faces
    CHECK(norm(normal(tip, kThird, {kHalfFloor, kWall})) == 0);
    // nor by a side far off
    CHECK(meet_beside(tip, kThird, {kHalfFloor, kWall}, 10).kind == PartsMet::kFar);
  }
}

TEST_CASE("hard contacts: a wall that is lifted by more than what is level is a block of its own") {
  const Body tip = wedge(35, 40);
  const auto lifted = [&](double by) { return normal(tip, kWall, {moved(kFloor, {0, -by})}); };
  CHECK(norm(lifted(0.9 * kLevel) - Vec2{1, 0}) < 1e-12);
  CHECK(lifted(1.1 * kLevel).y < -0.1);
}

TEST_CASE("hard contacts: what is slanted to the bottom of a wall by more than a tenth does not fill it") {
  const Body tip = wedge(35, 40);
  const auto slanted = [&](double slope) {
    return normal(tip, kWall, {moved(kFloor, {}, std::atan(slope))});
  };
  CHECK(norm(slanted(0.08) - Vec2{1, 0}) < 1e-12);
  CHECK(slanted(0.13).y < -0.1);
}

TEST_CASE("hard contacts: of two blocks that stand on a third each the way is the one across it the least") {
  // a tip that lies on the floor, 40 degrees: it is the wall that has the corner; the other way round the tip
  const Body flat{{{0, 0}, turned({1, 0}, 130 * kDegree), {-1, 0}}, {}};
  CHECK(norm(normal(wedge(0, 40), kWall, {kFloor}) - Vec2{1, 0}) < 1e-12);
  CHECK(norm(normal(wedge(0, 80), kWall, {kFloor}) - Vec2{1, 0}) < 1e-12);
  CHECK(norm(normal(wedge(0, 90), flat, {kFloor}) - Vec2{1, 0}) < 1e-12);
}

TEST_CASE("hard contacts: a tip beside the wall in a corner is apart, one in it is not") {
  for (const double lean : {0.0, 35.0}) {
    Body tip = wedge(lean, 40);
    CHECK(meet_beside(tip, kWall, {kFloor}).kind == PartsMet::kOverlap);
    tip.origin.x = kIn;
    const PartsMet met = meet_beside(tip, kWall, {kFloor});
    CHECK(met.kind == PartsMet::kApart);
    CHECK(norm(met.normal - Vec2{1, 0}) < 1e-12);
  }
}

TEST_CASE("hard contacts: what has slid off a block onto the next one is not struck by its corner") {
  // a joint that leans, the block behind its end and a little turned
  for (const double lean : {30.0, 60.0, 90.0, 120.0, 150.0}) {
    CAPTURE(lean);
    const Vec2 foot = turned({-1, 0}, lean * kDegree);
    const Body left{{{0, 0}, {-3, 0}, {-3, foot.y}, foot}, {}},
        right{{{0, 0}, foot, {3, foot.y}, {3, 0}}, {}};
    const Body upper = moved({box_polygon(0, 0, 1, 1), {}}, {0.3 * kLevel, -kIn}, 1e-3);
    CHECK(norm(normal(upper, left, {right}) - normal(upper, left, {})) == 0);
  }
}

TEST_CASE("hard contacts: what ends before the corner of a wall does not fill its bottom") {
  const Body tip = wedge(35, 40);
  const auto ends_at = [&](double x) { return normal(tip, kWall, {moved(kThird, {x, 0})}); };
  CHECK(norm(ends_at(-0.9 * kLevel) - Vec2{1, 0}) < 1e-12);
  CHECK(ends_at(-1.1 * kLevel).y < -0.1);
}

TEST_CASE("hard contacts: faces that lie on each other keep their way, whatever is beside them") {
  const Body below{box_polygon(-1, -1, 0, 0), {}}, beside{box_polygon(0, -1, 1, 0), {}};
  const auto of_turned = [&](double turn) {
    return normal(moved({box_polygon(-2, 0, 0, 1), {}}, {0, -kIn}, turn), below, {beside});
  };
  CHECK(norm(of_turned(-0.07) - turned({0, 1}, -0.07)) < 1e-12);
  CHECK(norm(of_turned(-0.15) - Vec2{0, 1}) < 1e-12);
}

}  // namespace test_corner
