// Monitors: motion against something else, convergence of two points, peak velocity.

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/run_case.h"
#include "support/told.h"
#include "support/tolerance.h"
#include "talus/base/error.h"
#include "talus/base/text_file.h"

namespace test_monitors {

using namespace talus;
using namespace talus::test;

namespace {

// Two blocks without forces that fly apart from a third, which stands still; a fourth spins.
const std::string kFlight = R"(talus = 1
[material.rock]
density = 2000
[joint.glue]
kind = "bonded"
[[block]]
name = "left"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "rock"
kind = "rigid"
velocity = [-1, 0]
[[block]]
name = "right"
polygon = [[3, 0], [4, 0], [4, 3], [3, 3]]
material = "rock"
kind = "rigid"
velocity = [2, 1]
[[block]]
name = "still"
polygon = [[0, 5], [1, 5], [1, 6], [0, 6]]
material = "rock"
kind = "rigid"
[[support]]
name = "base"
edge = [[0, 5], [1, 5]]
[[grid]]
name = "pair"
min = [0, 10]
max = [2, 11]
cells = [2, 1]
material = "rock"
joint = "glue"
kind = "rigid"
velocity = [0, 3]
[[stage]]
name = "first"
kind = "dynamic"
duration = 0.1
time_step = 1e-3
[[stage]]
name = "second"
kind = "dynamic"
duration = 0.1
time_step = 1e-3
)";

std::string monitor_refusal(const std::string& monitor) {
  return refusal(kFlight + "[[monitor]]\nname = \"m\"\n" + monitor);
}

}  // namespace

TEST_CASE("monitors: displacement and velocity against a support, a point, a group") {
  const CaseResult r = run_case(kFlight + R"([[monitor]]
name = "base"
point = [3.5, 1]
relative_to = "base"
[[monitor]]
name = "point"
point = [3.5, 1]
relative_to_point = [0.5, 0.5]
[[monitor]]
name = "points"
point = [3.5, 1]
relative_to_points = [[0.5, 0.5], [3.5, 1.5]]
[[monitor]]
name = "group"
point = [3.5, 1]
relative_to = "pair"
)");
  const auto last = [&r](const char* column) { return r.column(column).back(); };
  check_close("monitor against a support [m]", last("base.displacement_x"), 0.4, 1e-12, 1e-14);
  check_close("monitor against a point, along x [m]", last("point.displacement_x"), 0.6, 1e-12, 1e-14);
  check_close("monitor against a point [m/s]", last("point.velocity_x"), 3, 1e-12, 1e-14);
  check_close("monitor against the mean of points, along x [m]", last("points.displacement_x"), 0.3, 1e-12,
              1e-14);
  check_close("monitor against a group, along y [m]", last("group.displacement_y"), -0.4, 1e-12, 1e-14);
}

TEST_CASE("monitors: convergence is the change of a distance, counted from the last reset") {
  const std::string monitor = "[[monitor]]\nname = \"c\"\nconvergence = [[0.5, 0.5], [3.5, 1.5]]\n";
  const auto distance = [](double t) { return std::hypot(3 + 3 * t, 1 + t); };
  const CaseResult r = run_case(kFlight + monitor);
  check_close("convergence of blocks that part [m]", r.column("c.convergence").back(),
              -(distance(0.2) - distance(0)), 1e-12, 1e-14);
  const CaseResult again = run_case(kFlight + monitor, {"stage.second.reset_displacements=true"});
  check_close("convergence since the reset [m]", again.column("c.convergence").back(),
              -(distance(0.2) - distance(0.1)), 1e-12, 1e-13);
}

TEST_CASE("monitors: the peak velocity is kept between rows, and told in the summary") {
  const std::string text = kFlight + R"([history.push]
time = [0, 0.001, 0.002, 1]
value = [0, 3e6, 0, 0]
[[load]]
name = "push"
point = [3.5, 1.5]
force_x = "push"
[[load]]
name = "back"
point = [3.5, 1.5]
force_x = "back"
[history.back]
time = [0, 0.005, 0.006, 0.007, 1]
value = [0, 0, -3e6, 0, 0]
[[monitor]]
name = "p"
point = [3.5, 1.5]
[output]
history_interval = 0.1
)";
  const auto folder = std::filesystem::temp_directory_path() / ("talus_monitors_" + std::to_string(getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  Findings findings("model.toml", text);
  PreparedRun run = prepare_run("model.toml", text, {}, findings);
  State state = start_state(run.scene);
  {
    Recorder recorder(run.scene, ResultFolder(folder, false));
    const RunResult result = run_stages(run.scene, run.plans, state, recorder);
    recorder.finish(result);
  }
  const auto j = nlohmann::json::parse(read_text_file((folder / "summary.json").string()));
  // 3 MN for one step of 1 ms on 6000 kg: 0.5 m/s on top of 2 m/s, and 1 m/s along y
  check_close("peak velocity [m/s]", j["monitors"]["p"]["peak_velocity [m/s]"].get<double>(),
              std::hypot(2.5, 1), 1e-12, 1e-14);
  std::filesystem::remove_all(folder);
}

TEST_CASE("wrong monitors are found before the first step") {
  const auto told = [](const std::string& monitor, const std::vector<std::string>& pieces) {
    const std::string text = monitor_refusal(monitor);
    INFO(text);
    for (const std::string& piece : pieces) CHECK(text.find(piece) != std::string::npos);
  };
  told("point = [2.75, 0.5]\n", {"(2.75, 0.5) lies outside", "\"right\", is 0.25 m away"});
  told("block = \"pair\"\n", {"\"pair\" is 2 blocks, not one", "\"pair[0,0]\""});
  told("contact = [\"left\", \"rigth\"]\n", {"did you mean \"right\"?"});
  told("point = [3.5, 1]\nrelative_to = \"bass\"\n", {"monitor.m.relative_to", "did you mean \"base\"?"});
  told("point = [3.5, 1]\nrelative_to_point = [9, 9]\n", {"(9, 9) lies outside every block"});
  told("point = [3.5, 1]\nrelative_to = \"base\"\nrelative_to_point = [0.5, 0.5]\n",
       {"relative to two things"});
  told("point = [3.5, 1]\nrelative_to_points = [[0.5, 0.5], [9, 9]]\n", {"(9, 9) lies outside every block"});
  told("point = [3.5, 1]\nrelative_to_points = [[0.5, 0.5]]\n", {"needs two points or more"});
  told("block = \"left\"\nrelative_to = \"base\"\n", {"belong to point"});
  told("convergence = [[0.5, 0.5], [0.5, 0.5]]\n", {"two different points"});
  told("convergence = [[0.5, 0.5], [2, 0.5]]\n", {"(2, 0.5) lies outside every block"});
}

}  // namespace test_monitors
