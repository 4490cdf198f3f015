// Dynamic steps that no solver solves are taken in parts.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "support/run_case.h"
#include "talus/step/step.h"

namespace test_parts {

using namespace talus;
using namespace talus::test;

namespace {

// Stones that fall onto a floor and on each other.
std::string falling(const std::string& solver) {
  std::string text =
      "talus = 1\n[model]\ngravity = [0, -9.81]\n[material.m]\ndensity = 2500\n[joint.j]\nfriction_angle = \"35 deg\"\n"
      "[contact]\njoint = \"j\"\n[[block]]\nname = \"floor\"\npolygon = [[-9,-1],[9,-1],[9,0],[-9,0]]\nmaterial = \"m\"\n"
      "kind = \"fixed\"\n";
  for (int k = 0; k < 12; ++k) {
    const double x = 1.05 * (k % 3) + 0.3 * (k / 3), y = 0.02 + 0.55 * (k / 3);
    text += fmt::format(
        "[[block]]\nname = \"b{}\"\npolygon = [[{},{}],[{},{}],[{},{}],[{},{}]]\nmaterial = \"m\"\nkind = \"rigid\"\n",
        k, x, y, x + 1, y + 0.03, x + 0.95, y + 0.5, x + 0.1, y + 0.5);
  }
  return text +
         "[[stage]]\nname = \"fall\"\nkind = \"dynamic\"\nduration = \"0.5 s\"\ntime_step = \"2 ms\"\n[solver]\n" +
         solver;
}

RunResult run(const std::string& text, double& end) {
  Findings findings("m.toml", text);
  PreparedRun p = prepare_run("m.toml", text, {}, findings);
  State state = start_state(p.scene);
  MemoryObserver observer(p.scene, nullptr);
  const RunResult result = run_stages(p.scene, p.plans, state, observer);
  end = state.time;
  return result;
}

}  // namespace

TEST_CASE("steps in parts: what no solver solves is solved in shorter steps" *
          doctest::test_suite("optimised")) {
  // round-off leaves more than 2e-19 m in some steps of 2 ms: of velocities, which in half the step is half of that
  const std::string sharp = "tolerance = 3e-19\nlimit = 3e-19\non_failure = \"continue\"\n";
  double end = 0;
  const RunResult r = run(falling(sharp), end);
  CHECK(r.failure == "");
  CHECK(r.cut_steps > 5);
  CHECK(r.parts > 2 * r.cut_steps - 1);
  CHECK(r.failed_steps == 0);
  CHECK(end == 0.5);
  CHECK(r.steps == 251 - r.cut_steps + r.parts);
  CHECK(r.closure() < 1e-12);
  MESSAGE(r.cut_steps, " steps in ", r.parts, " parts");
  // what no step solves ends as before, at the shortest
  double stopped = 0;
  const std::string never = "tolerance = 1e-300\nlimit = 1e-300\nmax_sweeps = 50\n";
  CHECK(run(falling(never), stopped).failure.find("were not solved") != std::string::npos);
}

TEST_CASE("steps in parts: a step that is not taken leaves the state as it was") {
  const std::string text = falling("");
  Findings findings("m.toml", text);
  const PreparedRun p = prepare_run("m.toml", text, {}, findings);
  State once = start_state(p.scene);
  StepSettings settings;
  settings.tolerance = settings.limit = 1e-9;
  StepWork work;
  for (int k = 0; k < 100; ++k) {
    StepReport report = kick(p.scene, settings, 1e-3, work, once);
    drift(p.scene, once.time + 1e-3, work, once, report);
  }
  State twice = once;
  StepWork other;
  StepSettings out_of_reach = settings;
  out_of_reach.tolerance = out_of_reach.limit = 1e-300, out_of_reach.may_shorten = true;
  const StepReport untaken = kick(p.scene, out_of_reach, 1e-3, other, twice);
  REQUIRE(!untaken.taken);
  for (size_t i = 0; i < once.rate.size(); ++i)
    CHECK(norm(once.rate[i].a - twice.rate[i].a) + norm(once.rate[i].G - twice.rate[i].G) == 0);
  kick(p.scene, settings, 1e-3, work, once), kick(p.scene, settings, 1e-3, other, twice);
  REQUIRE(once.patches.size() == twice.patches.size());
  double most = 0;
  for (size_t k = 0; k < once.patches.size(); ++k)
    for (const size_t end : {0U, 1U}) {
      const Patch &a = once.patches[k], &b = twice.patches[k];
      CHECK(std::abs(a.closure[end] - b.closure[end]) == 0);
      CHECK(std::abs(a.slip[end] - b.slip[end]) < 1e-12);
      CHECK(std::abs(a.stretch[end] - b.stretch[end]) < 1e-12);
      most = std::max(most, std::abs(a.force[end][0] - b.force[end][0]));
    }
  // to the tolerance of the solver, 1e-9 m in a step of stones of a ton
  CHECK(most < 2e3 * 1e-9 / (1e-3 * 1e-3));
}

}  // namespace test_parts
