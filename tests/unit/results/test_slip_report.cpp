// slips.csv: the joints that have slipped at the end of each stage, greatest first.

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "support/relative.h"
#include "support/run_case.h"
#include "talus/base/text_file.h"
#include "talus/results/progress.h"
#include "talus/talus.h"

namespace test_slip_report {

using namespace talus;

namespace {

// Rigid slabs on a floor, each pushed at a corner: "far" by 3 mm in the first stage; "back" by 1 mm in the
// first stage and back to 0.4 mm in the second; the upper half of "cut" by 2 mm in the second, on its fault.
// All gently, so that no corner is lifted by a jolt: where nothing presses nothing slips.
const char* kModel = R"(talus = 1
[model]
gravity = [0, -10]
[material.rock]
density = 2500
[joint.face]
friction_angle = "30 deg"
[contact]
joint = "face"
stiffness = "none"
[[block]]
name = "floor"
polygon = [[-1, -1], [20, -1], [20, 0], [-1, 0]]
material = "rock"
kind = "fixed"
[[block]]
name = "back"
polygon = [[0, 0], [2, 0], [2, 1], [0, 1]]
material = "rock"
kind = "rigid"
[[block]]
name = "far"
polygon = [[4, 0], [6, 0], [6, 1], [4, 1]]
material = "rock"
kind = "rigid"
[[block]]
name = "still"
polygon = [[8, 0], [10, 0], [10, 1], [8, 1]]
material = "rock"
kind = "rigid"
[[region]]
name = "cut"
polygon = [[12, 0], [16, 0], [16, 2], [12, 2]]
material = "rock"
kind = "rigid"
[[fault]]
name = "seam"
points = [[12, 1], [16, 1]]
[history.back]
expression = "t < 0.08 ? 0.5e-3*(1-cos(_pi*t/0.08)) : t < 0.11 ? 1e-3 : t < 0.18 ? 1e-3-0.3e-3*(1-cos(_pi*(t-0.11)/0.07)) : 0.4e-3"
duration = 0.2
[history.far]
expression = "t < 0.08 ? 1.5e-3*(1-cos(_pi*t/0.08)) : 3e-3"
duration = 0.2
[history.cut]
expression = "t < 0.11 ? 0 : t < 0.18 ? 1e-3*(1-cos(_pi*(t-0.11)/0.07)) : 2e-3"
duration = 0.2
[[support]]
name = "back"
point = [0, 1]
x = { displacement = "back" }
y = "free"
[[support]]
name = "far"
point = [4, 1]
x = { displacement = "far" }
y = "free"
[[support]]
name = "cut"
point = [12, 2]
x = { displacement = "cut" }
y = "free"
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

struct Listed {
  std::string stage, block_a, block_b, set, joint;
  double residual, slip;
  std::string state;
};

std::vector<Listed> rows_of(const std::string& csv) {
  std::vector<Listed> out;
  for (size_t at = csv.find('\n') + 1; at < csv.size(); at = csv.find('\n', at) + 1) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (size_t i = at; csv[i] != '\n'; ++i) {
      if (csv[i] == '"')
        quoted = !quoted;
      else if (csv[i] == ',' && !quoted)
        cells.emplace_back();
      else
        cells.back() += csv[i];
    }
    REQUIRE(cells.size() == 14);
    out.push_back({cells[0], cells[2], cells[3], cells[4], cells[5], std::stod(cells[8]), std::stod(cells[9]),
                   cells[13]});
  }
  return out;
}

}  // namespace

TEST_CASE("slips.csv: joints that have slipped, greatest residual slip first, the closing lines tell it") {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("talus_slips_{}", getpid());
  Findings findings("m", kModel);
  PreparedRun p = prepare_run("m", kModel, {}, findings);
  Recorder recorder(p.scene, ResultFolder(folder, true));
  State state = start_state(p.scene);
  const RunResult r = run_stages(p.scene, p.plans, state, recorder);
  REQUIRE(r.failure.empty());
  recorder.finish(r);

  struct Expected {
    const char *stage, *block, *set;
    double residual, slip;  // [m]
  };
  const Expected expected[] = {{"first", "far", "", 3e-3, 3e-3},
                               {"first", "back", "", 1e-3, 1e-3},
                               {"second", "far", "", 3e-3, 3e-3},
                               {"second", "cut[1]", "seam", 2e-3, 2e-3},
                               {"second", "back", "", 0.4e-3, 1.6e-3}};
  const std::vector<Listed> rows = rows_of(read_text_file((folder / "slips.csv").string()));
  REQUIRE(rows.size() == std::size(expected));
  for (size_t i = 0; i < rows.size(); ++i) {
    INFO(i, ": ", rows[i].block_a, " ", rows[i].block_b);
    CHECK(rows[i].stage == expected[i].stage);
    CHECK((rows[i].block_a == expected[i].block || rows[i].block_b == expected[i].block));
    CHECK(rows[i].set == expected[i].set);
    CHECK(rows[i].joint == "face");
    // rigid blocks in hard joints that give nothing: slip is the way they were pushed, to the solver's tolerance (1e-8 m)
    CHECK(rows[i].residual == test::approx(expected[i].residual).epsilon(1e-5));
    CHECK(rows[i].slip == test::approx(expected[i].slip).epsilon(1e-5));
    CHECK(rows[i].state == "slipped");
  }

  const std::string summary = read_text_file((folder / "summary.json").string());
  INFO(summary);
  CHECK(summary.find("\"slipped_joints\": 3,") != std::string::npos);
  CHECK((summary.find("\"residual_slip_largest [m]\": 0.0030") != std::string::npos ||
         summary.find("\"residual_slip_largest [m]\": 0.002999") != std::string::npos));
  const std::string closing = closing_text(p.scene, r, recorder.joints(), recorder.bolts(), "out");
  INFO(closing);
  CHECK(closing.find("3 joints, residual slip 0.003 m at most: ") != std::string::npos);
  CHECK(closing.find("far") != std::string::npos);
  CHECK(closing.find("slips.csv") != std::string::npos);
  std::filesystem::remove_all(folder);
}

namespace {

// Thrown up at 1 m/s and along at 0.5 m/s, a stone comes down 0.2 s later, 0.1 m on, and slides to rest.
const std::string kThrown = R"(talus = 1
[model]
gravity = [0, -10]
[material.rock]
density = 2500
[joint.face]
friction_angle = "45 deg"
[contact]
joint = "face"
[[block]]
name = "floor"
polygon = [[-1, -1], [20, -1], [20, 0], [-1, 0]]
material = "rock"
kind = "fixed"
[[block]]
name = "stone"
polygon = [[0, 0], [4, 0], [4, 1], [0, 1]]
material = "rock"
kind = "rigid"
velocity = [0.5, 1]
[[stage]]
name = "go"
kind = "dynamic"
duration = 0.6
time_step = 1e-3
)";

}  // namespace

TEST_CASE("slips: what a block went while it was off its joint is left of the slip too") {
  std::vector<FramePoint> points;
  double gone = 0;
  const test::CaseResult r = test::run_case(kThrown, {}, [&](const Instant& i) {
    points = frame_points(i.scene, i);
    gone = i.state.displacement[1].x;
  });
  CHECK(gone > 0.0999);
  int closed = 0;
  for (const FramePoint& p : points) {
    if (p.normal_force <= 0) continue;
    ++closed;
    CHECK(std::abs(p.slip_signed) == test::approx(gone).epsilon(1e-3));
    CHECK(p.slip < 0.5 * gone);  // on the joint
  }
  CHECK(closed > 0);
  // the summary says how much that is
  JointPoint p;
  p.slip = 0.02, p.slip_signed = -0.1;
  CHECK(p.slip_while_open() == test::approx(0.08).epsilon(1e-12));
  p.slip = 0.2;
  CHECK(p.slip_while_open() == 0);
}

TEST_CASE("slips: the block that moved most in metres is told beside the one that did for its size") {
  Findings findings("thrown.toml", kThrown);
  PreparedRun run = prepare_run("thrown.toml", kThrown, {}, findings);
  State state = start_state(run.scene);
  state.displacement[0] = {0, 0.4}, state.displacement[1] = {0, 0.3};  // 21 m2 and 4 m2
  JointSummary joints;
  joints.look(run.scene, state);
  const std::string closing = closing_text(run.scene, {}, joints, {}, "out");
  INFO(closing);
  CHECK(closing.find("moved most      floor, 0.4 m (8.7 % of its size), in metres") != std::string::npos);
  CHECK(closing.find("moved most      stone, 0.3 m (15 % of its size), for its size") != std::string::npos);
}

TEST_CASE("warnings: blocks that overlap by a twentieth of the thinner one are told") {
  Findings findings("thrown.toml", kThrown);
  const PreparedRun run = prepare_run("thrown.toml", kThrown, {}, findings);
  RunResult r;
  r.closed_row = "in each other";
  for (const auto& [share, told] : {std::pair(0.04, 0), std::pair(0.06, 1)}) {
    r.closed_share = share;
    CHECK(warnings_of(run.scene, r, {}, true).size() == static_cast<size_t>(told));
  }
}

TEST_CASE("slips: a corner that comes down where it never lay has no way through the air in its slip") {
  // a column that falls over: its head hits the floor far from where it was
  const std::string model = R"(talus = 1
[model]
gravity = [0, -10]
[material.rock]
density = 2500
[joint.face]
friction_angle = "40 deg"
[contact]
joint = "face"
[[block]]
name = "floor"
polygon = [[-2, -1], [9, -1], [9, 0], [-2, 0]]
material = "rock"
kind = "fixed"
[[block]]
name = "column"
polygon = [[-0.93969262, 0.34202014], [0, 0], [1.36808057, 3.75877048], [0.42838795, 4.10079062]]
material = "rock"
kind = "rigid"
[[stage]]
name = "go"
kind = "dynamic"
duration = 3
time_step = 1e-3
)";
  // 1 x 4 m, leans by 20 deg about its lower right corner, which stands on the floor
  std::vector<FramePoint> points;
  test::run_case(model, {}, [&](const Instant& i) { points = frame_points(i.scene, i); });
  double largest = 0;
  for (const FramePoint& p : points)
    if (p.normal_force > 0) largest = std::max(largest, std::abs(p.slip_signed));
  CHECK(points.size() > 1);
  CHECK(largest < 0.3);   // metres were told
  CHECK(largest < 0.06);  // the corner that it fell over has gone 0.048 m along the floor
}

}  // namespace test_slip_report
