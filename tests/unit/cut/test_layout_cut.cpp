// Cut blocks in the layout: joints of their edges, supports along named traces, flat corners. (Blocks and
// grids: test_layout.cpp.)

#include <doctest/doctest.h>

#include <set>

#include "support/cut_case.h"
#include "support/layout_case.h"
#include "talus/base/index.h"
#include "talus/cut/check_places.h"
#include "talus/cut/selection.h"
#include "talus/geometry/shapes.h"

namespace test_layout_cut {

using namespace talus;
using namespace talus::test;

namespace {

int block_holding(const Layout& layout, Vec2 p) {
  const std::vector<int> list = blocks_at(layout, p, 0);
  REQUIRE(list.size() == 1);
  return list[0];
}

// The edge of the block around `inside` that passes through `on`.
size_t edge_through(const Layout& layout, Vec2 inside, Vec2 on) {
  const Polygon& p = layout.blocks[block_holding(layout, inside)].polygon;
  for (size_t k = 0; k < p.size(); ++k)
    if (distance_to_segment(on, p[k], p[(k + 1) % p.size()]) < 1e-6) return k;
  FAIL("no such edge");
  return 0;
}
int joint_at(const Layout& layout, Vec2 inside, Vec2 on) {
  const size_t k = edge_through(layout, inside, on);
  return layout.blocks[block_holding(layout, inside)].edge_joint[k];
}
std::string origin_at(const Layout& layout, Vec2 inside, Vec2 on) {
  const size_t k = edge_through(layout, inside, on);
  return layout.origins[layout.blocks[block_holding(layout, inside)].edge_origin[k]];
}

SupportInput along(const std::string& name) {
  SupportInput s;
  s.name = "base";
  s.is_edge = true;
  s.along = name;
  return s;
}

// Places of the corners that a support holds, each once.
std::set<std::pair<double, double>> places(const Layout& layout, const SupportInput& support) {
  std::set<std::pair<double, double>> out;
  for (const SelectedCorner& c : selected_corners(layout, support)) {
    CHECK(layout.blocks[c.block].polygon[c.vertex] == c.point);
    out.insert({c.point.x, c.point.y});
  }
  return out;
}

// One block of corners in cells of the grid 2^-20 m; origins of its edges by number.
Cut one_block(const std::vector<Cell>& corners, const std::vector<int>& origins) {
  Cut cut;
  cut.grid = 0x1p-20;
  cut.regions.push_back({"rock", {}, {}, 0, -1, BlockKind::kDeformable});
  CutBlock b;
  const int n = count_of(corners);
  for (int i = 0; i < n; ++i) {
    const Cell c = corners[i];
    cut.point.push_back({static_cast<double>(c.x) * cut.grid, static_cast<double>(c.y) * cut.grid});
    cut.edge.push_back({std::min(i, (i + 1) % n), std::max(i, (i + 1) % n)});
    cut.edge_origin.push_back(origins[i]);
    b.point.push_back(i);
    b.edge.push_back(i);
  }
  for (int i = 0; i <= *std::max_element(origins.begin(), origins.end()); ++i)
    cut.origins.push_back({fmt::format("line{}", i), OriginKind::kFault, -1});
  cut.whole = cut.blocks = {b};
  return cut;
}

Polygon shape_of(const Cut& cut) {
  return shapes_of(rock_model(box_polygon(0, 0, 1, 1)), cut, cut.blocks).at(0).polygon;
}

constexpr int64_t kMetre = 1 << 20;

}  // namespace

TEST_CASE("layout of a cut: every edge has the joint of its trace, else of its region, else the default") {
  Model model = rock_model(box_polygon(0, 0, 8, 4));
  add_region(model, "ore", box_polygon(0, 4, 8, 8));
  for (int i = 0; i < 5; ++i) model.joints.push_back({});  // 0 is the glue
  model.regions[1].joint = 1;
  model.default_joint = 2;
  add_fault(model, {{2, -1}, {2, 9}});
  add_fault(model, {{4, -1}, {4, 9}});
  model.faults[1].joint = 3;
  model.joint_sets = {joint_set("set", degrees(90), 100)};
  model.joint_sets[0].origin = {6, 0};
  model.joint_sets[0].joint = 4;
  add_opening(model, box_polygon(6.5, 1, 7.5, 2), true);
  add_opening(model, box_polygon(6.5, 5, 7.5, 6), true);
  model.openings[1].joint = 5;
  const Layout layout = layout_of(model);
  CHECK(joint_at(layout, {1, 2}, {2, 2}) == 2);                     // fault without joint in rock: default
  CHECK(joint_at(layout, {1, 6}, {2, 6}) == 1);                     // in ore: that of the region
  CHECK(joint_at(layout, {3, 2}, {4, 2}) == 3);                     // fault's own
  CHECK(joint_at(layout, {5, 6}, {6, 6}) == 4);                     // set's own
  CHECK(joint_at(layout, {7, 1.5}, {7, 1}) == model.bonded_joint);  // kept opening: glued
  CHECK(joint_at(layout, {7, 5.5}, {7, 5}) == 5);                   // or its own
  CHECK(origin_at(layout, {7, 1.5}, {7, 1}) == "opening0");
  CHECK(origin_at(layout, {1, 2}, {0, 2}) == "rock-4");
  // two blocks that meet: the joint of the edge, unless the pair of groups has one
  const int a = block_holding(layout, {3, 2}), b = block_holding(layout, {5, 2});
  const auto k = static_cast<int>(edge_through(layout, {3, 2}, {4, 2}));
  CHECK(layout.joint_at({a, k}, {b, -1}) == 3);
  CHECK(layout.joint_at({b, -1}, {a, k}) == 3);
  CHECK(layout.joint_at({a, -1}, {b, -1}) == 2);
  model.contact_pairs.push_back({"rock", "ore", 5, {}});
  const Layout with_pair = layout_of(model);
  CHECK(with_pair.joint_at({block_holding(with_pair, {1, 2}), 0}, {block_holding(with_pair, {1, 6}), 0}) ==
        5);
}

TEST_CASE("layout of a cut: groups are regions and openings, names are theirs and the number") {
  Model model = rock_model(box_polygon(0, 0, 8, 4));
  add_region(model, "ore", box_polygon(0, 4, 8, 8));
  add_opening(model, box_polygon(6, 1, 8, 3), true);
  model.blocks.push_back(block_input("slab", box_polygon(0, 8, 8, 9)));
  const Layout layout = layout_of(model);
  CHECK(layout.groups == std::vector<std::string>{"slab", "rock", "ore", "opening0"});
  CHECK(layout.blocks_called("ore") == std::vector<int>{block_holding(layout, {1, 6})});
  CHECK(layout.blocks_called("opening0") == std::vector<int>{block_holding(layout, {7, 2})});
  const BlockShape& rock = layout.blocks[block_holding(layout, {1, 1})];
  CHECK(layout.blocks_called(rock.name).size() == 1);
  CHECK(rock.name == fmt::format("rock[{}]", rock.id - 1));  // ids go on after the slab
}

TEST_CASE("layout of a cut: a support along a side holds exactly the corners on that side") {
  Model model = rock_model(box_polygon(0, 0, 8, 4));
  model.regions[0].sides = {"base", "east", "top", "west"};
  model.joint_sets = {joint_set("set", degrees(90), 2)};
  model.joint_sets[0].offset.mean = -1;  // at 1, 3, 5, 7
  const Layout layout = layout_of(model);
  using Places = std::set<std::pair<double, double>>;
  CHECK(places(layout, along("base")) == Places{{0, 0}, {1, 0}, {3, 0}, {5, 0}, {7, 0}, {8, 0}});
  CHECK(places(layout, along("east")) == Places{{8, 0}, {8, 4}});
  CHECK(selected_corners(layout, along("base")).size() == 10);  // two of each block
  CHECK(places(layout, along("set")).size() == 8);
  SupportInput one = along("base");
  one.block = layout.blocks[block_holding(layout, {0.5, 2})].name;
  CHECK(places(layout, one) == Places{{0, 0}, {1, 0}});
  // a side of two edges, and one that nothing is left of
  model.regions[0].sides = {"base", "walls", "top", "walls"};
  CHECK(places(layout_of(model), along("walls")) == Places{{0, 0}, {0, 4}, {8, 0}, {8, 4}});
  model.supports.push_back(along("bottom"));
  Findings findings("case.toml", "");
  checked_layout(model, findings);
  CHECK(findings.render().find("there is no side, opening, fault or joint set called \"bottom\"") !=
        std::string::npos);
}

TEST_CASE("layout of a cut: a support along the base holds kept rock of an opening that stands on it") {
  Model model = rock_model(box_polygon(0, 0, 8, 4));
  model.regions[0].sides = {"base", "east", "top", "west"};
  add_opening(model, box_polygon(3, 0, 5, 2), true);
  using Places = std::set<std::pair<double, double>>;
  const Layout layout = layout_of(model);
  SupportInput s = along("base");
  s.block = "opening0";
  CHECK(places(layout, s) == Places{{3, 0}, {5, 0}});
}

TEST_CASE("layout of a cut: removed rock leaves no glue on the walls it leaves") {
  Model model = rock_model(box_polygon(0, 0, 8, 8));
  model.default_joint = -1;
  add_opening(model, box_polygon(2, 2, 6, 6), false);
  model.blocks.push_back(block_input("lining", box_polygon(2, 2, 6, 3)));
  const Layout layout = layout_of(model);
  const int rock = block_holding(layout, {4, 1});
  const auto floor = static_cast<int>(edge_through(layout, {4, 1}, {4, 2}));
  CHECK(layout.joint_at({rock, floor}, {0, 0}) == -1);
}

TEST_CASE("layout of a cut: flat corners are no corners, those where another trace begins are") {
  const Cell a{0, 0}, b{kMetre, 0}, c{2 * kMetre, 0}, d{2 * kMetre, kMetre}, e{0, kMetre};
  CHECK(shape_of(one_block({a, b, c, d, e}, {0, 0, 1, 2, 3})).size() == 4);
  CHECK(shape_of(one_block({b, c, d, e, a}, {0, 1, 2, 3, 0})).size() == 4);  // also when it is the first
  CHECK(shape_of(one_block({a, b, c, d, e}, {0, 4, 1, 2, 3})).size() == 5);
  // off by one cell is flat, by two is not
  CHECK(shape_of(one_block({a, {kMetre, 1}, c, d, e}, {0, 0, 1, 2, 3})).size() == 4);
  CHECK(shape_of(one_block({a, {kMetre, 2}, c, d, e}, {0, 0, 1, 2, 3})).size() == 5);
  // a chain that bends by less than a cell from corner to corner, but by more from end to end
  std::vector<Cell> bow{{2 * kMetre, kMetre}, {0, kMetre}};
  std::vector<int> origins{1, 2};
  for (int i = 0; i <= 16; ++i) bow.push_back({i * kMetre / 8, -(i * (16 - i)) / 4}), origins.push_back(0);
  origins.back() = 3;
  const Polygon shape = shape_of(one_block(bow, origins));
  CHECK(shape.size() > 5);
  CHECK(shape.size() < bow.size());
  for (const Cell& p : bow) {
    double d_min = 1e300;
    for (size_t k = 0; k < shape.size(); ++k)
      d_min = std::min(
          d_min, distance_to_segment({static_cast<double>(p.x) * 0x1p-20, static_cast<double>(p.y) * 0x1p-20},
                                     shape[k], shape[(k + 1) % shape.size()]));
    CHECK(d_min <= 0x1p-20);
  }
}

TEST_CASE("layout of a cut: corners within a cell of each other do not make the polygon cross itself") {
  // without its flat corner (0, 0) the last edge would pass on the other side of (1, 1)
  const std::vector<Cell> corners{{0, 0}, {1, 0}, {1, 1}, {10696700, 25174676}, {7890684, 23554622}};
  const Cut cut = one_block(corners, {0, 0, 1, 2, 0});
  REQUIRE(is_simple(CellCut(cut).ring(cut.blocks[0])));
  CHECK(polygon_defect(shape_of(cut)) == "");
}

TEST_CASE("layout of a cut: a block two cells wide does not cross itself either, though its edges are long") {
  const std::vector<Cell> corners{{0, 0},    {2525, 616}, {297, 73}, {420, 104}, {408, 102},
                                  {302, 76}, {185, 47},   {55, 15},  {-90, -21}};
  const Cut cut = one_block(corners, {0, 1, 1, 2, 3, 2, 4, 1, 0});
  REQUIRE(is_simple(CellCut(cut).ring(cut.blocks[0])));
  CHECK(polygon_defect(shape_of(cut)).find("itself") == std::string::npos);
}

}  // namespace test_layout_cut
