// Static stages along a path (theory 4.24): each row of their table is a balance that statics gives.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/relative.h"
#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_path {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kG = 9.81, kDensity = 2500;

// A shear box of 0.2 m: the upper half goes to `ways` at the times 0, 1, 2 ... of the path, and cannot turn.
std::string box_text(const std::string& joint, double pressure, const std::vector<double>& ways,
                     int increments) {
  std::string times, values;
  for (size_t i = 0; i < ways.size(); ++i) {
    times += fmt::format("{}{}", i > 0 ? ", " : "", i);
    values += fmt::format("{}{:.17g}", i > 0 ? ", " : "", ways[i]);
  }
  return fmt::format(R"(
talus = 1
[model]
gravity = [0, 0]
[material.m]
density = 2500
[joint.face]
{}
[contact]
joint = "face"
[[block]]
name = "lower"
polygon = [[-0.1, -0.1], [0.3, -0.1], [0.3, 0], [-0.1, 0]]
material = "m"
kind = "fixed"
[[block]]
name = "upper"
polygon = [[0, 0], [0.2, 0], [0.2, 0.1], [0, 0.1]]
material = "m"
kind = "rigid"
[history.box]
time = [{}]
value = [{}]
[[load]]
name = "normal"
edge = [[0, 0.1], [0.2, 0.1]]
pressure = {:.17g}
[[support]]
name = "box"
edge = [[0, 0], [0, 0.1]]
x = {{ displacement = "box" }}
y = "free"
[[stage]]
name = "press"
kind = "static"
duration = 5
[[stage]]
name = "shear"
kind = "static"
path = {}
increments = {}
duration = 5
[[monitor]]
name = "box"
support = "box"
[[monitor]]
name = "upper"
point = [0.1, 0.05]
)",
                     joint, times, values, pressure, ways.size() - 1, increments);
}

// Rows of the table in which the path has begun, by index.
std::vector<size_t> rows_of_path(const CaseResult& r) {
  std::vector<size_t> rows;
  const std::vector<double>& clock = r.column("dynamic_time");
  for (size_t i = 0; i < clock.size(); ++i)
    if (clock[i] > 0) rows.push_back(i);
  return rows;
}

double history_at(const std::vector<double>& ways, double t) {
  const auto i = std::min(static_cast<size_t>(t), ways.size() - 2);
  return ways[i] + (ways[i + 1] - ways[i]) * (t - static_cast<double>(i));
}

// A column of 1 m x 3 m on a floor, its upper left corner led to the right along the path.
std::string column_text(double last, int increments) {
  return fmt::format(R"(
talus = 1
[model]
gravity = [0, -{}]
[material.m]
density = {}
[joint.face]
friction_angle = "40 deg"
[contact]
joint = "face"
[[block]]
name = "floor"
polygon = [[-2, -1], [4, -1], [4, 0], [-2, 0]]
material = "m"
kind = "fixed"
[[block]]
name = "column"
polygon = [[0, 0], [1, 0], [1, 3], [0, 3]]
material = "m"
kind = "rigid"
[history.way]
time = [0, 1]
value = [0, {}]
[[support]]
name = "hand"
point = [0, 3]
x = {{ displacement = "way" }}
y = "free"
[[stage]]
name = "stand"
kind = "static"
duration = 5
[[stage]]
name = "push"
kind = "static"
path = 1
increments = {}
duration = 5
[[monitor]]
name = "hand"
support = "hand"
[[monitor]]
name = "corner"
point = [0, 3]
)",
                     kG, kDensity, last, increments);
}

// Force along x at the corner that holds the column up by `turned` [rad] over its toe, per weight; and where the corner is.
double rocking_force(double turned) {
  const double s = std::sin(turned), c = std::cos(turned);
  return (0.5 * c - 1.5 * s) / (s + 3 * c);
}
double rocking_way(double turned) { return 1 - std::cos(turned) + 3 * std::sin(turned); }

// The rotation that has moved the corner by `way`.
double turned_by(double way) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (rocking_way(middle) < way ? low : high) = middle;
  }
  return low;
}

RunResult run_to_failure(const std::string& text, CsvTable& table) {
  Findings findings("m", text);
  PreparedRun p = prepare_run("m", text, {}, findings);
  State state = start_state(p.scene);
  MemoryObserver observer(p.scene, nullptr);
  const RunResult r = run_stages(p.scene, p.plans, state, observer);
  table = observer.table;
  return r;
}

}  // namespace

TEST_CASE("path: direct shear there and back sticks, slips and turns by hand, at three normal stresses") {
  const std::vector<double> ways{0, 1e-3, 0, -1e-3, 0, 1e-3};
  for (const double pressure : {0.5e6, 1e6, 2e6}) {
    const CaseResult r = run_case(box_text(
        "friction_angle = \"30 deg\"\nnormal_stiffness = \"20 GPa/m\"\nshear_stiffness = \"4 GPa/m\"",
        pressure, ways, 50));
    const std::vector<size_t> rows = rows_of_path(r);
    CHECK(r.run.stages[1].balances == 51);
    REQUIRE(rows.size() == 50);
    const double most = std::tan(std::numbers::pi / 6) * pressure * 0.2;
    double force = 0, before = 0, worst = 0, off = 0;
    for (const size_t i : rows) {
      const double way = history_at(ways, r.column("dynamic_time")[i]);
      force = std::clamp(force + 4e9 * 0.2 * (way - before), -most, most), before = way;
      worst = std::max(worst, std::abs(r.column("box.reaction_x")[i] - force) / most);
      off = std::max(off, std::abs(r.column("upper.displacement_x")[i] - way));
    }
    // a row is off by a thousandth of the last step's way at most, and by what slip shortens the joint's closure
    check_below(fmt::format("path, direct shear at {:g} MPa, force [share of the strength]", pressure / 1e6),
                worst, 1e-4, 2e-5);
    check_below(fmt::format("path, direct shear at {:g} MPa, way [m]", pressure / 1e6), off, 1e-7, 1e-8);
  }
}

TEST_CASE("path: a balance stands where the box turns, whatever the increments") {
  const std::vector<double> ways{0, 1e-3, -1e-3};
  for (const int increments : {3, 7}) {
    const CaseResult r = run_case(box_text(
        "friction_angle = \"30 deg\"\nnormal_stiffness = \"20 GPa/m\"\nshear_stiffness = \"4 GPa/m\"", 1e6,
        ways, increments));
    const std::vector<double>& u = r.column("upper.displacement_x");
    CHECK(*std::max_element(u.begin(), u.end()) == relative(1e-3, 1e-6));
    CHECK(u.back() == relative(-1e-3, 1e-6));
    CHECK(rows_of_path(r).size() == static_cast<size_t>(increments) + 1);
    // all of the way back slips at last
    CHECK(r.column("box.reaction_x").back() == relative(-std::tan(std::numbers::pi / 6) * 2e5, 1e-4));
  }
}

TEST_CASE("path: a cemented joint breaks at its strength, and bears what is left of it from then on") {
  const std::vector<double> ways{0, 1e-3};
  const CaseResult r = run_case(box_text(
      "friction_angle = \"30 deg\"\ncohesion = \"1 MPa\"\ntensile_strength = \"0.5 MPa\"\nresidual_friction_angle = \"25 "
      "deg\"\nnormal_stiffness = \"20 GPa/m\"\nshear_stiffness = \"4 GPa/m\"",
      1e6, ways, 100));
  const double peak = 1e6 + std::tan(std::numbers::pi / 6) * 1e6,
               left = std::tan(25 * std::numbers::pi / 180) * 1e6;  // [Pa]
  const std::vector<double>&force = r.column("box.reaction_x"), &u = r.column("upper.displacement_x");
  CHECK(r.run.broken_faces == 1);
  const double most = *std::max_element(force.begin(), force.end());
  // the last increment before the break: 10 um of 4 GPa/m are 40 kPa
  CHECK(most <= 0.2 * peak);
  CHECK(most > 0.2 * (peak - 40e3));
  for (const size_t i : rows_of_path(r)) {
    if (4e9 * u[i] < peak - 1e3) CHECK(force[i] == relative(0.2 * 4e9 * u[i], 1e-4));
    if (4e9 * u[i] > peak + 1e3) CHECK(force[i] == relative(0.2 * left, 1e-4));
  }
}

TEST_CASE("path: a column that is led over its toe yields to the force of statics, down to none") {
  const double weight = 3 * kDensity * kG, end = rocking_way(std::atan(1.0 / 3));
  for (const int increments : {25, 50}) {
    const CaseResult r = run_case(column_text(end, increments));
    const std::vector<double>&force = r.column("hand.reaction_x"), &way = r.column("corner.displacement_x");
    double worst = 0;
    for (const size_t i : rows_of_path(r))
      worst = std::max(worst, std::abs(force[i] / weight - rocking_force(turned_by(way[i]))));
    // the give of the hard contact under the toe, whose length is what bears the weight
    check_below(fmt::format("path, column led over its toe in {} increments, force [weights]", increments),
                worst, 1e-3, 1e-4);
    CHECK(*std::max_element(force.begin(), force.end()) > 0.14 * weight);
    CHECK(std::abs(force.back()) < 1e-3 * weight);
  }
}

TEST_CASE("path: loads that grow until something slides end with the last balance told") {
  std::string text = column_text(1, 50);
  // 1 g sideways at the end of the path, friction 5 deg, and no hand
  const auto replace = [&text](const std::string& what, const std::string& with) {
    const size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    text.replace(at, what.size(), with);
  };
  replace("40 deg", "5 deg");
  replace("[[support]]\nname = \"hand\"\npoint = [0, 3]\nx = { displacement = \"way\" }\ny = \"free\"\n",
          "[[load]]\nname = \"push\"\nacceleration_x = \"way\"\n");
  replace("[[monitor]]\nname = \"hand\"\nsupport = \"hand\"\n", "");
  replace("value = [0, 1]", "value = [0, 9.81]");
  CsvTable table;
  const RunResult r = run_to_failure(text, table);
  INFO(r.failure);
  CHECK(r.mechanism);
  // tan 5 deg = 0.0875: four of fifty
  CHECK(r.stages[1].balances == 5);
  CHECK(
      r.failure.find(
          "finds no balance, behind 5 of 51 balances of its path, as the histories go from 0.08 to 0.1 s: a "
          "mechanism") != std::string::npos);
  CHECK(table.column("dynamic_time").back() == approx(0.08));
}

TEST_CASE("path: the table is the same in one go, in pieces, and from a copy of the state") {
  const std::string text =
      box_text("friction_angle = \"30 deg\"\nnormal_stiffness = \"20 GPa/m\"\nshear_stiffness = \"4 GPa/m\"",
               1e6, {0, 1e-3, -1e-3}, 9);
  const CaseResult whole = run_case(text);
  Findings findings("m", text);
  PreparedRun p = prepare_run("m", text, {}, findings);
  State state = start_state(p.scene);
  MemoryObserver observer(p.scene, nullptr);
  RunResult result;
  {
    StagedRun run(p.scene, p.plans, state, observer);
    run.advance({.steps = 12});
    result = run.result();
    CHECK(result.stages.size() == 2);
    CHECK(result.stages[1].balances > 0);
    const Standing standing = run.standing();
    const PreparedRun again = prepare_run("m", text, {}, findings);
    Scene scene = again.scene;
    State copy = state;
    result = continue_stages(scene, again.plans, standing, copy, observer);
    CHECK(copy.displacement == whole.state.displacement);
  }
  CHECK(result.failure.empty());
  CHECK(result.stages[1].balances == whole.run.stages[1].balances);
  CHECK(observer.table.values == whole.table.values);
}

}  // namespace test_path
