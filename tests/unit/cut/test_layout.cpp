#include "talus/cut/layout.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/box_polygon.h"
#include "support/layout_case.h"
#include "talus/cut/check_places.h"
#include "talus/cut/selection.h"

namespace test_layout {

using namespace talus;
using namespace talus::test;

namespace {

GridInput grid(const std::string& name, Vec2 min, Vec2 max, int columns, int rows, int joint = 0) {
  GridInput g;
  g.name = name;
  g.min = min, g.max = max;
  g.columns = columns, g.rows = rows;
  g.material = 0;
  g.joint = joint;
  return g;
}

std::string errors_of(const Model& model) {
  Findings findings("case.toml", "");
  checked_layout(model, findings);
  CHECK(findings.has_errors());
  return findings.render();
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

SupportInput edge_support(Vec2 from, Vec2 to) {
  SupportInput s;
  s.name = "base";
  s.is_edge = true;
  s.from = from, s.to = to;
  return s;
}

SupportInput point_support(Vec2 at, const std::string& on = "") {
  SupportInput s;
  s.name = "pin";
  s.from = s.to = at;
  s.block = on;
  return s;
}

}  // namespace

TEST_CASE("cells of a grid tile its rectangle and share their corners to the last bit") {
  for (const GridPattern pattern : {GridPattern::kRectangles, GridPattern::kCrossedTriangles}) {
    const bool triangles = pattern == GridPattern::kCrossedTriangles;
    CAPTURE(triangles);
    Model model;
    model.grids = {grid("wall", {-0.1, 0.3}, {1.0 / 3, 2.7}, 7, 5)};  // no corner is exact in binary
    model.grids[0].pattern = pattern;
    const Layout layout = layout_of(model);
    REQUIRE(layout.blocks.size() == (triangles ? 140 : 35));
    double area = 0;
    std::vector<Vec2> corners;
    for (const BlockShape& b : layout.blocks) {
      CHECK(signed_area(b.polygon) > 0);
      area += signed_area(b.polygon);
      corners.insert(corners.end(), b.polygon.begin(), b.polygon.end());
    }
    const double whole = (1.0 / 3 + 0.1) * 2.4;
    CHECK(std::abs(area - whole) <= 1e-14 * whole);  // 140 areas, each rounded by 1e-16
    std::sort(corners.begin(), corners.end(),
              [](Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    const auto different = std::unique(corners.begin(), corners.end()) - corners.begin();
    CHECK(different == (triangles ? 48 + 35 : 48));
    CHECK(corners.front() == Vec2{-0.1, 0.3});
    CHECK(corners[different - 1] == Vec2{1.0 / 3, 2.7});
  }
}

TEST_CASE("areas of a grid with exact corners sum exactly") {
  Model model;
  model.grids = {grid("wall", {0, 0}, {4, 2}, 16, 8)};
  model.grids[0].pattern = GridPattern::kCrossedTriangles;
  double area = 0;
  for (const BlockShape& b : layout_of(model).blocks) area += signed_area(b.polygon);
  CHECK(area == 8);  // all numbers are sums of powers of two
}

TEST_CASE("names of grid cells run from the lower left, triangles from the lower one") {
  Model model;
  model.grids = {grid("wall", {0, 0}, {2, 2}, 2, 2), grid("roof", {0, 2}, {2, 4}, 1, 1)};
  model.grids[1].pattern = GridPattern::kCrossedTriangles;
  const Layout layout = layout_of(model);
  REQUIRE(layout.blocks.size() == 8);
  const std::vector<std::string> names{"wall[0,0]",   "wall[1,0]",   "wall[0,1]",   "wall[1,1]",
                                       "roof[0,0,0]", "roof[0,0,1]", "roof[0,0,2]", "roof[0,0,3]"};
  for (size_t i = 0; i < names.size(); ++i) CHECK(layout.blocks[i].name == names[i]);
  CHECK(layout.blocks[1].polygon == box_polygon(1, 0, 2, 1));
  CHECK(layout.blocks[4].polygon == Polygon{{0, 2}, {2, 2}, {1, 3}});
  CHECK(layout.blocks[5].polygon == Polygon{{2, 2}, {2, 4}, {1, 3}});
  CHECK(layout.blocks_called("wall") == std::vector<int>{0, 1, 2, 3});
  CHECK(layout.blocks_called("wall[1,0]") == std::vector<int>{1});
  CHECK(layout.blocks_called("floor").empty());
  CHECK(layout.find_group("roof") == 1);
  CHECK(layout.find_group("roof[0,0,0]") == -1);
}

TEST_CASE("a clockwise polygon is turned") {
  Model model;
  model.blocks = {block_input("a", {{0, 0}, {0, 1}, {2, 1}, {2, 0}})};
  const Layout layout = layout_of(model);
  CHECK(signed_area(layout.blocks[0].polygon) == 2);
  CHECK(layout.blocks[0].polygon == Polygon{{2, 0}, {2, 1}, {0, 1}, {0, 0}});
}

TEST_CASE("joints: a named pair goes before a grid's own joint and before the default") {
  Model model;
  model.blocks = {block_input("a", box_polygon(0, 0, 1, 1)), block_input("b", box_polygon(1, 0, 2, 1))};
  model.grids = {grid("g", {0, 1}, {2, 2}, 2, 1, 5), grid("h", {0, 2}, {2, 3}, 2, 1, 6)};
  model.default_joint = 3;
  model.contact_pairs = {{"g", "a", 7, {}}};
  const Layout layout = layout_of(model);
  const int a = 0, b = 1, g = 2, g2 = 3, h = 4, h2 = 5;  // blocks
  const auto joint = [&layout](int i, int j) { return layout.joint_at({i, -1}, {j, 0}); };
  CHECK(joint(a, g) == 7);
  CHECK(joint(g, a) == 7);
  CHECK(joint(g, g2) == 5);
  CHECK(joint(h, h2) == 6);
  CHECK(joint(a, b) == 3);
  CHECK(joint(g, h) == 3);
  CHECK(joint(b, g) == 3);
  model.default_joint = -1;
  CHECK(layout_of(model).joint_at({a, -1}, {b, 0}) == -1);
}

TEST_CASE("an edge support holds the corners of edges on the segment, not lone corners") {
  Model model;
  model.grids = {grid("wall", {0, 0}, {3, 2}, 3, 2)};
  const Layout layout = layout_of(model);
  const auto all = selected_corners(layout, edge_support({0, 0}, {3, 0}));
  REQUIRE(all.size() == 6);  // two of each block of the lowest row
  for (size_t i = 0; i < 6; ++i) {
    CHECK(all[i].block == static_cast<int>(i / 2));
    CHECK(all[i].vertex == static_cast<int>(i % 2));
    CHECK(all[i].point == Vec2{static_cast<double>((i + 1) / 2), 0});
  }
  // the third block has one corner on the segment, no edge; the segment may run either way
  CHECK(selected_corners(layout, edge_support({2, 0}, {0, 0})).size() == 4);
  // an inner line belongs to the blocks of both sides
  CHECK(selected_corners(layout, edge_support({0, 1}, {3, 1})).size() == 12);
  CHECK(selected_corners(layout, edge_support({0, 1.5}, {3, 1.5})).empty());
  CHECK(selected_corners(layout, edge_support({0.2, 0}, {0.8, 0})).empty());
  SupportInput one = edge_support({0, 1}, {3, 1});
  one.block = "wall[1,1]";
  const auto corners = selected_corners(layout, one);
  REQUIRE(corners.size() == 2);
  CHECK(corners[0].block == 4);
}

TEST_CASE("a point support holds every corner at the point, else the first block around it") {
  Model model;
  model.blocks = {block_input("a", box_polygon(0, 0, 1, 1)), block_input("b", box_polygon(1, 0, 2, 1)),
                  block_input("c", box_polygon(0, 1, 2, 2))};
  const Layout layout = layout_of(model);
  auto corners = selected_corners(layout, point_support({1, 1}));
  REQUIRE(corners.size() == 2);  // on the side of c, but no corner of it
  CHECK(corners[0].block == 0);
  CHECK(corners[0].vertex == 2);
  CHECK(corners[1].block == 1);
  CHECK(corners[1].vertex == 3);

  corners = selected_corners(layout, point_support({1, 1}, "c"));
  REQUIRE(corners.size() == 1);
  CHECK(corners[0].block == 2);
  CHECK(corners[0].vertex == -1);

  corners = selected_corners(layout, point_support({1.25, 0.5}));
  REQUIRE(corners.size() == 1);
  CHECK(corners[0].block == 1);
  CHECK(corners[0].vertex == -1);
  CHECK(corners[0].point == Vec2{1.25, 0.5});

  corners = selected_corners(layout, point_support({1, 0.5}));  // on the side of a and b
  REQUIRE(corners.size() == 1);
  CHECK(corners[0].block == 0);

  CHECK(selected_corners(layout, point_support({1.25, 0.5}, "a")).empty());
  CHECK(selected_corners(layout, point_support({5, 5})).empty());
}

TEST_CASE("blocks_at includes the boundary") {
  Model model;
  model.grids = {grid("wall", {0, 0}, {2, 2}, 2, 2)};
  const Layout layout = layout_of(model);
  CHECK(blocks_at(layout, {1, 1}, 0) == std::vector<int>{0, 1, 2, 3});
  CHECK(blocks_at(layout, {1, 0.5}, 0) == std::vector<int>{0, 1});
  CHECK(blocks_at(layout, {2.05, 0.5}, 0).empty());
  CHECK(blocks_at(layout, {2.05, 0.5}, 0.1) == std::vector<int>{1});
}

TEST_CASE("what cannot be laid out is reported by name") {
  Model model;
  CHECK(has(errors_of(model), "the model has no block"));
  model.blocks = {block_input("a", box_polygon(0, 0, 1, 1)), block_input("b", box_polygon(0.5, 0, 1.5, 1))};
  CHECK(has(errors_of(model), "overlaps \"a\" by 0.5 m2"));
  model.blocks[1] = block_input("b", {{2, 0}, {3, 1}, {3, 0}, {2, 1}});
  CHECK(has(errors_of(model), "block.b.polygon"));
  model.blocks[1] = block_input("b", box_polygon(1, 0, 2, 1));
  model.supports = {point_support({5, 5})};
  CHECK(has(errors_of(model), "support.pin: the point lies on no block"));
  model.supports.clear();
  model.contact_pairs = {{"a", "a", 0, {}}};
  CHECK(has(errors_of(model), "twice"));
  model.grids = {grid("wall", {3, 0}, {5, 1}, 2, 1)};
  model.contact_pairs = {{"a", "wall[0,0]", 0, {}}};
  CHECK(has(errors_of(model), "\"wall[0,0]\" is one block of several"));
  model.contact_pairs.clear();
  layout_of(model);
}

}  // namespace test_layout
