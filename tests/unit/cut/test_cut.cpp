#include "talus/base/index.h"
#include "talus/cut/cut.h"

#include <doctest/doctest.h>

#include <map>
#include <numbers>
#include <set>

#include "support/cut_case.h"
#include "support/relative.h"
#include "talus/base/random.h"
#include "talus/geometry/shapes.h"

namespace test_cut {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kPi = std::numbers::pi;

std::vector<double> areas_of(const Cut& cut, const std::vector<CutBlock>& blocks) {
  std::vector<double> out;
  for (const CutBlock& b : blocks) out.push_back(signed_area(cut.polygon(b)));
  std::sort(out.begin(), out.end());
  return out;
}

// Areas of blocks whose corners lie on the grid are exact; others are off by less than a cell along their
// edges, 1e-5 m2 for the models here (edges of 100 m at most, cells of 1e-7 m at most).
void check_areas(const Cut& cut, const std::vector<CutBlock>& blocks, std::vector<double> expected) {
  CHECK(partition_defect(cut) == "");
  const std::vector<double> areas = areas_of(cut, blocks);
  REQUIRE(areas.size() == expected.size());
  std::sort(expected.begin(), expected.end());
  for (size_t i = 0; i < areas.size(); ++i) CHECK(std::abs(areas[i] - expected[i]) < 1e-5);
}

std::set<std::string> names_of(const Cut& cut) {
  std::set<std::string> out;
  for (const CutBlock& b : cut.blocks) out.insert(cut.name(b));
  return out;
}

int edges_of_kind(const Cut& cut, OriginKind kind) {
  std::set<int> edges;
  for (const CutBlock& b : cut.whole)
    for (const int e : b.edge)
      if (cut.origins[cut.edge_origin[e]].kind == kind) edges.insert(e);
  return count_of(edges);
}

Model two_sets(double angle_a, double offset_a, double angle_b, double offset_b) {
  Model model = rock_model(box_polygon(0, 0, 200, 300));
  model.cut.slivers = SliverPolicy::kKeep;
  model.joint_sets = {joint_set("a", degrees(angle_a), 3), joint_set("b", degrees(angle_b), 3)};
  model.joint_sets[0].offset.mean = offset_a;
  model.joint_sets[1].offset.mean = offset_b;
  return model;
}

}  // namespace

TEST_CASE("a region without joints is one block, whichever way it runs and wherever it lies") {
  for (const Vec2 at : {Vec2{0, 0}, Vec2{5e6, -4e6}}) {
    for (const bool turned : {false, true}) {
      Polygon outline{at, at + Vec2{4, 0}, at + Vec2{4, 2}, at + Vec2{0, 3}};
      if (turned) std::reverse(outline.begin(), outline.end());
      const Cut cut = cut_of(rock_model(outline));
      check_areas(cut, cut.blocks, {10});
      CHECK(cut.name(cut.blocks[0]) == "rock[0]");
      // sides keep their names: corner k of the outline to k + 1 is rock-(k + 1)
      for (size_t k = 0; k < 4; ++k) {
        const Vec2 middle = 0.5 * (outline[k] + outline[(k + 1) % 4]);
        const CutBlock& b = cut.blocks[0];
        const Polygon p = cut.polygon(b);
        for (size_t e = 0; e < 4; ++e)
          if (distance_to_segment(middle, p[e], p[(e + 1) % 4]) < 1e-6)
            CHECK(cut.origins[cut.edge_origin[b.edge[e]]].name == fmt::format("rock-{}", k + 1));
      }
    }
  }
}

TEST_CASE("of coincident traces the more important names the edge: opening, side, fault, joint set") {
  Model model = rock_model(box_polygon(0, 0, 4, 4));
  add_region(model, "next", box_polygon(4, 0, 8, 4));
  JointSetInput set = joint_set("set", degrees(90), 1);
  model.joint_sets.push_back(set);
  add_fault(model, {{2, -1}, {2, 5}});
  add_fault(model, {{4, -1}, {4, 5}});
  add_opening(model, box_polygon(2, 1, 3, 2), true);
  const Cut cut = cut_of(model);
  const auto origin_at = [&](Vec2 p) {
    for (const CutBlock& b : cut.whole) {
      const Polygon polygon = cut.polygon(b);
      for (size_t k = 0; k < polygon.size(); ++k)
        if (distance_to_segment(p, polygon[k], polygon[(k + 1) % polygon.size()]) < 1e-6)
          return cut.origins[cut.edge_origin[b.edge[k]]].name;
    }
    return std::string("none");
  };
  CHECK(origin_at({1, 1.5}) == "set");
  CHECK(origin_at({2, 0.5}) == "fault0");
  CHECK(origin_at({2, 1.5}) == "opening0");
  CHECK(origin_at({4, 2.5}) == "rock-2");
  CHECK(origin_at({6, 2.5}) == "set");
  CHECK(cut.blocks.size() == 10);  // eight strips, one of them in three
}

TEST_CASE("a trace that ends inside a block bounds nothing and is told") {
  Model model = rock_model(box_polygon(0, 0, 4, 4));
  add_fault(model, {{0, 2}, {3, 2}});
  add_fault(model, {{1, 0}, {1, 4}});
  const Cut cut = cut_of(model);
  check_areas(cut, cut.whole, {2, 2, 12});
  CHECK(cut.dead_end_length == approx(2).epsilon(1e-6));  // from (1, 2) to (3, 2), ends on the grid
}

TEST_CASE("a circle alone in a region: its surroundings are cut open along a level line") {
  for (const bool kept : {true, false}) {
    Model model = rock_model(box_polygon(0, 0, 10, 10));
    add_opening(model, circle_polygon({5, 5}, 4, 32), kept);
    const Cut cut = cut_of(model);
    const double circle = 4 * kPi, half = 50 - circle / 2;
    check_areas(cut, cut.whole, {circle, half, half});
    CHECK(cut.blocks.size() == (kept ? 3 : 2));
    CHECK(cut.taken_out == (kept ? 0 : 1));
    CHECK(cut.bridges == 1);
    CHECK(edges_of_kind(cut, OriginKind::kConstruction) == 2);
    CHECK(cut.origins.back().joint == model.bonded_joint);
    for (const CutBlock& b : cut.whole)
      CHECK(cut.name(b) == fmt::format("{}[{}]", b.opening == 0 ? "opening0" : "rock", b.id));
  }
}

TEST_CASE("a dead end that a cut meets stays dead") {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  add_opening(model, box_polygon(4, 3, 6, 5), true);
  add_fault(model, {{2, 1.5}, {8, 1.5}});  // between the opening and the side next to it
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  CHECK(cut.whole.size() == 3);
  CHECK(cut.dead_end_length == approx(6));
  for (const CutBlock& b : cut.whole)
    for (const int e : b.edge) CHECK(cut.origins[cut.edge_origin[e]].kind != OriginKind::kFault);
}

TEST_CASE("two circles, side by side and one above the other") {
  for (const bool above : {false, true}) {
    Model model = rock_model(above ? box_polygon(0, 0, 10, 20) : box_polygon(0, 0, 20, 10));
    for (const double c : {5.0, 15.0})
      add_opening(model, circle_polygon(above ? Vec2{5, c} : Vec2{c, 5}, 4, 32), true);
    const Cut cut = cut_of(model);
    CHECK(partition_defect(cut) == "");
    CHECK(cut.bridges == 1);
    // each by two cuts to the nearest sides, from the corner beside the nearest one: a circle and a piece more for each
    const double radius =
        std::sqrt(4 * kPi / (16 * std::sin(kPi / 16)));  // of 32 corners, with the area of the circle
    REQUIRE(cut.whole.size() == 5);
    int circles = 0;
    for (const CutBlock& b : cut.whole) circles += std::abs(signed_area(cut.polygon(b)) - 4 * kPi) < 1e-5;
    CHECK(circles == 2);
    double cuts = 0;
    for (size_t e = 0; e < cut.edge.size(); ++e)
      if (cut.origins[cut.edge_origin[e]].kind == OriginKind::kConstruction)
        cuts += norm(cut.point[cut.edge[e][1]] - cut.point[cut.edge[e][0]]);
    CHECK(cuts == approx(4 * (5 - radius * std::cos(kPi / 16))).epsilon(1e-5));
  }
}

TEST_CASE(
    "any opening without joints around it is cut open: the cut reaches its sides, steep or nearly level") {
  // The cut ends between corners of the grid, on sides that lie up to a cell from where noding left them:
  // across a slope of 1 in 1000 that is a thousand cells along the level.
  Random random(3);
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    const Vec2 at{1 + 8 * random.uniform(), 1 + 2 * random.uniform()};
    const double d = 0.5 + 3 * random.uniform(), slope = std::pow(10, -3 * random.uniform());
    Model model = rock_model(box_polygon(0, 0, 16, 8));
    if (i % 2 == 0) add_opening(model, {at, at + Vec2{d, 0}, at + Vec2{0, d}}, true);
    if (i % 2 == 1)
      add_opening(model,
                  {at, at + Vec2{d, slope * d}, at + Vec2{d, 1.3 * slope * d}, at + Vec2{0, 0.3 * slope * d}},
                  true);
    const Cut cut = cut_of(model);
    CHECK(partition_defect(cut) == "");
    CHECK(cut.whole.size() == 3);
    CHECK(cut.bridges == 1);
  }
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  add_opening(model, {{0, 5}, {5, 3}, {5, 7}}, true);  // touches a side at a corner
  CHECK(partition_defect(cut_of(model)) == "");
}

TEST_CASE("a needle of joints that touches nothing is opened, too") {
  for (const double width : {2e-3, 2e-6, 2e-7}) {  // down to three cells of the grid
    CAPTURE(width);
    Model model = rock_model(box_polygon(0, 0, 10, 10));
    add_fault(model, {{2, 2}, {8, 7.3}, {8, 7.3 + width}, {2, 2}});
    const Cut cut = cut_of(model);
    CHECK(partition_defect(cut) == "");
    CHECK(cut.blocks.size() == (width > 1e-4 ? 3 : 2));  // a hair is merged
  }
}

TEST_CASE("faults half a cell apart that end in the rock enclose needles: opened without moving the faults") {
  Model model = rock_model({{67.755727279765438, 21.635700557909299},
                            {-90.688487868390894, 110.51423122046329},
                            {-31.624626810411002, 16.08519571505613},
                            {-85.838786411006396, -91.661212691315527},
                            {60.919421359764151, -42.234275634878607}});
  add_fault(model, {{6.2411648017572521, 55.489868260529597}, {-20.878008098036787, 29.069833111636349}});
  add_fault(model, {{6.2411652970533602, 55.489867752126763}, {-20.878007602740677, 29.069832603233511}});
  add_fault(model, {{6.2411654044125031, 55.489867641926637}, {-20.878007495381535, 29.069832493033388}});
  CHECK(partition_defect(cut_of(model)) == "");
}

TEST_CASE("a region within a region: later ones in the file hold") {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  add_region(model, "ore", box_polygon(2, 2, 6, 6));
  add_region(model, "core", box_polygon(3, 3, 5, 5));
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  double rock = 0, ore = 0, core = 0;
  for (const CutBlock& b : cut.whole)
    (b.region == 0 ? rock : b.region == 1 ? ore : core) += signed_area(cut.polygon(b));
  CHECK(std::abs(rock - 84) < 1e-5);
  CHECK(std::abs(ore - 12) < 1e-5);
  CHECK(std::abs(core - 4) < 1e-5);
  CHECK(cut.bridges == 2);
}

TEST_CASE("where regions overlap the later one is not cut by the sides of the earlier") {
  Model model = rock_model(box_polygon(0, 0, 2, 2));
  add_region(model, "later", box_polygon(1, 1, 3, 3));
  const Cut cut = cut_of(model);
  check_areas(cut, cut.blocks, {3, 4});
}

TEST_CASE("a block belongs where most of it lies, though a corner of its neighbour reaches into its middle") {
  // the centroid of the rock is level with the top of the triangle: (60 x 2.5 - 15 x 1) / 45 = 3
  Model model = rock_model(box_polygon(-6, 0, 6, 5));
  add_opening(model, {{-5, 0}, {5, 0}, {0, 3}}, false);
  const Cut cut = cut_of(model);
  check_areas(cut, cut.blocks, {45});
  CHECK(cut.taken_out == 1);
  model.openings.clear();
  add_region(model, "wedge", {{-5, 0}, {5, 0}, {0, 3}});
  CHECK(names_of(cut_of(model)) == std::set<std::string>{"rock[0]", "wedge[1]"});
}

TEST_CASE("other blocks keep their names whether an opening is kept or removed") {
  const auto make = [](bool kept) {
    Model model = two_sets(105, -1.11, 55, 2.43);
    model.regions[0].polygon = box_polygon(80, 180, 120, 220);
    add_opening(model, circle_polygon({100, 200}, 9.8, 32), kept);
    return cut_of(model);
  };
  const Cut kept = make(true), removed = make(false);
  CHECK(partition_defect(kept) == "");
  std::set<std::string> expected;
  for (const std::string& name : names_of(kept))
    if (name.starts_with("rock")) expected.insert(name);
  CHECK(names_of(removed) == expected);
  CHECK(kept.whole.size() == removed.whole.size());
  CHECK(kept.blocks.size() == removed.blocks.size() + static_cast<size_t>(removed.taken_out));
}

TEST_CASE("of two openings the later holds where both are, one outside all regions is an error") {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  add_opening(model, box_polygon(1, 1, 4, 4), true);
  add_opening(model, box_polygon(3, 3, 6, 6), true);
  const Cut cut = cut_of(model);
  double first = 0, second = 0;
  for (const CutBlock& b : cut.whole)
    (b.opening == 0 ? first : second) += b.opening < 0 ? 0 : signed_area(cut.polygon(b));
  CHECK(std::abs(first - 8) < 1e-5);
  CHECK(std::abs(second - 9) < 1e-5);
  add_opening(model, box_polygon(20, 20, 21, 21), true);
  Findings findings("case.toml", "");
  cut_model(model, findings);
  CHECK(findings.render().find("opening.opening2") != std::string::npos);
}

TEST_CASE("a grid too fine for the coordinates is an error, a coarse one a warning") {
  const auto findings_of = [](double at, double size, double grid) {
    Model model = rock_model(box_polygon(at, at, at + size, at + size));
    model.cut.grid = grid;
    Findings findings("case.toml", "");
    cut_model(model, findings);
    return fmt::format("{} errors, {} warnings", findings.error_count(), findings.warning_count());
  };
  CHECK(findings_of(0, 10, 1e-15) == "1 errors, 0 warnings");
  CHECK(findings_of(0, 10, 1e-9) == "0 errors, 0 warnings");
  CHECK(findings_of(0, 10, 0.01) == "0 errors, 1 warnings");
  CHECK(findings_of(5e6, 10, 1e-9) == "0 errors, 0 warnings");
  // coordinates of 5e6 m end at 2^-30 = 9e-10 m
  CHECK(findings_of(5e6, 10, 1e-11) == "1 errors, 0 warnings");
  CHECK(findings_of(5e6, 0.02, std::nan("")) == "1 errors, 0 warnings");
}

TEST_CASE("two sets at 3 m in 200 x 300 m: as many blocks as counted by cutting cell after cell") {
  struct Case {
    double angle_a, offset_a, angle_b, offset_b;
    size_t blocks;
  };
  // counted independently by splitting polygons line after line; offsets of .37 and .81 of a spacing along
  // the normal (sin dip, cos dip)
  for (const Case& c :
       {Case{105, -1.11, 55, 2.43, 5311}, Case{75, 0, 125, 0, 5307}, Case{-60.7, 1.11, 34.7, 2.43, 6865},
        Case{-63.5, 1.11, -55, 2.43, 1205}, Case{-72.4, 1.11, -0.01, 2.43, 6552}}) {
    CAPTURE(c.angle_a);
    const Cut cut = cut_of(two_sets(c.angle_a, c.offset_a, c.angle_b, c.offset_b));
    CHECK(cut.whole.size() == c.blocks);
    CHECK(cut.blocks.size() == c.blocks);
    CHECK(partition_defect(cut) == "");
    double sum = 0;
    for (const double a : areas_of(cut, cut.whole)) sum += a;
    CHECK(std::abs(sum - 60000) <
          1e-12 * 60000);  // 7000 areas, each rounded by 1e-16 of 1e4 m2, add to 1e-13
    CHECK(area_of(CellCut(cut).twice_area_of(cut.whole), cut.grid) == 60000);
  }
}

TEST_CASE("a tunnel of 9.8 m cuts 12 blocks in two and takes 2 whole ones and 12 pieces") {
  Model model = two_sets(105, -1.11, 55, 2.43);
  const Cut plain = cut_of(model);
  const Polygon circle = circle_polygon({100, 200}, 9.8, 32);
  int whole = 0, crossed = 0;
  for (const CutBlock& b : plain.whole) {
    const Polygon p = plain.polygon(b);
    const double inside = polygon_overlap(p, circle).area, all = signed_area(p);
    if (inside < 1e-6) continue;
    (inside > all - 1e-6 ? whole : crossed) += 1;
  }
  CHECK(whole == 2);  // their 75.4 m2 are 6.4 blocks of 11.75 m2: "about 6" counts pieces by area
  CHECK(crossed == 12);
  add_opening(model, circle, false);
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  CHECK(cut.whole.size() == 5311 + 12);
  CHECK(cut.taken_out == 2 + 12);
  CHECK(cut.blocks.size() == 5309);
  CHECK(cut.bridges == 0);
}

TEST_CASE("a model file with everything that divides rock is cut into a partition") {
  const Model model = model_of(R"(
[joint.rough]
friction_angle = "35 deg"
[cut]
section_azimuth = "60 deg"
seed = 7
[[region]]
name = "rock"
polygon = [["0 m", "0 m"], ["60 m", "0 m"], ["60 m", "40 m"], ["0 m", "40 m"]]
sides = ["base", "east", "top", "west"]
material = "stone"
joint = "rough"
[[region]]
name = "wall"
polygon = [["60 m", "0 m"], ["64 m", "0 m"], ["64 m", "4 m"], ["60 m", "4 m"]]
material = "stone"
[[arch]]
name = "vault"
center = ["80 m", "0 m"]
radius = "5 m"
thickness = "1 m"
voussoirs = 9
material = "stone"
[[joint_set]]
name = "steep"
dip = "75 deg"
dip_direction = "302.5 deg"
fisher = 200
spacing = { exponential = "4 m" }
region = "rock"
[[joint_set]]
name = "flat"
angle = { mean = "10 deg", normal = "2 deg" }
spacing = "5 m"
trace_length = { mean = "12 m", uniform = "4 m" }
gap = "2 m"
region = "rock"
[[fault]]
name = "thrust"
points = [["-1 m", "5 m"], ["30 m", "12 m"], ["61 m", "35 m"]]
[[opening]]
name = "tunnel"
shape = "circle"
center = ["20 m", "25 m"]
diameter = "8 m"
[[opening]]
name = "gallery"
shape = "horseshoe"
center = ["45 m", "12 m"]
width = "6 m"
height = "6 m"
rock = "kept"
[[masonry]]
name = "bond"
region = "wall"
length = "1 m"
height = "0.5 m"
)");
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  std::map<std::string, int> blocks;
  std::map<std::string, double> area;
  for (const CutBlock& b : cut.blocks) {
    const std::string name = cut.name(b), group = name.substr(0, name.find('['));
    ++blocks[group];
    area[group] += signed_area(cut.polygon(b));
  }
  const double tunnel = 16 * kPi, gallery = 18 + 4.5 * kPi;
  CHECK(std::abs(area["rock"] - (2400 - tunnel - gallery)) <
        1e-3);  // 2^-20 m along 300 m of edges, less of openings
  CHECK(std::abs(area["gallery"] - gallery) < 1e-3);
  CHECK(std::abs(area["wall"] - 16) < 1e-3);
  CHECK(blocks["wall"] == 4 * 4 + 4 * 5);
  CHECK(blocks["vault"] == 9);
  CHECK(blocks["tunnel"] == 0);
  CHECK(cut.taken_out > 0);
  CHECK(cut.slivers.merged == 0);
}

}  // namespace test_cut
