// rotate, rotate_about and move of everything that has a shape.

#include <doctest/doctest.h>

#include <algorithm>

#include "support/told.h"
#include "talus/cut/check_places.h"
#include "talus/model/read_model.h"

namespace test_placement {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kHead = R"(talus = 1
[material.rock]
density = 2600
young = 1e10
poisson = 0.25
[joint.j]
friction_angle = "30 deg"
[[stage]]
name = "s"
kind = "dynamic"
duration = 1
)";

const std::string kTurn = "rotate = \"30 deg\"\nrotate_about = [1, 2]\nmove = [10, -3]\n";

Layout laid_out(const std::string& sections) {
  const std::string text = kHead + sections;
  Findings findings("model.toml", text);
  Model model = read_model("model.toml", text, {}, findings);
  Layout out = checked_layout(model, findings);
  INFO(findings.render());
  REQUIRE(!findings.has_errors());
  return out;
}

// What the keys say, by complex numbers.
Vec2 turned(Vec2 p) {
  const double c = std::sqrt(3) / 2, s = 0.5;
  const Vec2 d = p - Vec2{1, 2};
  return Vec2{1 + 10, 2 - 3} + Vec2{c * d.x - s * d.y, s * d.x + c * d.y};
}

// Every corner of the placed model is that of the other one, turned.
void check_turned(const std::string& section) {
  const Layout as_drawn = laid_out(section), placed = laid_out(section + kTurn);
  REQUIRE(placed.blocks.size() == as_drawn.blocks.size());
  std::vector<Vec2> wanted, got;
  for (const BlockShape& b : as_drawn.blocks)
    for (const Vec2 p : b.polygon) wanted.push_back(turned(p));
  for (const BlockShape& b : placed.blocks) got.insert(got.end(), b.polygon.begin(), b.polygon.end());
  CHECK(got.size() == wanted.size());
  for (const Vec2 p : wanted) {
    double least = 1e300;
    for (const Vec2 q : got) least = std::min(least, norm(p - q));
    CHECK(least < 1e-6);  // regions and arches lie on a grid of some 1e-8 m
  }
}

}  // namespace

TEST_CASE("rotate, rotate_about and move place blocks, grids, meshes, regions and arches") {
  check_turned("[[block]]\nname = \"b\"\nmaterial = \"rock\"\npolygon = [[0, 0], [3, 0], [3, 1], [0, 2]]\n");
  check_turned(
      "[[grid]]\nname = \"g\"\nmaterial = \"rock\"\njoint = \"j\"\nmin = [0, 0]\nmax = [4, 2]\ncells = [3, "
      "2]\n"
      "pattern = \"crossed_triangles\"\n");
  check_turned("[[mesh]]\nname = \"m\"\nmaterial = \"rock\"\nfile = \"" + std::string(TALUS_SOURCE_DIR) +
               "/tests/fixtures/quarter_ring.msh\"\n");
  check_turned("[[region]]\nname = \"r\"\nmaterial = \"rock\"\npolygon = [[0, 0], [5, 0], [4, 3]]\n");
  check_turned(
      "[[arch]]\nname = \"a\"\nmaterial = \"rock\"\ncenter = [3, 1]\nradius = 2\nthickness = 0.5\nto = \"180 "
      "deg\"\n"
      "voussoirs = 7\n");
}

TEST_CASE("rotate turns about the centroid when no point is given, and about the middle of a grid") {
  const std::string block =
      "[[block]]\nname = \"b\"\nmaterial = \"rock\"\npolygon = [[0, 0], [3, 0], [0, 3]]\n";
  const Layout t = laid_out(block + "rotate = \"90 deg\"\n");
  const Vec2 c = polygon_moments(t.blocks[0].polygon).centroid;
  CHECK(norm(c - Vec2{1, 1}) < 1e-12);
  CHECK(norm(t.blocks[0].polygon[0] - Vec2{2, 0}) < 1e-12);  // the right angle, from (0, 0)
  const Layout g = laid_out(
      "[[grid]]\nname = \"g\"\nmaterial = \"rock\"\njoint = \"j\"\nmin = [0, 0]\nmax = [4, 2]\ncells = [2, "
      "1]\n"
      "rotate = \"90 deg\"\n");
  CHECK(norm(g.blocks[0].polygon[0] - Vec2{3, -1}) < 1e-12);
}

TEST_CASE("what is not turned keeps its bits, a point to turn about alone is refused") {
  const std::string block =
      "[[block]]\nname = \"b\"\nmaterial = \"rock\"\npolygon = [[0.1, 0.7], [3, 0], [0, 3]]\n";
  const Layout a = laid_out(block), b = laid_out(block + "rotate = \"0 deg\"\nmove = [0, 0]\n");
  CHECK(a.blocks[0].polygon == b.blocks[0].polygon);
  CHECK(told(kHead + block + "rotate_about = [0, 0]\n")
            .find("block.b.rotate_about: has no meaning without rotate") != std::string::npos);
  CHECK(told(kHead + block + "rotate = 30\n").find("an angle needs its unit") != std::string::npos);
  CHECK(told(kHead + block + "move = 3\n").find("block.b.move") != std::string::npos);
}

}  // namespace test_placement
