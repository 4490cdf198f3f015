// Lines from what the model names: masonry, arches, tessellations, joint sets of one region. (Joint sets
// alone: test_joint_set.cpp.)

#include "talus/cut/traces.h"

#include <doctest/doctest.h>

#include <numbers>
#include <set>

#include "support/cut_case.h"
#include "support/relative.h"
#include "talus/cut/layout.h"

namespace test_traces {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kNear = 1e-5;  // [m2] corners of blocks of some metres move by less than a cell of 1e-7 m

std::multiset<int64_t> areas_in_cm2(const Cut& cut) {
  std::multiset<int64_t> out;
  for (const CutBlock& b : cut.whole) out.insert(std::llround(1e4 * signed_area(cut.polygon(b))));
  return out;
}

Model wall(double width, double height) {
  Model model = rock_model(box_polygon(0, 0, width, height));
  MasonryInput m;
  m.name = "bond";
  m.region = 0;
  m.length = 0.4, m.height = 0.2;
  model.masonry.push_back(m);
  return model;
}

Model tessellated(const Polygon& outline, bool triangles, double size, double irregularity) {
  Model model = rock_model(outline);
  TessellationInput t;
  t.name = "cells";
  t.region = 0;
  t.triangles = triangles;
  t.size = size, t.irregularity = irregularity;
  model.tessellations.push_back(t);
  model.cut.slivers = SliverPolicy::kKeep;
  return model;
}

}  // namespace

TEST_CASE("masonry: running bond of n x m blocks, every second course with two halves") {
  const Cut cut = cut_of(wall(2, 1));  // 5 x 5
  CHECK(partition_defect(cut) == "");
  CHECK(cut.whole.size() == 3 * 5 + 2 * 6);
  const auto areas = areas_in_cm2(cut);
  CHECK(areas.count(800) == 3 * 5 + 2 * 4);
  CHECK(areas.count(400) == 2 * 2);
  for (const CutBlock& b : cut.whole) CHECK(real_corners(cut, b) == 4);
}

TEST_CASE("masonry: overlap, origin, and a region that the courses do not fit") {
  Model model = wall(2, 1);
  model.masonry[0].overlap = 0.25;
  CHECK(areas_in_cm2(cut_of(model)).count(200) == 2);  // a quarter at the left, three at the right
  CHECK(areas_in_cm2(cut_of(model)).count(600) == 2);
  model.masonry[0].overlap = 0;
  CHECK(cut_of(model).whole.size() == 25);
  model.masonry[0].origin = {0.1, -0.05};  // courses of 0.15, 4 x 0.2, 0.05
  const auto areas = areas_in_cm2(cut_of(model));
  CHECK(areas.size() == 6 * 6);
  CHECK(areas.count(150) == 2);  // 0.1 x 0.15 at the lower left, 0.3 x 0.05 at the upper right
  CHECK(areas.count(450) == 1);  // 0.3 x 0.15 at the lower right
  CHECK(areas.count(800) == 4 * 4);
  model.masonry[0].origin = {-40.3, 80.15};  // the same lattice from far away
  CHECK(areas_in_cm2(cut_of(model)) == areas);
}

TEST_CASE("masonry: courses below the origin are shifted by turns, too") {
  const auto areas = areas_in_cm2(cut_of(wall(2, 1)));
  Model model = wall(2, 1);
  model.masonry[0].origin = {0, 2};  // ten courses above the lowest
  CHECK(areas_in_cm2(cut_of(model)) == areas);
  model.masonry[0].origin = {0, 1.8};  // nine: now three courses are shifted
  CHECK(cut_of(model).whole.size() == 2 * 5 + 3 * 6);
}

TEST_CASE("masonry: only its region is divided, and its two kinds of joints have names") {
  Model model = wall(2, 1);
  add_region(model, "lintel", box_polygon(0.8, 0.3, 1.2, 0.7));
  model.masonry[0].bed_joint = 7;
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  int lintel = 0;
  for (const CutBlock& b : cut.whole) lintel += b.region == 1;
  CHECK(lintel == 1);
  std::set<std::string> names;
  for (const Origin& o : cut.origins) names.insert(o.name);
  CHECK(names.count("bond-bed") == 1);
  CHECK(names.count("bond-head") == 1);
}

TEST_CASE("an arch is a ring of equal voussoirs with named sides") {
  Model model;
  model.file = "case.toml";
  ArchInput a;
  a.name = "arch";
  a.center = {1, 2};
  a.radius = 3, a.thickness = 0.5;
  a.from = degrees(20), a.to = degrees(160);
  a.voussoirs = 7;
  model.arches.push_back(a);
  const Polygon ring = arch_polygon(a);
  REQUIRE(ring.size() == 16);
  CHECK(signed_area(ring) > 0);
  const auto at = [&](double r, double deg) {
    return a.center + r * Vec2{std::cos(degrees(deg)), std::sin(degrees(deg))};
  };
  CHECK(norm(ring[0] - at(3, 160)) < 1e-12);
  CHECK(norm(ring[7] - at(3, 20)) < 1e-12);
  CHECK(norm(ring[8] - at(3.5, 20)) < 1e-12);
  CHECK(norm(ring[15] - at(3.5, 160)) < 1e-12);

  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  REQUIRE(cut.blocks.size() == 7);
  // straight faces: two triangles from the centre, (R^2 - r^2) sin 20 deg / 2
  for (const CutBlock& b : cut.blocks)
    CHECK(std::abs(signed_area(cut.polygon(b)) - 0.5 * (3.5 * 3.5 - 9) * std::sin(degrees(20))) < kNear);
  std::map<std::string, int> edges;
  for (const CutBlock& b : cut.blocks)
    for (const int e : b.edge) ++edges[cut.origins[cut.edge_origin[e]].name];
  CHECK(edges["arch-intrados"] == 7);
  CHECK(edges["arch-extrados"] == 7);
  CHECK(edges["arch-start"] == 1);
  CHECK(edges["arch-end"] == 1);
  CHECK(edges["arch"] == 12);  // six joints from both sides
}

TEST_CASE("tessellation: as many Voronoi cells as squares of their size, convex, glued") {
  for (const double irregularity : {0.0, 0.5, 1.0}) {
    const Model model = tessellated(box_polygon(0, 0, 40, 25), false, 1, irregularity);
    const Cut cut = cut_of(model);
    CHECK(partition_defect(cut) == "");
    // those cut by the outline count whole: about half the perimeter of 130 cells more than 1000; 15 % allows
    // for it
    CHECK(std::abs(static_cast<double>(cut.whole.size()) - 1000) < 150);
    for (const CutBlock& b : cut.whole) {
      const Polygon p = cut.polygon(b);
      for (size_t k = 0; k < p.size(); ++k) {
        const Vec2 q = p[(k + 1) % p.size()], r = p[(k + 2) % p.size()];
        CHECK(talus::cross(q - p[k], r - q) > -2 * cut.grid * (norm(q - p[k]) + norm(r - q)));  // to a cell
      }
    }
    for (const BlockShape& s : shapes_of(model, cut, cut.blocks))
      for (size_t k = 0; k < s.polygon.size(); ++k)
        if (cut.origins[s.edge_origin[k]].name == "cells") CHECK(s.edge_joint[k] == model.bonded_joint);
  }
}

TEST_CASE("tessellation: a regular lattice has cells of the size asked for") {
  const Cut cut = cut_of(tessellated(box_polygon(0, 0, 40, 25), false, 2, 0));
  int hexagons = 0;
  for (const CutBlock& b : cut.whole)
    if (std::abs(signed_area(cut.polygon(b)) - 4) < kNear && real_corners(cut, b) == 6) ++hexagons;
  CHECK(hexagons > 150);  // 250 less those along the outline
}

TEST_CASE("tessellation: all blocks of a rectangle in triangles are triangles, edges of about the size") {
  for (const double irregularity : {0.0, 0.5, 1.0}) {
    const Model model = tessellated(box_polygon(-3, 1, 17, 13), true, 1, irregularity);
    const Cut cut = cut_of(model);
    CHECK(partition_defect(cut) == "");
    double sum = 0;
    int edges = 0, inner = 0;
    for (const CutBlock& b : cut.whole) {
      REQUIRE(b.point.size() == 3);
      const Polygon p = cut.polygon(b);
      for (size_t k = 0; k < 3; ++k) {
        sum += norm(p[(k + 1) % 3] - p[k]), ++edges;
        const Origin& o = cut.origins[cut.edge_origin[b.edge[k]]];
        inner += o.name == "cells";
        if (o.name == "cells") CHECK(o.joint == model.bonded_joint);
      }
    }
    CHECK(edges - inner == 2 * (20 + 12));  // pieces of 1 m along the outline
    CHECK(sum / edges > 0.8);               // no outside measure: triangles along the outline are longer
    CHECK(sum / edges < 1.3);
  }
}

TEST_CASE("tessellation: only its region is divided, the same for the same seed") {
  Model model = tessellated(box_polygon(0, 0, 10, 10), false, 1, 0.5);
  add_region(model, "beside", box_polygon(10, 0, 20, 10));
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  int beside = 0;
  for (const CutBlock& b : cut.whole) beside += b.region == 1;
  CHECK(beside == 1);
  CHECK(cut_of(model).point == cut.point);
  model.cut.seed = 2;
  CHECK_FALSE(cut_of(model).point == cut.point);
}

TEST_CASE("a joint set of one region leaves the others whole, also where they overlap") {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  add_region(model, "ore", box_polygon(5, 2, 15, 8));
  model.joint_sets = {joint_set("set", 0, 1)};
  model.joint_sets[0].offset.mean = 0.5;
  model.joint_sets[0].region = 0;
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  double ore = 0;
  for (const CutBlock& b : cut.whole) ore += b.region == 1 ? signed_area(cut.polygon(b)) : 0;
  CHECK(std::abs(ore - 60) < kNear);
  const TraceSet traces = [&] {
    Findings findings("case.toml", "");
    return make_traces(model, RegionMap(model), findings);
  }();
  REQUIRE(traces.joint_sets.size() == 1);
  CHECK(traces.joint_sets[0].traces == 10);
  CHECK(traces.joint_sets[0].length == approx(4 * 10 + 6 * 5).epsilon(1e-12));
}

}  // namespace test_traces
