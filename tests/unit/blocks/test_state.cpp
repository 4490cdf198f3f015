#include "talus/blocks/state.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include "support/relative.h"

namespace test_state {

using namespace talus;
using namespace talus::test;

namespace {

const PlaneModuli kModuli{3.0, 1.2, 0.9};  // c11 - c12 = 2 c33: isotropic

Mat2 rotation(double angle) { return {std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)}; }

// Strains and rotations of some ten percent.
Mat2 random_finite(std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-0.4, 0.4);
  return {entry(random), entry(random), entry(random), entry(random)};
}

}  // namespace

TEST_CASE("piola_stress is the derivative of strain_energy_density") {
  std::mt19937 random(3);
  for (int n = 0; n < 200; ++n) {
    const Mat2 h = random_finite(random), p = piola_stress(kModuli, h);
    const double step = 1e-5;  // third derivatives of order 1: error 1e-10; round-off 1e-16 / step = 1e-11
    const auto slope = [&](const Mat2& d) {
      return (strain_energy_density(kModuli, h + step * d) - strain_energy_density(kModuli, h - step * d)) /
             (2 * step);
    };
    const Mat2 difference{slope({1, 0, 0, 0}), slope({0, 1, 0, 0}), slope({0, 0, 1, 0}), slope({0, 0, 0, 1})};
    CHECK(size_of(p - difference) <= 2e-9);
  }
}

TEST_CASE("rotation turns the stress with it and leaves the energy") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> angle(-3.2, 3.2);
  for (int n = 0; n < 200; ++n) {
    const Mat2 h = random_finite(random), f = kIdentity + h, r = rotation(angle(random));
    const Mat2 turned = r * f - kIdentity;
    // a dozen roundings of numbers of order 1 to 3
    CHECK(size_of(piola_stress(kModuli, turned) - r * piola_stress(kModuli, h)) <= 2e-14);
    CHECK(strain_energy_density(kModuli, turned) == relative(strain_energy_density(kModuli, h), 1e-12));
  }
}

TEST_CASE("pure rotation makes no stress") {
  const double half_turn = 3.141592653589793;
  for (const double angle :
       {1e-12, 1e-6, 0.01, 1.0, -1.5, 2.5, -3.0, half_turn - 1e-5, 1e-8 - half_turn, half_turn}) {
    CAPTURE(angle);
    // strains of round-off 1e-16, also next to half a turn
    CHECK(size_of(piola_stress(kModuli, rotation_minus_identity(angle))) <= 1e-14);
  }
  CHECK(size_of(piola_stress(kModuli, {-2, 0, 0, -2})) == 0);  // half a turn, exactly
  // a rotation small enough that only its square could show
  CHECK(size_of(piola_stress(kModuli, rotation_minus_identity(1e-9))) <= 1e-24);
}

TEST_CASE("the stress exerts no torque: P F^T is symmetric") {
  std::mt19937 random(5);
  for (int n = 0; n < 200; ++n) {
    const Mat2 h = random_finite(random);
    const Mat2 tau = piola_stress(kModuli, h) * transpose(kIdentity + h);
    CHECK(std::abs(tau.xy - tau.yx) <= 1e-14);  // a few roundings of stresses of order 1
  }
}

TEST_CASE("strains far below the round-off of 1 keep their digits") {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> entry(-1, 1);
  for (int n = 0; n < 100; ++n) {
    const Mat2 g{entry(random), entry(random), entry(random), entry(random)};
    const double e = 1e-14;
    const Mat2 linear{kModuli.c11 * g.xx + kModuli.c12 * g.yy, kModuli.c33 * (g.xy + g.yx),
                      kModuli.c33 * (g.xy + g.yx), kModuli.c12 * g.xx + kModuli.c11 * g.yy};
    // what is not linear is 1e-14 smaller; 1e-10 is what the results promise
    CHECK(size_of((1 / e) * piola_stress(kModuli, e * g) - linear) <= 1e-10 * size_of(linear));
    CHECK(strain_energy_density(kModuli, e * g) / (e * e) == relative(0.5 * contract(linear, g), 1e-10));
  }
}

TEST_CASE("stress is linear in a uniaxial stretch of any size") {
  for (const double e : {-0.5, -1e-3, 1e-9, 0.2, 1.0, 5.0}) {
    CAPTURE(e);
    const Mat2 p = piola_stress(kModuli, {e, 0, 0, 0});
    CHECK(p.xx == relative(kModuli.c11 * e, 1e-14));
    CHECK(p.yy == relative(kModuli.c12 * e, 1e-14));
    CHECK(p.xy == 0);
    CHECK(p.yx == 0);
  }
}

TEST_CASE("cauchy_stress is P F^T / det F, and none in a block that does not deform") {
  BlockSet blocks;
  blocks.count = 2;
  blocks.kind = {BlockKind::kDeformable, BlockKind::kRigid};
  blocks.moduli = {kModuli, kModuli};
  State state;
  const double e = 0.25;
  state.strain_part = {{e, 0, 0, 0}, {e, 0, 0, 0}};
  const Mat2 s = cauchy_stress(blocks, state, 0);
  CHECK(s.xx == relative(kModuli.c11 * e, 1e-14));
  CHECK(s.yy == relative(kModuli.c12 * e / (1 + e), 1e-14));
  CHECK(size_of(cauchy_stress(blocks, state, 1)) == 0);
}

TEST_CASE("rotation_minus_identity has full accuracy at both ends") {
  const Mat2 tiny = rotation_minus_identity(1e-9);
  CHECK(tiny.xx == relative(-5e-19, 1e-14));  // the next term is 1e-18 smaller
  CHECK(tiny.yy == tiny.xx);
  CHECK(tiny.yx == relative(1e-9, 1e-15));
  CHECK(tiny.xy == -tiny.yx);
  const Mat2 large = rotation_minus_identity(3);
  CHECK(large.xx == relative(std::cos(3.0) - 1, 1e-15));
  CHECK(large.yx == relative(std::sin(3.0), 1e-15));
  const Vec2 x = Vec2{1, 0} + rotation_minus_identity(0.3) * Vec2{1, 0};
  CHECK(x.y > 0);  // counter-clockwise
}

TEST_CASE("initial_state starts at rest position with the velocities of blocks that move freely") {
  Model model;
  model.materials = {{"rock", 2700, 50e9, 0.25}};
  for (const BlockKind kind : {BlockKind::kDeformable, BlockKind::kRigid, BlockKind::kFixed}) {
    BlockInput b;
    const double x = 2.0 * static_cast<double>(model.blocks.size());
    b.name = "b" + std::to_string(model.blocks.size());
    b.polygon = {{x, 0}, {x + 1, 0}, {x + 1, 1}, {x, 1}};
    b.material = 0;
    b.kind = kind;
    b.velocity = {3, 4};
    b.spin = 5;
    model.blocks.push_back(b);
  }
  Findings findings("case.toml", "");
  const Layout layout = make_layout(model, findings);
  const BlockSet blocks = build_blocks(model, layout);
  const State state = initial_state(blocks, layout);
  for (const size_t i : {0u, 1u}) {
    CHECK(state.rate[i].a == Vec2{3, 4});
    // a corner one metre to the right moves up by the spin
    CHECK(velocity_at(state.rate[i], {1, 0}) == Vec2{3, 9});
    CHECK(offset_now(state, i, {0.5, 0.5}) == Vec2{0.5, 0.5});
  }
  CHECK(state.rate[2].a == Vec2{0, 0});
  CHECK(size_of(state.rate[2].G) == 0);
}

}  // namespace test_state
