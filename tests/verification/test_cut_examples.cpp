// The cut models of the gallery: counts and areas by hand, and the two that run.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "support/overlap.h"
#include "support/run_case.h"
#include "support/source_file.h"
#include "support/tolerance.h"
#include "talus/cut/check_places.h"
#include "talus/model/read_model.h"
#include "talus/output/cut_report.h"
#include "talus/schema/toml_source.h"

namespace test_cut_examples {

using namespace talus;
using namespace talus::test;

namespace {

std::string example(const std::string& name) {
  return read_text_file(source_file(fmt::format("examples/{0}/{0}.toml", name)));
}

struct CutExample {
  Model model;
  Cut cut;
  CutStatistics statistics;
};

CutExample cut_example(const std::string& name, const std::vector<std::string>& overrides = {}) {
  const std::string text = example(name);
  Findings findings(name, text);
  CutExample e;
  e.model = read_model(name, text, overrides, findings);
  e.cut = cut_model(e.model, findings);
  checked_layout(e.model, e.cut, findings);
  findings.throw_if_errors();
  e.statistics = cut_statistics(e.model, e.cut);
  return e;
}

// Length of all block edges with this origin [m].
double edge_length(const Cut& cut, const std::string& origin) {
  std::vector<bool> seen(cut.edge.size(), false);
  double sum = 0;
  for (const CutBlock& b : cut.blocks) {
    for (const int i : b.edge) {
      if (seen[i] || cut.origins[cut.edge_origin[i]].name != origin) continue;
      seen[i] = true;
      sum += norm(cut.point[cut.edge[i][1]] - cut.point[cut.edge[i][0]]);
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("example tunnel: blocks of the reference, slivers along the outline and the tunnel alone") {
  const CutExample e = cut_example("tunnel");
  CHECK(e.statistics.after.count == 5307);
  // 5307 blocks without the tunnel; the pieces into which its circle divides them come in addition
  const CutExample solid = cut_example("tunnel", {"opening.tunnel.rock=\"kept\""});
  int inside = 0;
  for (const CutBlock& b : solid.cut.blocks) inside += b.opening >= 0;
  CHECK(inside == e.cut.taken_out);
  check_close("tunnel area [m2]", e.statistics.after.total_area, 60000 - M_PI * 4.9 * 4.9, 1e-9, 1e-9);
  const BlockStatistics& s = e.statistics.after;
  // a full block: 3 m / sin 50 deg along both sides; limit by theory 2.4
  check_close("tunnel full block's stable step [s]", s.step.median, 0.872e-3, 1e-3, 1e-3);
  CHECK(e.cut.slivers.merged == 0);
  CHECK(e.cut.slivers.kept == 83);
  for (const Sliver& row : e.cut.slivers.rows) {
    const double to_side = std::min({row.at.x, 200 - row.at.x, row.at.y, 300 - row.at.y});
    CHECK(std::min(to_side, std::abs(norm(row.at - Vec2{100, 200}) - 4.9)) < 1);
  }
}

TEST_CASE("example slope: apparent dips by formula, no rock lost") {
  const CutExample e = cut_example("slope");
  const auto dip = [](double true_dip, double off) {
    return std::atan(std::tan(true_dip * M_PI / 180) * std::cos(off * M_PI / 180));
  };
  check_close("slope bedding, angle [rad]", e.cut.joint_sets[0].angle, dip(24, 20), 1e-12, 1e-14);
  check_close("slope cross joints, angle [rad]", e.cut.joint_sets[1].angle, -dip(78, 15), 1e-12, 1e-14);
  // corners lie on the grid: 1e-6 m along 360 m of outline
  const double area = signed_area(e.model.regions[0].polygon);
  check_close("slope area [m2]", e.statistics.after.total_area, area, 1e-7, 1e-7);
  CHECK(e.cut.slivers.merged == 0);
}

TEST_CASE("example cavern: the fault stays whole, the gallery's rock stays") {
  const CutExample e = cut_example("cavern");
  // its length less the part inside the cavern: between the crossings with the half circle and with the wall
  const auto& p = e.model.faults[0].points;
  double length = norm(p[1] - p[0]) + norm(p[2] - p[1]) + norm(p[3] - p[2]);
  const Vec2 d = (p[2] - p[1]) / norm(p[2] - p[1]);
  const double to_wall = (11 - p[1].x) / d.x;
  const Vec2 from_center = p[1] - Vec2{0, 6};
  const double b = dot(from_center, d);
  const double to_arc = -b - std::sqrt(b * b - dot(from_center, from_center) + 121);
  length -= to_wall - to_arc;
  // 24 segments stand for the half circle: up to 0.3 % of its radius off
  check_close("cavern fault, length of block edges [m]", edge_length(e.cut, "shear zone"), length, 5e-4,
              3e-4);
  double gallery = 0;
  for (const CutBlock& block : e.cut.blocks)
    if (block.opening == 1) gallery += signed_area(e.cut.polygon(block));
  check_close("cavern gallery, area kept [m2]", gallery, 20, 1e-6, 1e-6);
}

TEST_CASE("example specimen: cells of the size asked for") {
  const CutExample e = cut_example("specimen");
  int cells = 0;
  for (const CutBlock& b : e.cut.whole) cells += b.region == 1;
  // 5000 mm2 in cells of 25 mm2, and half cells along the outline of 300 mm
  CHECK(cells > 200);
  CHECK(cells < 260);
  check_close("specimen area [m2]", e.statistics.after.total_area, 5e-3 + 2 * 1.05e-3, 1e-7, 1e-7);
}

TEST_CASE("example wall: blocks counted by hand, the ground carries the weight") {
  // courses of 10, or 9 and two halves; the window takes the middle of six courses, the lintel that of the
  // seventh
  const CutExample e = cut_example("wall");
  CHECK(e.cut.blocks.size() == 5 * 10 + 2 + 6 * 8 + 9 + 3 * 10 + 1);
  const CaseResult r = run_case(example("wall"));
  const double weight = 9.81 * ((12 - 1.44 - 0.32) * 2200 + 0.32 * 2400);
  check_close("wall, reaction of the ground [N]", r.column("ground.reaction_y").back(), weight, 1e-4, 1e-4);
  CHECK(r.run.stages[0].at_rest);
  check_below("wall energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("example settle: nothing passes through anything") {
  LargestOverlap worst;
  const CaseResult r =
      run_case(example("settle"), {"output.history_interval=\"10 ms\"", "cut.slivers=\"delete\""},
               [&](const Instant& now) {
                 if (!now.last && now.state.step % 50 != 0) return;
                 const LargestOverlap largest = largest_overlap(now.scene.blocks, now.state);
                 if (largest.share > worst.share) worst = largest;
               });
  INFO(worst.between);
  // joints of 20 GPa/m under at most twice the weight of 60 m close by 0.17 mm, of blocks 3 m wide: 6e-5;
  // three-cornered ones at the floor have half the area per side. Crumbs of centimetres, whose share is more
  // by as much as they are thinner, are left out
  check_below("settle, largest overlap / smaller block", worst.share, 1e-3, 2e-4);
  CHECK(r.run.failed_steps == 0);
}

}  // namespace test_cut_examples
