// How blocks answer to impulses, elasticity explicit and implicit.

#include "talus/rows/mobility.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/relative.h"
#include "talus/rows/rows.h"

namespace test_mobility {

using namespace talus;
using namespace talus::test;

namespace {

struct Dice {
  std::mt19937 engine{21};
  double number(double limit = 1) { return std::uniform_real_distribution<double>(-limit, limit)(engine); }
  Vec2 vector(double limit = 1) { return {number(limit), number(limit)}; }
  Mat2 matrix() { return {number(), number(), number(), number()}; }
  Vec2 direction() {
    const double angle = number(3.1415926535);
    return {std::cos(angle), std::sin(angle)};
  }
};

// One crooked block of each kind, of order 1 in all units.
BlockSet one_of_each() {
  Model model;
  model.thickness = 0.8;
  model.materials = {{"rock", 3, 5, 0.25}};
  Layout layout;
  layout.groups = {"blocks"};
  for (const BlockKind kind :
       {BlockKind::kDeformable, BlockKind::kRigid, BlockKind::kFixed, BlockKind::kDriven}) {
    BlockShape shape;
    shape.name = "b" + std::to_string(layout.blocks.size());
    shape.polygon = {{0, 0}, {3, 0.5}, {2, 2}, {0.3, 0.8}};
    shape.kind = kind;
    layout.blocks.push_back(shape);
  }
  return build_blocks(model, layout);
}

constexpr size_t kDeformable = 0, kRigid = 1;

// Numbers of order 1 to 10 and a few dozen roundings of 1e-16 each; moments of inertia that differ tenfold.
constexpr double kRound = 1e-13;

// Derivative of the first Piola-Kirchhoff stress at F = R in direction G, by central differences. The stress
// is smooth: their error is that of round-off, 1e-15 / 1e-5, and of the third derivative, 1e-10.
Mat2 stress_rate(const BlockSet& blocks, Vec2 r, const Mat2& G) {
  constexpr double kBy = 1e-5;
  const Mat2 at = rotation(r) - kIdentity;
  const PlaneModuli& c = blocks.moduli[kDeformable];
  return (0.5 / kBy) * (piola_stress(c, at + kBy * G) - piola_stress(c, at - kBy * G));
}
constexpr double kDifferences = 1e-9;

// Explicit and implicit mobilities of the blocks that move.
std::vector<std::pair<size_t, Mobility>> all_sorts(Dice& dice, const BlockSet& blocks) {
  std::vector<std::pair<size_t, Mobility>> list;
  for (const size_t i : {kDeformable, kRigid}) {
    list.emplace_back(i, mobility_of(blocks, i, 0.7));
    for (const double time2 : {0.0, 0.1, 1.0, 100.0})
      list.emplace_back(i, mobility_implicit(blocks, i, dice.direction(), 0.7, time2));
  }
  return list;
}

}  // namespace

TEST_CASE("the mobility is the inverse of the mass matrix") {
  const BlockSet blocks = one_of_each();
  Dice dice;
  for (const double share : {1.0, 0.6}) {
    for (const size_t i : {kDeformable, kRigid}) {
      const Mobility m = mobility_of(blocks, i, share);
      CHECK(m.moves());
      for (int n = 0; n < 50; ++n) {
        const BlockRate rate{dice.vector(), i == kRigid ? spin_matrix(dice.number()) : dice.matrix()};
        const BlockRate back = accelerate(m, momentum(blocks, i, rate));
        CHECK(norm(back.a - share * rate.a) <= kRound);
        CHECK(size_of(back.G - share * rate.G) <= kRound);
      }
    }
  }
  // and the same as the one written without axes
  const Mobility m = mobility_of(blocks, kDeformable, 1);
  const BlockForce impulse{dice.vector(), dice.matrix()};
  CHECK(size_of(accelerate(m, impulse).G - accelerate(blocks, kDeformable, impulse).G) <= kRound);
}

TEST_CASE("blocks whose motion is prescribed do not answer") {
  const BlockSet blocks = one_of_each();
  const auto all = mobilities(blocks, 1);
  REQUIRE(all.size() == 4);
  CHECK(all[kDeformable].moves());
  CHECK(all[kRigid].moves());
  for (const size_t i : {2u, 3u})
    for (const Mobility& m : {all[i], mobility_implicit(blocks, i, {0, 1}, 1, 1)}) {
      CHECK_FALSE(m.moves());
      const BlockRate answer = accelerate(m, {{1, 2}, {3, 4, 5, 6}});
      CHECK(norm(answer.a) == 0);
      CHECK(size_of(answer.G) == 0);
      CHECK(size_of(influence(m, {1, 2}, {3, 4})) == 0);
    }
}

TEST_CASE("the implicit mobility solves (M / share + time2 K) G = Q") {
  const BlockSet blocks = one_of_each();
  Dice dice;
  for (const double share : {1.0, 0.6})
    for (const double time2 : {0.0, 0.01, 1.0, 30.0})
      for (int n = 0; n < 20; ++n) {
        CAPTURE(share);
        CAPTURE(time2);
        const Vec2 r = dice.direction();
        const Mobility m = mobility_implicit(blocks, kDeformable, r, share, time2);
        const BlockForce q{dice.vector(), dice.matrix()};
        const BlockRate rate = accelerate(m, q);
        CHECK(norm(blocks.mass[kDeformable] * rate.a - share * q.f) <= kRound);
        const Mat2 elastic = (time2 * blocks.volume[kDeformable]) * stress_rate(blocks, r, rate.G);
        const Mat2 left = (1 / share) * momentum(blocks, kDeformable, rate).Q + elastic;
        // the stress is formed from numbers of order 1, then multiplied
        CHECK(size_of(left - q.Q) <= kRound + kDifferences * time2 * blocks.volume[kDeformable]);
      }
}

TEST_CASE("a rigid block has no elasticity to be made implicit") {
  const BlockSet blocks = one_of_each();
  Dice dice;
  const Mobility with = mobility_implicit(blocks, kRigid, dice.direction(), 0.8, 3),
                 without = mobility_of(blocks, kRigid, 0.8);
  const BlockForce impulse{dice.vector(), dice.matrix()};
  const BlockRate x = accelerate(with, impulse), y = accelerate(without, impulse);
  CHECK(x.a == y.a);
  CHECK(size_of(x.G - y.G) == 0);
  CHECK(x.G.xy == -x.G.yx);
  CHECK(x.G.xx == 0);
}

TEST_CASE("a spin meets no elastic resistance, a stretch does") {
  const BlockSet blocks = one_of_each();
  Dice dice;
  const Vec2 r = dice.direction();
  const Mobility m = mobility_implicit(blocks, kDeformable, r, 1, 1e6),
                 none = mobility_of(blocks, kDeformable, 1);
  // momentum of a turning block, given as impulse, turns it
  const BlockForce turning = momentum(blocks, kDeformable, {{}, spin_matrix(1) * rotation(r)});
  CHECK(size_of(accelerate(m, turning).G - spin_matrix(1) * rotation(r)) <= 1e-8);  // digits of 1e6 lost
  const BlockForce stretching{{}, rotation(r)};
  CHECK(size_of(accelerate(m, stretching).G) <= 1e-5 * size_of(accelerate(none, stretching).G));
}

TEST_CASE("influence is the velocity that an impulse makes, there and back the same, never against it") {
  const BlockSet blocks = one_of_each();
  Dice dice;
  for (const auto& [i, m] : all_sorts(dice, blocks))
    for (int n = 0; n < 50; ++n) {
      const Vec2 at = dice.vector(2), from = dice.vector(2), p = dice.vector();
      const Mat2 w = influence(m, at, from);
      CHECK(norm(velocity_at(accelerate(m, {p, outer(p, from)}), at) - w * p) <= kRound);
      CHECK(size_of(w - transpose(influence(m, from, at))) <= kRound);
      CHECK(dot(p, influence(m, from, from) * p) >= m.mass * dot(p, p) * (1 - kRound));
    }
}

}  // namespace test_mobility
