// What of blocks touches: convex parts of an outline with notches, sides that bonds tie, sides that the stress
// of the ground has moved.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/block_scene.h"
#include "support/relative.h"
#include "talus/base/index.h"
#include "talus/base/random.h"
#include "talus/contact/outlines.h"
#include "talus/geometry/polygon.h"

namespace test_outlines {

using namespace talus;
using namespace talus::test;

namespace {

ConvexPart outline_of(const Polygon& polygon) {
  ConvexPart out;
  for (int k = 0; k < count_of(polygon); ++k) {
    out.corner.push_back(polygon[k]);
    out.side.push_back({k, -1});
  }
  return out;
}

std::vector<ConvexPart> parts_of(const Polygon& polygon) { return convex_parts(outline_of(polygon)); }

// Simple, since its corners are seen from the origin one after the other; counter-clockwise, with several notches.
Polygon random_star(Random& random) {
  const auto n = static_cast<size_t>(7 + 10 * random.uniform());
  Polygon out;
  for (size_t k = 0; k < n; ++k) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(k) + 0.7 * random.uniform()) / static_cast<double>(n);
    const double radius = 0.35 + 0.65 * random.uniform();
    out.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return out;
}

int notches_of(const Polygon& p) {
  int count = 0;
  for (size_t k = 0; k < p.size(); ++k) {
    const Vec2 before = p[(k + p.size() - 1) % p.size()], after = p[(k + 1) % p.size()];
    count += cross(p[k] - before, after - p[k]) < 0;
  }
  return count;
}

Polygon begun_at(const Polygon& p, size_t first) {
  Polygon out;
  for (size_t k = 0; k < p.size(); ++k) out.push_back(p[(first + k) % p.size()]);
  return out;
}

Polygon mirrored(const Polygon& p) {
  Polygon out;
  for (size_t k = p.size(); k-- > 0;) out.push_back({-p[k].x, p[k].y});
  return out;
}

// Parts of a mirrored outline, put back with their edges: edge j goes from its corner n-1-j to n-2-j.
std::vector<ConvexPart> mirrored_back(const std::vector<ConvexPart>& parts, size_t edges) {
  std::vector<ConvexPart> out;
  const int n = static_cast<int>(edges);
  for (const ConvexPart& part : parts) {
    ConvexPart back;
    const size_t count = part.corner.size();
    for (size_t k = count; k-- > 0;) {
      back.corner.push_back({-part.corner[k].x, part.corner[k].y});
      const int edge = part.side[(k + count - 1) % count].edge;
      back.side.push_back({edge < 0 ? -1 : (2 * n - 2 - edge) % n, -1});
    }
    out.push_back(back);
  }
  return out;
}

// Corners and sides of two parts in the same order, begun anywhere; places up to what `same` says [m].
bool is_same(const ConvexPart& p, const ConvexPart& q, double same) {
  const size_t n = p.corner.size();
  if (n != q.corner.size()) return false;
  for (size_t first = 0; first < n; ++first) {
    bool all = true;
    for (size_t k = 0; k < n; ++k) {
      const size_t at = (first + k) % n;
      all = all && norm(p.corner[k] - q.corner[at]) <= same && p.side[k].edge == q.side[at].edge;
    }
    if (all) return true;
  }
  return false;
}

bool are_same(const std::vector<ConvexPart>& one, const std::vector<ConvexPart>& other, double same) {
  if (one.size() != other.size()) return false;
  for (const ConvexPart& p : one)
    if (std::none_of(other.begin(), other.end(), [&](const ConvexPart& q) { return is_same(p, q, same); }))
      return false;
  return true;
}

// Places of outlines of about 1 m come from the crossing of two lines; those meet at no less than some 0.001 rad.
constexpr double kSamePlace = 1e-12;

void check_parts(const Polygon& polygon, const std::vector<ConvexPart>& parts) {
  double area = 0;
  std::vector<double> length(polygon.size());
  for (const ConvexPart& part : parts) {
    const size_t n = part.corner.size();
    REQUIRE(n >= 3);
    REQUIRE(part.side.size() == n);
    area += signed_area(part.corner);
    for (size_t k = 0; k < n; ++k) {
      const Vec2 from = part.corner[k], side = part.corner[(k + 1) % n] - from,
                 next = part.corner[(k + 2) % n] - from - side;
      // what outlines.cpp calls a notch
      CHECK(cross(side, next) >= -1e-9 * norm(side) * norm(next));
      if (part.side[k].edge < 0) continue;
      const int e = part.side[k].edge;
      REQUIRE(e < polygon.size());
      const Vec2 begin = polygon[e], edge = polygon[(e + 1) % polygon.size()] - begin;
      CHECK(std::abs(cross(edge, from - begin)) <= kSamePlace * norm(edge));
      CHECK(std::abs(cross(edge, from + side - begin)) <= kSamePlace * norm(edge));
      CHECK(dot(edge, side) > 0);
      length[e] += norm(side);
    }
  }
  // sums of a few numbers of about 1 m2 and 1 m, each rounded to 1e-16 of it
  CHECK(area == approx(signed_area(polygon)).epsilon(1e-13));
  for (size_t e = 0; e < polygon.size(); ++e)
    CHECK(length[e] == approx(norm(polygon[(e + 1) % polygon.size()] - polygon[e])).epsilon(kSamePlace));
}

// Total length of the cuts, each counted on both of its sides [m].
double length_of_cuts(const std::vector<ConvexPart>& parts) {
  double sum = 0;
  for (const ConvexPart& part : parts)
    for (size_t k = 0; k < part.corner.size(); ++k)
      if (part.side[k].edge < 0) sum += norm(part.corner[(k + 1) % part.corner.size()] - part.corner[k]);
  return sum;
}

}  // namespace

TEST_CASE("parts of an outline with notches are convex, make it up, and have its sides and cuts") {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    CAPTURE(i);
    const Polygon polygon = random_star(random);
    const std::vector<ConvexPart> parts = parts_of(polygon);
    CHECK(count_of(parts) == notches_of(polygon) + 1);  // each cut is from a notch, and ends it
    check_parts(polygon, parts);
    if (parts.size() > 1) CHECK(length_of_cuts(parts) > 0);
  }
}

TEST_CASE("parts do not depend on the corner that an outline begins with") {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    CAPTURE(i);
    const Polygon polygon = random_star(random);
    const std::vector<ConvexPart> parts = parts_of(polygon);
    const size_t n = polygon.size();
    for (size_t first = 1; first < n; ++first) {
      std::vector<ConvexPart> others = parts_of(begun_at(polygon, first));
      for (ConvexPart& part : others)
        for (PartSide& side : part.side)
          if (side.edge >= 0) side.edge = static_cast<int>((static_cast<size_t>(side.edge) + first) % n);
      CHECK(are_same(parts, others, kSamePlace));
    }
  }
}

TEST_CASE("parts of a mirrored outline are the mirrored parts") {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    CAPTURE(i);
    const Polygon polygon = random_star(random);
    CHECK(
        are_same(parts_of(polygon), mirrored_back(parts_of(mirrored(polygon)), polygon.size()), kSamePlace));
  }
}

TEST_CASE("parts of a symmetric outline are symmetric where two cuts of one length would cross") {
  // the cuts from both notches of a T meet at (0, 0.4)
  const Polygon tee{{-1, 0}, {-0.4, 0}, {-0.4, -1}, {0.4, -1}, {0.4, 0}, {1, 0}, {1, 1}, {-1, 1}};
  const std::vector<ConvexPart> parts = parts_of(tee);
  check_parts(tee, parts);
  CHECK(are_same(parts, mirrored_back(parts_of(mirrored(tee)), tee.size()), kSamePlace));
  for (size_t first = 1; first < tee.size(); ++first) {
    std::vector<ConvexPart> others = parts_of(begun_at(tee, first));
    for (ConvexPart& part : others)
      for (PartSide& side : part.side)
        if (side.edge >= 0)
          side.edge = static_cast<int>((static_cast<size_t>(side.edge) + first) % tee.size());
    CHECK(are_same(parts, others, kSamePlace));
  }
}

TEST_CASE("parts of a turned outline are the turned parts, corners in line and cuts of one length and all") {
  const Polygon box{{0, 0}, {0.3, 0}, {1, 0}, {2, 0}, {2, 0.7}, {2, 1}, {0, 1}};
  const Polygon tee{{-1, 0}, {-0.4, 0}, {-0.4, -1}, {0.4, -1}, {0.4, 0}, {1, 0}, {1, 1}, {-1, 1}};
  const auto turned = [](const Polygon& p, double angle) {
    Polygon out;
    for (const Vec2 x : p) out.push_back(x + rotation_minus_identity(angle) * x);
    return out;
  };
  for (int k = 1; k < 200; ++k) {
    CAPTURE(k);
    CHECK(parts_of(turned(box, 0.03 * k)).size() == 1);
    std::vector<ConvexPart> back = parts_of(turned(tee, 0.03 * k));
    for (ConvexPart& part : back) part.corner = turned(part.corner, -0.03 * k);
    CHECK(are_same(back, parts_of(tee), kSamePlace));
  }
}

TEST_CASE("an outline without notches is one part, corners in line and all") {
  const Polygon box{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}};
  const std::vector<ConvexPart> parts = parts_of(box);
  REQUIRE(parts.size() == 1);
  CHECK(is_same(parts[0], outline_of(box), 0));  // as it was given
}

TEST_CASE("the shortest cut comes first: an L is cut along the bisector of its notch") {
  const Polygon ell{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}};
  const std::vector<ConvexPart> parts = parts_of(ell);
  const std::vector<ConvexPart> by_hand{{{{0, 0}, {3, 0}, {3, 1}, {1, 1}}, {{0, -1}, {1, -1}, {2, -1}, {}}},
                                        {{{0, 0}, {1, 1}, {1, 2}, {0, 2}}, {{}, {3, -1}, {4, -1}, {5, -1}}}};
  CHECK(are_same(parts, by_hand, kSamePlace));
}

TEST_CASE("an arc of 60 notches is 61 parts, whether cuts end at corners of its outer side or between them") {
  constexpr int kPieces = 61;
  for (const double shifted : {0.0, 0.3, 0.5}) {  // of an outer corner, as share of a piece
    CAPTURE(shifted);
    Polygon arc;
    const double step = 2.0 / kPieces;  // [rad]
    const auto at = [](double radius, double angle) {
      return Vec2{radius * std::cos(angle), radius * std::sin(angle)};
    };
    arc.push_back(at(2.2, 0));
    for (int k = 1; k < kPieces; ++k) arc.push_back(at(2.2, step * (k + shifted)));
    arc.push_back(at(2.2, 2.0));
    for (int k = kPieces; k >= 0; --k) arc.push_back(at(2, step * k));
    const std::vector<ConvexPart> parts = parts_of(arc);
    CHECK(parts.size() == kPieces);
    check_parts(arc, parts);
    // 60 cuts of the thickness, each with two sides; a chord's sagitta is 3e-4 m
    CHECK(length_of_cuts(parts) == approx(2 * 60 * 0.2).epsilon(2e-3));
    CHECK(are_same(parts, mirrored_back(parts_of(mirrored(arc)), arc.size()), kSamePlace));
  }
}

namespace {

// One block's sides with an edge, in the order of its parts.
struct SideSeen {
  Vec2 from, to;  // arms [m]
  PartSide side;
};

std::vector<SideSeen> sides_of(const Scene& scene, int block, int edge) {
  std::vector<SideSeen> out;
  const Outlines& o = scene.outlines;
  for (int p = o.part_begin[block]; p < o.part_begin[block + 1]; ++p) {
    const int begin = o.corner_begin[p], n = o.corners_of(p);
    for (int k = 0; k < n; ++k)
      if (o.side[begin + k].edge == edge)
        out.push_back({o.corner[begin + k], o.corner[begin + (k + 1) % n], o.side[begin + k]});
  }
  return out;
}

Vec2 placed(const Scene& scene, int block, Vec2 arm) { return scene.blocks.centroid[block] + arm; }

}  // namespace

TEST_CASE("a bonded face that covers half a side splits it") {
  Model model = jointed_rock();
  model.joints[0].kind = kBondedJoint;
  model.joints[0].bonded = true;
  const Scene scene = block_scene(std::move(model), {{box_polygon(0, 0, 4, 1)}, {box_polygon(0, 1, 2, 2)}});
  REQUIRE(scene.bonds.faces.size() == 1);
  const std::vector<SideSeen> top = sides_of(scene, 0, 2), bottom = sides_of(scene, 1, 0);
  REQUIRE(top.size() == 2);  // from x = 4 to 2 free, on to 0 bonded
  CHECK(top[0].side.face == -1);
  CHECK(top[1].side.face == 0);
  for (const SideSeen& side : top) CHECK(norm(side.to - side.from) == approx(2));
  CHECK(placed(scene, 0, top[0].to).x == approx(2));
  REQUIRE(bottom.size() == 1);
  CHECK(bottom[0].side.face == 0);
  CHECK(scene.outlines.parts_of(0) == 1);  // a corner in line is no notch
  for (const int edge : {0, 1, 3})
    for (const SideSeen& side : sides_of(scene, 0, edge)) CHECK(side.side.face == -1);
}

namespace {

constexpr double kStiffness = 2e9;  // [Pa/m]

Model pressed_rock() {
  Model model = jointed_rock();
  model.joints[0].normal_stiffness = kStiffness, model.joints[0].shear_stiffness = 1e9;
  model.gravity = {0, -10};
  model.in_situ.given = model.in_situ.with_depth = true;
  model.in_situ.level = 10, model.in_situ.pressure = 1e6, model.in_situ.density = 2000,
  model.in_situ.k0 = 0.5;
  return model;
}

// Vertical stress of pressed_rock, > 0 pressing [Pa].
double pressure_at(double y) { return 1e6 + 2000 * 10 * (10 - y); }

}  // namespace

TEST_CASE("sides along a level face are moved outwards by half of what the stress of the ground closes") {
  const Scene scene = block_scene(pressed_rock(), {{box_polygon(0, 0, 2, 1)}, {box_polygon(0, 1, 2, 2)}});
  const double closure = pressure_at(1) / kStiffness;
  const std::vector<SideSeen> top = sides_of(scene, 0, 2), bottom = sides_of(scene, 1, 0);
  REQUIRE(top.size() == 1);
  REQUIRE(bottom.size() == 1);
  for (const Vec2 arm : {top[0].from, top[0].to}) {
    // places of 1 m are rounded to 1e-16 m, the closure is 6e-4 m
    CHECK(placed(scene, 0, arm).y - 1 == approx(0.5 * closure).epsilon(1e-12));
    CHECK(std::abs(placed(scene, 0, arm).x - 1) == approx(1).epsilon(1e-15));  // along the free side
  }
  for (const Vec2 arm : {bottom[0].from, bottom[0].to})
    CHECK(1 - placed(scene, 1, arm).y == approx(0.5 * closure).epsilon(1e-12));
  REQUIRE(scene.outlines.closed.size() == 1);
  CHECK(scene.outlines.closed[0] == std::pair(0, 1));
  // free sides stay
  for (const SideSeen& side : sides_of(scene, 0, 0))
    CHECK(placed(scene, 0, side.from).y == doctest::Approx(0));
}

TEST_CASE("what moved outlines overlap by follows the stress along an upright face and one at 45 degrees") {
  for (const bool slanted : {false, true}) {
    CAPTURE(slanted);
    const Polygon left{{0, 0}, {2, 0}, {slanted ? 4.0 : 2.0, 2}, {0, 2}},
        right{{2, 0}, {6, 0}, {6, 2}, {slanted ? 4.0 : 2.0, 2}};
    const Scene scene = block_scene(pressed_rock(), {{left}, {right}});
    const std::vector<SideSeen> one = sides_of(scene, 0, 1), two = sides_of(scene, 1, 3);
    REQUIRE(one.size() == 1);
    REQUIRE(two.size() == 1);
    const Vec2 normal = slanted ? Vec2{std::sqrt(0.5), -std::sqrt(0.5)} : Vec2{1, 0};
    // of a moved side over the face, at a height: its ends lie off it along the level sides of the blocks
    const auto off = [&](int block, const SideSeen& side, double y) {
      const Vec2 p = placed(scene, block, side.from), q = placed(scene, block, side.to);
      return dot(normal, p + (y - p.y) / (q.y - p.y) * (q - p) - left[1]);
    };
    for (const double y : {0.0, 0.5, 1.3, 2.0}) {
      CAPTURE(y);
      const double normal_stress =
          (slanted ? 0.75 : 0.5) * pressure_at(y);  // k0 = 0.5: half of it, mean of both
      // sides of different slopes are met at a place off by the closure, as share of 2 m: second order; places of 2 m are
      // rounded to 4e-16 m
      const double second = slanted ? 1e-4 : 0;
      const double closure = normal_stress / kStiffness;
      CHECK(std::abs(off(0, one[0], y) - off(1, two[0], y) - closure) < second * closure + 1e-15);
    }
  }
}

TEST_CASE(
    "a moved side ends on the next one where they meet within ten times the way, else a cut joins the two") {
  // beside a side that stays, at a sine of d, they meet 1/d times the way off: 7 and 14 times
  for (const bool meets : {true, false}) {
    CAPTURE(meets);
    const double d = meets ? 0.14 : 0.07;
    const Polygon bent{{0, 0}, {4, 0}, {4, 1 - 2 * d / std::sqrt(1 - d * d)}, {2, 1}, {0, 1}};
    const Scene scene = block_scene(pressed_rock(), {{bent}, {box_polygon(0, 1, 2, 2)}});
    const int end = scene.outlines.part_begin[1];
    CHECK((scene.outlines.corner_begin[end] == 5) == meets);
  }
}

TEST_CASE("a short side on a long one is a face whichever block comes first, however its ends are rounded") {
  // 3e-8 m over 0.25 m is 1.2e-6 m at the other end of a wall of 10 m
  const Polygon wall{{10, 0}, {10, 1}, {0, 1}, {0, 0}}, block{{0, -1}, {0.25, -1}, {0.25, 3e-8}, {0, -3e-8}};
  for (const bool first : {true, false}) {
    CAPTURE(first);
    const Scene scene = first ? block_scene(pressed_rock(), {{wall}, {block}})
                              : block_scene(pressed_rock(), {{block}, {wall}});
    CHECK(scene.outlines.closed.size() == 1);
  }
}

TEST_CASE("faces beside each other on one side leave no step in it, however their ends are rounded") {
  // a wall and three blocks on it, turned, with corners that lie up to 3e-8 m off it: a step of 1e-11 m in the moved side
  // would cut the wall in two, and a face that lies over the cut would have none of the stress of the ground
  for (const double turn : {0.0, 0.3, 37 * std::numbers::pi / 180, 1.0, 1.9}) {
    CAPTURE(turn);
    Random random(3);
    const double c = std::cos(turn), s = std::sin(turn);
    const auto at = [&](double x, double y) {
      const double off = 3e-8 * (2 * random.uniform() - 1);
      return Vec2{c * x - s * y + off, s * x + c * y - off};
    };
    const Vec2 a = at(1, 1), b = at(2, 1);
    const Scene scene = block_scene(pressed_rock(), {{{at(0, 0), at(3, 0), at(3, 1), at(0, 1)}},
                                                     {{at(0, 1), a, at(1, 2), at(0, 2)}},
                                                     {{a, b, at(2, 2), at(1, 2)}},
                                                     {{b, at(3, 1), at(3, 2), at(2, 2)}}});
    for (int block = 0; block < 4; ++block) {
      CHECK(scene.outlines.part_begin[block + 1] - scene.outlines.part_begin[block] == 1);
    }
  }
}

TEST_CASE("a face that covers half a side moves that half alone") {
  const Scene scene = block_scene(pressed_rock(), {{box_polygon(0, 0, 4, 1)}, {box_polygon(0, 1, 2, 2)}});
  const double half = 0.5 * pressure_at(1) / kStiffness;
  const std::vector<SideSeen> top = sides_of(scene, 0, 2);
  double closed = 0, free = 0;  // lengths of what lies out by half the closure, and where it was
  for (const SideSeen& side : top) {
    const double y0 = placed(scene, 0, side.from).y - 1, y1 = placed(scene, 0, side.to).y - 1;
    if (std::abs(y0 - half) < 1e-9 && std::abs(y1 - half) < 1e-9) closed += norm(side.to - side.from);
    if (std::abs(y0) < 1e-9 && std::abs(y1) < 1e-9) free += norm(side.to - side.from);
  }
  CHECK(closed == approx(2).epsilon(1e-9));
  CHECK(free == approx(2).epsilon(1e-9));
  for (const SideSeen& side : sides_of(scene, 1, 0)) {
    CHECK(1 - placed(scene, 1, side.from).y == approx(half).epsilon(1e-12));
    CHECK(1 - placed(scene, 1, side.to).y == approx(half).epsilon(1e-12));
  }
}

TEST_CASE("two moved sides end where their lines meet, at a notch too") {
  const Scene scene =
      block_scene(pressed_rock(), {{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},  // an L
                                   {box_polygon(1, 1, 2, 2)}});
  // at (1, 1) the level face closes by the vertical stress, the upright one by half of it
  const double half = 0.5 * pressure_at(1) / kStiffness;
  const std::vector<SideSeen> of_notch = sides_of(scene, 0, 2), of_corner = sides_of(scene, 1, 0);
  REQUIRE(of_notch.size() == 1);
  REQUIRE(of_corner.size() == 1);
  // places of 1 m are rounded to 1e-16 m
  CHECK(norm(placed(scene, 0, of_notch[0].to) - Vec2{1 + 0.5 * half, 1 + half}) < 1e-15);
  CHECK(norm(placed(scene, 1, of_corner[0].from) - Vec2{1 - 0.5 * half, 1 - half}) < 1e-15);
}

TEST_CASE("joints without stiffness, and models without stress of the ground, move nothing") {
  for (const bool hard : {true, false}) {
    Model model = pressed_rock();
    if (hard)
      model.joints[0].normal_stiffness = model.joints[0].shear_stiffness = 0;
    else
      model.in_situ = {};
    const Scene scene = block_scene(std::move(model), {{box_polygon(0, 0, 2, 1)}, {box_polygon(0, 1, 2, 2)}});
    CHECK(scene.outlines.closed.size() == (hard ? 1 : 0));
    REQUIRE(scene.outlines.corner.size() == scene.blocks.arm.size());
    for (size_t k = 0; k < scene.blocks.arm.size(); ++k)
      CHECK(scene.outlines.corner[k] == scene.blocks.arm[k]);
  }
}

}  // namespace test_outlines
