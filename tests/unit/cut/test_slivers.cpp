#include "talus/cut/slivers.h"

#include <doctest/doctest.h>

#include "support/cut_case.h"
#include "talus/geometry/shapes.h"

using namespace talus;
using namespace talus::test;

namespace {

// Areas and widths of blocks of some square metres on a grid of 1e-7 m: corners move by less than a cell.
constexpr double kNear = 1e-5;

// A square of 10 m in three columns, 4, 5 and 1 m wide, by joint sets that are one line each.
Model columns() {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  model.joint_sets = {joint_set("a", degrees(90), 100), joint_set("b", degrees(90), 100)};
  model.joint_sets[0].origin = {4, 0};
  model.joint_sets[1].origin = {9, 0};
  return model;
}

// And one level line 2 m from the top.
Model columns_and_top() {
  Model model = columns();
  model.joint_sets.push_back(joint_set("top", 0, 100));
  model.joint_sets.back().origin = {0, 8};
  return model;
}

double area_at(const Cut& cut, Vec2 p) {
  const int i = block_at(cut, cut.blocks, p);
  return i < 0 ? 0 : signed_area(cut.polygon(cut.blocks[static_cast<size_t>(i)]));
}

}  // namespace

TEST_CASE("slivers: limits are the larger of the absolute ones and the shares of the median") {
  Model model = columns();
  model.cut.slivers = SliverPolicy::kKeep;
  SliverTable t = cut_of(model).slivers;
  CHECK(std::abs(t.median_area - 40) < kNear);  // of 10, 40, 50
  CHECK(std::abs(t.median_width - 4) < kNear);  // of 1, 4, 5
  CHECK(std::abs(t.area_limit - 0.8) < kNear);
  CHECK(std::abs(t.width_limit - 1.2) < kNear);
  REQUIRE(t.rows.size() == 1);  // the narrow one
  CHECK(std::abs(t.rows[0].area - 10) < kNear);
  CHECK(std::abs(t.rows[0].width - 1) < kNear);
  CHECK(norm(t.rows[0].at - Vec2{9.5, 5}) < kNear);
  CHECK(t.rows[0].action == SliverAction::kKept);
  CHECK(t.rows[0].into == -1);
  CHECK((t.kept == 1 && t.merged == 0 && t.deleted == 0 && t.receivers == 0 && t.deleted_area == 0));
  model.cut.sliver_area = 45, model.cut.sliver_width = 0.5;
  t = cut_of(model).slivers;
  CHECK(t.area_limit == 45);
  CHECK(std::abs(t.width_limit - 1.2) < kNear);
  CHECK(t.rows.size() == 2);
  model.cut.sliver_area = 0;
  model.cut.sliver_area_share = model.cut.sliver_width_share = 0;
  CHECK(cut_of(model).slivers.rows.empty());
}

TEST_CASE("slivers: a strip merges into the neighbour with the longest shared edge") {
  Model model = columns_and_top();
  // the strip at the top has blocks of 4 x 2, 5 x 2 and 1 x 2, below are 4 x 8, 5 x 8 and 1 x 8
  model.cut.sliver_width_share = model.cut.sliver_area_share = 0;
  model.cut.sliver_area = 2.5;  // the corner block alone: 2 m to its left, 1 m below
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  REQUIRE(cut.blocks.size() == 5);
  CHECK(std::abs(area_at(cut, {9.5, 9}) - 12) < kNear);
  CHECK(std::abs(area_at(cut, {6, 9}) - 12) < kNear);
  const SliverTable& t = cut.slivers;
  REQUIRE(t.rows.size() == 1);
  CHECK((t.merged == 1 && t.kept == 0 && t.receivers == 1));
  CHECK(std::abs(t.rows[0].area - 2) < kNear);
  CHECK(t.rows[0].action == SliverAction::kMerged);
  CHECK(t.rows[0].into == cut.blocks[static_cast<size_t>(block_at(cut, cut.blocks, {6, 9}))].id);
  CHECK(t.rows[0].id == cut.whole[static_cast<size_t>(block_at(cut, cut.whole, {9.5, 9}))].id);
}

TEST_CASE("slivers: the smallest goes first, and what it makes is judged again") {
  Model model = columns_and_top();
  model.cut.sliver_width_share = model.cut.sliver_area_share = 0;
  // 2 (corner) joins 10 to 12; 8 (top left) joins the longer border of 4 m below it; 8 (1 x 8) the column
  // beside it
  model.cut.sliver_area = 8.5;
  Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  CHECK(cut.slivers.rows.size() == 3);
  CHECK(std::abs(cut.slivers.rows[0].area - 2) < kNear);
  CHECK(std::abs(area_at(cut, {9.5, 9}) - 12) < kNear);
  CHECK(std::abs(area_at(cut, {1, 9}) - 40) < kNear);
  CHECK(std::abs(area_at(cut, {9.5, 1}) - 48) < kNear);
  model.cut.sliver_area = 99;  // until one is left
  cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  REQUIRE(cut.blocks.size() == 1);
  CHECK(cut.slivers.merged == 5);
  CHECK(cut.slivers.kept == 0);
  CHECK(std::abs(area_at(cut, {5, 5}) - 100) < kNear);
}

TEST_CASE("slivers: a thin strip between two parallel lines goes to one side whole") {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  model.joint_sets = {joint_set("a", degrees(30), 100), joint_set("b", degrees(30), 100)};
  model.joint_sets[0].origin = {5, 5};
  model.joint_sets[1].origin = {5, 5.01};
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  CHECK(cut.whole.size() == 3);
  REQUIRE(cut.blocks.size() == 2);
  // 50 m2 below and 49.9 above it; the strip is 10 / cos 30 deg long and 0.01 cos 30 deg wide
  const double below = area_at(cut, {5, 1}), above = area_at(cut, {5, 9});
  CHECK(std::abs(below + above - 100) < kNear);
  CHECK(std::min(std::abs(below - 50), std::abs(above - 49.9)) < kNear);
  CHECK(std::abs(cut.slivers.rows.at(0).area - 0.1) < kNear);
}

TEST_CASE("slivers: a fault stays whole as long as another neighbour can take the sliver") {
  Model model = columns_and_top();
  model.joint_sets.erase(model.joint_sets.begin() + 1);
  add_fault(model, {{9, -1}, {9, 11}});  // instead of the line 1 m from the right side
  model.cut.sliver_width_share = model.cut.sliver_area_share = 0;
  model.cut.sliver_area = 2.5;
  Cut cut = cut_of(model);
  CHECK(std::abs(area_at(cut, {9.5, 9}) - 10) < kNear);  // now the block below, along 1 m instead of 2 m
  model.joint_sets.pop_back();                           // no level line: nobody else can take the strip
  model.cut.sliver_area = 15;
  cut = cut_of(model);
  CHECK(cut.blocks.size() == 2);
  CHECK(cut.slivers.merged == 1);
}

TEST_CASE("slivers: delete takes them out and tells their area") {
  Model model = columns_and_top();
  model.cut.slivers = SliverPolicy::kDelete;
  model.cut.sliver_width_share = model.cut.sliver_area_share = 0;
  model.cut.sliver_area = 8.5;
  const Cut cut = cut_of(model);
  CHECK(cut.blocks.size() == 3);
  CHECK((cut.slivers.deleted == 3 && cut.slivers.merged == 0 && cut.slivers.kept == 0));
  CHECK(std::abs(cut.slivers.deleted_area - (2 + 8 + 8)) < kNear);
  CHECK(area_at(cut, {9.5, 9}) == 0);
  for (const Sliver& row : cut.slivers.rows) CHECK(row.action == SliverAction::kDeleted);
  CHECK(cut.whole.size() == 6);
}

TEST_CASE("slivers: they merge only within their region and opening") {
  Model model = columns();
  add_region(model, "lower",
             box_polygon(0, 0, 10, 1));  // strips of 4, 5 and 1 m2, which the upper rock borders
  add_opening(model, box_polygon(0, 9.9, 0.1, 10), true);
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  double lower = 0;
  for (const CutBlock& b : cut.blocks) lower += b.region == 1 ? signed_area(cut.polygon(b)) : 0;
  CHECK(std::abs(lower - 10) < kNear);
  CHECK(cut.slivers.kept == 1);  // the rock of the opening: nothing may take it
  for (const Sliver& row : cut.slivers.rows)
    if (row.action == SliverAction::kKept) CHECK(std::abs(row.area - 0.01) < kNear);
}

TEST_CASE("slivers: one that closes a ring around an opening with its only neighbour stays, and is told") {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  add_opening(model, box_polygon(1, 1, 9, 9.5), false);
  add_fault(model, {{-1, 9.5}, {11, 9.5}});  // 5 m2 above, 27 m2 around
  model.cut.sliver_area = 6;
  const Cut cut = cut_of(model);
  CHECK(partition_defect(cut) == "");
  CHECK(cut.blocks.size() == 2);
  CHECK(cut.slivers.kept == 1);
}

TEST_CASE("slivers: rock that is removed is not judged") {
  Model model = columns();
  add_opening(model, box_polygon(9, 0, 10, 10), false);
  const Cut cut = cut_of(model);
  CHECK(cut.slivers.rows.empty());
  CHECK(cut.taken_out == 1);
  CHECK(std::abs(cut.slivers.median_area - 50) < kNear);  // of 40 and 50, the upper
}

TEST_CASE("slivers: the rock of an opening, kept or removed, does not change what is a sliver outside") {
  const auto names = [](bool kept) {
    Model model = columns();  // and four more columns of 1 m, all rock of the opening
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

TEST_CASE("slivers: blocks that are left have an area even where most blocks are hair-thin") {
  Model model = rock_model(box_polygon(0, 0, 10, 10));
  for (int i = 0; i < 4; ++i) add_fault(model, {{-1, 5 + 1e-6 * i}, {11, 5 + 1e-6 * i}});
  const Cut cut = cut_of(model);
  CHECK(cut.whole.size() == 5);
  for (const CutBlock& b : cut.blocks) CHECK(polygon_defect(cut.polygon(b)) == "");
}
