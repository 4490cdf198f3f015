// Static stages whose steps begin at rest (theory 14.1): what they come to is the balance that formulas give.

#include <cmath>
#include <numbers>

#include "support/run_case.h"
#include "support/tolerance.h"
#include "support/tunnel_model.h"

namespace test_from_rest {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kG = 9.81, kDensity = 2500;

// Ten blocks of 1 m x 0.8 m on each other, one-dimensional as poisson = 0; joints of `joint`.
std::string stack_text(const std::string& joint, const std::string& stages) {
  return fmt::format(R"(
talus = 1
[model]
gravity = [0, -{}]
[material.m]
density = {}
young = "2 GPa"
poisson = 0
[joint.face]
{}
[contact]
joint = "face"
[[block]]
name = "floor"
polygon = [[-1, -1], [2, -1], [2, 0], [-1, 0]]
material = "m"
kind = "fixed"
[[grid]]
name = "stack"
min = [0, 0]
max = [1, 8]
cells = [1, 10]
material = "m"
joint = "face"
[[monitor]]
name = "top"
point = [0.5, 8]
)",
                     kG, kDensity, joint) +
         stages;
}

const std::string kElastic =
    "friction_angle = \"30 deg\"\nnormal_stiffness = \"4 GPa/m\"\nshear_stiffness = \"4 GPa/m\"";

// Settlement of its top [m]: blocks shorten by the mean of what they bear, joints by all that is above them.
double settlement(bool elastic_joints) {
  const double weight = kDensity * kG * 0.8, kn = 4e9, young = 2e9;
  double sum = 0;
  for (int i = 0; i < 10; ++i)
    sum += (i + 0.5) * weight * 0.8 / young + (elastic_joints ? (i + 1) * weight / kn : 0);
  return -sum;
}

const std::string kRest =
    "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20\n"
    "integration = \"implicit\"\nunbalanced = 1e-9\n";

// A block of 2 m x 1 m on a slope, both rigid; joints of 2 GPa/m.
std::string slope_text(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  const auto turned = [a](double x, double y) {
    return fmt::format("[{:.17g}, {:.17g}]", x * std::cos(a) + y * std::sin(a),
                       -x * std::sin(a) + y * std::cos(a));
  };
  return fmt::format(R"(
talus = 1
[model]
gravity = [0, -{}]
[material.m]
density = {}
[joint.face]
friction_angle = "35 deg"
normal_stiffness = "2 GPa/m"
shear_stiffness = "2 GPa/m"
[contact]
joint = "face"
[[block]]
name = "slope"
polygon = [{}, {}, {}, {}]
material = "m"
kind = "fixed"
[[block]]
name = "slab"
polygon = [{}, {}, {}, {}]
material = "m"
kind = "rigid"
[[monitor]]
name = "foot"
point = {}
)",
                     kG, kDensity, turned(-5, -1), turned(15, -1), turned(15, 0), turned(-5, 0), turned(0, 0),
                     turned(2, 0), turned(2, 1), turned(0, 1), turned(1, 1e-6)) +
         kRest;
}

RunResult run_to_failure(const std::string& text) {
  Findings findings("m", text);
  PreparedRun p = prepare_run("m", text, {}, findings);
  State state = start_state(p.scene);
  MemoryObserver observer(p.scene, nullptr);
  return run_stages(p.scene, p.plans, state, observer);
}

}  // namespace

TEST_CASE("from rest: a stack on elastic joints settles by the sum of its weights over their stiffness") {
  const CaseResult elastic = run_case(stack_text(kElastic, kRest));
  CHECK(elastic.run.stages[0].at_rest);
  CHECK(elastic.run.steps <= 8);
  for (const BlockRate& v : elastic.state.rate) CHECK((v.a == Vec2{} && contract(v.G, v.G) == 0));
  // strains are 1e-4, and the balance of forces is of second order in them
  check_close("from rest, settlement on elastic joints", elastic.column("top.displacement_y").back(),
              settlement(true), 2e-4, 1e-4);
  check_below("from rest, elastic joints, energy left over", elastic.run.closure(), 1e-2, 1e-4);

  const CaseResult bonded = run_case(stack_text("kind = \"bonded\"", kRest));
  CHECK(bonded.run.stages[0].at_rest);
  check_close("from rest, settlement of bonded blocks", bonded.column("top.displacement_y").back(),
              settlement(false), 2e-4, 1e-4);
  check_below("from rest, bonded blocks, energy left over", bonded.run.closure(), 1e-2, 1e-4);
}

TEST_CASE("from rest: a pebble that falls is no rest, however large the forces beside it") {
  // 100 MPa on the stack: a weight of 0.2 N is 2e-9 of the mean force
  const std::string text = stack_text(
      "friction_angle = \"30 deg\"\nnormal_stiffness = \"40 GPa/m\"\nshear_stiffness = \"40 GPa/m\"",
      "[[block]]\nname = \"pebble\"\npolygon = [[1.5, 0.5], [1.503, 0.5], [1.503, 0.503], [1.5, 0.503]]\n"
      "material = \"m\"\n[[load]]\nname = \"top\"\nedge = [[0, 8], [1, 8]]\npressure = \"100 MPa\"\n"
      "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20\nintegration = \"implicit\"\n"
      "strict_rest = true\n");
  const CaseResult r = run_case(text + "[[monitor]]\nname = \"pebble\"\npoint = [1.5015, 0.5015]\n");
  CHECK(r.run.stages[0].at_rest);
  check_close("from rest, fall of a pebble beside large forces [m]", r.column("pebble.displacement_y").back(),
              -0.5, 1e-4, 1e-5);
}

TEST_CASE(
    "from rest: a slab below its friction moves by its weight over the stiffness, one above it is told") {
  for (const double degrees : {10.0, 25.0}) {
    const CaseResult r = run_case(slope_text(degrees));
    CHECK(r.run.stages[0].at_rest);
    const double a = degrees * std::numbers::pi / 180, pressure = kDensity * kG;
    const Vec2 moved{r.column("foot.displacement_x").back(), r.column("foot.displacement_y").back()};
    const double along = moved.x * std::cos(a) - moved.y * std::sin(a);
    const double across = moved.x * std::sin(a) + moved.y * std::cos(a);
    // no end slides: the mean closure and shear of the interface are those of the mean stresses; turning is 1e-5
    check_close(fmt::format("from rest, slab at {:g} deg, closing", degrees), across,
                -pressure * std::cos(a) / 2e9, 1e-3, 1e-4);
    check_close(fmt::format("from rest, slab at {:g} deg, shear", degrees), along,
                pressure * std::sin(a) / 2e9, 1e-3, 1e-4);
  }
  const RunResult sliding = run_to_failure(slope_text(38));
  CHECK(sliding.mechanism);
  CHECK(sliding.failure.find("finds no balance: a mechanism. 1 block") != std::string::npos);
  CHECK(sliding.failure.find("of the velocity is left") == std::string::npos);
}

TEST_CASE("from rest: what is excavated before anything has rested pushes nothing") {
  std::string rest = kRest;
  rest.insert(rest.find("unbalanced"), "excavate = [\"prop\"]\n");
  const CaseResult r = run_case(stack_text(
      kElastic,
      "[[block]]\nname = \"prop\"\npolygon = [[1, 0], [2, 0], [2, 1], [1, 1]]\nmaterial = \"m\"\n" + rest));
  CHECK(r.run.stages[0].at_rest);
  // joints close by up to 3e-5 of their length, and bear less by as much (theory 3.3)
  check_close("from rest, settlement beside what was excavated", r.column("top.displacement_y").back(),
              settlement(true), 3e-5, 1e-6);
}

TEST_CASE("from rest: what is flung out is told by its name") {
  std::string text = slope_text(10);
  const std::string weight = fmt::format("gravity = [0, -{}]", kG);
  text.replace(text.find(weight), weight.size(), "gravity = [2e6, -9.81]");
  const RunResult r = run_to_failure(text);
  INFO(r.failure);
  CHECK(r.failure.find("block \"slab\" at (") != std::string::npos);
  CHECK(r.failure.find("moves against \"slope\" by ") != std::string::npos);
  CHECK(r.failure.find("integration = \"dynamic\" follows it") != std::string::npos);
}

TEST_CASE("from rest: what slides on comes to rest where the force has gone") {
  // a weight aslant beyond the friction of the floor; the wall takes the rest
  const std::string text = fmt::format(R"(
talus = 1
[model]
gravity = [{}, -{}]
[material.m]
density = {}
[joint.face]
friction_angle = "20 deg"
normal_stiffness = "2 GPa/m"
shear_stiffness = "2 GPa/m"
[contact]
joint = "face"
[[block]]
name = "floor"
polygon = [[-1, -1], [6, -1], [6, 0], [-1, 0]]
material = "m"
kind = "fixed"
[[block]]
name = "wall"
polygon = [[4.05, 0.1], [5, 0.1], [5, 1], [4.05, 1]]
material = "m"
kind = "fixed"
[[block]]
name = "slab"
polygon = [[2, 0], [4, 0], [4, 1], [2, 1]]
material = "m"
kind = "rigid"
[[monitor]]
name = "wall"
contact = ["slab", "wall"]
[[monitor]]
name = "floor"
contact = ["slab", "floor"]
[[monitor]]
name = "slab"
point = [2.1, 0.1]
)",
                                       0.5 * kG, kG, kDensity) +
                           kRest;
  const CaseResult r = run_case(text);
  CHECK(r.run.stages[0].at_rest);
  // how much of the floor's friction is used depends on the way; all together is in balance
  const double weight = 2 * kDensity * kG;
  const auto force = [&r](const char* column) { return r.column(column).back(); };
  check_close("from rest, forces along a floor with a wall / weight",
              (force("wall.force_x") + force("floor.force_x")) / weight, -0.5, 1e-4, 1e-5);
  check_close("from rest, forces across it / weight",
              (force("wall.force_y") + force("floor.force_y")) / weight, 1, 1e-4, 1e-5);
  const double used =
      std::abs(force("floor.force_x") / force("floor.force_y")) / std::tan(20 * std::numbers::pi / 180);
  CHECK(used <= 1.0001);
  CHECK(used > 0.8);
  check_close("from rest, way to the wall [m]", r.column("slab.displacement_x").back(), 0.05, 1e-3, 1e-3);
  check_below("from rest, slide to a wall, energy left over", r.run.closure(), 1e-2, 1e-4);
}

TEST_CASE("from rest: a tunnel dug into bonded triangles closes as finite elements do (A6j)") {
  Tunnel t{8, 12};
  t.vertical /= 100, t.horizontal /= 100;
  std::string text = t.text();
  const size_t begin = text.find("[[stage]]\nname = \"dig\""), end = text.find("[solver]");
  text.replace(begin, end - begin,
               "[[stage]]\nname = \"dig\"\nkind = \"static\"\nduration = 10\nintegration = \"implicit\"\n"
               "unbalanced = 1e-6\nexcavate = [\"core\"]\n");
  const CaseResult r = run_case(text);
  CHECK(r.run.stages[1].at_rest);
  CHECK(r.run.stages[1].steps < 20);
  // supports stand still in static stages
  const std::vector<Vec2> u = t.finite_elements(false);
  check_close("from rest, A6j crown, blocks / finite elements",
              r.column("crown.displacement_y").back() / u[t.node(0, t.sectors)].y, 1, 5e-3, 5e-4);
  check_close("from rest, A6j side, blocks / finite elements",
              r.column("side.displacement_x").back() / u[t.node(0, 0)].x, 1, 5e-3, 5e-4);
  check_below("from rest, A6j energy left over", r.run.closure(), 1e-2, 1e-4);
}

TEST_CASE("from rest: the stage after it begins at rest and stays so") {
  const CaseResult r = run_case(
      stack_text(kElastic, kRest + "[[stage]]\nname = \"wait\"\nkind = \"dynamic\"\nduration = 0.05\n"));
  double fastest = 0;
  for (const double v : r.column("top.velocity_y")) fastest = std::max(fastest, std::abs(v));
  // what the balance asked for leaves, 1e-9 of the weight, over the time of the first step
  check_below("from rest, velocity in the dynamic stage after it [m/s]", fastest, 1e-8, 1e-9);
}

}  // namespace test_from_rest
