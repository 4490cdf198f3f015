// A3a free fall and A3c spin: one block without contact.

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_free_block {

using namespace talus;
using namespace talus::test;

TEST_CASE("A3a free fall: central differences with the half first step are exact for constant acceleration") {
  for (const std::string kind : {"rigid", "deformable"}) {
    const CaseResult r = run_case(fmt::format(R"(
talus = 1
[model]
gravity = [1.5, -9.81]
[material.m]
density = 2500
young = "50 MPa"
poisson = 0.25
[[block]]
name = "b"
polygon = [[0, 0], [1, 0], [1.2, 0.9], [0.1, 1]]
material = "m"
kind = "{}"
velocity = [3, 4]
[[stage]]
name = "fall"
kind = "dynamic"
duration = 2
time_step = "1 ms"
[[monitor]]
name = "p"
point = [0.5, 0.5]
)",
                                              kind));
    const auto &t = r.column("t [s]"), &x = r.column("p.displacement_x"), &y = r.column("p.displacement_y"),
               &vy = r.column("p.velocity_y");
    double worst = 0, worst_v = 0;
    for (size_t i = 0; i < t.size(); ++i) {
      worst = std::max({worst, std::abs(x[i] - (3 * t[i] + 0.75 * t[i] * t[i])),
                        std::abs(y[i] - (4 * t[i] - 4.905 * t[i] * t[i]))});
      worst_v = std::max(worst_v, std::abs(vy[i] - (4 - 9.81 * t[i])));
    }
    CHECK(t.back() == 2);
    // 2000 additions: round-off of 1e-16 x 12 m each
    check_below("A3a " + kind + " path / fall of 11.62 m", worst / 11.62, 1e-9, 1e-13);
    check_below("A3a " + kind + " velocity / 15.62 m/s", worst_v / 15.62, 1e-9, 1e-13);
    check_below("A3a " + kind + " energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
  }
}

TEST_CASE("A3c spin: area, angular momentum and spin stress of a free block") {
  // rho w^2 b^2 / 12 = 83333 Pa along both axes of a square; with it, no growth of area (naive updates grow
  // as exp(w^2 dt T)) and angular momentum kept to round-off. Started in its equilibrium strain.
  const double w = 20, density = 2500, young = 1e9, nu = 0.25;
  const double stress = density * w * w / 12;
  const double c = young / ((1 + nu) * (1 - 2 * nu));  // c11 + c12 of plane strain
  // C : (U - I) = rho w^2 b^2/12 (1 + strain), because the arms are stretched too
  const double strain = stress / (c - stress);
  double momentum_0 = 0, worst_momentum = 0, worst_area = 0;
  const auto watch = [&](const Instant& i) {
    const Mat2 F = kIdentity + i.state.strain_part[0];
    const Mat2 L = i.state.rate[0].G * i.scene.blocks.inertia[0] * transpose(F);
    const double momentum = L.yx - L.xy;
    if (i.state.step == 0) momentum_0 = momentum;
    worst_momentum = std::max(worst_momentum, std::abs(momentum / momentum_0 - 1));
    worst_area = std::max(worst_area, std::abs(det(F) - (1 + strain) * (1 + strain)));
  };
  const auto prepare = [&](const Scene&, State& s) {
    s.strain_part[0] = strain * kIdentity;
    s.rate[0].G = (1 + strain) * spin_matrix(w);
  };
  const CaseResult r = run_case(R"(
talus = 1
[material.m]
density = 2500
young = "1 GPa"
poisson = 0.25
[[block]]
name = "b"
polygon = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]
material = "m"
spin = "20 rad/s"
[[stage]]
name = "spin"
kind = "dynamic"
duration = 10
safety = 0.2
[[monitor]]
name = "b"
block = "b"
)",
                                {}, watch, prepare);
  const double cauchy = r.column("b.stress_xx").back();
  const Mat2 F = kIdentity + r.state.strain_part[0];
  // dt w = 3e-3: per step the block moves along a chord, not the arc, so that the centrifugal strain differs
  // by the share (dt w)^2/6 = 1e-6 and the block breathes by as much
  check_close("A3c spin stress [Pa]", cauchy, 83333.333, 1e-3, 1e-4);
  check_close("A3c area growth = twice the physical strain", det(F) - 1, 2 * strain + strain * strain, 1e-3,
              1e-5);
  check_below("A3c area beyond the physical strain", worst_area, 1e-9, 1e-10);
  check_below("A3c drift of angular momentum over 32 turns", worst_momentum, 1e-10, 5e-15);
}

}  // namespace test_free_block
