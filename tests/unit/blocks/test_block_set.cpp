#include "talus/blocks/block_set.h"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>
#include "support/relative.h"

namespace test_block_set {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kDensity = 2700, kYoung = 50e9;

Model model_of(const std::vector<Polygon>& polygons, double poisson = 0.25, Plane plane = Plane::kStrain) {
  Model model;
  model.plane = plane;
  model.thickness = 0.7;
  model.materials = {{"rock", kDensity, kYoung, poisson}};
  for (size_t i = 0; i < polygons.size(); ++i) {
    BlockInput b;
    b.name = "b" + std::to_string(i);
    b.polygon = polygons[i];
    b.material = 0;
    model.blocks.push_back(b);
  }
  return model;
}

BlockSet blocks_of(const Model& model) {
  Findings findings("case.toml", "");
  const Layout layout = make_layout(model, findings);
  INFO(findings.render());
  REQUIRE_FALSE(findings.has_errors());
  return build_blocks(model, layout);
}

Polygon square(double b) { return {{0, 0}, {b, 0}, {b, b}, {0, b}}; }

// Strain energy per volume of Hooke's law in three dimensions; the strain across the plane is zero in plane
// strain, and such that the stress across it vanishes in plane stress.
double hooke_energy(const Eigen::Vector4d& h, double poisson, Plane plane) {
  const double mu = kYoung / (2 * (1 + poisson));
  const double lambda = kYoung * poisson / ((1 + poisson) * (1 - 2 * poisson));
  const double exx = h[0], eyy = h[3], exy = 0.5 * (h[1] + h[2]);
  const double ezz = plane == Plane::kStrain ? 0 : -lambda * (exx + eyy) / (lambda + 2 * mu);
  const double sum = exx + eyy + ezz;
  return 0.5 * lambda * sum * sum + mu * (exx * exx + eyy * eyy + ezz * ezz + 2 * exy * exy);
}

// Largest squared frequency of the free triangle in its four modes of deformation (H = xx, xy, yx, yy).
double largest_eigenvalue(const Polygon& t, double thickness, double poisson, Plane plane) {
  const Vec2 c = (t[0] + t[1] + t[2]) / 3;
  const double area = 0.5 * std::abs(cross(t[1] - t[0], t[2] - t[0]));
  Mat2 second;  // exact for a triangle: area / 12 times the sum over corners about the centroid
  for (const Vec2 p : t) second += (area / 12) * outer(p - c, p - c);
  Eigen::Matrix4d mass = Eigen::Matrix4d::Zero(), stiffness;
  for (const int row : {0, 2}) {
    mass(row, row) = second.xx, mass(row, row + 1) = second.xy;
    mass(row + 1, row) = second.xy, mass(row + 1, row + 1) = second.yy;
  }
  mass *= kDensity * thickness;
  // differences of a quadratic form are exact at any step
  const auto energy = [&](const Eigen::Vector4d& h) {
    return area * thickness * hooke_energy(h, poisson, plane);
  };
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const Eigen::Vector4d ei = Eigen::Vector4d::Unit(i), ej = Eigen::Vector4d::Unit(j);
      stiffness(i, j) = energy(ei + ej) - energy(ei) - energy(ej);
    }
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix4d> solver(stiffness, mass);
  return solver.eigenvalues().maxCoeff();
}

std::array<double, 2> eigenvalues(const Mat2& m) {
  const double mean = 0.5 * (m.xx + m.yy), radius = std::hypot(0.5 * (m.xx - m.yy), m.xy);
  return {det(m) / (mean + radius), mean + radius};
}

}  // namespace

TEST_CASE("mass properties of a block") {
  Model model = model_of({{{1, 1}, {3, 1}, {3, 2}, {1, 2}}});
  const double mass = kDensity * 2 * 0.7;
  SUBCASE("consistent") {
    const BlockSet b = blocks_of(model);
    CHECK(b.count == 1);
    CHECK(b.volume[0] == relative(1.4, 1e-14));
    CHECK(b.mass[0] == relative(mass, 1e-14));
    CHECK(b.inertia[0].xx == relative(mass * 4 / 12, 1e-14));
    CHECK(b.inertia[0].yy == relative(mass * 1 / 12, 1e-14));
    CHECK(b.polar_inertia[0] == relative(mass * 5 / 12, 1e-14));
    CHECK(b.size[0] == relative(std::sqrt(2.0), 1e-14));
    CHECK(b.corner({0, 2}) == Vec2{1, 0.5});
    CHECK(b.vertex_count(0) == 4);
  }
  SUBCASE("lumped at the corners: three times the inertia, of deformable blocks only") {
    model.inertia = Inertia::kLumped;
    CHECK(blocks_of(model).inertia[0].xx == relative(mass, 1e-14));
    model.blocks[0].kind = BlockKind::kRigid;
    CHECK(blocks_of(model).inertia[0].xx == relative(mass / 3, 1e-14));
  }
}

TEST_CASE("stable_step_of is 2 / sqrt(largest eigenvalue) for triangles of any shape and material") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1), angle(0, 6.3);
  int slivers = 0;
  for (const Plane plane : {Plane::kStrain, Plane::kStress}) {
    for (const double poisson : {-0.5, -0.2, 0.0, 0.15, 0.3, 0.45}) {
      for (int n = 0; n < 40; ++n) {
        // aspect ratio down to 1 : 1000, turned anyhow
        const double thin = std::pow(10, -3 * unit(random)), c = angle(random);
        const Mat2 turn{std::cos(c), -std::sin(c), std::sin(c), std::cos(c)};
        Polygon t{{0, 0}, {1 + unit(random), 0.3 * thin * unit(random)}, {2 * unit(random) - 0.5, thin}};
        for (Vec2& p : t) p = turn * p;
        slivers += thin < 0.01;
        const Model model = model_of({t}, poisson, plane);
        const double expected = 2 / std::sqrt(largest_eigenvalue(t, model.thickness, poisson, plane));
        CAPTURE(poisson);
        CAPTURE(thin);
        // the thin moment is a difference of numbers 1e6 times larger: 1e-16 x 1e6, with some room
        CHECK(stable_step_of(blocks_of(model), 0) == relative(expected, 1e-9));
      }
    }
  }
  CHECK(slivers > 50);
}

TEST_CASE("stable step of a square in plane strain follows the closed formula") {
  for (const double poisson : {0.0, 0.25, 0.45}) {
    for (const double b : {0.01, 1.0, 300.0}) {
      const double lambda = kYoung * poisson / ((1 + poisson) * (1 - 2 * poisson)),
                   mu = kYoung / (2 * (1 + poisson));
      const double omega = std::sqrt(24 * (lambda + mu) / kDensity) / b;
      // a dozen roundings of 1e-16
      CHECK(stable_step_of(blocks_of(model_of({square(b)}, poisson)), 0) == relative(2 / omega, 1e-13));
    }
  }
}

TEST_CASE("stable step of a plate a million times longer than thick") {
  // without lateral strain the thickness oscillates at sqrt(12 E / rho) / h
  const double h = 1e-6, omega = std::sqrt(12 * kYoung / kDensity) / h;
  const BlockSet blocks = blocks_of(model_of({{{0, 0}, {1, 0}, {1, h}, {0, h}}}, 0));
  CHECK(stable_step_of(blocks, 0) == relative(2 / omega, 1e-12));  // few roundings of 1e-16
}

TEST_CASE("stable_step is the smallest over deformable blocks and names the block") {
  Model model = model_of({square(1), {{2, 0}, {2.5, 0}, {2.5, 0.5}, {2, 0.5}}, {{3, 0}, {3.1, 0}, {3, 0.1}}});
  model.blocks[2].kind = BlockKind::kRigid;
  BlockSet blocks = blocks_of(model);
  CHECK(stable_step(blocks).block == 1);
  CHECK(stable_step(blocks).dt == stable_step_of(blocks, 1));
  CHECK(std::isinf(stable_step_of(blocks, 2)));
  for (BlockInput& b : model.blocks) b.kind = BlockKind::kFixed;
  blocks = blocks_of(model);
  CHECK(stable_step(blocks).block == -1);
  CHECK(std::isinf(stable_step(blocks).dt));
}

TEST_CASE("the moment clamp raises what is needed and nothing else") {
  for (const double poisson : {-0.4, 0.0, 0.3}) {
    Model model = model_of({square(1),                                     // fits already
                            {{2, 0}, {3, 0}, {3, 0.05}, {2, 0.05}},        // a plate: its thin direction
                            {{4, 0}, {5, 1}, {5, 1.002}},                  // a sliver askew
                            {{6, 0}, {6.01, 0}, {6.01, 0.01}, {6, 0.01}},  // small in both directions
                            {{7, 0}, {7.02, 0}, {7, 0.001}},               // small and thin
                            {{8, 0}, {8.01, 0}, {8, 0.01}}},               // small but rigid
                           poisson);
    model.blocks[5].kind = BlockKind::kRigid;
    const BlockSet before = blocks_of(model);
    BlockSet after = before;
    const double dt = 0.6 * stable_step_of(before, 0);
    clamp_moments(after, dt);

    CHECK(after.clamped == 4);
    CHECK(after.mass == before.mass);
    CHECK(after.volume == before.volume);
    double largest = 1;
    for (int i = 0; i < before.count; ++i) {
      CAPTURE(i);
      const Mat2 s = after.inertia[i], s0 = before.inertia[i];
      const auto e = eigenvalues(s), e0 = eigenvalues(s0);
      // eigenvalues of slivers carry round-off 1e-16 times their ratio, here up to 1e6
      CHECK(e[0] >= e0[0] * (1 - 1e-9));
      CHECK(e[1] >= e0[1] * (1 - 1e-12));
      const Mat2 raised = s - s0;  // in no direction less than before
      CHECK(raised.xx >= -1e-12 * e0[1]);
      CHECK(raised.yy >= -1e-12 * e0[1]);
      CHECK(det(raised) >= -1e-12 * e[1] * e0[1]);
      largest = std::max(largest, e[0] / e0[0]);
      CHECK(after.polar_inertia[i] == relative(trace(s), 1e-14));
      if (i == 0 || i == 5) {
        CHECK((s.xx == s0.xx && s.xy == s0.xy && s.yx == s0.yx && s.yy == s0.yy));
        continue;
      }
      CHECK(stable_step_of(before, i) < dt);
      CHECK(stable_step_of(after, i) ==
            relative(dt / 0.9, 1e-9));                    // a tenth of room  // fits, and no more than that
      if (i <= 2) CHECK(e[1] == relative(e0[1], 1e-12));  // the long direction fits already
      // the principal directions stay: old and new commute
      const Mat2 left = s * s0 - s0 * s;
      CHECK(std::abs(left.xy) <= 1e-12 * e[1] * e0[1]);
      const Mat2 one = after.inertia_inverse[i] * s - kIdentity;
      CHECK(std::sqrt(contract(one, one)) <= 1e-9);
    }
    CHECK(after.largest_clamp == relative(largest, 1e-8));
  }
}

TEST_CASE("the moment clamp leaves blocks that fit alone, and a second call changes nothing") {
  BlockSet blocks = blocks_of(model_of({square(1), {{2, 0}, {3, 0}, {3, 0.05}, {2, 0.05}}}));
  clamp_moments(blocks, 0.9 * stable_step(blocks).dt);
  CHECK(blocks.clamped == 0);
  CHECK(blocks.largest_clamp == 1);
  const double dt = 2 * stable_step(blocks).dt;
  clamp_moments(blocks, dt);
  const Mat2 once = blocks.inertia[1];
  clamp_moments(blocks, dt * (1 - 1e-9));
  CHECK(blocks.clamped == 1);
  CHECK(blocks.inertia[1].yy == once.yy);
}

}  // namespace test_block_set
