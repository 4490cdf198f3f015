// Steps with block-implicit elasticity: period and decay, spin, energy ledger, order against explicit steps.

#include "talus/step/step.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "support/block_scene.h"
#include "support/relative.h"
#include "support/run_case.h"

namespace test_step {

using namespace talus;
using namespace talus::test;

namespace {

Scene scene_of(const std::vector<ScenePart>& parts, double alpha) {
  Model model = jointed_rock();
  model.contact.alpha = alpha;
  return block_scene(std::move(model), parts);
}

// A free block of 1 m2.
Scene free_square(double alpha) { return scene_of({{box_polygon(0, 0, 1, 1)}}, alpha); }

class March {
 public:
  March(const Scene& scene, bool implicit) : scene_(scene), state(start_state(scene)) {
    settings_.implicit = implicit;
    settings_.tolerance = 1e-10;
  }
  void step(double dt) {
    report = kick(scene_, settings_, dt, work, state);
    drift(scene_, state.time + dt, work, state, report);
  }

 private:
  const Scene& scene_;
  StepSettings settings_;

 public:
  State state;
  StepWork work;
  StepReport report;
};

// A way in which a square stretches on its own, and its frequency [rad/s]: V (stiffness) / (moment).
struct Mode {
  const char* name;
  Mat2 shape;
  double stiffness;  // [Pa] stress per strain along `shape`
};

std::vector<Mode> modes_of(const PlaneModuli& c) {
  return {{"swelling", {1, 0, 0, 1}, c.c11 + c.c12},
          {"pure shear along the axes", {1, 0, 0, -1}, c.c11 - c.c12},
          {"pure shear along the diagonals", {0, 1, 1, 0}, 2 * c.c33}};
}

double frequency(const BlockSet& blocks, const Mode& mode) {
  return std::sqrt(blocks.volume[0] * mode.stiffness / blocks.inertia[0].xx);
}

// Angular momentum about the centroid at the middle of a step: integral of F X x G X.
double spin_momentum(const BlockSet& blocks, const Mat2& strain_part, const Mat2& G) {
  const Mat2 m = G * blocks.inertia[0] * transpose(kIdentity + strain_part);
  return m.yx - m.xy;
}

}  // namespace

TEST_CASE("a block that stretches swings with the period of the trapezoidal rule and keeps its amplitude") {
  const Scene scene = free_square(0);
  const double dt = 5 * stable_step_of(scene.blocks, 0);
  for (const Mode& mode : modes_of(scene.blocks.moduli[0])) {
    CAPTURE(mode.name);
    const double omega = frequency(scene.blocks, mode), turn = 2 * std::atan(0.5 * omega * dt);
    const double speed = 1e-6 / dt;  // a strain of a millionth
    March march(scene, true);
    march.state.rate[0].G = speed * mode.shape;
    const double amplitude = dt * speed / std::sin(turn);
    double worst = 0;
    for (int n = 1; n <= 1000; ++n) {
      march.step(dt);
      const Mat2 error = march.state.strain_part[0] - (amplitude * std::sin(n * turn)) * mode.shape;
      worst = std::max(worst, std::sqrt(contract(error, error)));
    }
    // round-off of 1e-16 in each step is kept and turned for a thousand steps: up to 1e-13 in each, of the
    // phase as well, which is 1e-10
    CHECK(worst <= 1e-9 * amplitude);
  }
}

TEST_CASE("alpha takes energy out of it as its difference equation says") {
  constexpr double kAlpha = 0.2;
  const Scene scene = free_square(kAlpha);
  const double r = (1 - kAlpha) / (1 + kAlpha), k = 4 / ((1 + kAlpha) * (1 + kAlpha));
  for (const double steps_of_limit : {0.2, 1.0, 5.0}) {
    const double dt = steps_of_limit * stable_step_of(scene.blocks, 0);
    for (const Mode& mode : modes_of(scene.blocks.moduli[0])) {
      CAPTURE(mode.name);
      CAPTURE(steps_of_limit);
      // (1 + h/k) x+ - (2 + (1 + r2) h/k - h) x + (1 + r2 h/k) x- = 0 with h = (omega dt)^2, the first kick
      // over half a step
      const double omega = frequency(scene.blocks, mode), h = omega * dt * omega * dt;
      const double a = 1 + h / k, b = 2 + (1 + r * r) * h / k - h, c = 1 + r * r * h / k;
      const double speed = 1e-6 / dt;
      double before = 0, now = 1e-6 * (1 + r * r * h / (2 * k)) / (1 + h / (2 * k));
      March march(scene, true);
      march.state.rate[0].G = speed * mode.shape;
      double worst = 0;
      for (int n = 1; n <= 200; ++n) {
        march.step(dt);
        const Mat2 error = march.state.strain_part[0] - now * mode.shape;
        worst = std::max(worst, std::sqrt(contract(error, error)));
        const double next = (b * now - c * before) / a;
        before = now, now = next;
      }
      CHECK(worst <= 1e-9 * 1e-6);  // as above
      // the root of c / a is what a step leaves of the amplitude
      CHECK(c < a);
      // one of the last two is not near a zero of the swing
      const double left = std::max(std::abs(before), std::abs(now)) / 1e-6;
      CHECK(left <= 10 * std::pow(c / a, 100));
      if (steps_of_limit >= 1) CHECK(left < 1e-3);
    }
  }
}

TEST_CASE("a spinning block with implicit elasticity keeps its angular momentum") {
  for (const double alpha : {0.0, 0.2}) {
    CAPTURE(alpha);
    const Scene scene = free_square(alpha);
    constexpr double kSpin = 10, kTurnOfStep = 1e-2;
    constexpr double dt = kTurnOfStep / kSpin;
    REQUIRE(dt > 2 * stable_step_of(scene.blocks, 0));
    March march(scene, true);
    march.state.rate[0].G = spin_matrix(kSpin);
    const double start = kSpin * scene.blocks.polar_inertia[0];
    const int steps = static_cast<int>(std::lround(2 * std::numbers::pi / kTurnOfStep));
    double worst = 0, angle = 0;
    for (int n = 0; n < steps; ++n) {
      const Mat2 before = march.state.strain_part[0];
      march.step(dt);
      const Mat2 middle = 0.5 * (before + march.state.strain_part[0]);
      worst =
          std::max(worst, std::abs(spin_momentum(scene.blocks, middle, march.state.rate[0].G) / start - 1));
      const Mat2 F = kIdentity + march.state.strain_part[0];
      angle = std::atan2(F.yx - F.xy, F.xx + F.yy);
      CHECK(std::abs(det(F) - 1) < 1e-2);
    }
    // measured: 2e-15, the round-off of 628 steps
    CHECK(worst <= 1e-12);
    // steps turn by atan(w dt): w dt is too much by (w dt)^3 / 3 in each
    const double left = 2 * std::numbers::pi - steps * kTurnOfStep;
    CHECK(std::abs(angle + left) <= 2 * steps * std::pow(kTurnOfStep, 3) / 3);
  }
}

TEST_CASE("the energy ledger of implicit steps closes where motion is linear, steps that change included") {
  for (const double alpha : {0.0, 0.2}) {
    CAPTURE(alpha);
    // a swinging block and one that stands on it fall flat on a floor and bounce
    Scene scene = scene_of({{box_polygon(-5, -1, 5, 0), BlockKind::kFixed},
                            {box_polygon(0, 0.001, 1, 1.001)},
                            {box_polygon(0, 1.002, 1, 1.5)}},
                           alpha);
    scene.model.gravity = {0, -9.81};
    March march(scene, true);
    march.state.rate[1] = {{0, -0.5}, {0.3, 0, 0, -0.2}};
    march.state.rate[2] = {{0, -0.5}, {-0.1, 0, 0, 0.4}};
    march.state.energy_start = kinetic_energy(scene.blocks, march.state.rate);
    const double stable = stable_step(scene.blocks).dt;
    double worst = 0, implicit = 0;
    int closed = 0;
    for (int n = 0; n < 300; ++n) {
      march.step((n % 50 < 25 ? 1.5 : 3) * stable);
      const Energy& e = march.report.energy;
      worst = std::max(worst, std::abs(e.left_over) / e.largest());
      closed += march.report.closed > 0;
      implicit = std::max(implicit, std::abs(e.work[Cause::kImplicit]) / e.largest());
    }
    CHECK(worst <= 1e-9);  // sums of some thousand terms of the size of the largest
    CHECK(closed > 20);
    CHECK(implicit > 1e-3);
  }
}

TEST_CASE("what the ledger leaves over in turning motion is no more than in explicit steps") {
  // at a slant on the floor, with friction; the strain energy is not quadratic in the turning block
  const auto left_over = [](bool implicit, double share) {
    Scene scene = scene_of({{box_polygon(-5, -1, 5, 0), BlockKind::kFixed},
                            {box_polygon(0, 0.001, 1, 1.001)},
                            {box_polygon(0.1, 1.002, 0.9, 1.5)},
                            {box_polygon(0.2, 1.502, 1.1, 2.4), BlockKind::kRigid}},
                           0);
    scene.model.gravity = {3, -9.81};
    March march(scene, implicit);
    march.state.rate[2] = {{0.2, -0.1}, {0.1, 0.2, -0.2, -0.1}};
    march.state.rate[3] = {{0.1, -0.2}, spin_matrix(0.5)};
    march.state.energy_start = kinetic_energy(scene.blocks, march.state.rate);
    const double dt = share * stable_step(scene.blocks).dt;
    double worst = 0;
    while (march.state.time < 0.03) {
      march.step(dt);
      worst = std::max(worst, std::abs(march.report.energy.left_over) / march.report.energy.largest());
    }
    return worst;
  };
  const double explicit_one = left_over(false, 0.5), implicit_one = left_over(true, 0.5),
               implicit_long = left_over(true, 3);
  // measured: 1.2e-6, 1.1e-6, and 6e-5 at six times the step
  CHECK(implicit_one <= 2 * explicit_one);
  CHECK(implicit_long <= 2 * 36 * explicit_one);  // of second order
}

TEST_CASE("explicit and implicit runs come to each other with the square of the step") {
  const Scene scene = free_square(0);
  // a part of a swing, with all modes in it and a turn
  const double stable = stable_step_of(scene.blocks, 0), end = 3 * stable;
  const auto run = [&](bool implicit, int steps) {
    March march(scene, implicit);
    march.state.rate[0].G = (1e-2 / stable) * Mat2{0.7, 1.2, -0.6, 0.4};
    for (int n = 0; n < steps; ++n) march.step(end / steps);
    return march.state.strain_part[0];
  };
  std::vector<double> apart;
  for (const int steps : {16, 32, 64, 128}) {
    const Mat2 d = run(true, steps) - run(false, steps);
    apart.push_back(std::sqrt(contract(d, d)));
  }
  CHECK(apart[0] < 1e-2);
  for (size_t i = 1; i < apart.size(); ++i) {
    const double order = std::log2(apart[i - 1] / apart[i]);
    CAPTURE(i);
    // terms of the next order, a share of (omega dt)^2 = 0.14 at the coarsest
    CHECK(order == approx(2).epsilon(0.1 / std::pow(4, double(i - 1)) + 0.01));
  }
}

TEST_CASE("rigid blocks and blocks in free fall are not touched by implicit elasticity") {
  const auto fall = [](bool implicit, BlockKind kind) {
    Scene scene = scene_of({{box_polygon(0, 0, 1, 1), kind}}, 0.2);
    scene.model.gravity = {1, -9.81};
    March march(scene, implicit);
    march.state.rate[0] = {{2, 3}, kind == BlockKind::kRigid ? spin_matrix(4) : Mat2{}};
    for (int n = 0; n < 100; ++n) march.step(1e-3);
    return march.state;
  };
  for (const BlockKind kind : {BlockKind::kDeformable, BlockKind::kRigid}) {
    const State x = fall(true, kind), y = fall(false, kind);
    CHECK(x.displacement[0] == y.displacement[0]);
    CHECK(x.angle[0] == y.angle[0]);
    CHECK(x.rate[0].a == y.rate[0].a);
    CHECK(x.rate[0].G.yx == y.rate[0].G.yx);
  }
}

TEST_CASE(
    "a block that flies ten times its radius in a step ends the run, one that is held against as much does not") {
  Scene scene = scene_of({{box_polygon(0, 0, 1, 1), BlockKind::kRigid}}, 0.2);
  March march(scene, true);
  march.state.rate[0].a = {0, 1500};
  CHECK_THROWS_WITH_AS(march.step(5e-3), doctest::Contains("times its own radius in one step"),
                       NumericalError);

  // 14 MPa on a stone of 0.3 m: free of what it lies on it would fly 6.5 m in 20 ms, and what is wanted is its closure
  const CaseResult r = run_case(R"~(talus = 1
[material.rock]
density = 2850
young = "5 GPa"
poisson = 0.25
[joint.soft]
friction_angle = "35 deg"
normal_stiffness = "20 GPa/m"
shear_stiffness = "20 GPa/m"
[contact]
joint = "soft"
[[block]]
name = "floor"
polygon = [[-1, -1], [1, -1], [1, 0], [-1, 0]]
material = "rock"
kind = "fixed"
[[block]]
name = "stone"
polygon = [[0, 0], [0.3, 0], [0.3, 0.3], [0, 0.3]]
material = "rock"
kind = "rigid"
[[load]]
name = "press"
edge = [[0, 0.3], [0.3, 0.3]]
pressure = "14 MPa"
[[monitor]]
name = "stone"
point = [0.15, 0.15]
[[stage]]
name = "rest"
kind = "static"
duration = "10 s"
time_step = "20 ms"
elasticity = "implicit"
unbalanced = 1e-10
)~");
  // the ends of the side bear less: p L = kn c (L - c/2) (theory 3.2)
  const double closed = 0.3 - std::sqrt(0.3 * 0.3 - 2 * 0.3 * 14e6 / 20e9);
  CHECK(r.column("stone.displacement_y [m]").back() == approx(-closed).epsilon(1e-6));
}

}  // namespace test_step
