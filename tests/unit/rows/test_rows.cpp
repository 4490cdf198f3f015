#include "talus/rows/mobility.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>
#include "support/relative.h"

namespace test_rows {

using namespace talus;
using namespace talus::test;

namespace {

struct Random {
  std::mt19937 engine{11};
  double number(double limit = 1) { return std::uniform_real_distribution<double>(-limit, limit)(engine); }
  Vec2 vector(double limit = 1) { return {number(limit), number(limit)}; }
  Mat2 matrix() { return {number(), number(), number(), number()}; }
};

// One block of each kind, with the same oblique inertia.
BlockSet one_of_each() {
  Model model;
  model.thickness = 0.8;
  model.materials = {{"rock", 3, 5, 0.25}};
  for (const BlockKind kind :
       {BlockKind::kDeformable, BlockKind::kRigid, BlockKind::kFixed, BlockKind::kDriven}) {
    BlockInput b;
    const double x = 4.0 * static_cast<double>(model.blocks.size());
    b.name = "b" + std::to_string(model.blocks.size());
    b.polygon = {{x, 0}, {x + 3, 0.5}, {x + 2, 2}, {x + 0.3, 0.8}};
    b.material = 0;
    b.kind = kind;
    model.blocks.push_back(b);
  }
  Findings findings("case.toml", "");
  const Layout layout = make_layout(model, findings);
  REQUIRE_FALSE(findings.has_errors());
  return build_blocks(model, layout);
}

PointRows point_at(Vec2 arm_a, Vec2 arm_b, double angle) {
  PointRows p;
  p.block_a = 0, p.block_b = 1;
  p.arm_a = arm_a, p.arm_b = arm_b;
  p.normal = {std::cos(angle), std::sin(angle)};
  return p;
}

BlockRate random_rate(const BlockSet& blocks, size_t i, Random& random) {
  const Mat2 g = blocks.kind[i] == BlockKind::kDeformable ? random.matrix() : spin_matrix(random.number());
  return {random.vector(), g};
}

// Numbers of order 1, a dozen roundings of 1e-16 each.
constexpr double kRound = 1e-14;

}  // namespace

TEST_CASE("influence is the velocity change that an impulse makes through accelerate") {
  const BlockSet blocks = one_of_each();
  Random random;
  for (const size_t i : {0u, 1u}) {
    for (int n = 0; n < 100; ++n) {
      const Vec2 at = random.vector(2), from = random.vector(2);
      const PointRows p = point_at(from, from, random.number(3));
      const Impulse impulse{random.number(), random.number()};
      const Vec2 force = impulse[0] * p.normal + impulse[1] * turn_right(p.normal);
      for (const double sign : {1.0, -1.0}) {
        const BlockRate change = accelerate(blocks, i, impulse_on(p, impulse, sign));
        CHECK(norm(velocity_at(change, at) -
                   sign * (influence(mobility_of(blocks, i, 1), at, from) * force)) <= kRound);
      }
    }
  }
}

TEST_CASE("influence there and back is the same (Maxwell and Betti)") {
  const BlockSet blocks = one_of_each();
  Random random;
  for (const size_t i : {0u, 1u}) {
    const Vec2 x = random.vector(2), y = random.vector(2);
    CHECK(size_of(influence(mobility_of(blocks, i, 1), x, y) -
                  transpose(influence(mobility_of(blocks, i, 1), y, x))) <= kRound);
  }
}

TEST_CASE("influence of a rigid block by hand") {
  const BlockSet blocks = one_of_each();
  // a unit impulse along y at arm (2, 0) spins the block by 2 / J; the arm (0, 1) then moves by -2 / J along
  // x
  const double m = blocks.mass[1], j = blocks.polar_inertia[1];
  const Vec2 v = influence(mobility_of(blocks, 1, 1), {0, 1}, {2, 0}) * Vec2{0, 1};
  CHECK(v.x == relative(-2 / j, 1e-14));
  CHECK(v.y == relative(1 / m, 1e-14));
}

TEST_CASE("momentum is the inverse of accelerate") {
  const BlockSet blocks = one_of_each();
  Random random;
  for (const size_t i : {0u, 1u}) {
    for (int n = 0; n < 50; ++n) {
      const BlockRate rate = random_rate(blocks, i, random);
      const BlockRate back = accelerate(blocks, i, momentum(blocks, i, rate));
      CHECK(norm(back.a - rate.a) <= kRound);
      CHECK(size_of(back.G - rate.G) <=
            10 * kRound);  // through the inertia, whose eigenvalues differ tenfold
    }
  }
}

TEST_CASE("kinetic energy: work of momentum at the rate") {
  const BlockSet blocks = one_of_each();
  Random random;
  for (const size_t i : {0u, 1u}) {
    const BlockRate u = random_rate(blocks, i, random), v = random_rate(blocks, i, random);
    CHECK(work(momentum(blocks, i, u), v) == relative(work(momentum(blocks, i, v), u), 1e-13));
    CHECK(work(momentum(blocks, i, u), u) > 0);
  }
  // m v^2 + J w^2 of a rigid block
  const double w = 0.7;
  const BlockRate rate{{3, 4}, spin_matrix(w)};
  CHECK(work(momentum(blocks, 1, rate), rate) ==
        relative(25 * blocks.mass[1] + w * w * blocks.polar_inertia[1], 1e-14));
}

TEST_CASE("an impulse works on both blocks as much as on the relative velocity") {
  const BlockSet blocks = one_of_each();
  Random random;
  for (int n = 0; n < 100; ++n) {
    const std::vector<BlockRate> rate{random_rate(blocks, 0, random), random_rate(blocks, 1, random)};
    PointRows p = point_at(random.vector(), random.vector(), random.number(3));
    const Impulse impulse{random.number(), random.number()};
    auto u = relative_velocity(p, rate);
    const double on_a = work(impulse_on(p, impulse, 1), rate[0]),
                 on_b = work(impulse_on(p, impulse, -1), rate[1]);
    CHECK(std::abs(impulse[0] * u[0] + impulse[1] * u[1] - on_a - on_b) <= kRound);
    p.block_b = -1;  // the ground stands still
    u = relative_velocity(p, rate);
    CHECK(std::abs(impulse[0] * u[0] + impulse[1] * u[1] - on_a) <= kRound);
    p.block_a = -1;
    u = relative_velocity(p, rate);
    CHECK(u[0] == 0);
    CHECK(u[1] == 0);
  }
}

TEST_CASE("the tangent is the normal turned clockwise") {
  const PointRows p = point_at({0, 0}, {0, 0}, 1.5707963267948966);  // normal along y
  const auto u = relative_velocity(p, {{{2, 3}, {}}, {{0.5, 1}, {}}});
  CHECK(u[0] == relative(2, 1e-14));
  CHECK(u[1] == relative(1.5, 1e-14));
}

TEST_CASE("blocks with prescribed motion take no impulse") {
  const BlockSet blocks = one_of_each();
  for (const size_t i : {2u, 3u}) {
    CHECK(size_of(influence(mobility_of(blocks, i, 1), {1, 2}, {3, 4})) == 0);
    CHECK(norm(accelerate(blocks, i, {{1, 2}, {1, 2, 3, 4}}).a) == 0);
    CHECK(size_of(accelerate(blocks, i, {{1, 2}, {1, 2, 3, 4}}).G) == 0);
    CHECK(norm(momentum(blocks, i, {{1, 2}, {1, 2, 3, 4}}).f) == 0);
  }
}

TEST_CASE("bounds_of follows the cone and never crosses") {
  PointRows p;
  p.lower = -2;
  CHECK(bounds_of(p, 1, 100).upper == std::numeric_limits<double>::infinity());
  CHECK(bounds_of(p, 1, -1e9).lower == -std::numeric_limits<double>::infinity());
  p.friction = 0.5, p.cohesion = 1;
  CHECK(bounds_of(p, 0, 100).lower == -2);
  CHECK(bounds_of(p, 1, 4).upper == 3);
  CHECK(bounds_of(p, 1, 4).lower == -3);
  CHECK(bounds_of(p, 1, -1).upper == 0.5);  // pulled: the cohesion is left in part
  CHECK(bounds_of(p, 1, -4).upper == 0);
  CHECK(bounds_of(p, 1, -4).lower == 0);
}

TEST_CASE("row set: whose rows they are, also of families without any") {
  RowSet rows;
  const auto fill = [&rows](int bonds, int contacts, int ties) {
    rows.restart();
    const auto add = [&rows](Family family, int count) {
      const size_t first = rows.add_more(family, count);
      for (int i = 0; i < count; ++i) rows.owner[first + i] = {family, i};
    };
    add(Family::kFace, bonds), add(Family::kContact, contacts), add(Family::kSupport, 0);
    for (int i = 0; i < ties; ++i) rows.add({}, {}, {Family::kTie, i});
    rows.finish();
  };
  const auto holds = [&rows](Family family, size_t begin, size_t end) {
    const RowRange range = rows.range(family);
    CHECK(range.begin == begin);
    CHECK(range.size() == end - begin);
    for (size_t r = begin; r < end; ++r) {
      CHECK(rows.owner[r].family == family);
      CHECK(rows.owner[r].at() == r - begin);
    }
  };
  fill(2, 3, 2);
  CHECK(rows.owner.size() == 7);
  holds(Family::kFace, 0, 2), holds(Family::kContact, 2, 5), holds(Family::kTie, 5, 7);
  holds(Family::kSupport, 5, 5), holds(Family::kBolt, 7, 7);
  fill(0, 1, 1);  // the same set, written over
  CHECK(rows.owner.size() == 2);
  holds(Family::kFace, 0, 0), holds(Family::kContact, 0, 1), holds(Family::kTie, 1, 2);
}

TEST_CASE("families: one line of the table each, in their order") {
  for (size_t i = 0; i < kFamilies.size(); ++i) {
    CHECK(kFamilies[i].family == kAllFamilies[i]);
    CHECK(entry(kAllFamilies[i]).name == std::string(kFamilies[i].name));
  }
}

}  // namespace test_rows
