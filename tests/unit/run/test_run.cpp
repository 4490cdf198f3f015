// Stages, plans, damping, window means, predictions: the parts of a run that have an exact answer.

#include <unistd.h>

#include <filesystem>

#include "support/relative.h"
#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/base/text_file.h"
#include "talus/results/prediction.h"
#include "talus/run/plan.h"

namespace test_run {

using namespace talus;
using namespace talus::test;

namespace {

// A rigid block of 2000 kg on its own, thrown along x.
std::string thrown(const std::string& stage) {
  return R"(
talus = 1
[material.m]
density = 2000
[[block]]
name = "b"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "m"
kind = "rigid"
velocity = [2, 0]
[[monitor]]
name = "p"
point = [0.5, 0.5]
)" + stage;
}

}  // namespace

TEST_CASE("mass-proportional damping slows a free block as exp(-a t)") {
  const CaseResult r = run_case(
      thrown("[[stage]]\nname='s'\nkind='dynamic'\nduration=1\ntime_step=0.001\ndamping_mass='3 1/s'\n"));
  // centred in time: (1 - a dt/2)/(1 + a dt/2) a step, error a^3 dt^2 t/12 = 2e-6; half a step late at the
  // end
  const auto& v = r.column("p.velocity_x");
  const double exact = 2 * std::exp(-3.0 * 1);
  check_close("mass damping, velocity after 1 s", v.back(), exact, 2e-5, 1e-6);
  check_below("mass damping, energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("local damping leaves a block in uniform motion alone and opposes a force by its share") {
  const CaseResult alone = run_case(
      thrown("[[stage]]\nname='s'\nkind='dynamic'\nduration=1\ntime_step=0.01\ndamping_local=0.5\n"));
  CHECK(alone.column("p.velocity_x").back() == approx(2).epsilon(1e-12));
  // falling from rest: the first step starts, then half the weight acts
  const CaseResult fall = run_case(thrown("[model]\ngravity=[0,-10]\n[[stage]]\nname='s'\nkind='dynamic'"
                                          "\nduration=1\ntime_step=0.001\ndamping_local=0.5\n"),
                                   {"block.b.velocity=[0,0]"});
  check_close("local damping, fall with half the weight, velocity after 1 s",
              fall.column("p.velocity_y").back(), -5, 2e-3, 1e-3);
}

TEST_CASE("stages follow each other with their own steps and end exactly on their ends") {
  const CaseResult r = run_case(
      thrown("[model]\ngravity=[0,-10]\n[[stage]]\nname='a'\nkind='dynamic'\nduration=0.3\ntime_step=0.007\n"
             "[[stage]]\nname='b'\nkind='dynamic'\nduration=0.7\ntime_step=0.0031\n"));
  REQUIRE(r.run.stages.size() == 2);
  CHECK(r.run.stages[0].end == 0.3);
  CHECK(r.run.stages[1].end == approx(1).epsilon(1e-15));
  CHECK(r.run.stages[0].steps == 43);
  // constant acceleration stays exact across the change of step
  CHECK(r.column("p.displacement_y").back() == approx(-5).epsilon(1e-12));
}

TEST_CASE("a support with a velocity history moves its point by the integral of the history") {
  const CaseResult r = run_case(thrown(R"(
[history.v]
time = [0, 0.5, 1]
value = [0, 4, 0]
[[support]]
name = "hand"
point = [0.5, 0.5]
x = { velocity = "v" }
y = { displacement = "v" }
[[stage]]
name = "s"
kind = "dynamic"
duration = 1
time_step = 0.01
)"),
                                {"block.b.velocity=[0,0]"});
  CHECK(r.column("p.displacement_x").back() == approx(2).epsilon(1e-12));
  const auto &t = r.column("t [s]"), &y = r.column("p.displacement_y");
  for (size_t i = 0; i < t.size(); ++i)
    CHECK(y[i] == approx(t[i] < 0.5 ? 8 * t[i] : 8 * (1 - t[i])).epsilon(1e-9));
}

TEST_CASE("a driven block pushes a free one, and the work shows as support work") {
  const CaseResult r = run_case(R"(
talus = 1
[material.m]
density = 1000
[history.v]
time = [0, 1]
value = [0, 1]
[[block]]
name = "ram"
polygon = [[-1, 0], [0, 0], [0, 1], [-1, 1]]
material = "m"
kind = "driven"
motion_x = { velocity = "v" }
[[block]]
name = "load"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "m"
kind = "rigid"
[[stage]]
name = "s"
kind = "dynamic"
duration = 1
time_step = 0.01
[[monitor]]
name = "f"
contact = ["load", "ram"]
window = 0.1
[[monitor]]
name = "p"
point = [0.5, 0.5]
)");
  // 1000 kg at 1 m/s2
  const auto& f = r.column("f.force_x");
  CHECK(f[50] == approx(1000).epsilon(1e-9));
  CHECK(r.column("f.mean_force_x")[50] == approx(1000).epsilon(1e-9));
  CHECK(r.column("f.impulse_x").back() == approx(1000 * 0.995).epsilon(1e-2));
  CHECK(r.column("p.displacement_x").back() == approx(0.5).epsilon(1e-9));
  CHECK(r.run.energy.work[Cause::kSupports] == approx(500).epsilon(0.02));
  check_below("driven block, energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("window means: a centred mean of the force, cut at the start and at the end of the run") {
  // one rigid block set on a fixed floor, neither gives: a weight of 1000 N from the first step on
  const CaseResult r = run_case(R"(
talus = 1
[contact]
stiffness = "none"
[model]
gravity = [0, -1]
[material.m]
density = 1000
[[block]]
name = "floor"
polygon = [[-1, -1], [2, -1], [2, 0], [-1, 0]]
material = "m"
kind = "fixed"
[[block]]
name = "b"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "m"
kind = "rigid"
[[stage]]
name = "s"
kind = "dynamic"
duration = 1
time_step = 0.01
[[monitor]]
name = "f"
contact = ["b", "floor"]
window = 0.2
)");
  const auto &t = r.column("t [s]"), &mean = r.column("f.mean_force_y"), &raw = r.column("f.force_y");
  for (size_t i = 0; i < t.size(); ++i) {
    CHECK(raw[i] == approx(1000).epsilon(1e-9));
    // before t = 0.1 the window reaches before the start, where there was no force
    const double exact = t[i] < 0.1 ? 1000 * (t[i] + 0.1) / 0.2 : 1000;
    CHECK(mean[i] == approx(exact).epsilon(1e-9));
  }
}

TEST_CASE("a static stage that cannot come to rest fails with its name") {
  const std::string text = thrown(
      "[model]\ngravity=[0,-10]\n[[stage]]\nname='wait'\nkind='static'\nduration=1\ntime_step=0.01\nintegration='dynamic'\n");
  Findings findings("m", text);
  PreparedRun p = prepare_run("m", text, {}, findings);
  State state = start_state(p.scene);
  MemoryObserver observer(p.scene, nullptr);
  const RunResult r = run_stages(p.scene, p.plans, state, observer);
  CHECK(r.failure.find("static stage \"wait\" did not come to rest in 1 s (100 steps)") != std::string::npos);
}

TEST_CASE("moment clamp: planned, counted, refused when it would change every block") {
  std::string text = R"(
talus = 1
[material.m]
density = 2500
young = "5 GPa"
poisson = 0.25
)";
  for (int i = 0; i < 40; ++i)
    text += fmt::format("[[block]]\nname=\"b{0}\"\npolygon=[[{1},0],[{2},0],[{2},1],[{1},1]]\nmaterial='m'\n",
                        i, 2 * i, i == 7 ? 2 * i + 0.02 : 2 * i + 1);
  text += "[[stage]]\nname='s'\nkind='dynamic'\nduration='10 ms'\ntime_step='0.1 ms'\nmoment_clamp=true\n";
  Findings findings("m", text);
  PreparedRun p = prepare_run("m", text, {}, findings);
  CHECK(p.plans[0].clamped == 1);
  CHECK(p.plans[0].largest_clamp > 10);
  State state = start_state(p.scene);
  MemoryObserver observer(p.scene, nullptr);
  const RunResult r = run_stages(p.scene, p.plans, state, observer);
  CHECK(r.failure == "");
  CHECK(p.scene.blocks.clamped == 1);

  Findings refused("m", text);
  CHECK_THROWS_WITH_AS(prepare_run("m", text, {"stage.s.time_step=2 ms"}, refused),
                       doctest::Contains("the moment clamp would change the model, not its slivers"),
                       InputError);
}

TEST_CASE("a step that misses the limit ends the run or is counted, as the policy says") {
  const std::string text = thrown(
      "[solver]\nmax_iterations=1\ntolerance=1e-14\n[[block]]\nname='c'\npolygon=[[1,0.1],[2,0],[2,1],[1,1.1]"
      "]\nmaterial='m'\nkind='rigid'\n"
      "[[stage]]\nname='s'\nkind='dynamic'\nduration=0.5\ntime_step=0.01\n");
  Findings findings("m", text);
  PreparedRun p = prepare_run("m", text, {"solver.tolerance=1e-300", "solver.limit=1e-300"}, findings);
  State state = start_state(p.scene);
  MemoryObserver observer(p.scene, nullptr);
  const RunResult stopped = run_stages(p.scene, p.plans, state, observer);
  CHECK(stopped.failure.find("the contact equations were not solved") != std::string::npos);
  CHECK(stopped.failure.find("1 iteration of newton, ") != std::string::npos);
  CHECK(stopped.failure.find(" of pivoting, allowed") != std::string::npos);
  CHECK(stopped.failure.find("contact ") != std::string::npos);  // the row is named
  CHECK(stopped.failure.find("a wider solver.limit may help") != std::string::npos);
  CHECK(stopped.loose_steps == 0);

  PreparedRun q = prepare_run(
      "m", text, {"solver.tolerance=1e-300", "solver.limit=1e-300", "solver.on_failure=continue"}, findings);
  State again = start_state(q.scene);
  MemoryObserver watcher(q.scene, nullptr);
  const RunResult counted = run_stages(q.scene, q.plans, again, watcher);
  CHECK(counted.failure == "");
  CHECK(counted.failed_steps > 0);
  CHECK(counted.loose_steps == 0);
}

TEST_CASE("the predicted output size is that of the run within a tenth") {
  const std::string text =
      read_text_file(std::string(TALUS_SOURCE_DIR) + "/examples/impact_bar/impact_bar.toml");
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("talus_predict_{}", getpid());
  for (const char* cells : {"grid.bar.cells=[10,1]", "grid.bar.cells=[40,1]"}) {
    Findings findings("m", text);
    PreparedRun p = prepare_run("m", text, {cells}, findings);
    const double predicted = predict(p.scene, p.plans).output;
    Recorder recorder(p.scene, ResultFolder(folder, true));
    State state = start_state(p.scene);
    const RunResult r = run_stages(p.scene, p.plans, state, recorder);
    recorder.finish(r);
    double written = 0;
    for (const auto& e : std::filesystem::recursive_directory_iterator(folder))
      if (e.is_regular_file()) written += static_cast<double>(e.file_size());
    CAPTURE(predicted);
    CHECK(predicted / written == approx(1).epsilon(0.1));
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("joints.csv, the summary and the frames tell slip, opening and state of each point") {
  const std::string text =
      read_text_file(std::string(TALUS_SOURCE_DIR) + "/examples/rough_joint/rough_joint.toml");
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("talus_joints_{}", getpid());
  Findings findings("m", text);
  PreparedRun p = prepare_run("m", text, {}, findings);
  Recorder recorder(p.scene, ResultFolder(folder, true));
  State state = start_state(p.scene);
  const RunResult r = run_stages(p.scene, p.plans, state, recorder);
  REQUIRE(r.failure.empty());
  recorder.finish(r);
  // two ends of the face after "press", two contacts after "shear"
  const std::string joints = read_text_file((folder / "joints.csv").string());
  CHECK(std::count(joints.begin(), joints.end(), '\n') == 5);
  CHECK(joints.find("\npress,") != std::string::npos);
  CHECK(joints.find(",face 0 end 1,lower,upper,rough,") != std::string::npos);
  CHECK(joints.find(",intact\n") < joints.find(",slipped\n"));
  CHECK(joints.rfind(",slipped\n") == joints.size() - 9);
  const std::string summary = read_text_file((folder / "summary.json").string());
  for (const char* part :
       {"\"points\": 2", "\"intact\": 0", "\"slipped\": 2", "\"open\": 0", "\"slip_largest_at\""}) {
    INFO(summary);
    CHECK(summary.find(part) != std::string::npos);
  }
  std::string last;
  for (const auto& e : std::filesystem::directory_iterator(folder / "fields"))
    if (e.path().extension() == ".vtp") last = std::max(last, e.path().string());
  const std::string frame = read_text_file(last);
  for (const char* name :
       {"\"accumulated slip [m]\"", "\"residual slip [m]\"", "\"opening [m]\"", "\"state\""})
    CHECK(frame.find(name) != std::string::npos);
  std::filesystem::remove_all(folder);
}

}  // namespace test_run
