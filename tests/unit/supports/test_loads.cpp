#include "talus/supports/loads.h"

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_loads {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kPlate = R"(
talus = 1
[model]
thickness = 0.5
[material.a]
density = 2000
young = "1 GPa"
poisson = 0.2
[history.push]
time = [0, 1]
value = [3e4, 3e4]
[[stage]]
name = "go"
kind = "dynamic"
duration = "1 ms"
time_step = "0.1 ms"
)";

const std::string kBlock =
    "[[block]]\nname = \"b\"\npolygon = [[0, 0], [4, 0], [4, 3], [0, 3]]\nmaterial = \"a\"\n";

// Forces of all loads on the blocks at the start.
std::vector<BlockForce> forces(const std::string& sections,
                               const std::function<void(State&)>& prepare = nullptr) {
  Findings findings("case.toml", kPlate + sections);
  const PreparedRun run = prepare_run("case.toml", kPlate + sections, {}, findings);
  State state = start_state(run.scene);
  if (prepare) prepare(state);
  std::vector<BlockForce> force(run.scene.blocks.count);
  add_edge_and_point_loads(run.scene.blocks, run.scene.model, run.scene.loads, state, 0, force);
  return force;
}

void check_force(const BlockForce& f, Vec2 resultant, const Mat2& moment) {
  CHECK(norm(f.f - resultant) < 1e-9);
  const Mat2 off = f.Q - moment;
  CHECK(std::sqrt(contract(off, off)) < 1e-9);
}

}  // namespace

TEST_CASE("pressure on an edge pushes into the block at the middle of the edge") {
  // 30 kPa on 3 m x 0.5 m: 45 kN against the right side, 2 m from the centroid
  const auto f = forces(kBlock + "[[load]]\nname = \"l\"\nedge = [[4, 0], [4, 3]]\npressure = \"push\"\n");
  check_force(f[0], {-45e3, 0}, {-45e3 * 2, 0, 0, 0});
}

TEST_CASE("loads: a constant is as a history of it, a direction as its components") {
  const std::string place = kBlock + "[[load]]\nname = \"l\"\nedge = [[4, 0], [4, 3]]\n";
  const auto same = [](const std::string& a, const std::string& b) {
    const BlockForce f = forces(a)[0], g = forces(b)[0];
    INFO(a, b);
    CHECK(norm(f.f) > 1);
    check_force(f, g.f, g.Q);
  };
  same(place + "pressure = \"30 kPa\"\n", place + "pressure = \"push\"\n");
  same(place + "traction_y = -3e4\n", place + "traction = 3e4\ndirection = \"-90 deg\"\n");
  same(place + "traction = \"push\"\ndirection = \"30 deg\"\n",
       place + fmt::format("traction_x = {}\ntraction_y = {}\n", 3e4 * std::cos(M_PI / 6), 1.5e4));
  const std::string point = kBlock + "[[load]]\nname = \"l\"\npoint = [1, 2]\n";
  same(point + "force = \"3 kN\"\ndirection = \"180 deg\"\n", point + "force_x = \"-3 kN\"\n");
}

TEST_CASE("pressure turns with the block, traction does not") {
  const auto quarter = [](State& s) { s.strain_part[0] = {-1, -1, 1, -1}; };  // F = quarter turn
  const std::string edge = "edge = [[4, 0], [4, 3]]\n";
  for (const char* kind : {"deformable", "rigid"}) {
    const std::string block = kBlock + "kind = \"" + kind + "\"\n";
    const auto turn = [&](State& s) {
      quarter(s);
      if (std::string(kind) == "rigid") s.strain_part[0] = rotation_minus_identity(std::acos(0.0));
    };
    CHECK(norm(forces(block + "[[load]]\nname = \"l\"\npressure = \"push\"\n" + edge, turn)[0].f -
               Vec2{0, -45e3}) < 1e-6);
    CHECK(norm(forces(block + "[[load]]\nname = \"l\"\ntraction_x = \"push\"\n" + edge, turn)[0].f -
               Vec2{45e3, 0}) < 1e-6);
    CHECK(norm(forces(block + "[[load]]\nname = \"l\"\ntraction_y = \"push\"\n" + edge, turn)[0].f -
               Vec2{0, 45e3}) < 1e-6);
  }
}

TEST_CASE("pressure on all edges of a block is in balance and squeezes it") {
  const auto f = forces(kBlock +
                        "[[load]]\nname = \"l\"\npressure = \"push\"\nedge = [[4, 0], [4, 3]]\n"
                        "[[load]]\nname = \"m\"\npressure = \"push\"\nedge = [[0, 0], [4, 0]]\n"
                        "[[load]]\nname = \"n\"\npressure = \"push\"\nedge = [[0, 0], [0, 3]]\n"
                        "[[load]]\nname = \"o\"\npressure = \"push\"\nedge = [[0, 3], [4, 3]]\n");
  // Q = sum f X^T = -p V I: the virial of a pressure
  check_force(f[0], {0, 0}, {-3e4 * 6, 0, 0, -3e4 * 6});
}

TEST_CASE("a force at a corner is shared by the blocks that meet there") {
  const std::string two =
      kBlock + "[[block]]\nname = \"c\"\npolygon = [[4, 0], [8, 0], [8, 3], [4, 3]]\nmaterial = \"a\"\n";
  const auto f =
      forces(two + "[[load]]\nname = \"l\"\npoint = [4, 3]\nforce_x = \"push\"\nforce_y = \"push\"\n");
  check_force(f[0], {15e3, 15e3}, {15e3 * 2, 15e3 * 1.5, 15e3 * 2, 15e3 * 1.5});
  check_force(f[1], {15e3, 15e3}, {-15e3 * 2, 15e3 * 1.5, -15e3 * 2, 15e3 * 1.5});
  const auto g = forces(two + "[[load]]\nname = \"l\"\npoint = [4, 3]\nblock = \"c\"\nforce_y = \"push\"\n");
  check_force(g[0], {}, {});
  check_force(g[1], {0, 30e3}, {0, 0, -30e3 * 2, 30e3 * 1.5});
  const auto h = forces(two + "[[load]]\nname = \"l\"\npoint = [1, 1]\nforce_y = \"push\"\n");  // inside
  check_force(h[0], {0, 30e3}, {0, 0, -30e3, -30e3 * 0.5});
}

TEST_CASE("pressure on the wall of an opening: closed, so without a resultant") {
  const std::string hole = R"(
[cut]
sliver_area = 0
[[region]]
name = "rock"
polygon = [[0, 0], [10, 0], [10, 10], [0, 10]]
material = "a"
[[opening]]
name = "hole"
shape = "circle"
center = [5, 5]
diameter = 2
[[joint_set]]
name = "beds"
angle = 0
spacing = 2
[[load]]
name = "blast"
along = "hole"
pressure = "push"
)";
  const auto f = forces(hole);
  BlockForce sum;
  double push = 0;
  for (const BlockForce& b : f) sum += {b.f, {}}, push += norm(b.f);
  CHECK(norm(sum.f) < 1e-6 * push);
  CHECK(push > 0.5 * 3e4 * 3.14 * 2 * 0.5);  // pressure times perimeter, less where a block has both walls
}

TEST_CASE("work of loads: a free block under a pressure") {
  // 45 kN along -x on 12 t for 10 steps: work to the middle of the last kick, whose measure is 1/2 m v- v+
  // (theory 8)
  const CaseResult r =
      run_case(kPlate + kBlock +
               "kind = \"rigid\"\n[[load]]\nname = \"l\"\nedge = [[4, 0], [4, 3]]\npressure = \"push\"\n");
  check_close("work of a pressure [J]", r.run.energy.work[Cause::kLoads],
              45e3 * 45e3 / 12e3 * 1e-6 / 2 * (1 - 0.05 * 0.05), 1e-9, 1e-12);
  check_below("work of a pressure: energy left over / largest term", r.run.closure(), 1e-9, 1e-12);
}

}  // namespace test_loads
