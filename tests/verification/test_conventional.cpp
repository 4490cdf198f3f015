// Conventional DDA (formulation = "penalty") on models whose answers are known, run as any model is: sliding, friction
// at rest, a column under its weight, a bar that is struck; what it refuses; and the same bits for any number of threads.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "support/model_text.h"
#include "support/run_case.h"
#include "support/source_file.h"
#include "support/told.h"
#include "support/tolerance.h"
#include "talus/base/text_file.h"

namespace test_conventional {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kExample = source_file("examples/conventional/conventional.toml");

double last(const CaseResult& r, const std::string& column) { return r.column(column).back(); }

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

TEST_CASE(
    "conventional DDA: the error of the start of friction falls with the run-out, and with stiffer springs") {
  const std::string text = read_text_file(kExample);
  const double t = std::numbers::pi / 180,
               a = 9.81 * (std::sin(30 * t) - std::tan(20 * t) * std::cos(30 * t));
  const auto error = [&](const std::string& springs, double end) {
    const CaseResult r = run_case(
        text, {"penalty.normal_stiffness=\"" + springs + "\"", fmt::format("stage.slide.duration={}", end)});
    return last(r, "block.displacement_x [m]") / (0.5 * a * end * end) - 1;
  };
  // while its springs take up the pressure the block slides too easily: a velocity too much ever after, so that the
  // error of the way falls as 1/t
  const double first = 0.25 * error("10 MPa", 0.25);
  for (const double end : {0.5, 1.0, 2.0})
    check_close(
        fmt::format("conventional DDA: error of the way after {:g} s / that after 0.25 s, times t", end),
        end * error("10 MPa", end) / first, 1, 0.1, 0.05);
  double before = 1;
  for (const std::string springs : {"100 MPa", "1 GPa", "10 GPa"}) {
    const double now = std::abs(error(springs, 1));
    check_below("conventional DDA: error of the way in 1 s on springs of " + springs + " / on a tenth of it",
                now / before, 0.2, 0.1);
    before = now;
  }
  // what is left is the rounding of what springs of that stiffness carry, and of the step
  for (const std::string springs : {"100 GPa", "1000 GPa"})
    check_below("conventional DDA: error of the way in 1 s on springs of " + springs,
                std::abs(error(springs, 1)), 2e-5, 1e-6);
}

TEST_CASE("conventional DDA: friction goes by the pressure of its own step") {
  // two rigid blocks on planes of 45 and 20 deg push each other over a smooth vertical face (A6i): where friction went by
  // the pressure of an iteration before, they jammed on stiff springs
  const std::string text = R"(talus = 1
[model]
formulation = "penalty"
gravity = [0, -9.81]
[penalty]
normal_stiffness = "1e12 Pa"
[material.upper]
density = 2000
[material.lower]
density = 297.2677908424
[joint.face]
friction_angle = "30 deg"
[joint.smooth]
[contact]
joint = "face"
[[contact_pair]]
between = ["upper", "lower"]
joint = "smooth"
[[block]]
name = "ground"
polygon = [[-4, -9], [6, -9], [6, -2.683821405597], [0, -0.5], [0, 0], [-4, 4]]
material = "upper"
kind = "fixed"
[[block]]
name = "upper"
polygon = [[0, 0], [0, 2.5], [-1, 2.5], [-1, 1]]
material = "upper"
kind = "rigid"
[[block]]
name = "lower"
polygon = [[0, -0.5], [2, -1.227940468532], [2, 2.5], [0, 2.5]]
material = "lower"
kind = "rigid"
[[stage]]
name = "slide"
kind = "dynamic"
duration = "0.1 s"
time_step = "1 ms"
[[monitor]]
name = "upper"
point = [-0.5, 2]
)";
  const CaseResult r = run_case(text);
  const double way = std::hypot(last(r, "upper.displacement_x [m]"), last(r, "upper.displacement_y [m]"));
  check_close("conventional DDA: acceleration of the upper of two blocks [m/s2]", 200 * way, 1.43689, 1e-2,
              1e-3);
}

TEST_CASE("conventional DDA: on a smooth floor nothing sticks, and no step is cut") {
  const CaseResult r = run_case(
      read_text_file(kExample),
      {"joint.floor.friction_angle=0", "stage.slide.duration=1", "penalty.normal_stiffness=\"1e13 Pa\""});
  CHECK(r.run.cut_steps == 0);
  check_close("conventional DDA: smooth slide in 1 s [m]", last(r, "block.displacement_x [m]"), 0.25 * 9.81,
              1e-6, 1e-8);
}

TEST_CASE("conventional DDA: steps of a wall that takes up its weight are hardly ever cut" *
          doctest::test_suite("optimised")) {
  std::string text = R"(talus = 1
[model]
formulation = "penalty"
gravity = [0, -9.81]
[penalty]
normal_stiffness = "40 GPa"
[material.m]
density = 2000
young = "1 GPa"
poisson = 0.2
[joint.bed]
friction_angle = "30 deg"
[contact]
joint = "bed"
[[stage]]
name = "rest"
kind = "dynamic"
duration = "0.3 s"
time_step = "5 ms"
[[monitor]]
name = "top"
point = [2.01, 1.99]
)" + block_text("base", {{-0.5, -0.5}, {4.5, -0.5}, {4.5, 0}, {-0.5, 0}}, "fixed");
  int n = 0;
  for (int course = 0; course < 20; ++course) {
    const double y = 0.1 * course, shift = course % 2 == 0 ? 0.2 : 0.1;
    for (double x = 0; x < 4 - 1e-9;) {
      const double end = std::min(x == 0 ? shift : x + 0.2, 4.0);
      text += block_text("b" + std::to_string(n++), {{x, y}, {end, y}, {end, y + 0.1}, {x, y + 0.1}},
                         "deformable");
      x = end;
    }
  }
  const CaseResult r = run_case(text);
  // with places held to rounding some steps are cut into hundreds of parts
  CHECK(r.run.cut_steps <= 5);
  CHECK(r.run.parts < 90);
  // rho g H^2 / (2 E'); the springs of the beds give 0.2 % of it, and the wall still swings
  check_close("conventional DDA: settlement of a wall of 410 bricks [m]", last(r, "top.displacement_y [m]"),
              -3.9e-5, 0.1, 0.05);
}

TEST_CASE("conventional DDA: friction that takes its own pressure away is found") {
  // a thin rod that slides at 3 m/s leaning back at 60 deg: friction turns it off the floor, and iteration by whole steps
  // swings between its pressure and none. By contact forces, another way to the same forces, as reference
  for (const double friction : {50.0, 60.0, 70.0}) {
    const std::string text = friction_model({0, -9.81}, friction, 0.01, 2e-4) +
                             block_text("floor", {{-5, -1}, {5, -1}, {5, 0}, {-5, 0}}, "fixed") +
                             block_text("rod",
                                        {{0, 0},
                                         {0.5, 0.8660254037844386},
                                         {0.48267949192431137, 0.8760254037844386},
                                         {-0.017320508075688773, 0.01}},
                                        "rigid", "velocity = [3, 0]") +
                             "[[monitor]]\nname = \"foot\"\ncontact = [\"rod\", \"floor\"]\n";
    const CaseResult penalty = run_case(text, {"model.formulation=\"penalty\""}), forces = run_case(text);
    // both schemes are of first order in the step here, and a per cent apart
    for (const std::string column : {"foot.normal_force [N]", "foot.force_x [N]"})
      check_close(fmt::format("conventional DDA: rod at {:g} deg, {}", friction, column),
                  last(penalty, column), last(forces, column), 0.05, 0.01);
  }
}

TEST_CASE("conventional DDA: a pebble slides as it does without a boulder far away") {
  const double t = std::numbers::pi / 180,
               exact = 0.5 * 9.81 * (std::sin(30 * t) - std::tan(20 * t) * std::cos(30 * t));
  const std::string text = friction_model({4.905, -8.495709}, 20, 1, 1e-3) +
                           block_text("floor", {{-10, -1}, {100, -1}, {100, 0}, {-10, 0}}, "fixed") +
                           block_text("stop", {{90, 0}, {91, 0}, {91, 12}, {90, 12}}, "fixed") +
                           block_text("boulder", {{80, 0}, {90, 0}, {90, 10}, {80, 10}}, "rigid") +
                           "[[monitor]]\nname = \"b\"\npoint = [0.1, 0.1]\n";
  for (const double size : {0.2, 0.05})
    check_close(fmt::format("conventional DDA: slide of a pebble of {:g} m beside a boulder [m]", size),
                last(run_case(text + block_text("pebble",
                                                {{0.1 - size / 2, 0},
                                                 {0.1 + size / 2, 0},
                                                 {0.1 + size / 2, 2 * size},
                                                 {0.1 - size / 2, 2 * size}},
                                                "rigid"),
                              {"model.formulation=\"penalty\"",
                               "monitor.b.point=[0.1," + std::to_string(size) + "]"}),
                     "b.displacement_x [m]"),
                exact, 1e-3, 1e-4);
}

TEST_CASE("conventional DDA: forces and impulses where a stage begins, and where steps are cut") {
  const std::string text =
      friction_model({0, -9.81}, 30, 0.2, 1e-3) +
      "[[stage]]\nname = \"second\"\nkind = \"dynamic\"\nduration = 0.2\ntime_step = 4e-3\n" +
      "[[monitor]]\nname = \"c\"\ncontact = [\"block\", \"floor\"]\n" +
      block_text("floor", {{-1, -1}, {9, -1}, {9, 0}, {-1, 0}}, "fixed") +
      block_text("block", {{0, 0}, {1, 0}, {1, 0.2}, {0, 0.2}}, "rigid", "velocity = [2, 0]");
  const double weight = 0.2 * 2600 * 9.81;
  // the block comes 2 mm in a step of 1 ms, a third of which a step may go
  for (const std::string largest : {"1", "7e-4"}) {
    const CaseResult r =
        run_case(text, {"model.formulation=\"penalty\"", "new:penalty.largest_displacement=" + largest});
    CHECK((r.run.cut_steps > 100) == (largest != "1"));
    const std::vector<double>&force = r.column("c.normal_force [N]"), &t = r.column("t [s]");
    // 2 % is the ringing of the springs where steps become four times as long; another step's length would be 300 %
    double least = weight, most = weight;
    for (size_t k = 0; k < t.size(); ++k)
      if (t[k] > 0.1 && t[k] < 0.39) least = std::min(least, force[k]), most = std::max(most, force[k]);
    check_below("conventional DDA: least and most of a weight, cut at " + largest, (most - least) / weight,
                0.05, 0.01);
    // two steps of 1 ms pass before the springs carry it
    check_close("conventional DDA: impulse of a weight, cut at " + largest, last(r, "c.normal_impulse [N s]"),
                weight * 0.4, 0.02, 5e-3);
  }
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
  check_told(text + "\n[[boundary]]\nname = \"low\"\nkind = \"viscous\"\nedge = [[0, 0], [1, 0]]\n",
             {"boundary.low: there are no boundaries that let waves out"});
  const std::vector<std::array<std::string, 2>> wrong{
      {"block.floor.kind=\"driven\"", "block.floor.kind: no block is driven"},
      {"joint.floor.dilation_angle=\"5 deg\"", "joint.floor.dilation_angle: no joint dilates"},
      {"stage.slide.damping_mass=\"1 1/s\"", "stage.slide: damping is the scheme's own"},
      {"penalty.shear_share=0", "penalty.shear_share"},
      {"penalty.rotation=\"none\"", "penalty.rotation"},
      {"model.formulation=\"penalties\"", "model.formulation"}};
  for (const auto& [override, said] : wrong) check_told(text, {said}, {override});
}

TEST_CASE("conventional DDA: the same bits for any number of threads") {
  // some hundred blocks and pairs, so that threads have shares
  const std::string file = source_file("studies/comparison/tunnel.toml"), text = read_text_file(file);
  std::vector<double> first;
  for (const int threads : {1, 2, 3}) {
    Findings findings("m.toml", text);
    PreparedRun run = prepare_run("m.toml", text, {"model.formulation=\"penalty\""}, findings);
    State state = start_state(run.scene);
    struct Nobody : Observer {
      void at(const Instant&) override {}
    } nobody;
    run_stages(run.scene, run.plans, state, nobody, Workers(threads));
    std::vector<double> now;
    for (size_t k = 0; k < state.displacement.size(); ++k)
      now.insert(now.end(), {state.displacement[k].x, state.displacement[k].y, state.strain_part[k].xy,
                             state.carried_stress[k].yy});
    if (first.empty()) first = now;
    CHECK(now == first);
  }
}

TEST_CASE("conventional DDA: a run that is stopped and goes on has the bits of one that is not") {
  const std::string text = read_text_file(kExample);
  const std::vector<std::string> overrides{"penalty.scheme=\"mean_acceleration\"",
                                           "stage.slide.duration=\"0.2 s\"",
                                           "penalty.largest_displacement=1e-4"};  // steps are cut
  // stops before a step, and keeps the state
  struct Stopper : Observer {
    int64_t at_step = -1;
    std::vector<std::vector<double>> rows;
    std::optional<Standing> standing;
    std::optional<State> state;
    int64_t step = 0;
    void at(const Instant& i) override {
      step = i.state.step;
      std::vector<double> row{i.state.time, i.state.displacement[1].x, i.state.rate[1].a.x,
                              i.report.energy.left_over};
      for (const Impulse& p : i.work.rows.impulse) row.insert(row.end(), {p[0], p[1]});
      for (const PointRows& p : i.work.rows.points) row.insert(row.end(), {p.normal.x, p.arm_a.x, p.arm_b.y});
      if (rows.empty() || rows.back()[0] < row[0]) rows.push_back(row);
    }
    bool stop() override { return at_step >= 0 && step == at_step; }
    void keep_state(const Standing& s, const State& now) override { standing = s, state = now; }
  };
  const auto prepared = [&] {
    Findings findings("m.toml", text);
    return prepare_run("m.toml", text, overrides, findings);
  };
  Stopper whole;
  PreparedRun p = prepared();
  State state = start_state(p.scene);
  run_stages(p.scene, p.plans, state, whole);
  Stopper first;
  first.at_step = 40;
  PreparedRun q = prepared();
  State half = start_state(q.scene);
  run_stages(q.scene, q.plans, half, first);
  REQUIRE(first.standing);
  PreparedRun r = prepared();
  Stopper second;
  State rest = *first.state;
  continue_stages(r.scene, r.plans, *first.standing, rest, second);
  REQUIRE(second.rows.size() > 10);
  CHECK(whole.rows.size() > second.rows.size());
  for (size_t k = 1; k <= second.rows.size(); ++k)
    CHECK(whole.rows[whole.rows.size() - k] == second.rows[second.rows.size() - k]);
}

}  // namespace test_conventional
