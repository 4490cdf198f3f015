// Stress of the ground at the start, and the elastic law around an initial stress.

#include <doctest/doctest.h>

#include "support/relative.h"
#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/blocks/in_situ.h"
#include "talus/step/change.h"

namespace test_in_situ {

using namespace talus;
using namespace talus::test;

namespace {

const PlaneModuli kModuli{6e9, 2e9, 2e9};
const Mat2 kT0{-3e6, 1.2e6, 1.2e6, -5e6};

// What both grounds are made of.
const std::string kRock = R"(talus = 1
[model]
gravity = [0, -10]
[material.rock]
density = 2500
young = "5 GPa"
poisson = 0.25
)";

// Rock of 10 m x 20 m with hard joints, as laid by the ground: k0 on rollers, weight of 1000 m above.
const std::string kColumn = kRock + R"([joint.glue]
kind = "bonded"
[in_situ]
level = 20
pressure = "2 MPa"
density = 2500
k0 = 0.5
[history.above]
time = [0, 1]
value = [2e6, 2e6]
[[grid]]
name = "rock"
min = [0, 0]
max = [10, 20]
cells = [2, 8]
pattern = "crossed_triangles"
material = "rock"
joint = "glue"
[[support]]
name = "base"
edge = [[0, 0], [10, 0]]
x = "free"
[[support]]
name = "left"
edge = [[0, 0], [0, 20]]
y = "free"
[[support]]
name = "right"
edge = [[10, 0], [10, 20]]
y = "free"
[[load]]
name = "above"
edge = [[0, 20], [10, 20]]
pressure = "above"
[[monitor]]
name = "top"
point = [5, 19.9]
[[stage]]
name = "rest"
kind = "static"
duration = 1
)";

// The same ground with two joint sets of rough rock and a tunnel's rock still in place, glued in.
const std::string kJointed = kRock + R"([joint.natural]
friction_angle = "45 deg"
normal_stiffness = "20 GPa/m"
shear_stiffness = "20 GPa/m"
[contact]
joint = "natural"
[in_situ]
level = 20
pressure = "10 MPa"
density = 2500
k0 = 0.5
[history.above]
time = [0, 1]
value = [10e6, 10e6]
[[region]]
name = "rock"
polygon = [[0, 0], [20, 0], [20, 20], [0, 20]]
sides = ["base", "right", "top", "left"]
material = "rock"
joint = "natural"
[[joint_set]]
name = "steep"
angle = "75 deg"
spacing = 2.3
[[joint_set]]
name = "flat"
angle = "125 deg"
spacing = 2.7
[[opening]]
name = "tunnel"
shape = "circle"
center = [10, 10]
diameter = 6
segments = 24
rock = "kept"
[cut]
sliver_width = 0.2
[[support]]
name = "base"
along = "base"
[[support]]
name = "left"
along = "left"
x = "fixed"
y = "free"
[[support]]
name = "right"
along = "right"
x = "fixed"
y = "free"
[[load]]
name = "above"
along = "top"
pressure = "above"
[[monitor]]
name = "middle"
point = [10, 10]
[[stage]]
name = "rest"
kind = "static"
duration = 0.5
)";

}  // namespace

TEST_CASE("stress around an initial one is the derivative of its energy, turns along and exerts no torque") {
  const Mat2 H{0.03, -0.08, 0.05, 0.02};
  const double step = 1e-6;
  const Mat2 p = elastic_state(kModuli, H, kT0).stress;
  for (const Mat2 d : {Mat2{1, 0, 0, 0}, Mat2{0, 1, 0, 0}, Mat2{0, 0, 1, 0}, Mat2{0, 0, 0, 1}}) {
    const double slope = (elastic_state(kModuli, H + step * d, kT0).density -
                          elastic_state(kModuli, H - step * d, kT0).density) /
                         (2 * step);
    // second differences of an energy of 1e7: 1e-6^2 of it, and round-off 1e-16 / 1e-6
    CHECK(slope == approx(contract(p, d)).epsilon(1e-6));
  }
  const Mat2 tau = p * transpose(kIdentity + H);
  CHECK(std::abs(tau.xy - tau.yx) <= 1e-14 * size_of(tau));
  // a turned block carries its stress along
  const Mat2 r = kIdentity + rotation_minus_identity(0.7);
  const Mat2 turned = r * (kIdentity + H) - kIdentity;
  CHECK(size_of(elastic_state(kModuli, turned, kT0).stress - r * p) <= 1e-13 * size_of(p));
  CHECK(size_of(elastic_state(kModuli, {}, kT0).stress - kT0) == 0);
}

TEST_CASE("other moduli keep the stress as it is") {
  const PlaneModuli soft{3e9, 1e9, 1e9};
  const Mat2 H{-3e-4, 2e-4, 1e-4, -5e-4};
  const Mat2 before = elastic_state(kModuli, H, kT0).stress;
  const Mat2 after = elastic_state(soft, H, initial_stress_for(kModuli, soft, H, kT0)).stress;
  // the skew part, stress x strain, depends on T0 alone: second order in strains
  CHECK(size_of(after - before) <= 1e-6 * size_of(before));
}

TEST_CASE("pressure of the ground grows with depth, k0 gives the horizontal one") {
  InSituInput in;
  in.given = in.with_depth = true;
  in.level = 100, in.pressure = 1e6, in.density = 2000, in.k0 = 0.4;
  const Mat2 s = in_situ_stress(in, {0, -10}, 50);
  CHECK(s.yy == approx(-2e6).epsilon(1e-15));
  CHECK(s.xx == approx(-0.8e6).epsilon(1e-15));
  in.k0 = std::nan("");
  in.horizontal_pressure = 3e5, in.horizontal_gradient = 1e4;
  CHECK(in_situ_stress(in, {0, -10}, 50).xx == approx(-8e5).epsilon(1e-15));
}

TEST_CASE("ground laid with its stress is at rest, with the gradient of gravity") {
  double moved = 0, slope = 0, ratio = 0;
  const CaseResult r = run_case(kColumn, {}, [&](const Instant& i) {
    if (!i.last) return;
    // stress against depth over all blocks, by least squares through the known pressure at the top
    double sum_dd = 0, sum_ds = 0, sum_x = 0, sum_y = 0;
    for (int b = 0; b < i.scene.blocks.count; ++b) {
      const Mat2 s = cauchy_stress(i.scene.blocks, i.state, b);
      const double depth = 20 - i.scene.blocks.centroid[b].y;
      sum_dd += depth * depth, sum_ds += depth * (-s.yy - 2e6), sum_x += s.xx, sum_y += s.yy;
    }
    slope = sum_ds / sum_dd, ratio = sum_x / sum_y;
    for (const Vec2 d : i.state.displacement) moved = std::max(moved, norm(d));
  });
  CHECK(r.run.stages[0].at_rest);
  // triangles of constant stress under a linear one: half a block's weight, 1.25 m of 20 m, goes to and fro
  check_close("in_situ gradient of the vertical stress [Pa/m]", slope, 25000, 1e-2, 5e-3);
  check_close("in_situ horizontal / vertical", ratio, 0.5, 1e-2, 5e-3);
  // without it the column would sink by (2 MPa + 0.25 MPa) 20 m / 6 GPa = 7.5 mm
  check_below("in_situ largest displacement [m]", moved, 5e-5, 3e-5);
  check_below("in_situ energy left over / largest term", r.run.closure(), 1e-2, 1e-8);
}

TEST_CASE("jointed ground laid with its stress is at rest: nothing presses at the crossings of joints") {
  double moved = 0, at_corners = 0, on_faces = 0;
  const CaseResult r = run_case(kJointed, {}, [&](const Instant& i) {
    for (const Patch& c : i.state.patches) {
      double& force = c.length < 0.01 ? at_corners : on_faces;  // joints have closed by 1 mm
      force = std::max({force, c.force[0][0], c.force[1][0]});
    }
    if (!i.last) return;
    for (const Vec2 d : i.state.displacement) moved = std::max(moved, norm(d));
  });
  CHECK(r.run.stages[0].at_rest);
  CHECK(r.run.stages[0].steps < 2000);
  // blocks of constant stress under a linear one move by far less than the 1.5 mm that the joints have closed
  check_below("in_situ jointed largest displacement [m]", moved, 1e-6, 1e-7);
  // the stress of the ground on such a corner would make 5 %
  check_below("in_situ largest force at corners / on faces", at_corners / on_faces, 1e-4, 1e-5);
}

}  // namespace test_in_situ
