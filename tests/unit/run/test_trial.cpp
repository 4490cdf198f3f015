// The trial of a run's first steps. (How well it foretells times is no test: benchmarks/foretold.py.)

#include "talus/run/trial.h"

#include <doctest/doctest.h>

#include "support/told.h"

using namespace talus;

TEST_CASE("trial steps: a cost for every stage, one that rests at once too, and the run as it was") {
  const std::string text = R"(talus = 1
[model]
gravity = [0, -9.81]
[material.rock]
density = 2700
young = "20 GPa"
poisson = 0.25
[joint.face]
friction_angle = "35 deg"
[contact]
joint = "face"
[[block]]
name = "floor"
polygon = [[-5, -1], [5, -1], [5, 0], [-5, 0]]
material = "rock"
kind = "fixed"
[[block]]
name = "stone"
polygon = [[0, 0.5], [1, 0.5], [1, 1.5], [0, 1.5]]
material = "rock"
[[stage]]
name = "fall"
kind = "dynamic"
duration = "1 s"
[[stage]]
name = "short"
kind = "dynamic"
duration = "1 us"
)";
  Findings findings("model.toml", text);
  const PreparedRun run = prepare_run("model.toml", text, {}, findings);
  const std::vector<double> cost = time_steps(run, 0.02, 1);
  REQUIRE(cost.size() == 2);
  CHECK(cost[0] > 0);
  CHECK(cost[1] == cost[0]);  // too short to be measured
  CHECK(run.scene.model.stages.size() == 2);
}
