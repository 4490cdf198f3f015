// Two convex parts that are apart, and hard contacts: the way along which they meet, normal, gap and ends by hand.

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "support/convex_parts.h"
#include "support/relative.h"

namespace test_face_ends {

using namespace talus;
using namespace talus::test;

namespace {

struct Ends {
  bool any = false;
  PartsMet met;
};

Ends ends_of(const Body& a, const Body& b, double reach, const PartMotion& motion_b = {}) {
  const Seen one(a), two(b);
  PartsMeeting meeting;
  const PartsMet& met = meeting.look(one.now(), two.now(), b.origin - a.origin, kMargin, kRounding);
  REQUIRE(met.kind != PartsMet::kFar);
  meeting.choose_way({}, motion_b, {0, kLevel});
  REQUIRE(met.kind != PartsMet::kFar);
  const bool any = meeting.face_ends(reach);
  PartsMet out = met;  // with its ends half way across the gap
  out.begin += -0.5 * out.across[0] * out.normal, out.end += -0.5 * out.across[1] * out.normal;
  return {any, out};
}

// Places of about 1 m, some operations on.
constexpr double kPlace = 1e-14;

}  // namespace

TEST_CASE("parts apart: face against face has the common stretch, half way across the gap") {
  const double gap = 0.01;
  const Ends e = ends_of(block_over(1, -gap), floor_body(), kMargin);
  CHECK(e.met.kind == PartsMet::kApart);
  CHECK(norm(e.met.normal - Vec2{0, 1}) < kPlace);
  REQUIRE(e.any);
  // seen from the block's origin, which lies at (0.1, gap)
  CHECK(norm(e.met.begin - Vec2{-0.5, -0.5 * gap}) < kPlace);
  CHECK(norm(e.met.end - Vec2{0.5, -0.5 * gap}) < kPlace);
  for (const double closure : e.met.closure) CHECK(closure == approx(-gap));
  const Ends exchanged = ends_of(floor_body(), block_over(1, -gap), kMargin);
  CHECK(norm(exchanged.met.normal - Vec2{0, -1}) < kPlace);
  CHECK(norm(exchanged.met.begin - Vec2{0.6, 0.5 * gap}) < kPlace);
  CHECK(norm(exchanged.met.end - Vec2{-0.4, 0.5 * gap}) < kPlace);
  CHECK(meet(block_over(1, -1.01 * kMargin), floor_body()).kind == PartsMet::kFar);
}

TEST_CASE(
    "parts apart: a face tilted either way has its near corner and its far one, or where it is too far") {
  const double gap = 0.003, tilt = 0.02, rise = std::sin(tilt), run = std::cos(tilt);
  for (const bool right : {true, false}) {  // up to the right: the left corner is near
    CAPTURE(right);
    const Body block = right ? moved({box_polygon(0, 0, 1, 1), {}}, {0, gap}, tilt)
                             : moved({box_polygon(-1, 0, 0, 1), {}}, {0, gap}, -tilt);
    const double sign = right ? 1 : -1;
    for (const double reach : {0.05, 0.01}) {
      CAPTURE(reach);
      const Ends e = ends_of(block, floor_body(), reach);
      CHECK(e.met.kind == PartsMet::kApart);
      CHECK(norm(e.met.normal - Vec2{0, 1}) <
            kPlace);  // the floor's: the tilted side is nearer to the floor's corner
      REQUIRE(e.any);
      const double most = std::min(reach, rise);
      const size_t near = right ? 0 : 1;
      const Vec2 from = right ? e.met.begin : e.met.end, to = right ? e.met.end : e.met.begin;
      // the slope along the floor is the tangent of the tilt; a place is half way between floor and block
      CHECK(norm(from - Vec2{0, -0.5 * gap}) < kPlace);
      CHECK(norm(to - Vec2{sign * most * run / rise, 0.5 * (most - gap)}) < 100 * kPlace);
      CHECK(e.met.closure[near] == approx(-gap));
      CHECK(e.met.closure[1 - near] == approx(-gap - most));
    }
  }
}

TEST_CASE("parts apart: a corner over a face has the corner and a place that bears nothing") {
  const double gap = 0.004, half = std::sqrt(0.5);
  const Body square{{{0, 0}, {half, half}, {0, 2 * half}, {-half, half}}, {0.3, gap}};
  for (const double reach : {0.01, 0.05}) {
    const Ends e = ends_of(square, floor_body(), reach);
    CHECK(norm(e.met.normal - Vec2{0, 1}) < kPlace);
    REQUIRE(e.any);
    // sides rise by as much as they run: reach along the tangent, to the one side or the other
    const bool begins = std::abs(e.met.closure[0] + gap) < kPlace;
    CHECK(norm((begins ? e.met.begin : e.met.end) - Vec2{0, -0.5 * gap}) < kPlace);
    CHECK(e.met.closure[begins ? 1 : 0] == approx(-gap - reach));
    CHECK(e.met.length() == approx(reach));
    const Ends turned = ends_of(floor_body(), square, reach);
    REQUIRE(turned.any);
    CHECK(turned.met.length() == approx(reach));
  }
}

TEST_CASE("parts apart: a corner in line on a face changes nothing, on either side of the gap") {
  const double gap = 0.003, tilt = 0.01;
  const Polygon plain = box_polygon(0, 0, 1, 1), extra{{0, 0}, {0.3, 0}, {1, 0}, {1, 1}, {0, 1}};
  const Body floor_extra{{{-2, -1}, {2, -1}, {2, 0}, {0.55, 0}, {-2, 0}}, {}};
  for (const double angle : {0.0, tilt, -tilt}) {
    CAPTURE(angle);
    const Vec2 up{0, gap + (angle < 0 ? std::sin(tilt) : 0)};
    const Ends one = ends_of(moved({plain, {}}, up, angle), floor_body(), kMargin);
    for (const bool on_floor : {false, true}) {
      const Ends two = ends_of(moved({on_floor ? plain : extra, {}}, up, angle),
                               on_floor ? floor_extra : floor_body(), kMargin);
      REQUIRE(one.any);
      REQUIRE(two.any);
      CHECK(norm(one.met.normal - two.met.normal) < kPlace);
      CHECK(norm(one.met.begin - two.met.begin) < kPlace);
      CHECK(norm(one.met.end - two.met.end) < kPlace);
      for (const size_t end : {0U, 1U}) CHECK(std::abs(one.met.closure[end] - two.met.closure[end]) < kPlace);
    }
  }
}

TEST_CASE("parts apart: hard contacts in overlap stand on the ends of their face") {
  const double c = 1e-6;
  const Ends e = ends_of(block_over(1, c), floor_body(), kMargin);
  CHECK(e.met.kind == PartsMet::kOverlap);
  REQUIRE(e.any);
  CHECK(e.met.begin.x == approx(-0.5));
  CHECK(e.met.end.x == approx(0.5));
  for (const double closure : e.met.closure) CHECK(closure == approx(c).epsilon(1e-9));  // 1e-16 m of c
}

TEST_CASE("parts apart: corners of level blocks that slide past each other over a slanted joint are far") {
  // b slides to the left, in touch with what lies left of a: 1e-5 m below the top of a, whose joint leans either way
  constexpr double kClosure = 1e-5, kFar = 1e-4;
  for (const double lean : {0.5, 0.0, -0.5}) {
    CAPTURE(lean);
    const Body a{{{lean, -1}, {2, -1}, {2, 0}, {0, 0}}, {}};
    const Body b{box_polygon(-1, 0, 0, 1), {-kFar, -kClosure}};  // moves to the right over a's corner
    // past it by far more than the closure: it is going to lie on top, which it does now
    CHECK(meet(a, b, {{3 * kFar, 0}, {}}).kind == PartsMet::kFar);
    // towards it, but not as far as that: the joint's side is what is left last
    const PartsMet comes = meet(a, b, {{0.5 * kFar, 0}, {}});
    CHECK(comes.kind == PartsMet::kApart);
    CHECK(comes.normal.x > 0.8);
    // at rest
    CHECK(meet(a, b).kind == PartsMet::kApart);
    // further below the top than what is level: it is stopped by what is before it
    const Body deep{box_polygon(-1, 0, 0, 1), {-kFar, -2 * kLevel}};
    const PartsMet stopped = meet(a, deep, {{5 * kLevel, 0}, {}});
    CHECK(stopped.kind == PartsMet::kApart);
    CHECK(stopped.normal.x > 0.8);
  }
}

TEST_CASE("parts apart: the way that is left last at the end of the step is the one they meet along") {
  // b to the upper right of a's corner, nearer from the right
  const Body a{box_polygon(-1, -1, 0, 0), {}}, b{box_polygon(0, 0, 1, 1), {0.01, 0.002}};
  CHECK(norm(meet(a, b).normal - Vec2{-1, 0}) < kPlace);
  // right of way as it comes from the right: above at the end of the step
  CHECK(norm(meet(a, b, {{-0.02, 0}, {}}).normal - Vec2{0, -1}) < kPlace);
  CHECK(norm(meet(a, b, {{0, -0.02}, {}}).normal - Vec2{-1, 0}) < kPlace);
  // seen from its middle it turns: its near corner goes to the left by 0.01 m and up by as much
  const Body middle{box_polygon(-0.5, -0.5, 0.5, 0.5), {0.51, 0.502}};
  CHECK(norm(meet(a, middle).normal - Vec2{-1, 0}) < kPlace);
  CHECK(norm(meet(a, middle, {{}, spin_matrix(-0.02)}).normal - Vec2{0, -1}) < kPlace);
}

TEST_CASE(
    "parts apart: of two sides that lie on each other the longer one is the way, whichever block is first") {
  // a way that is kept stays with its side: the longer one is the better one as soon as they turn at all
  const Body wall{box_polygon(-1, -4, 0, 5), {}}, stone{box_polygon(-0.5, -0.5, 0.5, 0.5), {0.5, 0.1}};
  for (const bool wall_first : {true, false}) {
    const PartsMet met = ends_of(wall_first ? wall : stone, wall_first ? stone : wall, kMargin).met;
    CHECK((met.way > 0) == !wall_first);  // sides of b count from one, those of a below zero
    CHECK(norm(met.normal - Vec2{wall_first ? -1.0 : 1.0, 0}) < kPlace);
  }
}

TEST_CASE("overlap: what touches along one way keeps to it when two corners are driven into each other") {
  // b's corner bears on a's upright side 4 mm below a's corner, and is driven into it; by the end of the step a's corner
  // would be in less below b's slanted side, which it has long been behind: pushed along that it slides on into b
  const Body b{{{0, 0}, {-0.12, 1}, {-1, 1}, {-1, -0.95}}, {0, 0}};
  const PartMotion motion_b{{5e-3, 3.27e-3}, {}};
  const auto normal = [&](double in) {
    const Body a{{{-in, -1}, {1, -1}, {1, 0.004}, {-in, 0.004}}, {0, 0}};
    PartsMeeting meeting;
    const Seen one(a), two(b);
    REQUIRE(meeting.look(one.now(), two.now(), b.origin - a.origin, kMargin, kRounding).kind ==
            PartsMet::kOverlap);
    meeting.choose_way({}, motion_b, {0, kLevel});
    return meeting.met().normal;
  };
  for (const double in : {1e-12, 3e-6, 0.6 * kLevel}) {
    CAPTURE(in);
    CHECK(norm(normal(in) - Vec2{1, 0}) < 1e-12);
  }
  // what is deep in another touches along no way: it is pushed out where it is in least
  CHECK(norm(normal(2 * kLevel) - Vec2{0.95, -1} / norm(Vec2{0.95, -1})) < 1e-12);
}

TEST_CASE("overlap: a corner on a corner bears along the side that its force does not push it off") {
  // a's tip, under its slanted side, stands on b's corner: the two sides are both what it may bear on
  constexpr double kIn = 1e-8;
  constexpr int kSlanted = -1, kTop = 3;  // a's side, b's
  const double slope = std::atan2(1, 2);
  const auto way = [&](double right, int before, double lean, bool exchanged) {
    const Body tip{{{0, 0}, {2, 1}, {0, 1}}, {right, -kIn}}, block{box_polygon(0, -1, 2, 0), {}};
    const Seen one(exchanged ? block : tip), two(exchanged ? tip : block);
    const double sign = exchanged ? -1 : 1;  // the force on the tip leans to the left
    PartsMeeting meeting;
    REQUIRE(meeting.look(one.now(), two.now(), sign * (block.origin - tip.origin), kMargin, kRounding).kind ==
            PartsMet::kOverlap);
    meeting.choose_way({}, {},
                       {exchanged ? -before : before, kLevel, sign * Vec2{-std::sin(lean), std::cos(lean)}});
    return exchanged ? -meeting.met().way : meeting.met().way;
  };
  for (const bool exchanged : {false, true}) {
    CAPTURE(exchanged);
    for (const double right : {-0.3 * kIn, 0.0, 0.4 * kIn}) {
      CAPTURE(right);
      // between the two normals either side may hold it, and the one that does goes on
      for (const double share : {0.1, 0.9})
        for (const int before : {kSlanted, kTop})
          CHECK(way(right, before, share * slope, exchanged) == before);
      // pushed to the right it slides along the top, not up b's corner; to the left down its slanted side
      CHECK(way(right, kSlanted, 1.1 * slope, exchanged) == kTop);
      CHECK(way(right, kTop, 1.1 * slope, exchanged) == kTop);
      CHECK(way(right, kTop, -0.1 * slope, exchanged) == kSlanted);
      CHECK(way(right, kSlanted, -0.1 * slope, exchanged) == kSlanted);
    }
    // past the corner by more than it is in it bears on the top alone; short of it by as much b's corner holds it
    for (const double lean : {0.5 * slope, 1.5 * slope}) {
      CHECK(way(5 * kIn, kSlanted, lean, exchanged) == kTop);
      CHECK(way(-kIn, kSlanted, lean, exchanged) == kSlanted);
    }
  }
}

TEST_CASE("overlap: a chord ends at the corner where a side along the normal begins a rounding beyond it") {
  // bricks of one course: their upper sides lean by a hair, so that they go on to face the other a rounding further
  for (const double lean : {1e-9, 3e-9, 1e-6})
    for (const double further : {-5e-15, 1e-17, 5e-15, 1e-13}) {
      const Body a{{{0, -0.25 - lean}, {1, -0.25}, {1, 0.25}, {0, 0.25 + lean}}, {0, 0}},
          b{{{0, -0.25}, {1, -0.25 - lean}, {1, 0.25 + lean}, {0, 0.25}}, {1, further}};
      PartsMeeting meeting;
      const Seen one(a), two(b);
      REQUIRE(meeting.look(one.now(), two.now(), b.origin, kMargin, kRounding).kind == PartsMet::kApart);
      meeting.choose_way({}, {}, {});
      REQUIRE(meeting.face_ends(kMargin));
      const PartsMet& met = meeting.met();
      CAPTURE(lean);
      CAPTURE(further);
      CHECK(std::abs(met.closure[0]) <= 1e-15);
      CHECK(std::abs(met.closure[1]) <= 1e-15);
      CHECK(met.length() == approx(0.5).epsilon(1e-12));
    }
}

TEST_CASE("parts apart: a tilted face has the same length from either side") {
  // a's lower side leans by 2 %: along it the face is longer than along b's, which is the way
  const Body a{{{0, 0.01}, {1, 0.03}, {1, 1}, {0, 1}}, {0, 0}},
      b{{{-1, -1}, {2, -1}, {2, 0}, {-1, 0}}, {0, 0}};
  for (const bool exchanged : {false, true}) {
    PartsMeeting meeting;
    const Seen one(exchanged ? b : a), two(exchanged ? a : b);
    REQUIRE(meeting.look(one.now(), two.now(), {}, kMargin, kRounding).kind == PartsMet::kApart);
    meeting.choose_way({}, {}, {});
    REQUIRE(meeting.face_ends(kMargin));
    CHECK(meeting.met().length() == approx(1).epsilon(1e-12));
  }
}

TEST_CASE("parts apart: where it is looked for them first makes no difference") {
  // a long floor and stones that turn on it: places of the floor far off move most of all as a stone sees them
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  int apart = 0, of_stone = 0;
  for (int n = 0; n < 20000; ++n) {
    const double tilt = 2e-3 * unit(random), spin = 4e-3 * unit(random), low = 1e-3 * unit(random);
    const Vec2 way{1e-3 * unit(random), 1e-3 * unit(random)};
    const bool wide = n % 2 == 0;
    const Body floor{box_polygon(wide ? -17 : 0.2 * unit(random), -1, wide ? 5 : 0.5, 0), {}};
    Body stone = moved({box_polygon(-0.3, -0.2, 0.3, 0.2), {}}, {0, 0}, tilt);
    stone.origin = {0.5 * unit(random), 0.2 + low + 0.3 * std::abs(std::sin(tilt))};
    const Seen one(floor), two(stone);
    const PartMotion motion{way, {0, -spin, spin, 0}};
    // no place of either moves further as the other sees it
    const double moves = norm(way) + std::sqrt(2) * std::abs(spin) * 20;
    PartsMet met[2];
    for (const bool told : {false, true}) {
      PartsMeeting meeting;
      LookFirst first;
      if (told) first = {n % 9 - 4, false, 2 * moves + kLevel};
      met[told] = meeting.look(one.now(), two.now(), stone.origin, kMargin, kRounding, first);
      if (met[told].kind != PartsMet::kFar)
        meeting.choose_way({}, motion, {0, kLevel}), met[told] = meeting.met();
    }
    REQUIRE(met[0].kind == met[1].kind);
    if (met[0].kind == PartsMet::kFar) continue;
    REQUIRE(met[0].way == met[1].way);
    REQUIRE(met[0].at_corner == met[1].at_corner);
    apart += met[0].kind == PartsMet::kApart, of_stone += met[0].way > 0;
  }
  CHECK(apart > 2000);
  CHECK(of_stone > 20);
}

TEST_CASE("parts apart: of the two sides of one interface one that a corner hangs over is the way") {
  // the stone's left corner is past the end of the floor and below its line: along the stone's own side they are apart. It
  // turns back, so that the floor's side is the better one at the end of the step
  for (const bool exchanged : {false, true})
    for (const double lean : {1e-9, 1e-6}) {
      const Body floor{box_polygon(0, -1, 2, 0), {}};
      Body stone{box_polygon(-0.2, 0, 1, 1), {}};
      stone = moved(stone, {0, 0.2 * lean - 0.1 * lean}, lean);
      const Seen one(exchanged ? stone : floor), two(exchanged ? floor : stone);
      PartsMeeting meeting;
      const Vec2 shift = exchanged ? floor.origin - stone.origin : stone.origin - floor.origin;
      REQUIRE(meeting.look(one.now(), two.now(), shift, kMargin, kRounding).kind != PartsMet::kFar);
      const PartMotion still, turns{{}, {0, 3 * lean, -3 * lean, 0}};
      meeting.choose_way(exchanged ? turns : still, exchanged ? still : turns, {0, kLevel});
      CHECK(meeting.met().kind == PartsMet::kApart);
      CHECK(std::abs(meeting.met().normal.y) == approx(1).epsilon(1e-9));
    }
}

}  // namespace test_face_ends
