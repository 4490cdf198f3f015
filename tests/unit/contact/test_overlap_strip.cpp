// Overlaps that are strips, in closed form, against the general way by cells; and that where they are looked for first
// makes no difference.

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "support/convex_parts.h"
#include "talus/base/random.h"

namespace test_overlap_strip {

using namespace talus;
using namespace talus::test;

namespace {

// With a corner in the middle of each side: no strip any more, and the same shape.
Body halved(const Body& body) {
  Body out;
  out.origin = body.origin;
  const size_t n = body.corner.size();
  for (size_t k = 0; k < n; ++k)
    out.corner.push_back(body.corner[k]),
        out.corner.push_back(0.5 * (body.corner[k] + body.corner[(k + 1) % n]));
  for (const SideRole role : body.role) out.role.push_back(role), out.role.push_back(role);
  return out;
}

// A block with a face along x from `from` to `to`, on its upper or lower side, and ends that lean.
Body block(Random& random, double from, double to, bool above) {
  const double lean[2]{0.3 * (random.uniform() - 0.5), 0.3 * (random.uniform() - 0.5)};
  if (above) return {{{from, 0}, {to, 0}, {to + lean[0], 0.6}, {from + lean[1], 0.6}}, {}};
  return {{{from + lean[1], -0.6}, {to + lean[0], -0.6}, {to, 0}, {from, 0}}, {}};
}

struct Two {
  Body a, b;
};

// A block on another one: closed by 1e-8 to 1e-2, turned by less than that, ends beside each other by 1e-12 to 0.3 either
// way, the frame turned anyhow.
Two random_two(Random& random) {
  const auto spread = [&](double least, double most) {
    return least * std::exp(random.uniform() * std::log(most / least));
  };
  const double closed = spread(1e-8, 1e-2), tilt = 0.5 * closed * (2 * random.uniform() - 1);
  const auto off = [&] { return (random.uniform() < 0.5 ? -1 : 1) * spread(1e-12, 0.3); };
  Body above = moved(block(random, -0.5, 0.5, true), {}, tilt),
       below = block(random, -0.5 + off(), 0.5 + off(), false);
  above.origin = {0.1 * random.uniform(), -closed};
  const double angle = 6.3 * random.uniform();
  above = moved(above, {}, angle), below = moved(below, {}, angle);
  return random.uniform() < 0.5 ? Two{above, below} : Two{below, above};
}

PartsMet measured(const Two& two, int face) {
  PartsMeeting meeting;
  const Seen one(two.a), other(two.b);
  PartsMet met =
      meeting.look(one.now(), other.now(), two.b.origin - two.a.origin, kMargin, kRounding, {face, true});
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
  double area = 0, energy = 0, turn = 0, place = 0, closure = 0;
  for (int i = 0; i < 4000; ++i) {
    const Two two = random_two(random);
    const PartsMet strip = measured(two, 0), cells = measured({halved(two.a), halved(two.b)}, 0);
    REQUIRE(strip.kind == PartsMet::kOverlap);
    REQUIRE(cells.kind == PartsMet::kOverlap);
    CHECK(cells.way == 0);
    ++all, strips += strip.way != 0;
    area = std::max({area, std::abs(strip.area - cells.area), std::abs(strip.force - cells.force)});
    energy = std::max(energy,
                      std::abs(strip.energy - cells.energy) / std::abs(strip.closure[0] + strip.closure[1]));
    turn = std::max(turn, norm(strip.normal - cells.normal));
    place = std::max({place, norm(strip.begin - cells.begin), norm(strip.end - cells.end)});
    for (int end = 0; end < 2; ++end)
      closure = std::max(closure, std::abs(strip.closure[end] - cells.closure[end]));
  }
  // blocks of 1 m are rounded to 1e-16 m, and so are the ends and the heights of an overlap
  constexpr double kRounded = 1e-14;
  CHECK(area < kRounded);
  CHECK(energy < kRounded);
  CHECK(closure < kRounded);
  CHECK(turn < kRounded);
  CHECK(place < kRounded);
  MESSAGE("largest differences: area ", area, ", energy ", energy, ", normal ", turn, ", ends ", place,
          ", closure ", closure, "; strips ", strips, " of ", all);
  // the others are those whose ends cross within the overlap
  CHECK(strips > 0.99 * all);
}

TEST_CASE(
    "strips as short as they are deep: where ends cross within the overlap, or a cut does, it is none") {
  Random random(73);
  int strips = 0, cut_strips = 0;
  for (int i = 0; i < 40000; ++i) {
    const double width = std::exp(random.uniform() * std::log(1e-3)), closed = 1.2 * width * random.uniform();
    const auto leaning = [&](bool above) {
      const auto off = [&](double most) { return most * width * (2 * random.uniform() - 1); };
      const double left = -0.5 * width + off(0.45), right = 0.5 * width + off(0.45),
                   high = (above ? 2 : -2) * width, out_left = off(3), out_right = off(3);
      Body body{{{left, 0}, {right, 0}, {right + out_right, high}, {left - out_left, high}}, {}};
      if (random.uniform() < 0.5)
        body.role = {SideRole::kOut, SideRole::kCut, SideRole::kOut, SideRole::kOut};
      if (!above) {
        std::swap(body.corner[0], body.corner[1]), std::swap(body.corner[2], body.corner[3]);
        if (!body.role.empty()) std::swap(body.role[1], body.role[3]);
      }
      return body;
    };
    Body above = moved(leaning(true), {}, 0.3 * (random.uniform() - 0.5)), below = leaning(false);
    above.origin = {0, -closed};
    const auto convex = [](const Body& body) {
      for (size_t k = 0; k < 4; ++k)
        if (cross(body.at(k + 1) - body.at(k), body.at(k + 2) - body.at(k + 1)) <= 0) return false;
      return true;
    };
    if (!convex(above) || !convex(below)) continue;
    const PartsMet strip = measured({above, below}, i % 4 + 1),
                   cells = measured({halved(above), halved(below)}, 0);
    if (strip.way == 0) continue;
    ++strips, cut_strips += !above.role.empty() || !below.role.empty();
    CAPTURE(i);
    REQUIRE(cells.kind == PartsMet::kOverlap);
    // bodies of 1 m are rounded to 1e-16 m: so is each length of an overlap, and its area by as much of its width
    const double rounded = 1e-14 * width;
    CHECK(std::abs(strip.area - cells.area) < rounded);
    CHECK(norm(strip.force * strip.normal - cells.force * cells.normal) < rounded);
    CHECK(std::abs(strip.energy - cells.energy) < rounded * width);
  }
  MESSAGE("strips ", strips, ", beside cuts ", cut_strips);
  CHECK(strips > 2000);
  CHECK(cut_strips > 1000);
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
