// Conventional DDA (formulation = "penalty") on models whose answers are known, run as any model is: sliding, friction
// at rest, a column under its weight, a bar that is struck; what it refuses; and the same bits for any number of threads.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "support/model_text.h"
#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/base/text_file.h"

namespace test_conventional {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kExample = std::string(TALUS_SOURCE_DIR) + "/examples/conventional/conventional.toml";

double last(const CaseResult& r, const std::string& column) { return r.column(column).back(); }

// What is wrong with a model, or "".
std::string refused(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    Findings findings("m.toml", text);
    prepare_run("m.toml", text, overrides, findings);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("conventional DDA: the example slides as by hand, closer with stiffer springs and shorter steps") {
  const std::string text = read_text_file(kExample);
  const double g = 9.81, angle = 30 * std::numbers::pi / 180;
  const double a = g * (std::sin(angle) - std::tan(20 * std::numbers::pi / 180) * std::cos(angle));
  const CaseResult r = run_case(text);
  check_close("conventional DDA: slide in 2 s [m]", last(r, "block.displacement_x [m]"), 2 * a, 1e-4, 1e-5);
  check_close("conventional DDA: velocity after 2 s [m/s]", last(r, "block.velocity_x [m/s]"), 2 * a, 1e-4,
              1e-5);
  check_close("conventional DDA: acceleration [m/s2]", last(r, "block.acceleration_x [m/s2]"), a, 1e-3, 1e-4);
  check_below("conventional DDA: slide, energy left over / largest term", r.run.closure(), 1e-4, 1e-5);
  // by forces as unknowns, with the same file
  const CaseResult forces = run_case(text, {"model.formulation=\"contact_forces\""});
  check_close("conventional DDA: slide beside contact forces [m]", last(r, "block.displacement_x [m]"),
              last(forces, "block.displacement_x [m]"), 1e-4, 1e-5);
}

TEST_CASE("conventional DDA: below its friction angle the block stands") {
  const CaseResult r = run_case(read_text_file(kExample), {"joint.floor.friction_angle=\"31 deg\""});
  // friction goes by pressure that the springs only take up in the first steps: a start that no step shortens away
  const std::vector<double>& x = r.column("block.displacement_x [m]");
  check_below("conventional DDA: slip at the start of what stands [m]", std::abs(x.back()), 1e-4, 1e-5);
  check_below("conventional DDA: creep in the second half [m]", std::abs(x.back() - x[x.size() / 2]), 1e-9,
              1e-12);
}

// Compression under its own weight: strain at height y is rho g (h - y) / E' where the sides are free.
TEST_CASE("conventional DDA: a glued column settles under its weight") {
  const std::string text = R"(talus = 1
[model]
formulation = "penalty"
gravity = [0, -10]
plane = "stress"
[penalty]
normal_stiffness = "1e13 Pa"
[material.m]
density = 2500
young = 1e9
poisson = 0
[joint.glue]
kind = "bonded"
[[grid]]
name = "column"
min = [0, 0]
max = [1, 8]
cells = [1, 8]
material = "m"
joint = "glue"
[[support]]
name = "foot"
edge = [[0, 0], [1, 0]]
x = "free"
y = "fixed"
[[stage]]
name = "rest"
kind = "static"
duration = "4 s"
time_step = "10 ms"
[[monitor]]
name = "top"
point = [0.5, 8]
)";
  const CaseResult r = run_case(text);
  CHECK(r.run.stages.back().at_rest);
  // blocks carry the mean of their stress: the top of the last one sinks by the sum over whole blocks
  check_close("conventional DDA: settlement of a column [m]", last(r, "top.displacement_y [m]"),
              -0.5 * 2500 * 10 * 64 / 1e9, 2e-3, 1e-3);
}

TEST_CASE("conventional DDA: what it does not know is refused by its key") {
  const std::string text = read_text_file(kExample);
  const auto holds = [](const std::string& message, const std::string& part) {
    INFO(message);
    CHECK(message.find(part) != std::string::npos);
  };
  holds(refused(text + "\n[[boundary]]\nname = \"low\"\nkind = \"viscous\"\nedge = [[0, 0], [1, 0]]\n"),
        "boundary.low: there are no boundaries that let waves out");
  holds(refused(text, {"block.floor.kind=\"driven\""}), "block.floor.kind: no block is driven");
  holds(refused(text, {"joint.floor.dilation_angle=\"5 deg\""}),
        "joint.floor.dilation_angle: no joint dilates");
  holds(refused(text, {"stage.slide.damping_mass=\"1 1/s\""}), "stage.slide: damping is the scheme's own");
  holds(refused(text, {"penalty.shear_share=0"}), "penalty.shear_share");
  holds(refused(text, {"penalty.rotation=\"none\""}), "penalty.rotation");
  holds(refused(text, {"model.formulation=\"penalties\""}), "model.formulation");
}

TEST_CASE("conventional DDA: the same bits for any number of threads") {
  const std::string text = read_text_file(kExample);
  std::vector<double> first;
  for (const int threads : {1, 2, 3}) {
    Findings findings("m.toml", text);
    PreparedRun run = prepare_run("m.toml", text, {"stage.slide.duration=\"0.1 s\""}, findings);
    State state = start_state(run.scene);
    struct Nobody : Observer {
      void at(const Instant&) override {}
    } nobody;
    run_stages(run.scene, run.plans, state, nobody, Workers(threads));
    std::vector<double> now{state.displacement[1].x, state.displacement[1].y, state.strain_part[1].xy,
                            state.carried_stress[1].yy, state.rate[1].a.x};
    if (first.empty()) first = now;
    CHECK(now == first);
  }
}

}  // namespace test_conventional
