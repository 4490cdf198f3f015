// A step of conventional DDA against what its formulas say by hand: one mass on one spring, a spinning block, a block
// that sinks into its springs, a push from rest, friction.

#include "talus/penalty/penalty_step.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "support/model_text.h"
#include "support/relative.h"
#include "talus/cut/check_places.h"
#include "talus/model/read_model.h"

namespace test_penalty_step {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kHead = R"(talus = 1
[material.m]
density = 2000
young = 1e9
poisson = 0.2
[[stage]]
name = "go"
kind = "dynamic"
duration = 1
)";

Scene scene_of(const std::string& text) {
  Findings findings("m.toml", text);
  Model model = read_model("m.toml", text, {}, findings);
  Layout layout = checked_layout(model, findings);
  findings.throw_if_errors();
  return build_scene(std::move(model), std::move(layout));
}

// A run of equal steps.
struct Course {
  Scene scene;
  StepWork work;
  State state;
  PenaltySettings settings;
  PenaltySteps steps;
  PenaltyReport last;

  Course(const std::string& text, const PenaltySettings& how)
      : scene(scene_of(text)), state(start_state(scene)), settings(how), steps(scene, work) {
    begin_penalty(scene, settings.scheme, state);
  }
  void step(double dt) { last = steps.step(settings, state.time + dt, true, state); }
  Vec2 moved(size_t block) const { return state.displacement[block]; }
};

const Polygon kUnit{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

PenaltySettings with_springs(double normal, double shear) {
  PenaltySettings s;
  s.stiffness = {normal, shear};
  s.support_stiffness = normal;
  return s;
}

}  // namespace

// d = (2 v0 dt - w^2 u0) / (2 + w^2), v1 dt = 2 d - v0 dt with w = omega dt: the determinant of that map is 2 / (2 + w^2).
TEST_CASE("penalty: one mass on one spring loses what the spectral radius of Newmark 1/2, 1 says") {
  const double mass = 2000, stiffness = 5e6, omega = std::sqrt(stiffness / mass);
  for (const double share : {0.01, 0.05, 0.2, 1.0}) {  // of the period
    const double dt = share * 2 * std::numbers::pi / omega, w = omega * dt;
    Course c(kHead + block_text("b", kUnit, "rigid", "velocity = [1, 0]") +
                 "[[support]]\nname = \"spring\"\npoint = [0.5, 0.5]\ny = \"free\"\n",
             with_springs(stiffness, stiffness));
    std::array<double, 5> u{};
    for (double& place : u) c.step(dt), place = c.moved(0).x;
    // u[n+2] = trace u[n+1] - det u[n], twice
    const double below = u[1] * u[1] - u[0] * u[2];
    const double det = (u[2] * u[2] - u[1] * u[3]) / below;
    CHECK(std::sqrt(det) == approx(std::sqrt(2 / (2 + w * w))).epsilon(1e-6));
  }
}

TEST_CASE("penalty: the mean acceleration keeps the amplitude") {
  const double stiffness = 5e6, omega = std::sqrt(stiffness / 2000);
  PenaltySettings how = with_springs(stiffness, stiffness);
  how.scheme = {0.25, 0.5};
  Course c(kHead + block_text("b", kUnit, "rigid", "velocity = [1, 0]") +
               "[[support]]\nname = \"spring\"\npoint = [0.5, 0.5]\ny = \"free\"\n",
           how);
  std::array<double, 5> u{};
  for (double& place : u) c.step(0.3 / omega), place = c.moved(0).x;
  CHECK((u[2] * u[2] - u[1] * u[3]) / (u[1] * u[1] - u[0] * u[2]) == approx(1).epsilon(1e-6));
}

TEST_CASE(
    "penalty: a spinning free block grows by sqrt(1 + (omega dt)^2) a step, and not with its rotation exact") {
  const double omega = 3, dt = 0.02;
  const std::string model = kHead + block_text("b", kUnit, "deformable", fmt::format("spin = {}", omega));
  for (const bool exact : {false, true}) {
    PenaltySettings how;
    how.exact_rotation = exact;
    Course c(model, how);
    for (int n = 1; n <= 50; ++n) {
      c.step(dt);
      const double growth = std::sqrt(det(kIdentity + c.state.strain_part[0]));
      const double expected = exact ? 1 : std::pow(1 + omega * omega * dt * dt, 0.5 * n);
      CHECK(growth == approx(expected).epsilon(1e-6));
    }
  }
}

TEST_CASE("penalty: a rigid block keeps its spin, and a load beside its middle turns it as by hand") {
  PenaltySettings how;
  Course spin(kHead + block_text("b", kUnit, "rigid", "spin = 3"), how);
  for (int n = 0; n < 100; ++n) spin.step(0.01);
  CHECK(spin.state.rate[0].G.yx == approx(3).epsilon(1e-9));
  CHECK(spin.state.angle[0] == approx(3).epsilon(1e-9));
  // 100 N upwards at its right side: 50 N m on 2000 kg / 6 m2; the force keeps its direction, the arm turns by little
  Course load(
      kHead + block_text("b", kUnit, "rigid") + "[[load]]\nname = \"l\"\npoint = [1, 0.5]\nforce_y = 100\n",
      how);
  for (int n = 0; n < 100; ++n) load.step(0.01);
  CHECK(load.state.angle[0] == approx(0.5 * 50 / (2000.0 / 6)).epsilon(2e-3));
  CHECK(load.moved(0).y == approx(0.5 * 100 / 2000).epsilon(1e-9));
}

TEST_CASE("penalty: by the mean acceleration a fall is exact from the first step on") {
  PenaltySettings how;
  how.scheme = {0.25, 0.5};
  Course c("talus = 1\n[model]\ngravity = [0, -10]\n" + kHead.substr(kHead.find('\n') + 1) +
               block_text("b", kUnit, "deformable"),
           how);
  for (int n = 0; n < 100; ++n) c.step(0.01);
  CHECK(c.moved(0).y == approx(-5).epsilon(1e-9));
  CHECK(c.state.rate[0].a.y == approx(-10).epsilon(1e-9));
}

TEST_CASE("penalty: a block sinks by its weight over the stiffness of the springs under it") {
  const double stiffness = 2e7, weight = 2000 * 9.81;
  PenaltySettings how = with_springs(stiffness, stiffness);
  how.dynamic_factor = 0;
  Course c("talus = 1\n[model]\ngravity = [0, -9.81]\n" + kHead.substr(kHead.find('\n') + 1) +
               "[joint.j]\nfriction_angle = \"30 deg\"\n[contact]\njoint = \"j\"\n" +
               block_text("floor", {{-1, -1}, {2, -1}, {2, 0}, {-1, 0}}, "fixed") +
               block_text("b", kUnit, "rigid"),
           how);
  for (int n = 0; n < 200; ++n) c.step(0.02);
  CHECK(c.moved(1).y == approx(-weight / (2 * stiffness)).epsilon(1e-6));  // two corners
  double carried = 0;
  for (const Contact& contact : c.state.contacts) carried += contact.force[0];
  CHECK(carried == approx(weight).epsilon(1e-6));
  CHECK(std::abs(c.moved(1).x) < 1e-12);
}

TEST_CASE("penalty: a free block pushed from rest goes as far as by hand, whatever the step") {
  for (const double dt : {0.1, 0.001}) {
    Course c("talus = 1\n[model]\ngravity = [11.111111111111111, 0]\n" + kHead.substr(kHead.find('\n') + 1) +
                 block_text("b", kUnit, "deformable"),
             {});
    const int n = static_cast<int>(std::lround(1 / dt));
    for (int k = 0; k < n; ++k) c.step(dt);
    CHECK(c.moved(0).x == approx(5.5555556).epsilon(1e-7));
    CHECK(c.state.rate[0].a.x == approx(11.111111).epsilon(1e-7));
    const StepReport r = c.steps.report(c.state);
    CHECK(std::abs(r.energy.left_over) < 1e-9 * r.energy.kinetic);
  }
}

// a = g (sin - tan(phi) cos) below; the springs take a moment to fill, which the start of the slide feels.
TEST_CASE("penalty: a block on an incline stays below its friction angle and slides above it") {
  for (const double friction : {40.0, 20.0}) {
    const double slope = 30 * std::numbers::pi / 180, g = 9.81;
    PenaltySettings how = with_springs(1e9, 1e9);
    Course c(
        fmt::format("talus = 1\n[model]\ngravity = [{}, {}]\n", g * std::sin(slope), -g * std::cos(slope)) +
            kHead.substr(kHead.find('\n') + 1) +
            fmt::format("[joint.j]\nfriction_angle = \"{} deg\"\n[contact]\njoint = \"j\"\n", friction) +
            block_text("floor", {{-1, -1}, {20, -1}, {20, 0}, {-1, 0}}, "fixed") +
            block_text("b", kUnit, "rigid"),
        how);
    const int n = 500;
    const double dt = 0.002, t = n * dt;
    for (int k = 0; k < n; ++k) c.step(dt);
    const double a = g * (std::sin(slope) - std::tan(friction * std::numbers::pi / 180) * std::cos(slope));
    if (a < 0)
      CHECK(std::abs(c.moved(1).x) < 1e-4);
    else
      CHECK(c.moved(1).x == approx(0.5 * a * t * t).epsilon(0.02));
  }
}

TEST_CASE("penalty: a step that open-close iteration cannot end is cut, and said when it cannot be cut") {
  PenaltySettings how = with_springs(1e9, 1e9);
  how.most_iterations = 1, how.most_cuts = 3;
  Course c("talus = 1\n[model]\ngravity = [0, -9.81]\n" + kHead.substr(kHead.find('\n') + 1) +
               "[joint.j]\nfriction_angle = \"30 deg\"\n[contact]\njoint = \"j\"\n" +
               block_text("floor", {{-1, -1}, {2, -1}, {2, 0}, {-1, 0}}, "fixed") +
               block_text("b", kUnit, "rigid"),
           how);
  CHECK_THROWS_WITH_AS(c.step(0.05), doctest::Contains("open-close iteration does not end at t = 0 s"),
                       NumericalError);
  CHECK(c.state.time == 0);
  CHECK(c.moved(1).y == 0);
}

}  // namespace test_penalty_step
