#include "talus/cut/slivers.h"

#include <doctest/doctest.h>

#include "support/cut_case.h"
#include "talus/geometry/shapes.h"

namespace test_slivers {

using namespace talus;
using namespace talus::test;

namespace {

// Areas and widths of blocks of some square metres on a grid of 1e-7 m: corners move by less than a cell.
constexpr double kNear = 1e-5;

JointSetInput one_line(const std::string& name, double angle, Vec2 origin) {
  JointSetInput set = joint_set(name, degrees(angle), 1000);
  set.origin = origin;
  return set;
}

// A square of 10 m in three columns, 4, 5 and 1 m wide, by joint sets that are one line each.
Model columns() {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  model.joint_sets = {one_line("a", 90, {4, 0}), one_line("b", 90, {9, 0})};
  return model;
}

// A square of 20 m by level lines at 5, 10 and 15 m and upright ones at 5, 9, 10 and 15 m: the strip between
// 9 ("left") and 10 ("right") has two blocks inside, at 5 to 10 and 10 to 15 m, and two at the outline.
Model lattice() {
  Model model = rock_model(box_polygon(0, 0, 20, 20));
  model.joint_sets = {one_line("v1", 90, {5, 0}),     one_line("left", 90, {9, 0}),
                      one_line("right", 90, {10, 0}), one_line("v4", 90, {15, 0}),
                      one_line("h1", 0, {0, 5}),      one_line("h2", 0, {0, 10}),
                      one_line("h3", 0, {0, 15})};
  model.cut.sliver_area_share = 0;
  return model;
}

// The same with lines beside the strip that end 5 m from the outline, on the level lines.
Model inner_lattice() {
  Model model = lattice();
  for (const int i : {1, 2}) {
    JointSetInput& set = model.joint_sets[i];
    set.trace_length.mean = 10, set.gap.mean = 100, set.start.mean = 5;
  }
  return model;
}

Model merging(Model model, const std::vector<std::string>& along = {}) {
  model.cut.slivers = SliverPolicy::kMerge;
  model.cut.merge_along = along;
  return model;
}

double area_at(const Cut& cut, Vec2 p) {
  const int i = block_at(cut, cut.blocks, p);
  return i < 0 ? 0 : signed_area(cut.polygon(cut.blocks[i]));
}

void add_support(Model& model, Vec2 from, Vec2 to) {
  SupportInput s;
  s.name = "hold";
  s.is_edge = norm(to - from) > 0;
  s.from = from, s.to = to;
  model.supports.push_back(s);
}

}  // namespace

TEST_CASE("slivers: limits are the larger of the absolute ones and the shares of the median") {
  Model model = columns();
  SliverTable t = cut_of(model).slivers;
  REQUIRE(t.limits.size() == 1);
  CHECK(std::abs(t.limits[0].median_area - 40) < kNear);  // of 10, 40, 50
  CHECK(std::abs(t.limits[0].median_width - 4) < kNear);  // of 1, 4, 5
  CHECK(std::abs(t.limits[0].area - 0.8) < kNear);
  CHECK(std::abs(t.limits[0].width - 1.2) < kNear);
  REQUIRE(t.rows.size() == 1);  // the narrow one
  CHECK(std::abs(t.rows[0].area - 10) < kNear);
  CHECK(std::abs(t.rows[0].width - 1) < kNear);
  CHECK(norm(t.rows[0].at - Vec2{9.5, 5}) < kNear);
  CHECK(t.rows[0].action == SliverAction::kKept);
  CHECK(t.rows[0].into == -1);
  CHECK((t.kept == 1 && t.needles == 0 && t.merged == 0 && t.deleted == 0 && t.receivers == 0 &&
         t.deleted_area == 0));
  model.cut.sliver_area = 45, model.cut.sliver_width = 0.5;
  t = cut_of(model).slivers;
  CHECK(t.limits[0].area == 45);
  CHECK(std::abs(t.limits[0].width - 1.2) < kNear);
  CHECK(t.rows.size() == 2);
  model.regions[0].sliver_area = 5;  // the region's own goes before
  CHECK(cut_of(model).slivers.limits[0].area == 5);
  model.regions[0].sliver_area = model.cut.sliver_area = 0;
  model.cut.sliver_area_share = model.cut.sliver_width_share = 0;
  CHECK(cut_of(model).slivers.rows.empty());
}

TEST_CASE("slivers: every region has limits of its own") {
  Model model = columns();
  add_region(model, "lining", box_polygon(0, 0, 10, 0.1));
  for (int i = 1; i < 20; ++i) add_fault(model, {{0.5 * i, -1}, {0.5 * i, 0.1}});
  const Cut cut = cut_of(model);
  // blocks of 0.5 x 0.1 m are no slivers among their own
  CHECK(cut.slivers.kept == 1);
  REQUIRE(cut.slivers.limits.size() == 2);
  CHECK(std::abs(cut.slivers.limits[1].median_width - 0.1) < kNear);
}

TEST_CASE("slivers: nothing with a joint is merged unless asked for") {
  for (const Model& model : {lattice(), inner_lattice()}) {
    const Cut cut = cut_of(model);
    CHECK(cut.blocks.size() == cut.whole.size());
    CHECK((cut.slivers.kept > 0 && cut.slivers.merged == 0 && cut.slivers.opened.empty()));
  }
}

TEST_CASE("slivers: merging stays away from the outline and from lines that reach it") {
  Cut cut = cut_of(merging(lattice()));
  CHECK((cut.slivers.merged == 0 && cut.slivers.kept == 4));
  // named: the two blocks inside, across the line that may be interrupted and no other
  cut = cut_of(merging(lattice(), {"left"}));
  CHECK(partition_defect(cut) == "");
  CHECK((cut.slivers.merged == 2 && cut.slivers.kept == 2 && cut.slivers.receivers == 2));
  CHECK(std::abs(area_at(cut, {9.5, 7}) - 25) < kNear);
  CHECK(std::abs(area_at(cut, {7, 7}) - 25) < kNear);
  CHECK(std::abs(area_at(cut, {12, 7}) - 25) < kNear);
  CHECK(std::abs(area_at(cut, {9.5, 2}) - 5) < kNear);
  REQUIRE(cut.slivers.opened.size() == 2);
  for (const int e : cut.slivers.opened)
    for (const int p : cut.edge[e]) CHECK(std::abs(cut.point[p].x - 9) < kNear);
  const Sliver& first = cut.slivers.rows.at(0);
  CHECK((first.action == SliverAction::kMerged && first.into >= 0));
  CHECK(std::abs(first.area - 5) < kNear);
}

TEST_CASE("slivers: lines that end inside may be interrupted without being named") {
  const Cut cut = cut_of(merging(inner_lattice()));
  CHECK(partition_defect(cut) == "");
  CHECK((cut.slivers.merged == 2 && cut.slivers.kept == 0));
  CHECK(std::abs(area_at(cut, {9.5, 7}) - 25) < kNear);
}

TEST_CASE("slivers: never across a fault, a surveyed trace, a face of an opening, or beside a support") {
  const std::vector<std::string> both{"left", "right"};
  REQUIRE(cut_of(merging(lattice(), both)).slivers.merged == 2);
  // all four sides of the strip's blocks
  const auto closed = [](Model model, bool surveyed) {
    model.joint_sets.clear();
    for (const double c : {5.0, 9.0, 10.0, 15.0}) {
      std::vector<Polyline> lines{{{c, -1}, {c, 21}}};
      if (c != 9) lines.push_back({{-1, c}, {21, c}});
      for (const Polyline& line : lines) {
        if (!surveyed) {
          add_fault(model, line);
          continue;
        }
        TracesInput t;
        t.name = fmt::format("map{}", model.traces.size());
        t.lines = {line};
        model.traces.push_back(t);
      }
    }
    return merging(model);
  };
  CHECK(cut_of(closed(lattice(), false)).slivers.merged == 0);
  CHECK(cut_of(closed(lattice(), true)).slivers.merged == 0);
  Model model = merging(lattice(), both);
  add_opening(model, box_polygon(9.5, 12, 12, 13), false);  // cuts the upper one
  CHECK(cut_of(model).slivers.merged == 1);
  model = merging(lattice(), both);
  add_support(model, {9.5, 7}, {9.5, 7});
  CHECK(cut_of(model).slivers.merged == 1);
  add_support(model, {9.2, 12}, {9.7, 12});
  CHECK(cut_of(model).slivers.merged == 0);
}

TEST_CASE("slivers: merging goes on with what it makes, the smallest first") {
  Model model = merging(lattice(), {"v1", "left", "right", "v4", "h1", "h2", "h3"});
  model.cut.sliver_width_share = 0;
  model.cut.sliver_area = 99;  // until one is left inside: 10 x 10 m
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  CHECK(cut.slivers.merged == 5);
  CHECK(std::abs(area_at(cut, {7, 7}) - 100) < kNear);
  CHECK(std::abs(cut.slivers.rows.at(0).area - 5) < kNear);
}

TEST_CASE("slivers: delete takes them out and tells their area") {
  Model model = lattice();
  model.cut.slivers = SliverPolicy::kDelete;
  const Cut cut = cut_of(model);
  CHECK(cut.blocks.size() == cut.whole.size() - 4);
  CHECK((cut.slivers.deleted == 4 && cut.slivers.merged == 0 && cut.slivers.kept == 0));
  CHECK(std::abs(cut.slivers.deleted_area - 20) < kNear);
  CHECK(area_at(cut, {9.5, 9}) == 0);
  for (const Sliver& row : cut.slivers.rows) CHECK(row.action == SliverAction::kDeleted);
}

TEST_CASE("slivers: they merge only within their region and opening") {
  Model model = merging(lattice(), {"left", "right"});
  add_region(model, "band", box_polygon(9, -1, 10, 21));  // the strip is a region of its own
  CHECK(cut_of(model).slivers.merged == 0);
}

TEST_CASE("slivers: rock that is removed is not judged") {
  Model model = columns();
  add_opening(model, box_polygon(9, 0, 10, 10), false);
  const Cut cut = cut_of(model);
  CHECK(cut.slivers.rows.empty());
  CHECK(cut.taken_out == 1);
  CHECK(std::abs(cut.slivers.limits[0].median_area - 50) < kNear);  // of 40 and 50, the upper
}

TEST_CASE("slivers: the rock of an opening, kept or removed, does not change what is a sliver outside") {
  const auto names = [](bool kept) {
    Model model = columns();  // and four more columns of 1 m, all rock of the opening
    model.cut.slivers = SliverPolicy::kDelete;
    model.regions[0].polygon = box_polygon(0, 0, 14, 10);
    add_opening(model, box_polygon(10, 0, 14, 10), kept);
    for (int i = 11; i < 14; ++i)
      add_fault(model, {{static_cast<double>(i), -1}, {static_cast<double>(i), 11}});
    const Cut cut = cut_of(model);
    std::vector<std::string> out;
    for (const CutBlock& b : cut.blocks)
      if (b.opening < 0) out.push_back(cut.name(b));
    return out;
  };
  CHECK(names(true) == names(false));
}

TEST_CASE("needles: hairs between two joints that the grid hardly resolves are one joint") {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  for (int i = 0; i < 4; ++i) add_fault(model, {{-1, 5 + 1e-6 * i}, {11, 5 + 1e-6 * i}});
  Cut cut = cut_of(model);
  CHECK(cut.whole.size() == 5);
  CHECK(cut.blocks.size() == 2);
  CHECK((cut.slivers.needles == 3 && cut.slivers.merged == 0));
  for (const CutBlock& b : cut.blocks) CHECK(polygon_defect(cut.polygon(b)) == "");
  // a joint of a set goes before a fault: the fault stays straight
  model = rock_model(box_polygon(0, 0, 10, 10));
  add_fault(model, {{-1, 5}, {11, 5}});
  model.joint_sets = {one_line("set", 0, {0, 5 + 1e-6})};
  cut = cut_of(model);
  REQUIRE(cut.blocks.size() == 2);
  for (const CutBlock& b : cut.blocks)
    for (const int e : b.edge) CHECK(cut.origins[cut.edge_origin[e]].kind != OriginKind::kJointSet);
}

TEST_CASE("needles: what lies between the facets of two circles goes back to its region") {
  // a ring of rock of its own around an opening of the same radius: inscribed corners against equal areas
  const double radius = 2.8;
  Model model = rock_model(box_polygon(-10, -10, 10, 10));
  Polygon ring;
  for (int i = 0; i < 32; ++i) {
    const double a = degrees(360.0 / 32 * (i + 0.5));
    ring.push_back({radius * std::cos(a), radius * std::sin(a)});
  }
  add_region(model, "core", ring);
  add_opening(model, circle_polygon({0, 0}, 2 * radius, 32), true);
  model.openings[0].sagitta = 0;
  Cut cut = cut_of(model);
  const size_t with = cut.blocks.size();
  CHECK(cut.slivers.needles == 0);
  model.openings[0].sagitta = sagitta(radius, degrees(360.0 / 32));
  cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  CHECK(cut.slivers.needles >= 64);  // 32 corners of the ring, 32 of the opening
  CHECK(cut.blocks.size() == with - static_cast<size_t>(cut.slivers.needles));
  for (const CutBlock& b : cut.blocks) CHECK(signed_area(cut.polygon(b)) > 1);
  // a strip of that width that meets the opening with its end alone is none
  model.joint_sets = {one_line("a", 90, {0, 0}), one_line("b", 90, {0.01, 0})};
  cut = cut_of(model);
  CHECK(area_at(cut, {0.005, 5}) > 0.05);
  CHECK(area_at(cut, {0.005, 5}) < 0.1);
}

TEST_CASE("needles: cells of a glued tessellation are judged among their own") {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  TessellationInput t;
  t.name = "cells";
  t.region = 0;
  t.size = 1;
  t.irregularity = 1;
  model.tessellations.push_back(t);
  model.cut.sliver_width = 5;  // asked for on purpose: cells stay as they are drawn
  model.cut.sliver_width_share = 0.6, model.cut.sliver_area_share = 0.3;
  Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  CHECK(cut.slivers.needles > 0);
  CHECK(cut.blocks.size() > 50);
  model.joints.push_back(JointProperty{});
  model.joints[1].name = "real";
  model.tessellations[0].joint = 1;
  CHECK(cut_of(model).slivers.needles == 0);
}

}  // namespace test_slivers
