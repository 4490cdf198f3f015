// The trial of a run's first steps. (How well it foretells times is no test: benchmarks/foretold.py.)

#include "talus/run/trial.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "support/told.h"

namespace test_trial {

using namespace talus;
using namespace talus::test;

// A dry wall of rigid blocks. @param joint  more keys of its joint
static std::string wall_text(int courses, const std::string& joint) {
  return fmt::format(R"(talus = 1
[model]
gravity = [0, -9.81]
[material.rock]
density = 2700
[joint.face]
friction_angle = "35 deg"
{1}[contact]
joint = "face"
[[block]]
name = "floor"
polygon = [[-1, -1], [7, -1], [7, 0], [-1, 0]]
material = "rock"
kind = "fixed"
[[grid]]
name = "wall"
min = [0, 0]
max = [6, {0}]
cells = [6, {0}]
material = "rock"
joint = "face"
kind = "rigid"
)",
                     courses, joint);
}

TEST_CASE("trial steps: a cost for every stage, one that rests at once too, and the run as it was") {
  const std::string text =
      kShakenBlock + "[[stage]]\nname = \"short\"\nkind = \"dynamic\"\nduration = \"1 us\"\n";
  Findings findings("model.toml", text);
  const PreparedRun run = prepare_run("model.toml", text, {}, findings);
  const std::vector<StageCost> cost = time_stages(run, 0.02, 1, 5000);
  REQUIRE(cost.size() == 2);
  CHECK(cost[0].step > 0);
  CHECK(cost[0].low < cost[0].high);
  CHECK(cost[1].high > 0);  // of one step
  CHECK(!cost[0].at_least);
  CHECK(run.scene.model.stages.size() == 2);
}

TEST_CASE(
    "trial steps: a static stage that comes to its rest is known, one that does not in the time has a range") {
  const std::string text =
      wall_text(5, "normal_stiffness = \"10 GPa/m\"\nshear_stiffness = \"5 GPa/m\"\n") + R"([[stage]]
name = "settle"
kind = "static"
duration = "10 s"
[[stage]]
name = "shake"
kind = "dynamic"
duration = "1 s"
)";
  Findings findings("model.toml", text);
  const PreparedRun run = prepare_run("model.toml", text, {}, findings);
  const std::vector<StageCost> cost = time_stages(run, 5, 1, 5000);
  REQUIRE(cost.size() == 2);
  CHECK(cost[0].steps_to_rest > 1);
  CHECK(cost[0].steps_to_rest < 100);
  CHECK(cost[0].low == cost[0].high);
  CHECK(cost[1].steps_to_rest == 0);
  CHECK(cost[1].ended);  // within the five seconds
  CHECK(cost[1].low == cost[1].high);
  // a few steps of damped motion are no rest
  std::string slow = text;
  slow.replace(slow.find("kind = \"static\""), 15, "kind = \"static\"\nintegration = \"dynamic\"");
  const std::vector<StageCost> hasty = time_stages(prepare_run("model.toml", slow, {}, findings), 0, 1, 5000);
  CHECK(hasty[0].steps_to_rest == 0);
  CHECK(hasty[0].low < hasty[0].high);
}

TEST_CASE("trial steps: a step that the solver does not get through ends soon, and is told") {
  // a hard wall asks for more sweeps than there may be at this tolerance
  const std::string text = wall_text(30, "") + R"([solver]
method = "gauss_seidel"
tolerance = 1e-14
max_sweeps = 50
[[stage]]
name = "stand"
kind = "dynamic"
duration = "1 s"
time_step = "1 ms"
)";
  Findings findings("model.toml", text);
  const std::vector<StageCost> cost = time_stages(prepare_run("model.toml", text, {}, findings), 0.02, 1, 0);
  REQUIRE(cost.size() == 1);
  CHECK(cost[0].step > 0);
  CHECK(cost[0].at_least);
}

}  // namespace test_trial
