// Every solver of the table owes the same: what the judge measures below the tolerance, and, where forces are
// unique, the same forces. A new one is tried here without a line of its own.

#include <doctest/doctest.h>

#include <string>

#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/model/solver_kind.h"

namespace test_solvers {

using namespace talus;
using namespace talus::test;

namespace {

// Bricks on joints that give, shaken sideways: some slide, some open. A row is glued without any give.
const std::string kWall = R"~(talus = 1
[model]
gravity = [0, -9.81]
[material.brick]
density = 2000
young = "5 GPa"
poisson = 0.2
[joint.bed]
friction_angle = "30 deg"
normal_stiffness = "10 GPa/m"
shear_stiffness = "5 GPa/m"
[joint.glue]
kind = "bonded"
[contact]
joint = "bed"
[history.shake]
expression = "0.2*sin(2*_pi*5*t)"
duration = "0.5 s"
[[block]]
name = "floor"
polygon = [[-3, -1], [6, -1], [6, 0], [-3, 0]]
material = "brick"
kind = "driven"
motion_x = { velocity = "shake" }
[[grid]]
name = "low"
min = [0, 0]
max = [3, 0.5]
cells = [3, 1]
material = "brick"
joint = "bed"
[[grid]]
name = "beam"
min = [0.5, 0.5]
max = [2.5, 1]
cells = [2, 1]
material = "brick"
joint = "glue"
[[grid]]
name = "top"
min = [1, 1]
max = [2, 1.5]
cells = [2, 1]
material = "brick"
joint = "bed"
kind = "rigid"
[[monitor]]
name = "top"
point = [1.25, 1.25]
[[monitor]]
name = "bed"
contact = ["low[1,0]", "floor"]
[[stage]]
name = "shake"
kind = "dynamic"
duration = 0.1
time_step = 1e-4
)~";

}  // namespace

TEST_CASE("solvers: each of the table solves a shaken wall to the tolerance, with the same forces") {
  constexpr double kTolerance = 1e-10;  // share of the smallest block
  const auto run = [=](const std::string& method) {
    return run_case(kWall, {"solver.method=" + method, "solver.second_solver=false",
                            fmt::format("solver.tolerance={}", kTolerance)});
  };
  const CaseResult first = run(std::string(kSolverName[1]));
  for (size_t k = 1; k < kSolverName.size(); ++k) {
    const std::string name(kSolverName[k]);
    CAPTURE(name);
    const CaseResult r = run(name);
    CHECK(r.run.failed_steps == 0);
    CHECK(r.run.steps_by[k] == r.run.steps);
    check_below("solvers: worst error / tolerance, " + name, r.run.worst_error / (kTolerance * 0.5), 1, 1);
    // errors add up over a thousand steps of sliding; a hundredth of the tolerance makes them a hundredth
    check_close("solvers: impulse on the bed [N s], " + name, r.column("bed.impulse_y [N s]").back(),
                first.column("bed.impulse_y [N s]").back(), 1e-5, 1e-7);
    check_close("solvers: travel of the top [m], " + name, r.column("top.displacement_x [m]").back(),
                first.column("top.displacement_x [m]").back(), 1e-4, 1e-6);
  }
}

}  // namespace test_solvers
