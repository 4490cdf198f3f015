#include "talus/solve/primal_newton.h"

#include <fmt/format.h>

#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/solve/gauss_seidel.h"
#include "talus/step/step.h"

namespace test_primal_newton {

using namespace talus;
using namespace talus::test;

namespace {

constexpr size_t kPrimal = place_of(SolverKind::kPrimalNewton);

// Ground of `columns` x `rows` blocks of 1 m on a fixed floor, its joints with stiffness; `kind` of block.
std::string ground(int columns, int rows, const std::string& kind, double strength = 0) {
  return fmt::format(R"~(talus = 1
[model]
gravity = [0, -9.81]
[material.rock]
density = 2500
young = "5 GPa"
poisson = 0.25
[joint.soft]
friction_angle = "35 deg"
normal_stiffness = "1 GPa/m"
shear_stiffness = "1 GPa/m"
cohesion = {3}
tensile_strength = {3}
[contact]
joint = "soft"
[[block]]
name = "floor"
polygon = [[-1, -1], [{0}, -1], [{0}, 0], [-1, 0]]
material = "rock"
kind = "fixed"
[[grid]]
name = "g"
min = [0, 0]
max = [{1}, {2}]
cells = [{1}, {2}]
material = "rock"
joint = "soft"
kind = "{4}"
[[monitor]]
name = "top"
point = [0.5, {5}]
[[stage]]
name = "rest"
kind = "static"
duration = "20 s"
time_step = "20 ms"
elasticity = "implicit"
unbalanced = 1e-6
[solver]
tolerance = 1e-9
)~",
                     columns + 1, columns, rows, strength, kind, rows);
}

// One step, after `before` others by sweeps, by any number of threads.
struct Step {
  std::vector<Impulse> impulse;
  StepReport report;
  int sliding = 0;
};
Step step_of(const std::string& text, SolverKind method, int threads, int before = 0) {
  Findings findings("case.toml", text);
  Scene scene = prepare_run("case.toml", text, {}, findings).scene;
  scene.model.solver.second_solver = false;
  State state = start_state(scene);
  StepSettings settings;
  settings.implicit = true;
  settings.tolerance = 1e-9;
  StepWork work;
  work.workers = Workers(threads);
  work.clock.dynamic = false;
  scene.model.solver.method = SolverKind::kGaussSeidel;
  for (int i = 0; i < before; ++i) {
    StepReport report = kick(scene, settings, 20e-3, work, state);
    drift(scene, state.time + 20e-3, work, state, report);
  }
  scene.model.solver.method = method;
  Step result;
  result.report = kick(scene, settings, 20e-3, work, state);
  result.impulse = work.rows.impulse;
  for (size_t i = 0; i < result.impulse.size(); ++i)
    result.sliding += result.impulse[i][0] > 1 && slides(work.rows.points[i], result.impulse[i]);
  return result;
}

}  // namespace

TEST_CASE("a high stack of rigid blocks on springs settles as their sum says") {
  constexpr int kRows = 60;
  const CaseResult r = run_case(ground(4, kRows, "rigid"), {"solver.method=primal_newton"});
  // closure of joint i under the i blocks above it: i rho g h / kn = c - c^2, of sides that end level; the lowest
  // ends on wider ground, c - c^2/2 (theory 3.3)
  double exact = 0;
  for (int i = 1; i <= kRows; ++i) {
    const double share = i * 2500 * 9.81 / 1e9;
    exact += i < kRows ? 0.5 * (1 - std::sqrt(1 - 4 * share)) : 1 - std::sqrt(1 - 2 * share);
  }
  check_close("primal Newton: settlement of the top [m]", -r.column("top.displacement_y [m]").back(), exact,
              1e-6, 1e-7);
  CHECK(r.run.steps_by[kPrimal] == r.run.steps);
}

TEST_CASE("a step by Newton's method in velocities has the forces that thousands of sweeps find") {
  // strong joints, weak ones, and some that only rub, leaning, a few steps on: there some points slide
  for (const std::string kind : {"deformable", "rigid"})
    for (const double strength : {1e6, 3e3, 0.0}) {
      CAPTURE(kind);
      CAPTURE(strength);
      if (strength == 0 && kind == "rigid") continue;  // too many slide
      std::string text = ground(12, 40, kind, strength);
      const int before = strength == 0 ? 8 : 0;
      if (strength == 0) text.replace(text.find("[0, -9.81]"), 10, "[2.5, -9.5]");
      const Step newton = step_of(text, SolverKind::kPrimalNewton, 1, before),
                 sweeps = step_of(text, SolverKind::kGaussSeidel, 1, before);
      CHECK(newton.report.solve.converged);
      CHECK(newton.report.error.worst < 1e-9);
      CHECK(newton.report.solve.iterations < 5);
      CHECK(sweeps.report.solve.iterations > 200);
      REQUIRE(newton.impulse.size() == sweeps.impulse.size());
      double most = 0, largest = 0;
      for (size_t i = 0; i < newton.impulse.size(); ++i)
        for (size_t k = 0; k < 2; ++k) {
          most = std::max(most, std::abs(newton.impulse[i][k] - sweeps.impulse[i][k]));
          largest = std::max(largest, std::abs(sweeps.impulse[i][k]));
        }
      // ten times what the allowed 1e-9 m are worth over a joint of 1 m: kn dt 1e-9 m
      CHECK(most < 10 * 1e9 * 1e-9 * 20e-3);
      CHECK(largest > 100);
      CHECK((newton.sliding > 20) == (strength == 0));
    }
}

TEST_CASE("Newton's method in velocities has the same bits for any number of threads and when used again") {
  const std::string text = ground(30, 25, "deformable", 3e3);
  const Step once = step_of(text, SolverKind::kPrimalNewton, 1);
  CHECK(once.report.solve.iterations > 0);
  for (const int threads : {2, 3, 4}) {
    CAPTURE(threads);
    CHECK(step_of(text, SolverKind::kPrimalNewton, threads).impulse == once.impulse);
  }
}

TEST_CASE("a step from rest that is taken again begins where it ended") {
  // leaning on a wall that holds it fast
  std::string text = ground(12, 40, "deformable", 1.5e4) +
                     "[[support]]\nname = \"left\"\nedge = [[0, 0], [0, 40]]\ny = \"free\"\n";
  text.replace(text.find("[0, -9.81]"), 10, "[-2.5, -9.5]");
  Findings findings("case.toml", text);
  const Scene scene = prepare_run("case.toml", text, {}, findings).scene;
  const State start = start_state(scene);
  StepSettings settings;
  settings.implicit = settings.from_rest = true;
  settings.tolerance = 1e-9;
  StepWork work;
  work.clock.dynamic = false;
  State once = start;
  const StepReport first = kick(scene, settings, 20e-3, work, once);
  const std::vector<Impulse> found = work.rows.impulse;
  CHECK(first.solve.iterations >= 3);
  CHECK(first.error.worst < 1e-9);

  State again = start;
  again.rate = once.rate, again.supports = once.supports;
  settings.near_expected = true;
  const StepReport second = kick(scene, settings, 20e-3, work, again);
  CHECK(second.solve.iterations <= 1);
  CHECK(second.error.worst < 1e-9);
  REQUIRE(work.rows.impulse.size() == found.size());
  double most = 0, largest = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    if (work.rows.owner[i].family == Family::kSupport) continue;  // by more points than it can feel
    for (size_t k = 0; k < 2; ++k) {
      most = std::max(most, std::abs(work.rows.impulse[i][k] - found[i][k]));
      largest = std::max(largest, std::abs(found[i][k]));
    }
  }
  // ten times what the allowed 1e-9 m are worth over a joint of 1 m: kn dt 1e-9 m
  CHECK(most < 10 * 1e9 * 1e-9 * 20e-3);
  CHECK(largest > 100);
}

TEST_CASE("sweeps give up where more are to be expected than they are worth, and only there" *
          doctest::test_suite("optimised")) {
  const std::string text = ground(6, 200, "deformable", 1e6);
  for (const bool soft : {true, false}) {
    std::string other = text;
    if (!soft)  // joints without any stiffness: no place for the other solver
      for (const std::string key : {"normal_stiffness", "shear_stiffness"}) {
        const size_t begin = other.find(key);
        other.erase(begin, other.find('\n', begin) - begin);
      }
    Findings findings("case.toml", other);
    Scene scene = prepare_run("case.toml", other, {}, findings).scene;
    State state = start_state(scene);
    StepSettings settings;
    settings.implicit = true, settings.tolerance = 1e-9;
    StepWork work;
    work.clock.dynamic = false;
    const StepReport report = kick(scene, settings, 0.1, work, state);
    if (soft) CHECK(report.method == SolverKind::kPrimalNewton);
    CHECK(work.profile.sweeps > 0);
    CHECK((work.profile.sweeps <= 400) == soft);
  }
}

}  // namespace test_primal_newton
