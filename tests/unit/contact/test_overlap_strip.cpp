// Overlaps that are strips, in closed form, against the general way by cells; and that where they are looked for first
// makes no difference.

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "talus/base/random.h"
#include "talus/contact/overlap.h"

namespace test_overlap_strip {

using namespace talus;

namespace {

struct Body {
  std::vector<Vec2> corner, along;
  PartNow now() const { return {corner, along, {}}; }
};

Body body_of(std::vector<Vec2> corner) {
  Body out{std::move(corner), {}};
  const size_t n = out.corner.size();
  for (size_t k = 0; k < n; ++k) {
    const Vec2 side = out.corner[(k + 1) % n] - out.corner[k];
    out.along.push_back(side / norm(side));
  }
  return out;
}

// With a corner in the middle of each side: no strip any more, and the same shape.
Body halved(const Body& body) {
  std::vector<Vec2> corner;
  const size_t n = body.corner.size();
  for (size_t k = 0; k < n; ++k)
    corner.push_back(body.corner[k]), corner.push_back(0.5 * (body.corner[k] + body.corner[(k + 1) % n]));
  return body_of(corner);
}

Vec2 turned(Vec2 x, double angle) {
  return {std::cos(angle) * x.x - std::sin(angle) * x.y, std::sin(angle) * x.x + std::cos(angle) * x.y};
}

// A block with a face along x from `from` to `to`, on its upper or lower side, and ends that lean.
Body block(Random& random, double from, double to, bool above) {
  const double lean[2]{0.3 * (random.uniform() - 0.5), 0.3 * (random.uniform() - 0.5)};
  if (above) return body_of({{from, 0}, {to, 0}, {to + lean[0], 0.6}, {from + lean[1], 0.6}});
  return body_of({{from + lean[1], -0.6}, {to + lean[0], -0.6}, {to, 0}, {from, 0}});
}

struct Two {
  Body a, b;
  Vec2 shift;
};

// A block on another one: closed by 1e-8 to 1e-2, turned by less than that, ends beside each other by 1e-12 to 0.3 either
// way, the frame turned anyhow.
Two random_two(Random& random) {
  const auto spread = [&](double least, double most) {
    return least * std::exp(random.uniform() * std::log(most / least));
  };
  const double closed = spread(1e-8, 1e-2), tilt = 0.5 * closed * (2 * random.uniform() - 1);
  const auto off = [&] { return (random.uniform() < 0.5 ? -1 : 1) * spread(1e-12, 0.3); };
  Two two{block(random, -0.5, 0.5, true), block(random, -0.5 + off(), 0.5 + off(), false), {}};
  if (random.uniform() < 0.5) std::swap(two.a, two.b);
  const bool a_above = two.a.corner[0].y == 0;
  const double angle = 6.3 * random.uniform();
  for (Vec2& x : two.a.corner) x = turned(x, tilt + angle);
  for (Vec2& x : two.b.corner) x = turned(x, angle);
  two.a = body_of(two.a.corner), two.b = body_of(two.b.corner);
  two.shift = turned({0.1 * random.uniform(), a_above ? closed : -closed}, angle);
  return two;
}

PartsMet measured(const Two& two, int face) {
  PartsMeeting meeting;
  PartsMet met = meeting.look(two.a.now(), two.b.now(), two.shift, 0.02, 1e-14, face);
  const bool overlaps = met.kind == PartsMet::kOverlap;
  const bool any = overlaps && meeting.measure_overlap();
  met = meeting.met();
  if (overlaps && !any) met.kind = PartsMet::kFar;
  return met;
}

}  // namespace

TEST_CASE("strips have the force, energy and chord of the general way") {
  Random random(71);
  int strips = 0, all = 0;
  for (int i = 0; i < 4000; ++i) {
    const Two two = random_two(random);
    const PartsMet strip = measured(two, 0), cells = measured({halved(two.a), halved(two.b), two.shift}, 0);
    REQUIRE(strip.kind == PartsMet::kOverlap);
    REQUIRE(cells.kind == PartsMet::kOverlap);
    CHECK(cells.way == 0);
    ++all, strips += strip.way != 0;
    // areas, not coordinates, are what is left of round-off: 1e-16 m of a depth of 1e-8 m
    CAPTURE(i);
    CHECK(std::abs(strip.area - cells.area) <= 1e-14);
    CHECK(std::abs(strip.force - cells.force) <= 1e-14);
    CHECK(std::abs(strip.energy - cells.energy) <= 1e-14 * (strip.closure[0] + strip.closure[1]));
    CHECK(norm(strip.normal - cells.normal) <= 1e-13 * (1 + 0.1 / strip.force));
    CHECK(norm(strip.begin - cells.begin) <= 1e-13 + 1e-6 * strip.force);
    CHECK(norm(strip.end - cells.end) <= 1e-13 + 1e-6 * strip.force);
    for (int end = 0; end < 2; ++end) CHECK(std::abs(strip.closure[end] - cells.closure[end]) <= 1e-13);
  }
  // two of three in four, the rest crossed or with ends that cross
  CHECK(strips > 0.7 * all);
}

TEST_CASE("where a strip is looked for first makes no difference") {
  Random random(72);
  for (int i = 0; i < 2000; ++i) {
    const Two two = random_two(random);
    const PartsMet plain = measured(two, 0);
    for (int face = -1; face <= 5; ++face) {
      const PartsMet met = measured(two, face);
      CAPTURE(i);
      CAPTURE(face);
      CHECK(met.kind == plain.kind);
      CHECK(met.way == plain.way);
      CHECK(met.force == plain.force);
      CHECK(met.energy == plain.energy);
      CHECK(met.normal == plain.normal);
      CHECK(met.begin == plain.begin);
      CHECK(met.closure[0] == plain.closure[0]);
      CHECK(met.closure[1] == plain.closure[1]);
    }
  }
}

}  // namespace test_overlap_strip
