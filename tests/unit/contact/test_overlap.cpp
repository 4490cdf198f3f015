// Two convex parts that overlap: area, energy, force, chord and closures against quadrature, differences and
// closed forms.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "support/box_polygon.h"
#include "support/convex_parts.h"
#include "talus/base/random.h"
#include "talus/contact/overlap.h"
#include "talus/geometry/polygon.h"

namespace test_overlap {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kAll = std::numeric_limits<double>::infinity();

// All pieces of an overlap that ties leave.
std::vector<PartsMet> pieces_of(const Body& a, const Body& b) {
  PartsMeeting meeting;
  const Seen one(a), two(b);
  std::vector<PartsMet> out;
  if (meeting.look(one.now(), two.now(), b.origin - a.origin, kMargin, kRounding).kind != PartsMet::kOverlap)
    return out;
  for (bool any = meeting.measure_overlap(); any; any = meeting.measure_next_piece())
    out.push_back(meeting.met());
  return out;
}

// Random convex polygon: corners on an ellipse of half axes up to 1 m.
Body random_body(Random& random) {
  const auto n = static_cast<size_t>(3 + 6 * random.uniform());
  const double one = 0.5 + 0.5 * random.uniform(), two = 0.3 + 0.3 * random.uniform(),
               lean = 6.3 * random.uniform();
  Body out;
  for (size_t k = 0; k < n; ++k) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(k) + 0.8 * random.uniform()) / static_cast<double>(n);
    out.corner.push_back(turned({one * std::cos(angle), two * std::sin(angle)}, lean));
  }
  return out;
}

// How far the two are in each other, along the way that is shortest; < 0: apart [m].
double overlap_of(const Body& a, const Body& b) {
  double least = kAll;
  const auto sides = [&](const Body& own, const Body& other) {
    for (size_t k = 0; k < own.corner.size(); ++k) {
      const Vec2 side = own.at(k + 1) - own.at(k);
      double most = -kAll;
      for (size_t i = 0; i < other.corner.size(); ++i)
        most = std::max(most, cross(side, other.at(i) - own.at(k)) / norm(side));
      least = std::min(least, most);
    }
  };
  sides(a, b), sides(b, a);
  return least;
}

struct Two {
  Body a, b;
  double depth = 0;  // [m]
};

// Two in each other by 1e-3 to 5e-2 m, 5 % of a polygon's size; b is seen from anywhere.
Two random_two(Random& random) {
  Two two{random_body(random), random_body(random),
          std::exp(std::log(1e-3) + random.uniform() * std::log(50.0))};
  const double angle = 2 * std::numbers::pi * random.uniform();
  const Vec2 way{std::cos(angle), std::sin(angle)};
  double near = 0, far = 3;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (near + far);
    two.b.origin = middle * way;
    (overlap_of(two.a, two.b) > two.depth ? near : far) = middle;
  }
  two.depth = overlap_of(two.a, two.b);
  // where b begins outside of a there is no such place on the way
  return two.depth < 0.9e-3 ? random_two(random) : two;
}

struct Pull {
  Vec2 force;         // on a, over stiffness and thickness [m2]
  double moment = 0;  // about the origin of a [m3]
};

// Of the cells, each pushed along its side's normal.
Pull by_cells(const Body& a, const Body& b, const PartsMet& met) {
  Pull out;
  const auto add = [&](const Body& own, const std::vector<SideCell>& cells, double sign) {
    for (const SideCell& c : cells) {
      const int k = c.side;
      const Vec2 side = own.at(k + 1) - own.at(k), push = 0.5 * sign * turn_right(side) / norm(side);
      out.force += c.area * push, out.moment += cross(c.first, push);
    }
  };
  add(b, met.cells_b, 1), add(a, met.cells_a, -1);
  return out;
}

// Of closures that are linear along the chord.
Pull by_closures(const PartsMet& met) {
  const double length = met.length(), mean = 0.5 * (met.closure[0] + met.closure[1]);
  const Vec2 force = length * mean * met.normal;
  const Vec2 first =
      length / 6 *
      ((2 * met.closure[0] + met.closure[1]) * met.begin + (met.closure[0] + 2 * met.closure[1]) * met.end);
  return {force, cross(first, met.normal)};
}

// --- quadrature that shares no code: lines across the overlap, midpoints along and across

// The overlap along a line y = const: [0] from, [1] to; from > to: none.
std::array<double, 2> across(const Body& a, const Body& b, double y) {
  std::array<double, 2> x{-kAll, kAll};
  for (const Body* own : {&a, &b})
    for (size_t k = 0; k < own->corner.size(); ++k) {
      const Vec2 p = own->at(k), q = own->at(k + 1);
      if (p.y == q.y) {
        if ((q.x - p.x) * (y - p.y) < 0) return {1, 0};
        continue;
      }
      const double at = p.x + (y - p.y) / (q.y - p.y) * (q.x - p.x);
      if (q.y > p.y)
        x[1] = std::min(x[1], at);
      else
        x[0] = std::max(x[0], at);
    }
  return x;
}

// Lowest and highest place of the overlap: its breadth is concave in y.
std::array<double, 2> heights(const Body& a, const Body& b) {
  const auto breadth = [&](double y) {
    const auto x = across(a, b, y);
    return x[1] - x[0];
  };
  double low = -4, high = 4;
  for (int i = 0; i < 200; ++i) {
    const double one = low + (high - low) / 3, two = high - (high - low) / 3;
    (breadth(one) < breadth(two) ? low : high) = breadth(one) < breadth(two) ? one : two;
  }
  std::array<double, 2> out{};
  for (const size_t end : {0U, 1U}) {
    double in = 0.5 * (low + high), outside = end == 0 ? -4 : 4;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (in + outside);
      (breadth(middle) > 0 ? in : outside) = middle;
    }
    out[end] = in;
  }
  return out;
}

struct Nearest {
  double depth = kAll;
  SideRole role = SideRole::kOut;
};

Nearest nearest(const Body& body, Vec2 x) {
  Nearest out;
  for (size_t k = 0; k < body.corner.size(); ++k) {
    if (body.role_of(k) == SideRole::kCut || body.role_of(k) == SideRole::kTied) continue;
    const Vec2 side = body.at(k + 1) - body.at(k);
    const double depth = cross(side, x - body.at(k)) / norm(side);
    if (depth < out.depth) out = {depth, body.role_of(k)};
  }
  return out;
}

struct Summed {
  double area = 0, energy = 0;
};

// What bears, piece by piece: stretches of one line and the next that lie beside each other are of one. Lines lie close
// where the overlap ends: sides that are nearly level lie between two of them.
std::vector<Summed> pieces_by_lines(const Body& a, const Body& b, int lines) {
  struct Stretch {
    double from, to;
    size_t piece;
  };
  const auto y = heights(a, b);
  std::vector<Summed> sums;
  std::vector<size_t> piece;  // of what was begun as one
  const auto first_of = [&](size_t k) {
    while (piece[k] != k) k = piece[k];
    return k;
  };
  std::vector<Stretch> before, now;
  for (int i = 0; i < lines; ++i, before.swap(now), now.clear()) {
    const double u = (i + 0.5) / lines, here = y[0] + (y[1] - y[0]) * u * u * (3 - 2 * u);
    const double dy = (y[1] - y[0]) * 6 * u * (1 - u) / lines;
    const auto x = across(a, b, here);
    if (!(x[1] > x[0])) continue;
    const double dx = (x[1] - x[0]) / lines;
    bool bears = false;
    for (int j = 0; j < lines; ++j) {
      const Vec2 place{x[0] + (j + 0.5) * dx, here};
      const Nearest in_a = nearest(a, place), in_b = nearest(b, place);
      const bool bore = bears;
      bears = in_a.role != SideRole::kTiedHere && in_b.role != SideRole::kTiedHere;
      if (!bears) continue;
      if (!bore) {
        piece.push_back(piece.size()), sums.emplace_back();
        now.push_back({place.x - 0.5 * dx, place.x, piece.back()});
      }
      now.back().to = place.x + 0.5 * dx;
      sums[now.back().piece].area += dx * dy;
      sums[now.back().piece].energy += 0.5 * (in_a.depth + in_b.depth) * dx * dy;
    }
    for (const Stretch& s : now)
      for (const Stretch& t : before)
        if (s.from <= t.to && t.from <= s.to) piece[first_of(s.piece)] = first_of(t.piece);
  }
  std::vector<Summed> out;
  for (size_t k = 0; k < sums.size(); ++k) {
    if (piece[k] != k) continue;
    Summed sum;
    for (size_t n = 0; n < sums.size(); ++n)
      if (first_of(n) == k) sum.area += sums[n].area, sum.energy += sums[n].energy;
    out.push_back(sum);
  }
  return out;
}

Summed by_lines(const Body& a, const Body& b, int lines) {
  Summed sum;
  for (const Summed& one : pieces_by_lines(a, b, lines)) sum.area += one.area, sum.energy += one.energy;
  return sum;
}

double energy_of(const Body& a, const Body& b) { return meet(a, b).energy; }

double off(double value, double exact) { return std::abs(value - exact) / std::abs(exact); }
double off(Vec2 value, Vec2 exact) { return norm(value - exact) / norm(exact); }

// Of two that are the same but for where they are seen from.
double off(const PartsMet& met, const PartsMet& like) {
  double most =
      std::max({off(met.area, like.area), off(met.energy, like.energy), off(met.force, like.force)});
  most = std::max(most, off(met.length(), like.length()));
  for (const size_t end : {0U, 1U})
    most = std::max(most, std::abs(met.closure[end] - like.closure[end]) /
                              (std::abs(like.closure[0]) + std::abs(like.closure[1])));
  return most;
}

}  // namespace

TEST_CASE("overlap: area and energy of random pairs are those of a fine quadrature" *
          doctest::test_suite("optimised")) {
  Random random(10);
  double worst_area = 0, worst_energy = 0;
  for (int i = 0; i < 150; ++i) {
    CAPTURE(i);
    const Two two = random_two(random);
    const PartsMet met = meet(two.a, two.b);
    REQUIRE(met.kind == PartsMet::kOverlap);
    constexpr int kLines = 300;
    const Summed sum = by_lines(two.a, two.b, kLines);
    // midpoints of n pieces miss some 1/n^2 at each kink, a few of which lie on every line
    constexpr double kMissed = 5.0 / (kLines * kLines);
    worst_area = std::max(worst_area, off(met.area, sum.area)),
    worst_energy = std::max(worst_energy, off(met.energy, sum.energy));
    CHECK(off(met.area, sum.area) < kMissed);
    CHECK(off(met.energy, sum.energy) < kMissed);
  }
  MESSAGE("largest errors: area ", worst_area, ", energy ", worst_energy);
}

TEST_CASE("overlap: force and moment are the slope of the energy, whichever way b moves") {
  Random random(11);
  double worst = 0;
  int beyond = 0;
  for (int i = 0; i < 400; ++i) {
    CAPTURE(i);
    const Two two = random_two(random);
    const PartsMet met = meet(two.a, two.b);
    REQUIRE(met.kind == PartsMet::kOverlap);
    const Pull pull = by_cells(two.a, two.b, met);
    const double h = 1e-4 * two.depth;
    const auto slope = [&](Vec2 way, double angle) {
      const double after = energy_of(two.a, moved(two.b, h * way, h * angle)),
                   before = energy_of(two.a, moved(two.b, -h * way, -h * angle));
      return (after - before) / (2 * h);
    };
    // differences miss (h / depth)^2 = 1e-8, and 1e-16 / (depth h) of rounded places, at least 1e-9; next to the
    // cells' forces of both blocks, which may all but balance each other
    constexpr double kMissed = 1e-6;
    const double scale = met.area;
    const double error =
        std::max({std::abs(slope({1, 0}, 0) - pull.force.x), std::abs(slope({0, 1}, 0) - pull.force.y),
                  std::abs(slope({0, 0}, 1) - pull.moment)}) /
        scale;
    CHECK(error < kMissed);
    worst = std::max(worst, error);
    beyond += met.beyond;
  }
  CHECK(beyond < 20);  // the force hardly ever acts beyond an end of the chord
  MESSAGE("largest error over the area ", worst, ", beyond an end of the chord: ", beyond);
}

TEST_CASE("overlap: closures at the ends of the chord have the force and the moment of the cells") {
  Random random(12);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    CAPTURE(i);
    const Two two = random_two(random);
    const PartsMet met = meet(two.a, two.b);
    REQUIRE(met.kind == PartsMet::kOverlap);
    const Pull cells = by_cells(two.a, two.b, met), closures = by_closures(met);
    CHECK(std::abs(dot(met.end - met.begin, met.normal)) <= 1e-15);  // the chord is along the tangent
    CHECK(dot(met.end - met.begin, turn_right(met.normal)) > 0);
    // sums of areas, which places rounded to 1e-16 m give to 1e-13 at a depth of 1e-3 m
    double error = norm(closures.force - cells.force) / met.area;
    if (!met.beyond) error = std::max(error, std::abs(closures.moment - cells.moment) / met.area);
    CHECK(error < 1e-13);
    worst = std::max(worst, error);
    if (met.beyond) CHECK(std::min(met.closure[0], met.closure[1]) < 0);  // at an end of the chord
  }
  MESSAGE("largest error ", worst);
}

namespace {

Body mirrored(const Body& body) {
  Body out;
  for (size_t k = body.corner.size(); k-- > 0;) out.corner.push_back({-body.corner[k].x, body.corner[k].y});
  out.origin = {-body.origin.x, body.origin.y};
  return out;
}

Body begun_later(Body body, size_t by) {
  std::rotate(body.corner.begin(), body.corner.begin() + (by % body.corner.size()), body.corner.end());
  return body;
}

}  // namespace

TEST_CASE(
    "overlap: a mirrored, turned or exchanged pair is the same, and one whose corners begin elsewhere") {
  Random random(13);
  std::array<double, 4> worst{};
  for (int i = 0; i < 500; ++i) {
    CAPTURE(i);
    const Two two = random_two(random);
    const PartsMet met = meet(two.a, two.b);
    REQUIRE(met.kind == PartsMet::kOverlap);
    const double extent = std::min(two.depth, met.length());
    const auto note = [&](size_t which, double error) {
      worst[which] = std::max(worst[which], error * std::min(1.0, extent / 4e-3));
    };
    PartsMet mirror = meet(mirrored(two.a), mirrored(two.b));
    std::swap(mirror.closure[0], mirror.closure[1]);
    note(0, off({-mirror.normal.x, mirror.normal.y}, met.normal));
    note(0, norm(Vec2{-mirror.end.x, mirror.end.y} - met.begin)), note(0, off(mirror, met));
    const double angle = 6.3 * random.uniform();
    const PartsMet turn = meet(moved(two.a, {}, angle), moved(two.b, {}, angle));
    note(1, off(turn.normal, turned(met.normal, angle)));
    note(1, norm(turn.begin - turned(met.begin, angle))), note(1, off(turn, met));
    PartsMet other = meet(two.b, two.a);
    std::swap(other.closure[0], other.closure[1]);
    note(2, off(-other.normal, met.normal)), note(2, off(other, met));
    note(2, norm(other.begin + (two.b.origin - two.a.origin) - met.end));
    CHECK(other.side_a == met.side_b);
    const auto by = static_cast<size_t>(10 * random.uniform());
    const PartsMet later = meet(begun_later(two.a, by), begun_later(two.b, by + 1));
    note(3, off(later.normal, met.normal)), note(3, off(later, met));
    note(3, std::max(norm(later.begin - met.begin), norm(later.end - met.end)));
  }
  // places of 1 m are rounded to 1e-16 m of the extents of the overlap, and closures are differences: 1e-12 at 4e-3 m
  CHECK(worst[0] < 1e-12);
  CHECK(worst[1] < 1e-11);  // the coordinates differ
  CHECK(worst[2] < 1e-12);
  CHECK(worst[3] < 1e-12);
  MESSAGE("mirrored ", worst[0], ", turned ", worst[1], ", exchanged ", worst[2], ", begun elsewhere ",
          worst[3]);
}

TEST_CASE("overlap: only the shift between the two matters, not where they are") {
  Random random(14);
  for (int i = 0; i < 100; ++i) {
    const Two two = random_two(random);
    const PartsMet met = meet(two.a, two.b);
    const PartsMet far = meet(moved(two.a, {1 << 20, 1 << 19}), moved(two.b, {1 << 20, 1 << 19}));
    // their difference loses 1e-10 m there, of a depth of at least 1e-3 m
    CHECK(off(far, met) < 1e-6);
    // the same origin for both, which b's corners are not seen from
    Body aside = two.b;
    for (Vec2& c : aside.corner) c += Vec2{1000, 0};
    aside.origin -= Vec2{1000, 0};
    CHECK(off(meet(two.a, aside), met) < 1e-9);  // 1e-13 m of 1e-3 m, and some
  }
}

TEST_CASE("overlap: a level strip on a wider face") {
  for (const double length : {0.5, 1.0, 1.7})
    for (const double c : {1e-5, 1e-3, 0.05}) {
      const Body block = block_over(length, c);
      const PartsMet met = meet(block, floor_body());
      REQUIRE(met.kind == PartsMet::kOverlap);
      // places of 1 m are rounded to 1e-16 m
      const double rounded = 1e-15 / c + 1e-13;
      CHECK(off(met.area, length * c) < rounded);
      CHECK(off(met.force, c * (length - 0.5 * c)) < rounded);
      CHECK(off(met.energy, c * c * (0.5 * length - c / 6)) < 2 * rounded);
      CHECK(norm(met.normal - Vec2{0, 1}) < rounded);
      CHECK(off(met.length(), length) < 1e-14);
      CHECK(met.begin.x < met.end.x);  // the tangent of an upward normal points right
      for (const double closure : met.closure) CHECK(off(closure, c * (1 - 0.5 * c / length)) < 10 * rounded);
      CHECK(met.side_a == 0);
      CHECK(met.side_b == 2);
    }
}

TEST_CASE("overlap: two level blocks of one width have both ends less") {
  const double length = 1, c = 0.01;
  const Body block{box_polygon(0, 0, length, 1), {0, -c}}, under{box_polygon(0, -1, length, 0), {}};
  const PartsMet met = meet(block, under);
  REQUIRE(met.kind == PartsMet::kOverlap);
  CHECK(off(met.force, c * (length - c)) < 1e-13);  // 1e-16 m of c, and some
  CHECK(norm(met.normal - Vec2{0, 1}) < 1e-13);
  CHECK(off(met.energy, c * c * (0.5 * length - c / 3)) < 1e-13);
}

TEST_CASE("overlap: a toe of a tilted block is a triangle, which tends to the toe of springs") {
  for (const double tilt : {1e-3, 0.02, 0.3}) {
    CAPTURE(tilt);
    const double h = 1e-4, s = std::sin(tilt), c = std::cos(tilt);
    Body block = moved({box_polygon(0, 0, 1, 1), {}}, {0, -h}, tilt);
    const PartsMet met = meet(block, floor_body());
    REQUIRE(met.kind == PartsMet::kOverlap);
    // areas of the triangle, and of what is nearest to the block's bottom and to its wall
    const double area = 0.5 * h * h * (c / s + s / c), bottom = 0.5 * h * h * (c / s - (c - s) / (c + s)),
                 wall = area - bottom;
    const Vec2 force = 0.5 * (area * Vec2{0, 1} - bottom * Vec2{s, -c} - wall * Vec2{-c, -s});
    constexpr double kRounded = 1e-11;  // 1e-16 m of h, with h over the tilt from the floor
    CHECK(off(met.area, area) < kRounded);
    CHECK(off(met.force * met.normal, force) < kRounded);
    CHECK(met.begin.x == doctest::Approx(-h * s / c).scale(h).epsilon(0.6));
    if (tilt > 0.01) continue;
    // springs under the bottom: h^2 / (2 tilt); the closure falls to nothing along the chord
    CHECK(off(met.force, 0.5 * h * h / tilt) < tilt);
    CHECK(off(met.closure[0], h) < 2 * tilt);
    CHECK(std::abs(met.closure[1]) < 2 * tilt * h);
  }
}

TEST_CASE("overlap: the force of a corner that is pushed into a face goes by the square of its depth") {
  for (const double half_angle : {0.2, 0.785, 1.3}) {
    CAPTURE(half_angle);
    const double s = std::sin(half_angle), c = std::cos(half_angle);
    for (const double h : {1e-4, 1e-3, 1e-2}) {
      const Body wedge{{{0, 0}, {s, c}, {-s, c}}, {0.3, -h}};
      const PartsMet met = meet(wedge, floor_body());
      REQUIRE(met.kind == PartsMet::kOverlap);
      const double area = h * h * s / c;
      constexpr double kRounded = 1e-11;  // 1e-16 m of 1e-4 m, and some
      CHECK(off(met.area, area) < kRounded);
      CHECK(off(met.force, 0.5 * area * (1 + s)) < kRounded);
      CHECK(norm(met.normal - Vec2{0, 1}) < kRounded);
      CHECK(off(met.length(), 2 * h * s / c) < kRounded);
      CHECK(std::abs(met.closure[0] - met.closure[1]) < kRounded * met.closure[0]);
    }
  }
}

namespace {

// A closed way of b against a, as s goes from 0 to 1.
struct Loop {
  std::array<double, 6> size{}, phase{};

  // Way in x, in y and turn, or how they grow with s.
  std::array<double, 3> place(double s) const {
    std::array<double, 3> out{};
    for (size_t k = 0; k < 6; ++k) out[k % 3] += size[k] * std::sin(times(k) * s + phase[k]);
    return out;
  }
  std::array<double, 3> growth(double s) const {
    std::array<double, 3> out{};
    for (size_t k = 0; k < 6; ++k) out[k % 3] += times(k) * size[k] * std::cos(times(k) * s + phase[k]);
    return out;
  }

 private:
  static double times(size_t k) { return 2 * std::numbers::pi * (k < 3 ? 1 : 2); }
};

// Work along a loop.
struct Round {
  const Body &a, &b;
  const Loop& loop;

  double power(double s) const {
    const auto [x, y, turn] = loop.place(s);
    const auto [dx, dy, spin] = loop.growth(s);
    const Body here = moved(b, {x, y}, turn);
    const PartsMet met = meet(a, here);
    if (met.kind != PartsMet::kOverlap) return 0;
    const Pull pull = by_cells(a, here, met);
    return dot(pull.force, Vec2{dx, dy}) + spin * (pull.moment - cross(Vec2{x, y}, pull.force));
  }
  // Simpson's rule, halved where it is not yet good enough.
  double work(double s0, double s1, double p0, double pm, double p1, double good, int depth) const {
    const double sm = 0.5 * (s0 + s1), pl = power(0.5 * (s0 + sm)), pr = power(0.5 * (sm + s1)), ds = s1 - s0;
    const double once = ds / 6 * (p0 + 4 * pm + p1), twice = ds / 12 * (p0 + 4 * pl + 2 * pm + 4 * pr + p1);
    if (std::abs(twice - once) < 15 * good * ds || depth > 14) return twice + (twice - once) / 15;
    return work(s0, sm, p0, pl, pm, good, depth + 1) + work(sm, s1, pm, pr, p1, good, depth + 1);
  }
};

}  // namespace

TEST_CASE("overlap: no work is left after a closed way of rigid motions") {
  Random random(15);
  double worst = 0;
  for (int i = 0; i < 10; ++i) {
    CAPTURE(i);
    const Two two = random_two(random);
    Loop loop;
    for (double& phase : loop.phase) phase = 6.3 * random.uniform();
    for (double& size : loop.size) size = 0.3 * two.depth * random.uniform();
    const Round round{two.a, two.b, loop};
    double along = 0, sum = 0;
    constexpr int kPieces = 64;
    for (int k = 0; k < kPieces; ++k) along += std::abs(round.power((k + 0.5) / kPieces)) / kPieces;
    for (int k = 0; k < kPieces; ++k) {
      const double s0 = static_cast<double>(k) / kPieces, s1 = (k + 1.0) / kPieces;
      sum += round.work(s0, s1, round.power(s0), round.power(0.5 * (s0 + s1)), round.power(s1), 2e-12 * along,
                        0);
    }
    REQUIRE(along > 0);
    // the integral is asked for to 2e-12; forces follow places of 1e-16 m at depths of 1e-3 m
    CHECK(std::abs(sum) < 1e-10 * along);
    worst = std::max(worst, std::abs(sum) / along);
  }
  MESSAGE("largest rest ", worst);
}

TEST_CASE("overlap: cuts and sides tied to third blocks are no ways out") {
  Random random(16);
  double worst = 0;
  int met_with[4]{};
  for (int i = 0; i < 300; ++i) {
    CAPTURE(i);
    Two two = random_two(random);
    const PartsMet free = meet(two.a, two.b);
    REQUIRE(free.kind == PartsMet::kOverlap);
    const auto role = static_cast<SideRole>(1 + i % 3);
    Body& own = i % 2 == 0 ? two.a : two.b;
    own.role.assign(own.corner.size(), SideRole::kOut);
    // one of the sides that have a cell, which need not be that of most of it
    const std::vector<SideCell>& cells = i % 2 == 0 ? free.cells_a : free.cells_b;
    own.role[cells[static_cast<size_t>(i) / 6 % cells.size()].side] = role;
    const std::vector<PartsMet> pieces = pieces_of(two.a, two.b);
    if (pieces.empty()) continue;
    ++met_with[place_of(role)];
    Summed all;
    for (const PartsMet& met : pieces) all.area += met.area, all.energy += met.energy;
    constexpr int kLines = 400;
    const Summed sum = by_lines(two.a, two.b, kLines);
    // midpoints miss 1/n^2 at kinks; what bears nothing has an edge of its own, which each line misses by half a
    // piece of up to all of its length either way: next to the whole overlap, not to what of it bears
    const bool edge = role == SideRole::kTiedHere;
    const double missed = edge ? 2.0 / kLines : 10.0 / (kLines * kLines);
    const double area = std::abs(all.area - sum.area) / free.area,
                 energy = std::abs(all.energy - sum.energy) / std::max(free.energy, sum.energy);
    CHECK(area < missed);
    CHECK(energy < missed);
    worst = std::max({worst, area, energy});
    for (const PartsMet& met : pieces) {
      for (const SideCell& c : i % 2 == 0 ? met.cells_a : met.cells_b)
        CHECK(own.role[c.side] == SideRole::kOut);
      const Pull by_cell = by_cells(two.a, two.b, met), by_chord = by_closures(met);
      CHECK(norm(by_cell.force - by_chord.force) < 1e-13 * met.area);  // sums of areas, as without ties
    }
  }
  CHECK(met_with[1] > 50);
  CHECK(met_with[2] > 20);
  CHECK(met_with[3] > 20);
  MESSAGE("largest error ", worst);
}

TEST_CASE("overlap: parts that a cut or a tie separates do not meet") {
  const Body under = floor_body();
  for (const SideRole role : {SideRole::kCut, SideRole::kTied, SideRole::kTiedHere}) {
    Body block = block_over(1, -0.01);  // a hundredth above
    block.role = {role, SideRole::kOut, SideRole::kOut, SideRole::kOut};
    CHECK(meet(block, under).kind == PartsMet::kFar);
  }
  Body sides = block_over(1, 0.01);
  sides.role.assign(4, SideRole::kCut);
  CHECK(meet(sides, under).kind == PartsMet::kFar);  // without a side of its own it makes no patch
  // a tip in the middle of a tied side has far sides left alone
  Body block = block_over(1, 0);
  block.role = {SideRole::kTied, SideRole::kOut, SideRole::kOut, SideRole::kOut};
  const Body tip{{{0, 0.01}, {-0.5, -0.5}, {0.5, -0.5}}, {0.1, 0}};
  CHECK(meet(block, tip).kind == PartsMet::kFar);
  block.role[0] = SideRole::kCut;  // a cut has no depth that could say so
  CHECK(meet(block, tip).kind == PartsMet::kOverlap);
}

TEST_CASE("overlap: of a strip along a side that ties the two, the corners nearest to the walls are left") {
  constexpr double c = 0.01, kRounded = 1e-12;  // 1e-16 m of c, and some
  const double diagonal = std::sqrt(0.5);
  Body block = block_over(1, c);
  block.role = {SideRole::kTiedHere, SideRole::kOut, SideRole::kOut, SideRole::kOut};
  const std::vector<PartsMet> pieces = pieces_of(block, floor_body());
  REQUIRE(pieces.size() == 2);
  int walls = 0;
  for (const PartsMet& met : pieces) {
    // a triangle of c by c, above 45 deg from the corner; both sides press at its centroid, where either is c/3 away
    const bool left = met.begin.x < 0;
    const double out = left ? -1 : 1;
    walls += left ? 1 : 2;
    CHECK(off(met.area, 0.5 * c * c) < kRounded);
    CHECK(off(met.energy, c * c * c / 6) < kRounded);
    CHECK(off(met.force, 0.25 * c * c / diagonal) < kRounded);
    CHECK(norm(met.normal - Vec2{-out * diagonal, diagonal}) < kRounded);
    CHECK(met.side_a == (left ? 3 : 1));
    CHECK(met.side_b == 2);
    // from the top of the wall to the middle of the slanted side; at two thirds of it, where a triangle of closures acts
    const Vec2 top{0.5 * out, c}, slant{0.5 * out - 0.5 * out * c, 0.5 * c};
    CHECK(norm((left ? met.begin : met.end) - top) < kRounded * c);
    CHECK(norm((left ? met.end : met.begin) - slant) < kRounded * c);
    CHECK(std::abs(met.closure[left ? 0 : 1]) < kRounded * c);
    CHECK(off(met.closure[left ? 1 : 0], c) < kRounded);
    CHECK_FALSE(met.beyond);
  }
  CHECK(walls == 3);
}

namespace {

// A block of 1 m whose bottom is divided at `at`, `depth` below the top of the floor.
Body divided_block(const std::vector<double>& at, const std::vector<SideRole>& bottom, double depth) {
  Body out{{{-0.5, 0}}, {0.1, -depth}, bottom};
  for (const double x : at) out.corner.push_back({x, 0});
  for (const Vec2 x : {Vec2{0.5, 0}, Vec2{0.5, 1}, Vec2{-0.5, 1}}) out.corner.push_back(x);
  out.role.resize(out.corner.size(), SideRole::kOut);
  return out;
}

// The strip of `length` between a wall and a tie, on a wider face.
void check_strip(const PartsMet& met, double length, double c, bool left) {
  constexpr double kRounded = 1e-11;  // 1e-16 m of c, and some
  const Vec2 force{(left ? 1 : -1) * 0.25 * c * c,
                   c * (length - 0.25 * c)};  // one corner less, which pushes along
  const Vec2 normal = force / norm(force);
  CHECK(off(met.area, length * c) < kRounded);
  CHECK(off(met.energy, c * c * (0.5 * length - c / 12)) < kRounded);
  CHECK(off(met.force * met.normal, force) < kRounded);
  CHECK(off(met.length(), length * normal.y + c * std::abs(normal.x)) < kRounded);
  CHECK(std::abs(0.5 * (met.begin.x + met.end.x) - (left ? -0.5 + 0.5 * length : 0.5 - 0.5 * length)) < c);
  for (const double closure : met.closure) CHECK(off(closure, c) < 2 * c / length);
}

}  // namespace

TEST_CASE("overlap: a side that is tied in its middle bears at both ends, each by a chord of its own") {
  constexpr auto kOut = SideRole::kOut, kTied = SideRole::kTiedHere;
  for (const double c : {1e-5, 1e-3}) {
    const std::vector<PartsMet> both =
        pieces_of(divided_block({-0.2, 0.3}, {kOut, kTied, kOut}, c), floor_body());
    REQUIRE(both.size() == 2);
    const size_t left = both[0].begin.x < both[1].begin.x ? 0 : 1;
    check_strip(both[left], 0.3, c, true), check_strip(both[1 - left], 0.2, c, false);
    // the other end's corner is behind a cut, and nothing is left there
    Body block = divided_block({-0.2}, {kOut, kTied}, c);
    block.role[2] = SideRole::kCut;
    const std::vector<PartsMet> one = pieces_of(block, floor_body());
    REQUIRE(one.size() == 1);
    check_strip(one[0], 0.3, c, true);
  }
}

TEST_CASE(
    "overlap: what hangs together beside a tie is one piece, however thin it is and whichever way it lies") {
  constexpr auto kOut = SideRole::kOut, kTied = SideRole::kTiedHere;
  Random random(73);
  for (int i = 0; i < 3000; ++i) {
    CAPTURE(i);
    const double c = 1e-9 * std::exp(random.uniform() * std::log(1e7)),
                 tilt = 0.5 * c * (2 * random.uniform() - 1), angle = 6.3 * random.uniform(),
                 from = -0.4 + 0.5 * random.uniform();
    const Body block =
        moved(divided_block({from, from + 0.01 + 0.2 * random.uniform()}, {kOut, kTied, kOut}, c), {}, tilt);
    CHECK(pieces_of(moved(block, {}, angle), moved(floor_body(), {}, angle)).size() == 2);
    // of one width, their corners in each other at either end
    const Body same{box_polygon(-0.4, -1, 0.6, 0), {}};
    CHECK(pieces_of(moved(block, {}, angle), moved(same, {}, angle)).size() == 2);
  }
}

TEST_CASE("overlap: two pieces come to bear as one without a jump where what ties them shrinks to nothing") {
  constexpr auto kOut = SideRole::kOut, kTied = SideRole::kTiedHere;
  constexpr double c = 1e-3;
  const PartsMet whole = meet(block_over(1, c), floor_body());
  for (const double tied : {1e-2, 1e-4, 1e-6, 1e-8}) {
    CAPTURE(tied);
    const std::vector<PartsMet> two =
        pieces_of(divided_block({-0.2, -0.2 + tied}, {kOut, kTied, kOut}, c), floor_body());
    REQUIRE(two.size() == 2);
    Pull sum;
    double energy = 0, length = 0;
    for (const PartsMet& met : two) {
      const Pull one = by_closures(met);
      sum.force += one.force, sum.moment += one.moment, energy += met.energy, length += met.length();
    }
    const Pull all = by_closures(whole);
    constexpr double kRounded = 1e-12;
    CHECK(norm(sum.force - all.force) < c * (tied + kRounded));
    CHECK(std::abs(sum.moment - all.moment) < c * (tied + kRounded));
    CHECK(std::abs(energy - whole.energy) < c * c * (tied + kRounded));
    CHECK(std::abs(length - whole.length()) < tied + 4 * c * c);  // of the three lean by what a corner pushes
  }
}

namespace {

// A body with one bent side up or down, of several pieces nearly in line.
Body random_bow(Random& random, bool up) {
  std::vector<double> at{-1, 1};
  const auto more = static_cast<size_t>(3 + 5 * random.uniform());
  while (at.size() < more + 2) {
    const double x = -0.95 + 1.9 * random.uniform();
    if (std::all_of(at.begin(), at.end(), [&](double y) { return std::abs(x - y) > 0.05; })) at.push_back(x);
  }
  std::sort(at.begin(), at.end());
  const double sag = 0.01 * random.uniform(), lean = 0.01 * random.uniform();
  Body out;
  for (const double x : at) out.corner.push_back({x, sag * x * x + lean * x});
  out.corner.push_back({1.1, 1}), out.corner.push_back({-1.1, 1.1});
  for (size_t k = 0; k < out.corner.size(); ++k)
    out.role.push_back(k + 3 < out.corner.size() && random.uniform() < 0.5 ? SideRole::kTiedHere
                                                                           : SideRole::kOut);
  return up ? moved(out, {}, std::numbers::pi) : out;
}

}  // namespace

TEST_CASE("overlap: pieces of random tied pairs are those of a fine quadrature, and add up to it" *
          doctest::test_suite("optimised")) {
  Random random(17);
  double worst = 0;
  std::array<int, 5> met_with{};
  int other = 0;
  constexpr int kPairs = 200, kLines = 400;
  for (int i = 0; i < kPairs; ++i) {
    CAPTURE(i);
    Body a = random_bow(random, false), b = random_bow(random, true);
    b.origin = {-0.3 + 0.6 * random.uniform(), 0.01 + 0.02 * random.uniform()};
    Body free_a = a, free_b = b;
    free_a.role.clear(), free_b.role.clear();
    const PartsMet free = meet(free_a, free_b);
    REQUIRE(free.kind == PartsMet::kOverlap);
    std::vector<PartsMet> pieces = pieces_of(a, b);
    std::vector<Summed> sums = pieces_by_lines(a, b, kLines);
    // what bears has some edges at ties, which each line misses by half a piece of its length either way
    constexpr double kMissed = 2.0 / kLines;
    Summed all, exact;
    for (const PartsMet& met : pieces) all.area += met.area, all.energy += met.energy;
    for (const Summed& sum : sums) exact.area += sum.area, exact.energy += sum.energy;
    const double error = std::max(std::abs(all.area - exact.area) / free.area,
                                  std::abs(all.energy - exact.energy) / free.energy);
    CHECK(error < kMissed);
    worst = std::max(worst, error);
    // one by one, but for what is too small for the lines
    const auto by_area = [](const auto& x, const auto& y) { return x.area > y.area; };
    const auto small = [&](const auto& x) { return x.area < kMissed * free.area; };
    pieces.erase(std::remove_if(pieces.begin(), pieces.end(), small), pieces.end());
    sums.erase(std::remove_if(sums.begin(), sums.end(), small), sums.end());
    std::sort(pieces.begin(), pieces.end(), by_area), std::sort(sums.begin(), sums.end(), by_area);
    ++met_with[std::min(pieces.size(), met_with.size() - 1)];
    bool same = pieces.size() == sums.size();
    for (size_t k = 0; same && k < pieces.size(); ++k)
      same = std::abs(pieces[k].area - sums[k].area) < kMissed * free.area &&
             std::abs(pieces[k].energy - sums[k].energy) < kMissed * free.energy;
    other += !same;
    for (const PartsMet& met : pieces) {
      const Pull cells = by_cells(a, b, met), closures = by_closures(met);
      CHECK(norm(closures.force - cells.force) < 1e-12 * met.area);
      if (!met.beyond) CHECK(std::abs(closures.moment - cells.moment) < 1e-12 * met.area);
    }
  }
  CHECK(met_with[2] > 30);
  CHECK(met_with[3] > 10);
  CHECK(other <= kPairs / 50);  // a neck or a gap that is narrower than the lines lie apart
  MESSAGE("largest error ", worst, "; pairs of other pieces ", other, ", with two and three pieces ",
          met_with[2], " ", met_with[3]);
}

TEST_CASE("overlap: what rounding leaves beside a tie is no patch") {
  // tied left of the origin, where the floor ends; the block's left wall is tied to a third one: nothing is left to bear
  const double c = 1e-3;
  Body block{{{-1, -c}, {0, -c}, {1, -c}, {1, 1}, {-1, 1}}, {}};
  block.role = {SideRole::kTiedHere, SideRole::kOut, SideRole::kOut, SideRole::kOut, SideRole::kTied};
  const Body under{box_polygon(-2, -1, 0, 0), {}};
  for (int k = 0; k < 1000; ++k) {
    CAPTURE(k);
    const PartsMet met = meet(moved(block, {}, 0.0063 * k), moved(under, {}, 0.0063 * k));
    CHECK((met.kind != PartsMet::kOverlap || met.length() > kRounding));
  }
}

TEST_CASE("overlap: a side cut in two, with a cut between, bears as the whole one") {
  const double c = 0.01;
  const Body under = floor_body();
  const PartsMet whole = meet(block_over(1, c), under);
  Body left{box_polygon(-0.5, 0, 0.2, 1), {0.1, -c}}, right{box_polygon(0.2, 0, 0.5, 1), {0.1, -c}};
  left.role = {SideRole::kOut, SideRole::kCut, SideRole::kOut, SideRole::kOut};
  right.role = {SideRole::kOut, SideRole::kOut, SideRole::kOut, SideRole::kCut};
  const PartsMet one = meet(left, under), two = meet(right, under);
  const Vec2 sum = one.force * one.normal + two.force * two.normal;
  CHECK(off(sum, whole.force * whole.normal) < 1e-13);  // 1e-16 m of c, and some
  CHECK(off(one.energy + two.energy, whole.energy) < 1e-13);
}

}  // namespace test_overlap
