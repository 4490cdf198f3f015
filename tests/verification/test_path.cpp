// Static stages along a path (theory 14.7): each row of their table is a balance that statics gives.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/relative.h"
#include "support/run_case.h"
#include "support/source_file.h"
#include "support/tolerance.h"
#include "talus/base/random.h"
#include "talus/base/text_file.h"
#include "talus/run/safety.h"
#include "talus/run/saved_state.h"

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

// A semicircular arch of radius 1 m of an even number of voussoirs, thrust outwards: its halves turn about one joint at
// the intrados each, `hinge` joints above the springings, and lean on each other at the extrados of the crown.
struct Spreading {
  double thickness;  // over the radius
  int voussoirs, hinge;

  double angle(int joint) const { return std::numbers::pi * joint / voussoirs; }
  Vec2 at(double radius, int joint) const {
    return radius * Vec2{std::cos(angle(joint)), std::sin(angle(joint))};
  }
  double inner() const { return 1 - 0.5 * thickness; }
  double outer() const { return 1 + 0.5 * thickness; }
};

// Thrust of the right half over the density of weight [m2], and whether it stays between intrados and extrados of all joints
// but the hinge, when the springings have gone apart by `spread` [m].
std::pair<double, bool> thrust(const Spreading& a, double spread) {
  const Vec2 foot = a.at(a.inner(), a.hinge), out{0.5 * spread, 0}, pivot = foot + out;
  const double length = norm(foot - Vec2{0, a.outer()});
  const Vec2 crown{0, pivot.y + std::sqrt(length * length - pivot.x * pivot.x)};
  const Vec2 before = Vec2{0, a.outer()} - foot, now = crown - pivot;
  const double turn = std::atan2(now.y, now.x) - std::atan2(before.y, before.x);
  const auto moved = [&](Vec2 p, bool turns) {
    const Vec2 d = p - foot;
    return turns ? pivot + Vec2{std::cos(turn) * d.x - std::sin(turn) * d.y,
                                std::sin(turn) * d.x + std::cos(turn) * d.y}
                 : p + out;
  };
  double thrust_x = 0, weight = 0, moment = 0;
  bool inside = true;
  for (int pass = 0; pass < 2; ++pass) {
    weight = moment = 0;
    for (int k = a.voussoirs / 2 - 1; k >= 0; --k) {  // from the crown down; joint k is below voussoir k
      const PolygonMoments shape = polygon_moments(
          Polygon{a.at(a.inner(), k), a.at(a.outer(), k), a.at(a.outer(), k + 1), a.at(a.inner(), k + 1)});
      const Vec2 centre = moved(shape.centroid, k >= a.hinge);
      weight += shape.area, moment += shape.area * centre.x;
      // moment of all above about the ends of the joint
      const auto about = [&](double radius) {
        const Vec2 p = moved(a.at(radius, k), k > a.hinge);
        return -thrust_x * (crown.y - p.y) + p.x * weight - moment;
      };
      if (pass == 0 && k == a.hinge) thrust_x = (pivot.x * weight - moment) / (crown.y - pivot.y);
      if (pass == 1 && k != a.hinge) inside = inside && about(a.inner()) * about(a.outer()) <= 0;
    }
  }
  return {thrust_x, inside};
}

double spread_at_collapse(const Spreading& a) {
  double spread = 0;
  while (thrust(a, spread).second) spread += 1e-5;
  return spread;
}

std::string spreading_text(const Spreading& a, double last, int increments) {
  const double t = a.thickness;
  return fmt::format(R"(
talus = 1
[model]
gravity = [0, -{}]
[material.m]
density = {}
[joint.face]
friction_angle = "45 deg"
[contact]
joint = "face"
[[block]]
name = "left"
polygon = [[{}, -0.2], [{}, -0.2], [{}, 0], [{}, 0]]
material = "m"
kind = "fixed"
[[block]]
name = "right"
polygon = [[{}, -0.2], [{}, -0.2], [{}, 0], [{}, 0]]
material = "m"
kind = "driven"
motion_x = {{ displacement = "spread" }}
[[arch]]
name = "arch"
center = [0, 0]
radius = {}
thickness = {}
from = "0 deg"
to = "180 deg"
voussoirs = {}
material = "m"
kind = "rigid"
[history.spread]
time = [0, 1]
value = [0, {}]
[[stage]]
name = "stand"
kind = "static"
duration = 20
[[stage]]
name = "spread"
kind = "static"
path = 1
increments = {}
duration = 20
[[monitor]]
name = "thrust"
contact = ["arch", "right"]
)",
                     kG, kDensity, -1 - t, -1 + t, -1 + t, -1 - t, 1 - t, 1 + t, 1 + t, 1 - t, a.inner(), t,
                     a.voussoirs, last, increments);
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

TEST_CASE(
    "path: twenty random shear boxes on random ways have the force of return to the cone at every balance") {
  Random random(24);
  const auto between = [&random](double low, double high) { return low + (high - low) * random.uniform(); };
  for (int model = 0; model < 20; ++model) {
    const double friction = between(5, 55), kn = std::pow(10, between(9, 11)), ks = kn * between(0.2, 1),
                 pressure = std::pow(10, between(5, 6.5)),
                 most = std::tan(friction * std::numbers::pi / 180) * pressure * 0.2,
                 give = most / (ks * 0.2);
    std::vector<double> ways{0};
    for (int leg = 0; leg < 5; ++leg) ways.push_back(give * between(-4, 4));
    const int increments = static_cast<int>(between(5, 60));
    INFO(fmt::format("model {}: friction {} deg, kn {}, ks {}, pressure {}, {} increments", model, friction,
                     kn, ks, pressure, increments));
    const CaseResult r = run_case(box_text(
        fmt::format("friction_angle = \"{:.17g} deg\"\nnormal_stiffness = {:.17g}\nshear_stiffness = {:.17g}",
                    friction, kn, ks),
        pressure, ways, increments));
    CHECK(r.run.stages[1].balances >= increments + 1);
    double force = 0, before = 0, worst = 0;
    for (const size_t i : rows_of_path(r)) {
      const double way = history_at(ways, r.column("dynamic_time")[i]);
      force = std::clamp(force + ks * 0.2 * (way - before), -most, most), before = way;
      worst = std::max(worst, std::abs(r.column("box.reaction_x")[i] - force) / most);
    }
    // half the closure is missing from the face at its ends, and twice the way of the last step (theory 3.3, 14.7)
    CHECK(worst < 2e-4 + pressure / kn);
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

TEST_CASE(
    "path: an arch on spreading springings bears the thrust of its three hinges, and falls where a fourth opens") {
  for (const Spreading& arch : {Spreading{0.15, 16, 3}, Spreading{0.2, 16, 3}}) {
    const double collapse = spread_at_collapse(arch), last = 1.1 * collapse;
    constexpr int kIncrements = 440;  // a quarter of a per cent of the collapse each
    CsvTable table;
    const RunResult r = run_to_failure(spreading_text(arch, last, kIncrements), table);
    INFO(r.failure);
    CHECK(r.mechanism);
    const std::vector<double>&clock = table.column("dynamic_time"), &force = table.column("thrust.force_x");
    double worst = 0;
    for (size_t i = 0; i < clock.size(); ++i)
      if (clock[i] > 0.1)  // the first of the way closes the springings' own joints
        worst = std::max(
            worst, std::abs(std::abs(force[i]) / (kDensity * kG * thrust(arch, last * clock[i]).first) - 1));
    const std::string name = fmt::format("path, arch t/R {:g} on spreading springings, ", arch.thickness);
    check_below(name + "thrust [share]", worst, 1e-3, 2e-4);
    // the last balance is within an increment of it
    check_close(name + "collapse [radius]", last * clock.back(), collapse, 5e-3, 2.5e-3);
  }
}

TEST_CASE(
    "path: bricks under a growing share of their weight sideways go at the limit load, a hand slides their top course") {
  const std::string wall = read_text_file(source_file("examples/pushed_wall/pushed_wall.toml"));
  const std::string path =
      "[[stage]]\nname = \"push\"\nkind = \"static\"\npath = 1\nduration = 60\nincrements = {}\n[history.way]\ntime = "
      "[0, 1]\nvalue = [0, {}]\n{}";
  CsvTable table;
  const RunResult r =
      run_to_failure(wall + fmt::format(fmt::runtime(path), 350, 0.7 * kG,
                                        "[[load]]\nname = \"sideways\"\nacceleration_x = \"way\"\n"),
                     table);
  INFO(r.failure);
  CHECK(r.mechanism);
  // linear programming of rigid blocks (Ferris and Tin-Loi 2001); an increment is 0.002
  check_close("path, 33 bricks, last balance [g]", 0.7 * table.column("dynamic_time").back(), 0.6429, 5e-3,
              4e-3);

  const CaseResult hand = run_case(
      wall +
      fmt::format(
          fmt::runtime(path), 20, 0.1,
          "[[support]]\nname = \"jack\"\nedge = [[0, 8.75], [0, 10.5]]\nstages = [\"push\"]\nx = {displacement "
          "= \"way\"}\ny = \"free\"\n[[monitor]]\nname = \"jack\"\nsupport = \"jack\"\n"));
  const double slides = 0.65 * 20 * 1.75 * 1800 * kG;
  for (const size_t i : rows_of_path(hand))
    if (hand.column("dynamic_time")[i] > 0.2)
      CHECK(hand.column("jack.reaction_x")[i] == relative(slides, 1e-3));
}

TEST_CASE("path: rows of an elastic arch are balances: the same where four times as many lead there") {
  const auto run = [](int increments) {
    std::string text = spreading_text({0.15, 16, 3}, 0.07, increments);
    const std::string hard = "friction_angle = \"45 deg\"\n";
    text.insert(text.find(hard) + hard.size(), "normal_stiffness = 1e10\nshear_stiffness = 1e10\n");
    return run_case(text + "[[monitor]]\nname = \"crown\"\npoint = [0.01, 1]\n");
  };
  const CaseResult few = run(35), many = run(140);
  const std::vector<size_t> rows = rows_of_path(few), all = rows_of_path(many);
  REQUIRE((rows.size() == 35 && all.size() == 140));
  for (const auto& [column, most] :
       {std::pair("thrust.force_x", 5e-5), std::pair("crown.displacement_y", 2e-4)}) {
    const std::vector<double>&a = few.column(column), &b = many.column(column);
    double worst = 0;
    for (size_t i = 0; i < rows.size(); ++i)
      worst = std::max(worst, std::abs(a[rows[i]] - b[all[4 * i + 3]]));
    CHECK(worst < most * std::abs(b.back()));
  }
}

TEST_CASE("path: a load that follows it closes a joint by hand, in two steps a balance") {
  std::string text =
      box_text("friction_angle = \"30 deg\"\nnormal_stiffness = \"20 GPa/m\"\nshear_stiffness = \"4 GPa/m\"",
               1e6, {1e3, 1e6}, 20);
  const std::string constant = "pressure = 1000000\n", motion = "x = { displacement = \"box\" }\n";
  text.replace(text.find(constant), constant.size(), "pressure = \"box\"\n");
  text.replace(text.find(motion), motion.size(), "");
  const CaseResult r = run_case(text);
  for (const size_t i : rows_of_path(r))
    // the closure that makes the face a little shorter (theory 3.3)
    CHECK(r.column("upper.displacement_y")[i] ==
          relative(-(1e3 + 999e3 * r.column("dynamic_time")[i]) / 20e9, 2e-4));
  CHECK(r.run.stages[1].balances == 21);
  // where nothing has pressed yet the first steps are short
  CHECK(r.run.stages[1].steps <= 2 * 21 + 4);
}

TEST_CASE("path: the table is the same in one go, in pieces, and from a saved state") {
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
    const PreparedRun again = prepare_run("m", text, {}, findings);
    SavedRun saved = saved_run_of("state", run_archive(p.scene, run.standing(), state), again);
    Scene scene = again.scene;
    result = continue_stages(scene, again.plans, saved.standing, saved.state, observer);
    CHECK(saved.state.displacement == whole.state.displacement);
  }
  CHECK(result.failure.empty());
  CHECK(result.stages[1].balances == whole.run.stages[1].balances);
  CHECK(observer.table.values == whole.table.values);
}

TEST_CASE("path: safety asks behind one, and what it moves is no failure") {
  const std::vector<double> ways{0, 0.03};  // a fifth of the size of the box
  const std::string text =
      box_text("friction_angle = \"30 deg\"\nnormal_stiffness = \"20 GPa/m\"\nshear_stiffness = \"4 GPa/m\"",
               1e6, ways, 10);
  for (const char* from : {"start", "rest"}) {
    const std::string safety =
        fmt::format("[safety]\nby = \"strength\"\nfrom = \"{}\"\nhighest = 1.5\n", from);
    Findings findings("m", text + safety);
    const SafetyResult r = seek_safety(prepare_run("m", text + safety, {}, findings), Workers());
    // the box is held: less strength is a smaller force on it
    CHECK(r.stands == 1.5);
  }
}

}  // namespace test_path
