#include "talus/base/index.h"
#include "talus/corners/find.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/block_scene.h"
#include "support/relative.h"
#include "talus/corners/corner_rows.h"
#include "talus/geometry/polygon_check.h"
#include "talus/step/scene.h"

namespace test_find {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kMargin = 0.05;
const Polygon kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

Polygon moved(Polygon polygon, Vec2 by) {
  for (Vec2& p : polygon) p += by;
  return polygon;
}

/// A square with half-diagonals `r` that stands with its lowest corner at `tip`.
Polygon diamond(Vec2 tip, double r) {
  return {tip, tip + Vec2{r, r}, tip + Vec2{0, 2 * r}, tip + Vec2{-r, r}};
}

Scene scene_of(const std::vector<Polygon>& polygons) { return laid_out_scene(plain_rock(), polygons); }

std::vector<ContactPoint> touch(const Scene& s, const State& state, int a = 0, int b = 1) {
  std::vector<ContactPoint> out;
  touch_blocks(s.blocks, state, a, b, kMargin, out);
  for (size_t i = 1; i < out.size(); ++i) CHECK(out[i - 1].key < out[i].key);  // sorted, none twice
  return out;
}

std::vector<ContactPoint> touch(const std::vector<Polygon>& polygons) {
  const Scene s = scene_of(polygons);
  return touch(s, start_state(s));
}

Vec2 place_of(const Scene& s, const ContactPoint& c) { return s.blocks.centroid[c.key.block_a] + c.arm_a; }

// Pairs whose bounding boxes, as they lie now, are closer than the margin.
std::vector<std::pair<int, int>> close_now(const BlockSet& blocks, const State& state, double margin) {
  std::vector<Box> boxes;
  for (int i = 0; i < blocks.count; ++i) {
    std::vector<Vec2> corners;
    for (int v = 0; v < blocks.vertex_count(i); ++v)
      corners.push_back(blocks.centroid[i] + offset_now(state, i, blocks.corner({i, v})));
    boxes.push_back(bounding_box(corners));
  }
  return close_pairs(boxes, margin);
}

// Distance of a corner from the line of an edge: < 0 inside a polygon.
double gap_over(const Polygon& polygon, size_t edge, Vec2 corner) {
  const Vec2 from = polygon[edge], along = polygon[(edge + 1) % polygon.size()] - from;
  return -cross(along, corner - from) / norm(along);
}

// Sums of a few numbers of order 1.
constexpr double kRound = 1e-14;

}  // namespace

TEST_CASE("a face that stands open like a wedge has two ends, wherever its corners pass each other") {
  // the upper square is turned about its right lower corner and has slid by a hair: at the open end each corner comes to lie
  // within the other's side, over some of the way
  for (const double turned : {0.001, 0.0039, 0.01, 0.018, -0.0005, -0.004})
    for (const double deep : {0.0, 3.4e-4})
      for (double slid = -4e-4; slid <= 4e-4; slid += 3.7e-6) {
        const Polygon lower{{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}};
        Polygon upper{{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}};
        for (Vec2& p : upper) {
          const Vec2 r = p - Vec2{1, 0};
          p = Vec2{1 + slid, 0.5 - deep} + Vec2{std::cos(turned) * r.x + std::sin(turned) * r.y,
                                                std::cos(turned) * r.y - std::sin(turned) * r.x};
        }
        const std::vector<ContactPoint> points = touch({lower, upper});
        INFO("turned " << turned << ", deep " << deep << ", slid " << slid);
        REQUIRE(points.size() == 2);
        CHECK(points[0].partner == 1);
        CHECK(points[1].partner == 0);
        // all of the face but what has slid past, and what the turn takes
        CHECK(points[0].length + points[1].length == approx(1).epsilon(2e-3));
        CHECK(points[0].length == points[1].length);
      }
}

TEST_CASE("a short overlap that stands open like a wedge has two ends") {
  for (const double turned : {0.004, -0.004, 0.015})
    for (double over = 6e-5; over < 1e-2; over *= 1.3) {
      Polygon upper{{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}};
      for (Vec2& p : upper)
        p = Vec2{1 - over, 0.502} + Vec2{std::cos(turned) * p.x - std::sin(turned) * p.y,
                                         std::cos(turned) * p.y + std::sin(turned) * p.x};
      const std::vector<ContactPoint> points = touch({{{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}}, upper});
      INFO("turned " << turned << ", over " << over);
      REQUIRE(points.size() == 2);
      CHECK(points[0].partner == 1);
      CHECK(points[0].length + points[1].length == approx(over).epsilon(0.1));
    }
}

TEST_CASE("square on square: two points with half the face each") {
  const Scene s = scene_of({kSquare, moved(kSquare, {0, 1})});
  const auto contacts = touch(s, start_state(s));
  REQUIRE(contacts.size() == 2);
  for (const ContactPoint& c : contacts) {
    CHECK(std::abs(c.gap) <= kRound);
    CHECK(std::abs(c.length - 0.5) <= kRound);
    // from b into a: up when the upper block is a
    CHECK(norm(c.normal - Vec2{0, c.key.block_a == 1 ? 1.0 : -1.0}) <= kRound);
    CHECK(place_of(s, c).y == 1);
  }
  CHECK(std::abs(std::abs(place_of(s, contacts[0]).x - place_of(s, contacts[1]).x) - 1) <= kRound);
}

TEST_CASE("offset square: a corner of each block ends the common face") {
  const Scene s = scene_of({kSquare, moved(kSquare, {0.3, 1})});
  const auto contacts = touch(s, start_state(s));
  REQUIRE(contacts.size() == 2);
  CHECK(contacts[0].key == ContactKey{0, 2, 1, 0});  // right end: the lower block's corner at x = 1
  CHECK(contacts[1].key == ContactKey{1, 0, 0, 2});  // left end: the upper block's corner at x = 0.3
  for (const ContactPoint& c : contacts) {
    CHECK(std::abs(c.length - 0.35) <= kRound);
    CHECK(std::abs(c.gap) <= kRound);
  }
}

TEST_CASE("corners that come over an edge within the step take nothing of the face there is now") {
  // the upper block begins 0.5 mm to the right of the lower one, and moves 1 mm to the left in the step
  const Scene s = scene_of({kSquare, moved(kSquare, {0.0005, 1})});
  State state = start_state(s);
  state.rate[1].a = {-1, -0.1};
  std::vector<ContactPoint> points;
  touch_blocks(s.blocks, state, 0, 1, kMargin, points, 1e-3);
  const auto at = [&](const ContactKey& key) {
    for (int i = 0; i < count_of(points); ++i)
      if (points[i].key == key) return i;
    return -1;
  };
  const int ends[] = {at({0, 2, 1, 0}), at({1, 0, 0, 2})}, coming[] = {at({0, 3, 1, 0}), at({1, 1, 0, 2})};
  REQUIRE(std::min({ends[0], ends[1], coming[0], coming[1]}) >= 0);
  for (const int k : {0, 1}) {
    const ContactPoint& end = points[ends[k]];
    CHECK(end.partner == ends[1 - k]);
    CHECK(end.length == approx(0.5 * 0.9995).epsilon(1e-9));
    CHECK(points[coming[k]].partner == -1);
    CHECK(points[coming[k]].length == 0);
  }
}

TEST_CASE("a corner over an edge") {
  for (const double gap : {0.01, 0.0, -0.01}) {
    CAPTURE(gap);
    const Scene s = scene_of({kSquare, diamond({0.3, 1 + gap}, 0.5)});
    const auto contacts = touch(s, start_state(s));
    REQUIRE(contacts.size() == 1);
    const ContactPoint& c = contacts[0];
    CHECK(c.key == ContactKey{1, 0, 0, 2});
    CHECK(std::abs(c.gap - gap) <= kRound);
    CHECK(norm(c.normal - Vec2{0, 1}) <= kRound);
    CHECK(norm(c.arm_a - Vec2{0, -0.5}) <= kRound);
    CHECK(norm(c.arm_b - Vec2{0.3 - 0.5, 0.5}) <= kRound);
    CHECK(c.length == 0);
    // the slip coordinate rises along the normal turned clockwise, here along x
    State later = start_state(s);
    later.displacement[1].x = 0.02;
    CHECK(std::abs(touch(s, later)[0].slip - c.slip - 0.02) <= kRound);
  }
  CHECK(touch({kSquare, diamond({0.3, 1 + 1.01 * kMargin}, 0.5)}).empty());
  CHECK(touch({kSquare, diamond({0.3, 1 + 0.99 * kMargin}, 0.5)}).size() == 1);
}

TEST_CASE("a corner beyond the end of an edge touches nothing") {
  // the tip of a steep wedge, level with the top side but beside it
  const auto wedge = [](double x, double y) { return Polygon{{x, y}, {x + 0.02, y + 1}, {x - 0.02, y + 1}}; };
  CHECK(touch({kSquare, wedge(1.01, 1.005)}).empty());
  CHECK(touch({kSquare, wedge(-0.01, 1.005)}).empty());
  CHECK(touch({kSquare, wedge(0.99, 1.005)}).size() == 1);
  CHECK(touch({kSquare, moved(kSquare, {1.01, 1.01})}).empty());  // corner beside corner
}

TEST_CASE("a corner whose own edges lie behind an edge does not touch it") {
  // the upper square's lower left corner is near the left side of the lower one, too
  for (const ContactPoint& c : touch({kSquare, moved(kSquare, {0.02, 1})}))
    CHECK(std::abs(c.normal.x) <= kRound);
}

TEST_CASE("corner against corner makes one contact") {
  CHECK(touch({kSquare, moved(kSquare, {1, 1})}).size() == 1);
  CHECK(touch({moved(kSquare, {1, 1}), kSquare}).size() == 1);
  CHECK(touch({kSquare, moved(kSquare, {-1, 1})}).size() == 1);
  CHECK(touch({kSquare, diamond({1, 1}, 0.5)}).size() == 1);
  CHECK(touch({kSquare, diamond({0, 1}, 0.5)}).size() == 1);
  // slightly inside each other: the contact has the larger gap, the shorter way out
  const auto inside = touch({kSquare, moved(kSquare, {1 - 4e-7, 1 - 2e-7})});
  REQUIRE(inside.size() == 1);
  CHECK(std::abs(inside[0].gap + 2e-7) <= kRound);
  CHECK(std::abs(inside[0].normal.x) <= kRound);
}

TEST_CASE("of two corners inside each other the larger gap counts") {
  // the tip of the diamond lies `y` below the top side, the square's corner (x + y) / sqrt(2) behind the
  // diamond's lower left side
  for (const Vec2 in : {Vec2{1e-7, 3e-7}, Vec2{3e-7, 1e-7}}) {
    const auto contacts = touch({kSquare, diamond(Vec2{1, 1} - in, 0.5)});
    REQUIRE(contacts.size() == 1);
    const bool tip = in.y < in.x;
    CHECK(contacts[0].key == (tip ? ContactKey{1, 0, 0, 2} : ContactKey{0, 2, 1, 3}));
    CHECK(std::abs(contacts[0].gap + (tip ? in.y : (in.x + in.y) / std::sqrt(2.0))) <= kRound);
  }
}

TEST_CASE("the contact of two corners does not depend on the order of the blocks") {
  for (const Vec2 by : {Vec2{1 - 4e-7, 1 - 2e-7}, Vec2{1 - 2e-7, 1 - 4e-7}, Vec2{1, 1}}) {
    const auto one = touch({kSquare, moved(kSquare, by)}), other = touch({moved(kSquare, by), kSquare});
    REQUIRE(one.size() == 1);
    REQUIRE(other.size() == 1);
    CHECK(std::abs(one[0].gap - other[0].gap) <= kRound);
  }
}

TEST_CASE(
    "four squares around a point: those across it touch where they are alone, else the others hold them") {
  const Scene s = scene_of({kSquare, moved(kSquare, {1, 0}), moved(kSquare, {0, 1}), moved(kSquare, {1, 1})});
  const State state = start_state(s);
  for (const auto& [a, b] : {std::pair(0, 3), std::pair(1, 2)}) CHECK(touch(s, state, a, b).size() == 1);
  for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 3), std::pair(2, 3)}) {
    const auto contacts = touch(s, state, a, b);
    REQUIRE(contacts.size() == 2);
    for (const ContactPoint& c : contacts) CHECK(std::abs(c.length - 0.5) <= kRound);
    CHECK(touch(s, state, b, a).size() == 2);
  }
  const auto all = find_contacts(s.blocks, s.bonds, state, kMargin);
  CHECK(all.size() == 8);
  for (const ContactPoint& c : all)  // none twice
    CHECK(std::count_if(all.begin(), all.end(), [&](const ContactPoint& o) { return o.key == c.key; }) == 1);
}

TEST_CASE("a corner in the notch of an L-shaped block touches both sides of the notch") {
  const Polygon l{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  // a little apart, well in the middle of the sides' ends: the corner lies over both edges
  const Scene s = scene_of({l, moved(kSquare, {1 + 0.01, 1 + 0.02})});
  const auto contacts = touch(s, start_state(s));
  const auto has = [&](ContactKey key, double gap) {
    return std::any_of(contacts.begin(), contacts.end(), [&](const ContactPoint& c) {
      return c.key == key && std::abs(c.gap - gap) <= kRound;
    });
  };
  CHECK(has({1, 0, 0, 2}, 0.02));  // over the lower side
  CHECK(has({1, 0, 0, 3}, 0.01));  // beside the left one
  CHECK(has({0, 2, 1, 0}, 0.02));  // the L's own convex corners under and beside the square
  CHECK(has({0, 4, 1, 3}, 0.01));
  CHECK(contacts.size() == 4);
}

TEST_CASE("gaps do not change when both blocks move 1 km") {
  const Scene s = scene_of({kSquare, diamond({0.3, 1.01}, 0.5)});
  State state = start_state(s);
  state.strain_part[0] = {1e-4, 2e-5, -3e-5, 2e-4};
  const auto before = touch(s, state);
  for (Vec2& d : state.displacement) d += Vec2{1000, -700};
  const auto after = touch(s, state);
  REQUIRE(before.size() == 1);
  REQUIRE(after.size() == 1);
  // a displacement of 1 km is rounded by 1e-13 m
  CHECK(std::abs(after[0].gap - before[0].gap) <= 1e-12);
  CHECK(std::abs(after[0].slip - before[0].slip) <= 1e-12);

  const Vec2 far{1024, -2048};
  const auto there = touch({moved(kSquare, far), moved(diamond({0.3, 1.01}, 0.5), far)});
  REQUIRE(there.size() == 1);
  CHECK(std::abs(there[0].gap - 0.01) <= 1e-12);
}

TEST_CASE("a corner over the edge of a turned and strained block") {
  const Scene s = scene_of({kSquare, diamond({0.5, 1.01}, 0.5)});
  State state = start_state(s);
  const double angle = 0.02, stretch = 1.1;
  const Mat2 r = kIdentity + rotation_minus_identity(angle);
  state.strain_part[0] = r * Mat2{1, 0, 0, stretch} - kIdentity;
  state.strain_part[1] = {0.1, 0, 0, -0.02};  // lifts the tip, half a metre below the middle, by 0.01
  // the top side turns about the centroid and lies stretch / 2 from it
  const Vec2 normal = r * Vec2{0, 1};
  const double gap = dot(normal, Vec2{0.5, 1.02} - Vec2{0.5, 0.5}) - 0.5 * stretch;
  const auto contacts = touch(s, state);
  REQUIRE(contacts.size() == 1);
  CHECK(std::abs(contacts[0].gap - gap) <= kRound);
  CHECK(norm(contacts[0].normal - normal) <= kRound);
}

std::vector<std::pair<int, int>> renewed(const Scene& s, State& state) {
  renew_pairs(s.blocks, s.bonds, s.layout, joint_laws(s.model.joints), {StepClock{1e-3}, state.rate},
              Workers(), state);
  std::vector<std::pair<int, int>> pairs;
  for (const ContactPair& p : state.pairs) pairs.emplace_back(p.a, p.b);
  return pairs;
}

TEST_CASE("renew_pairs misses no close pair while the blocks move") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Polygon> polygons;
  for (int i = 0; i < 100; ++i) {
    const double width =
        i % 7 == 0 ? 0.565 : 0.53;  // gaps of 0.04 and 0.005; the skin is 0.053, the margin 0.011
    const Vec2 at{0.57 * (i % 10), 0.57 * (i / 10)};
    polygons.push_back({at, at + Vec2{width, 0}, at + Vec2{width, width}, at + Vec2{0, width}});
  }
  const Scene s = scene_of(polygons);
  struct Stride {
    double shift, strain;
    int least_rebuilds, most_rebuilds;
  };
  // far below the skin, at a part of it, mostly by strain, beyond it
  for (const Stride stride :
       {Stride{0.0005, 0.0001, 1, 5}, {0.005, 0.001, 2, 40}, {0.0002, 0.01, 2, 40}, {0.4, 0.01, 60, 60}}) {
    CAPTURE(stride.shift);
    State state = start_state(s);
    size_t met = 0;
    for (int step = 0; step < 60; ++step) {
      for (size_t i = 0; i < state.displacement.size(); ++i) {
        state.displacement[i] += stride.shift * Vec2{unit(random), unit(random)};
        state.strain_part[i] += stride.strain * Mat2{unit(random), unit(random), unit(random), unit(random)};
      }
      const auto pairs = renewed(s, state);
      const auto expected = close_now(s.blocks, state, 0.0106);
      met += expected.size();
      CHECK(std::is_sorted(pairs.begin(), pairs.end()));
      CHECK(std::includes(pairs.begin(), pairs.end(), expected.begin(), expected.end()));
    }
    CHECK(met > 60);
    CHECK(state.candidates.rebuilds >= stride.least_rebuilds);
    CHECK(state.candidates.rebuilds <= stride.most_rebuilds);
  }
}

TEST_CASE("renew_pairs leaves out pairs that cannot move and looks ahead as far as its blocks are fast") {
  Scene s = scene_of({kSquare, moved(kSquare, {1.04, 0}), moved(kSquare, {2.04, 0})});
  s.blocks.kind[0] = BlockKind::kFixed;
  s.blocks.kind[1] = BlockKind::kDriven;
  State state = start_state(s);
  using Pairs = std::vector<std::pair<int, int>>;
  CHECK(renewed(s, state) == Pairs{{1, 2}});
  CHECK(renewed(s, state) == Pairs{{1, 2}});
  CHECK(state.candidates.rebuilds == 1);
  state.rate[2].a = {300, 0};  // 0.3 m in a step
  CHECK(renewed(s, state) == Pairs{{0, 2}, {1, 2}});
  CHECK(state.candidates.rebuilds == 2);
}

TEST_CASE(
    "the two ends of a face are each other's partner and share one length, whatever else touches there") {
  // hexagons with a kinked side, a little out of place: some pairs touch at three points and more
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Polygon> polygons;
  for (int i = 0; i < 60; ++i) {
    const Vec2 at{1.0 * (i % 10), 1.0 * (i / 10)};
    const double kink = 0.005 * unit(random);
    polygons.push_back({at, at + Vec2{0.5, kink}, at + Vec2{1, 0}, at + Vec2{1, 1}, at + Vec2{0.5, 1 - kink},
                        at + Vec2{0, 1}});
  }
  const Scene s = scene_of(polygons);
  State state = start_state(s);
  for (Vec2& d : state.displacement) d = {0.01 * unit(random), 0.01 * unit(random)};
  int faces = 0, beside = 0;
  for (int a = 0; a < s.blocks.count; ++a) {
    for (int b = a + 1; b < s.blocks.count; ++b) {
      const auto points = touch(s, state, a, b);
      for (int i = 0; i < count_of(points); ++i) {
        const ContactPoint& p = points[i];
        beside += p.partner < 0 && p.length > 0;
        if (p.partner < 0) continue;
        ++faces;
        const ContactPoint& q = points[p.partner];
        CHECK(q.partner == i);
        CHECK(q.length == p.length);
        CHECK(q.face_edge_a >= 0);
      }
    }
  }
  CHECK(faces > 100);
  CHECK(beside > 0);  // third points do occur
}

TEST_CASE("a corner at the thin end of a block does not act on the far side of the block") {
  // b ends in an edge of 4 cm; the upper left corner of a lies in its foot's extension, just past its upper
  // end
  const Polygon b{{0, 0}, {1, 0}, {1, 0.04}, {0, 0.5}};
  for (const double past : {-4e-5, -1e-6, 1e-6, 4e-5}) {
    CAPTURE(past);
    const Vec2 corner{1 - 5e-5, 0.04 + past};
    const Polygon a{corner, {corner.x, -0.5}, {1.5, -0.5}, {1.5, corner.y}};
    const auto points = touch({a, b});
    CHECK(points.size() >= 2);
    for (const ContactPoint& p : points) CHECK(p.gap == approx(-5e-5).epsilon(1e-6));
  }
}

TEST_CASE("a force at two corners that slide past each other deep inside passes on to the other corner") {
  // the lower block's left upper corner has just left the upper one's edge; the corner of the upper one is
  // nearer to the left side of the lower one than to its top
  const Polygon lower{{1.116893, -0.810654}, {1.140114, -0.441042}, {0.945066, -0.254016},
                      {0.525079, -0.33627},  {0.429259, -0.499423}, {0.561182, -0.905661},
                      {0.857248, -0.981335}};
  const Polygon upper{{0.53323, -0.347885},  {0.772451, -0.199325}, {0.878834, 0.247787},
                      {0.670586, 0.535116},  {0.320467, 0.605484},  {-0.003888, 0.3908},
                      {-0.080297, 0.072468}, {0.082844, -0.242866}};
  const Scene s = scene_of({lower, upper});
  Contact before;
  before.key = {0, 3, 1, 0};
  before.memory = Contact::kWhole;
  SearchRange range;
  range.margin = 0.01, range.depth = 0.1, range.look_ahead = 3e-4;
  for (const double force : {0.0, 2.5e6}) {
    CAPTURE(force);
    before.force = {force, 0};
    range.known = {&before, 1};
    ContactSearch search;
    const auto& points = search.touch(s.blocks, start_state(s), 0, 1, range).points;
    // met so in flight, the two are past each other
    if (force == 0) {
      CHECK(points.empty());
      continue;
    }
    REQUIRE(points.size() == 1);
    CHECK(points[0].key.block_a == 1);
    CHECK(points[0].key.vertex == 0);
    CHECK(points[0].key.edge == 2);
    CHECK(points[0].gap == approx(gap_over(lower, 2, upper[0])).epsilon(1e-9));
  }
}

TEST_CASE("two sides that turn out of line leave no corner on the far side of the other block") {
  // quadrilaterals of a pile, pressed into each other by 6 mm, 2 degrees apart: the corner that no longer
  // lies along the other block's side is 13 cm behind the side beyond it
  const Polygon left{{0.5452, 0.5558}, {0.2733, 0.0398}, {0.8506, -0.2968}, {1.1674, 0.0945}};
  const Polygon right{{0.5943, 1.2336}, {0.2357, 0.762}, {0.6543, 0.4734}, {0.9516, 1.0154}};
  const Scene s = scene_of({left, right});
  std::array<Contact, 2> before;
  before[0].key = {0, 0, 1, 1}, before[1].key = {1, 2, 0, 3};
  for (Contact& c : before) c.memory = Contact::kWhole, c.force = {4e6, 0};
  SearchRange range;
  range.margin = 0.05, range.depth = 0.2, range.look_ahead = 5e-4, range.known = before;
  ContactSearch search;
  const auto& points = search.touch(s.blocks, start_state(s), 0, 1, range).points;
  REQUIRE(points.size() >= 1);
  for (const ContactPoint& p : points) CHECK(p.gap == approx(gap_over(right, 1, left[0])).epsilon(1e-9));
}

TEST_CASE(
    "a corner seen to come over an edge stays on it, though another side that it cannot enter is nearer") {
  // a tip between the lower block's top and a short side that leaves it at 17 degrees
  const Polygon lower{{0, 0}, {1, 0}, {1, 0.5}, {0.02, 0.5}, {0, 0.47}};
  const Scene s = scene_of({lower, diamond({0.03, 0.475}, 0.3)});
  SearchRange range;
  range.margin = 0.05, range.depth = 0.2, range.look_ahead = 1e-3;
  Contact before;
  before.key = {1, 0, 0, 2};
  range.known = {&before, 1};
  ContactSearch search;
  const auto& points = search.touch(s.blocks, start_state(s), 0, 1, range).points;
  CHECK(
      std::any_of(points.begin(), points.end(), [&](const ContactPoint& p) { return p.key == before.key; }));
}

TEST_CASE("two blocks that a gap keeps apart at a crossing of joints do not touch by their other sides") {
  // rhombi of 50 deg at a crossing, b beyond the upper right corner of a; moved by about the distance at
  // which two corners count as one place
  const double sine = std::sin(50 * M_PI / 180), cosine = std::cos(50 * M_PI / 180);
  const Polygon rhombus{{0, 0}, {1, 0}, {1 + cosine, sine}, {cosine, sine}};
  const Scene s = scene_of({rhombus, moved(rhombus, {1 + cosine, sine})});
  const double same = kSamePlace * s.blocks.size[0];
  int apart = 0, inside = 0;
  for (int i = -30; i <= 30; ++i) {
    for (int j = -30; j <= 30; ++j) {
      State state = start_state(s);
      const Vec2 d = (0.1 * same) * Vec2{double(i), double(j)};
      state.displacement[1] = d;
      const double gap = std::max(d.y, sine * d.x - cosine * d.y);  // along the normals of the sides
      if (gap <= 1.001 * same) {
        for (const ContactPoint& p : touch(s, state)) inside += gap < 0 && p.gap < 0;
        continue;
      }
      ++apart;
      for (const ContactPoint& p : touch(s, state)) CHECK(p.gap > 0);
    }
  }
  CHECK(apart > 1000);
  CHECK(inside > 100);
}

TEST_CASE(
    "two corners that have gone deep into each other share the length that their polygons overlap along") {
  // blocks of steep joints that lean by 5 degrees against the normal of the bedding; the right one has come 8 mm to the
  // left and stands so high that their corners share a stretch of `high` at the common side
  const double lean = std::tan(5 * std::acos(-1) / 180), deep = 8e-3;
  for (const double high : {0.9e-3, 1.5e-3, 4e-3, 20e-3}) {
    const Polygon left{{-1, -1}, {0, -1 - lean}, {0, 0}, {-1, lean}};
    // its lower left corner at (-deep, -high): the bottom falls to the right as the top of the left block does
    const Polygon right{{-deep, -high}, {1 - deep, -high - lean}, {1 - deep, 1}, {-deep, 1}};
    const Overlap common = polygon_overlap(left, right);
    REQUIRE(common.area > 0);
    double length = 0;
    // they have met at their steep sides, and stay there
    std::vector<Contact> known(2);
    known[0].key = {0, 2, 1, 3}, known[1].key = {1, 0, 0, 1};
    for (Contact& c : known) c.force[0] = 1, c.memory = Contact::kWhole;
    const Scene scene = scene_of({left, right});
    SearchRange range;
    range.margin = range.depth = kMargin, range.known = known;
    ContactSearch search;
    for (const ContactPoint& c : search.touch(scene.blocks, start_state(scene), 0, 1, range).points) {
      if (std::abs(c.normal.x) < 0.9) continue;
      CHECK(c.gap == approx(-deep).epsilon(1e-12));
      length += c.length;
    }
    // the mean length over the depth: exact for a parallelogram
    CHECK(length * deep == approx(common.area).epsilon(1e-9));
  }
}

}  // namespace test_find
