// What stages change: excavation with relaxation, supports by stage, properties, displacements from zero.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "support/run_case.h"
#include "support/told.h"
#include "support/tolerance.h"
#include "talus/base/error.h"
#include "talus/output/vtk.h"

namespace test_stages {

using namespace talus;
using namespace talus::test;

namespace {

// A block of 2000 kg on a prop on fixed ground.
const std::string kProp = R"(talus = 1
[model]
gravity = [0, -10]
[material.rock]
density = 2000
young = "5 GPa"
poisson = 0.25
[joint.face]
friction_angle = "30 deg"
[contact]
joint = "face"
[[block]]
name = "ground"
polygon = [[-1, -1], [2, -1], [2, 0], [-1, 0]]
material = "rock"
kind = "fixed"
[[block]]
name = "prop"
polygon = [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]
material = "rock"
[[block]]
name = "load"
polygon = [[0, 0.5], [1, 0.5], [1, 1.5], [0, 1.5]]
material = "rock"
kind = "rigid"
[[monitor]]
name = "load"
point = [0.5, 1]
[[stage]]
name = "rest"
kind = "static"
duration = 1
elasticity = "explicit"    # a short step: what comes next begins half of it early
)";

const std::string kIncline = R"(talus = 1
[model]
gravity = [5, -8.660254037844386]
[material.rock]
density = 2000
[joint.face]
friction_angle = "40 deg"
[contact]
joint = "face"
[[block]]
name = "ground"
polygon = [[-10, -1], [10, -1], [10, 0], [-10, 0]]
material = "rock"
kind = "fixed"
[[block]]
name = "block"
polygon = [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]
material = "rock"
kind = "rigid"
[[monitor]]
name = "block"
point = [0.5, 0.25]
[[stage]]
name = "stick"
kind = "dynamic"
duration = 0.1
time_step = 1e-4
[[stage]]
name = "slide"
kind = "dynamic"
duration = 0.2
time_step = 1e-4
)";

size_t first_row(const CaseResult& r, size_t stage) {
  const auto& t = r.column("t [s]");
  size_t i = 0;
  while (t[i] < r.run.stages[stage].begin - 1e-9) ++i;
  return i;
}

}  // namespace

TEST_CASE("excavate: the load follows the share of its support that is gone") {
  const CaseResult r = run_case(kProp + R"([[stage]]
name = "go"
kind = "dynamic"
duration = 0.4
time_step = 1e-4
excavate = ["prop"]
relaxation = [[0, 0], ["0.4 s", 1]]
reset_displacements = true
)");
  // acceleration g t / T, so g t^3 / (6 T); central differences: dt^2 of it. The static stage leaves 1e-5 g
  const double fallen = 10 * 0.4 * 0.4 / 6;
  check_close("excavate: fall of the load [m]", -r.column("load.displacement_y").back(), fallen, 1e-3, 1e-4);
  const auto& y = r.column("load.displacement_y");
  check_below("excavate: displacement just before, counted anew [m]", std::abs(y[first_row(r, 1)]), 1e-15,
              0.0);
  check_below("excavate: energy left over / largest term", r.run.closure(), 1e-2, 1e-10);
}

TEST_CASE("excavate at once: free fall, and nothing is left to touch") {
  size_t contacts = 0, drawn = 0;
  const CaseResult r = run_case(kProp + R"([[stage]]
name = "go"
kind = "dynamic"
duration = 0.2
time_step = 1e-4
excavate = ["prop"]
reset_displacements = true
)",
                                {}, [&](const Instant& i) {
                                  if (i.stage == 0) return;
                                  contacts = std::max(contacts, i.state.patches.size());
                                  const std::string vtu =
                                      blocks_vtu(i.scene.blocks, i.state, i.work.rate_before);
                                  if (i.last) drawn = vtu.find("NumberOfCells=\"2\"");
                                });
  check_close("excavate at once: fall [m]", -r.column("load.displacement_y").back(), 0.2, 1e-3, 1e-4);
  CHECK(contacts == 0);
  CHECK(drawn != std::string::npos);
  check_below("excavate at once: energy left over / largest term", r.run.closure(), 1e-2, 1e-10);
}

TEST_CASE("a support that begins later holds where it meets the block and takes what the prop gives up") {
  const CaseResult r = run_case(kProp + R"([[support]]
name = "anchor"
edge = [[0, 1.5], [1, 1.5]]
stages = ["half", "all", "wait"]
[[monitor]]
name = "anchor"
support = "anchor"
[[stage]]
name = "half"
kind = "static"
time_step = 1e-4
duration = 1
excavate = ["prop"]
relaxation = [[0, 0], ["20 ms", 0.5]]
[[stage]]
name = "wait"
kind = "dynamic"
time_step = 1e-4
duration = "5 ms"
[[stage]]
name = "all"
kind = "static"
time_step = 1e-4
duration = 1
relaxation = [[0, 0.5], ["20 ms", 1]]
)");
  const auto &force = r.column("anchor.reaction_y"), &y = r.column("load.displacement_y");
  const size_t wait = first_row(r, 2);
  check_below("anchor before it acts [N]", std::abs(force[first_row(r, 1) - 1]), 1e-15, 0.0);
  check_close("anchor at half relaxation [N]", force[wait], 10000, 1e-3, 1e-4);
  check_close("anchor in a stage without relaxation [N]", force[first_row(r, 3) - 1], 10000, 1e-3, 1e-4);
  check_close("anchor in the end [N]", force.back(), 20000, 1e-3, 1e-4);
  // the prop had been pressed together by 20 kPa x 0.5 m / 5.3 GPa: that place is held, not the undeformed
  // one
  const double place = y[first_row(r, 1)];
  CHECK(place < -1e-6);
  check_close("anchored block stays [m]", y.back(), place, 1e-3, 1e-4);
  for (const StageResult& s : r.run.stages)
    if (s.kind == StageKind::kStatic) CHECK(s.at_rest);
  check_below("anchor: energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
}

TEST_CASE("change: a joint gets weaker, and the block slides from then on") {
  const CaseResult r =
      run_case(kIncline + "[[change]]\nstage = \"slide\"\njoint = \"face\"\nfriction_angle = \"20 deg\"\n");
  const auto& x = r.column("block.displacement_x");
  check_below("change: slip before [m]", std::abs(x[1000]), 1e-9, 1e-12);
  const double a = 5 - std::tan(20 * M_PI / 180) * 8.660254037844386;
  check_close("change: slip after 0.2 s [m]", x.back(), 0.5 * a * 0.04, 1e-3, 1e-5);
  check_below("change: energy left over / largest term", r.run.closure(), 1e-2, 1e-10);
}

TEST_CASE("change: blocks that are fixed stay, and go on when they are free again") {
  const CaseResult r = run_case(kIncline + R"([[stage]]
name = "hold"
kind = "dynamic"
duration = 0.1
time_step = 1e-4
[[stage]]
name = "again"
kind = "dynamic"
duration = 0.2
time_step = 1e-4
[[change]]
stage = "slide"
joint = "face"
friction_angle = 0
[[change]]
stage = "hold"
block = "block"
kind = "fixed"
[[change]]
stage = "again"
block = "block"
kind = "free"
)");
  const auto& x = r.column("block.displacement_x");
  const size_t held = first_row(r, 2), free = first_row(r, 3);
  check_close("held after sliding [m]", x[free], 0.5 * 5 * 0.04, 1e-3, 1e-5);
  check_below("moved while held [m]", std::abs(x[free] - x[held]), 1e-15, 0.0);
  // from rest: the fixed block has lost its velocity, which is no work
  check_close("slip when free again [m]", x.back() - x[free], 0.5 * 5 * 0.04, 1e-3, 1e-4);
  check_below("fixed and free: energy left over / largest term", r.run.closure(), 1e-2, 1e-10);
}

TEST_CASE("change: softer rock keeps its stress, and moves under what comes after") {
  const std::string bar = R"(talus = 1
[material.rock]
density = 2000
young = "5 GPa"
poisson = 0
[history.pull]
time = [0, 1]
value = [1e6, 1e6]
[history.more]
time = [0, 1]
value = [1e6, 1e6]
[[block]]
name = "bar"
polygon = [[0, 0], [2, 0], [2, 1], [0, 1]]
material = "rock"
[[support]]
name = "wall"
edge = [[0, 0], [0, 1]]
[[load]]
name = "pull"
edge = [[2, 0], [2, 1]]
traction_x = "pull"
[[load]]
name = "more"
edge = [[2, 0], [2, 1]]
traction_x = "more"
stages = ["more"]
[[monitor]]
name = "end"
point = [2, 0.5]
[[stage]]
name = "pull"
kind = "static"
duration = 1
[[stage]]
name = "soft"
kind = "static"
duration = 1
[[stage]]
name = "more"
kind = "static"
duration = 1
[[change]]
stage = "soft"
material = "rock"
young = "2.5 GPa"
)";
  const CaseResult r = run_case(bar);
  const auto& x = r.column("end.displacement_x");
  const double first = x[first_row(r, 1)], soft = x[first_row(r, 2)];
  check_close("bar pulled [m]", first, 2 * 1e6 / 5e9, 1e-3, 1e-4);
  check_close("bar made softer [m]", soft, first, 1e-3, 1e-4);
  check_close("bar pulled on [m]", x.back() - soft, 2 * 1e6 / 2.5e9, 1e-3, 1e-3);
  check_below("softer bar: energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
}

TEST_CASE("a static stage that finds no rest says where") {
  Findings findings("model.toml", kIncline);
  PreparedRun run =
      prepare_run("model.toml",
                  kIncline +
                      "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 0.1\ntime_step = "
                      "1e-3\n[[change]]\nstage = \"rest\"\njoint = \"face\"\nfriction_angle = 0\n",
                  {}, findings);
  State state = start_state(run.scene);
  MemoryObserver observer(run.scene, nullptr);
  const RunResult r = run_stages(run.scene, run.plans, state, observer);
  INFO(r.failure);
  for (const char* piece : {"\"rest\"", "on block \"block\" at (", " N; it moves at (", "m/s"})
    CHECK(r.failure.find(piece) != std::string::npos);
}

TEST_CASE("a mass that swings slowly is no reason to solve more sharply") {
  // 2000 kg on 20 kN/m: a period of 2 s, 2000 steps, with a twentieth of the critical damping
  const std::string slow = R"(talus = 1
[model]
gravity = [0, -0.1]
[material.rock]
density = 2000
[joint.soft]
normal_stiffness = 20e3
shear_stiffness = 10e3
[contact]
joint = "soft"
[[block]]
name = "ground"
polygon = [[-1, -1], [2, -1], [2, 0], [-1, 0]]
material = "rock"
kind = "fixed"
[[block]]
name = "mass"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "rock"
kind = "rigid"
[[stage]]
name = "swing"
kind = "static"
duration = "60 s"
time_step = "1 ms"
damping_mass = "0.314 1/s"
damping_local = 0
unbalanced = 0.01
)";
  double sharpest = 1;
  const CaseResult r =
      run_case(slow, {}, [&](const Instant& i) { sharpest = std::min(sharpest, i.state.rest.sharper); });
  CHECK(r.run.stages[0].at_rest);
  CHECK(r.run.stages[0].steps > 10000);
  CHECK(sharpest == 1);
}

TEST_CASE("wrong stages are found before the first step") {
  const std::string dig = kProp + "[[stage]]\nname = \"dig\"\nkind = \"static\"\nduration = 1\n";
  const std::string more = "[[stage]]\nname = \"more\"\nkind = \"static\"\nduration = 1\n";
  struct Case {
    std::string text;
    std::vector<std::string> pieces;
  };
  const std::vector<Case> cases{
      {dig + "excavate = [\"prob\"]\n", {"stage.dig.excavate", "\"prob\"", "did you mean \"prop\"?"}},
      {dig + "excavate = [\"prop\"]\n" + more + "excavate = [\"prop\"]\n",
       {"stage.more.excavate", "stage \"dig\" has taken out already"}},
      {dig + "excavate = [\"prop\"]\nrelaxation = [[0, 0], [0.2, 0.6], [0.3, 0.5]]\n",
       {"stage.dig.relaxation", "falls from 0.6 to 0.5"}},
      {dig + "excavate = [\"prop\"]\nrelaxation = [[0, 0], [0.2, 0.6], [0.2, 1]]\n",
       {"stage.dig.relaxation", "0.2 s is followed by 0.2 s"}},
      {dig + "excavate = [\"prop\"]\nrelaxation = [[0, 0], [0.2, 1.5]]\n",
       {"stage.dig.relaxation", "1.5", "<= 1"}},
      {dig + "excavate = [\"prop\"]\nrelaxation = [[0, 0.2], [0.2, 1]]\n",
       {"stage.dig.relaxation", "begins with [0 s, 0.2]"}},
      {dig + "excavate = [\"prop\"]\nrelaxation = [[0, 0], [2, 1]]\n",
       {"stage.dig.relaxation", "ends at 2 s, after the stage (1 s)"}},
      {dig + "relaxation = [[0, 0], [0.2, 1]]\n", {"stage.dig.relaxation", "nothing to relax"}},
      {dig + "excavate = [\"prop\"]\nrelaxation = [[0, 0], [0.2, 0.5]]\n" + more + "excavate = [\"load\"]\n",
       {"stage.more.excavate", "0.5 of the tractions of an earlier excavation"}},
      {dig + "excavate = [\"prop\"]\nrelaxation = [[0, 0], [0.2, 0.5]]\n",
       {"warning", "stage.dig", "0.5 of the tractions"}},
      {kProp.substr(0, kProp.find("[[stage]]")) +
           "[[stage]]\nname = \"dig\"\nkind = \"static\"\nduration = 1\nexcavate = [\"prop\"]\nrelaxation = "
           "[[0, 0], [0.2, 1]]\n",
       {"stage.dig.relaxation", "no stage comes before"}},
      {dig + "excavate = [\"prop\", \"load\", \"ground\"]\n", {"no block is left"}},
      {dig + "[[support]]\nname = \"s\"\npoint = [0, 1]\nstages = [\"digg\"]\n",
       {"support.s.stages", "\"digg\"", "did you mean \"dig\"?"}},
      {dig + "[[support]]\nname = \"s\"\npoint = [0, 1]\nstages = []\n", {"support.s.stages", "never act"}},
      {dig + "[[change]]\nstage = \"dig\"\n", {"change.0", "does not say what changes"}},
      {dig + "[[change]]\nstage = \"dig\"\njoint = \"face\"\nyoung = 1e9\n", {"change.0", "a joint changes"}},
      {dig + "[[change]]\nstage = \"dig\"\njoint = \"face\"\ncohesion = 1e5\n",
       {"change.0.cohesion", "no strength at the start"}},
      {dig + "[[change]]\nstage = \"dog\"\njoint = \"face\"\nfriction_angle = 0\n",
       {"change.0.stage", "\"dig\""}},
      {dig + "[[change]]\nstage = \"dig\"\nblock = \"ground\"\nkind = \"free\"\n",
       {"change.kind", "fixed or driven from the start"}},
      {dig + "excavate = [\"prop\"]\n[[change]]\nstage = \"dig\"\nblock = \"prop\"\nkind = \"fixed\"\n",
       {"change.block", "excavated by then"}},
      {dig + "[in_situ]\nlevel = 0.2\ndensity = 2000\nk0 = 1\n",
       {"in_situ.level", "below the centroid of \"prop\""}},
      {dig + "[in_situ]\nlevel = 2\nk0 = 1\n", {"in_situ.density", "is missing"}},
      {dig + "[in_situ]\nlevel = 2\ndensity = 2000\n", {"in_situ.k0", "is missing"}},
      {dig + "[in_situ]\nstress_xx = 0\nlevel = 2\n", {"in_situ", "two ways"}},
      {dig + "[in_situ]\nstress_xx = 0\nk0 = 2\n", {"in_situ.k0", "grows with depth"}},
  };
  for (const Case& c : cases) check_told(c.text, c.pieces);
}

}  // namespace test_stages
