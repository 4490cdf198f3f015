// What bolts go through: yield, unloading and reloading of an anchored one against a calculation by hand, and
// bolts in rock that is excavated.

#include <numbers>

#include "support/drawn_blocks.h"
#include "support/run_case.h"
#include "support/told.h"
#include "support/tolerance.h"

namespace test_bolt_history {

using namespace talus;
using namespace talus::test;

namespace {

// --- A bar of 25 mm and 2 m between a fixed block and one that is drawn to and fro along it ---

constexpr double kLength = 2, kYield = 100e3;                                      // [m], [N]
const double kStiffness = 200e9 * std::numbers::pi * 0.025 * 0.025 / 4 / kLength;  // E A / L [N/m]

// Each elongation [m] of the list is reached in 0.1 s and held for as long.
std::string drawn_text(const std::vector<double>& elongations) {
  std::string time = "0", value = "0";
  for (size_t i = 0; i < elongations.size(); ++i) {
    const double begin = 0.2 * static_cast<double>(i);
    time += fmt::format(", {:.10g}, {:.10g}", begin + 0.1, begin + 0.2);
    value += fmt::format(", {0:.17g}, {0:.17g}", elongations[i]);
  }
  return drawn_blocks(time, value) + fmt::format(R"([bolt_type.bar]
kind = "anchored"
diameter = "25 mm"
yield_force = {}
spacing = "1 m"
[[bolt]]
name = "b"
from = [-1, 0.1]
to = [1, 0.1]
type = "bar"
[[monitor]]
name = "m"
bolt = "b"
[[stage]]
name = "draw"
kind = "dynamic"
duration = {}
time_step = 1e-3
)",
                                                 kYield, 0.2 * static_cast<double>(elongations.size()));
}

}  // namespace

TEST_CASE("anchored bolt after yield: unloads and reloads along its stiffness, yields again, goes slack") {
  // yields at 2.04 mm; drawn to 5 mm it has a plastic part of 2.96 mm
  const double yields_at = kYield / kStiffness;
  const double first = 5e-3 - yields_at, second = 7e-3 - yields_at;  // plastic parts [m]
  struct {
    const char* what;
    double elongation, force;  // [m], [N]
  } const path[] = {{"elastic", 1e-3, kStiffness * 1e-3},
                    {"yields", 5e-3, kYield},
                    {"unloads", 3.5e-3, kStiffness * (3.5e-3 - first)},
                    {"reloads below the yield force", 4.5e-3, kStiffness * (4.5e-3 - first)},
                    {"reloads up to it", 5e-3, kYield},
                    {"yields again", 7e-3, kYield},
                    {"goes slack", 4.5e-3, 0},
                    {"reloads from slack", 6e-3, kStiffness * (6e-3 - second)}};
  std::vector<double> elongations;
  for (const auto& p : path) elongations.push_back(p.elongation);
  const CaseResult r = run_case(drawn_text(elongations));
  const auto &t = r.column("t [s]"), &force = r.column("m.axial_force [N]");
  for (size_t k = 0; k < std::size(path); ++k) {
    size_t row = 0;
    while (row + 1 < t.size() && t[row + 1] < 0.2 * static_cast<double>(k) + 0.195) ++row;
    // rigid blocks drawn along the bar: nothing but round-off and the drift a step leaves
    check_close(fmt::format("anchored bolt {} at {:g} mm: force / yield force", path[k].what,
                            1e3 * path[k].elongation),
                force[row] / kYield, path[k].force / kYield, 1e-6, 1e-9, 1);
  }
  // plastic work: yield force x plastic part, and what is stored at the end; taken from the drawn block
  const double left = path[7].force * path[7].force / (2 * kStiffness);
  check_close("anchored bolt work / by hand", r.run.energy.work[Cause::kBolts] / -(kYield * second + left), 1,
              1e-2, 1e-3);
  check_below("anchored bolt energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
}

namespace {

// Three blocks in a row, "c" excavated in stage "dig"; a bolt from -> to along y = 0.5.
std::string dug_text(const std::string& kind, double from, double to, const std::string& stage) {
  return fmt::format(R"(talus = 1
[material.rock]
density = 2500
young = "5 GPa"
poisson = 0.2
[[block]]
name = "a"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "rock"
kind = "fixed"
[[block]]
name = "b"
polygon = [[1, 0], [2, 0], [2, 1], [1, 1]]
material = "rock"
[[block]]
name = "c"
polygon = [[2, 0], [3, 0], [3, 1], [2, 1]]
material = "rock"
[bolt_type.t]
kind = "{}"
diameter = "25 mm"
spacing = "1 m"
[[bolt]]
name = "bar"
from = [{}, 0.5]
to = [{}, 0.5]
type = "t"
stage = "{}"
[[stage]]
name = "first"
kind = "dynamic"
duration = 1e-3
[[stage]]
name = "dig"
kind = "dynamic"
duration = 1e-3
excavate = ["c"]
[[stage]]
name = "after"
kind = "dynamic"
duration = 1e-3
)",
                     kind, from, to, stage);
}

}  // namespace

TEST_CASE("bolt in rock that is excavated: refused before the first step, with block, stage and a way out") {
  for (const char* kind : {"anchored", "grouted"}) {
    INFO(kind);
    const std::string text = refusal(dug_text(kind, 0.2, 2.6, "first"));
    INFO(text);
    CHECK(text.find("model.toml:23:") != std::string::npos);
    CHECK(text.find("bolt.bar: is tied to block \"c\", which stage \"dig\" excavates") != std::string::npos);
    CHECK(text.find("tied to rock that stays") != std::string::npos);
    // what has gone when the bolt is installed holds nothing, so that the bolt ends in the air
    const std::string later = refusal(dug_text(kind, 0.2, 2.6, "after"));
    INFO(later);
    CHECK(later.find("ends outside the blocks") != std::string::npos);
    // one that ends in rock that stays is taken, in any stage, also when it ends at the wall to be
    for (const char* stage : {"first", "dig", "after"}) {
      CHECK(refusal(dug_text(kind, 0.2, 1.8, stage)) == "");
      CHECK(refusal(dug_text(kind, 0.2, 2.0, stage)) == "");
    }
  }
  // an anchored bolt that only passes the rock is not tied to it: here "b" goes, between its ends
  std::string between = dug_text("anchored", 0.2, 2.6, "first");
  between.replace(between.find("excavate = [\"c\"]"), 16, "excavate = [\"b\"]");
  CHECK(refusal(between) == "");
  // a superposed one is a part of the block, and goes with it
  CHECK(refusal(dug_text("superposed", 0.2, 2.6, "first")) == "");
}

TEST_CASE("bolt installed after an excavation reaches over the gap, not into rock that has gone") {
  std::string text = dug_text("grouted", 0.2, 2.6, "after");
  text.replace(text.find("excavate = [\"c\"]"), 16, "excavate = [\"b\"]");
  std::vector<int> tied;
  run_case(text, {}, [&tied](const Instant& i) {
    tied.clear();
    for (const Bolt& bolt : i.state.bolts)
      for (const BoltNode& n : bolt.nodes) tied.push_back(n.block);
  });
  REQUIRE(!tied.empty());
  CHECK(std::count(tied.begin(), tied.end(), 1) == 0);  // block "b"
  CHECK(std::count(tied.begin(), tied.end(), 0) > 0);
  CHECK(std::count(tied.begin(), tied.end(), 2) > 0);
}

}  // namespace test_bolt_history
