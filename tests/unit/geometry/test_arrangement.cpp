#include "talus/base/index.h"
#include "talus/geometry/arrangement.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "talus/base/random.h"

namespace test_arrangement {

using namespace talus;

namespace {

constexpr double kGrid = 0x1p-20;

const Polyline kSquare{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}};

Polygon corners(const Arrangement& a, size_t face) {
  Polygon out;
  for (const int p : a.face[face].point) out.push_back(a.point[p]);
  return out;
}

// Faces on both sides of every edge know it, and it joins the corners it should.
void check_topology(const Arrangement& a) {
  REQUIRE(a.edge_face.size() == a.edge.size());
  REQUIRE(a.edge_source.size() == a.edge.size());
  std::vector<int> uses(a.edge.size(), 0);
  for (int f = 0; f < count_of(a.face); ++f) {
    const auto& face = a.face[f];
    REQUIRE(face.edge.size() == face.point.size());
    CHECK(signed_area(corners(a, f)) > 0);
    for (size_t k = 0; k < face.edge.size(); ++k) {
      const int e = face.edge[k];
      const int p = face.point[k], q = face.point[(k + 1) % face.point.size()];
      CHECK(a.edge[e][0] == std::min(p, q));
      CHECK(a.edge[e][1] == std::max(p, q));
      CHECK(a.edge_face[e][p < q ? 0 : 1] == f);
      ++uses[e];
    }
  }
  for (size_t e = 0; e < a.edge.size(); ++e)
    CHECK(uses[e] == (a.edge_face[e][0] >= 0) + (a.edge_face[e][1] >= 0));
}

int count_source(const Arrangement& a, int line) {
  return static_cast<int>(std::count(a.edge_source.begin(), a.edge_source.end(), line));
}

// Strictly inside, away from every side.
void check_inside(const Polygon& polygon) {
  const Vec2 p = interior_point(polygon);
  CAPTURE(p.x);
  CAPTURE(p.y);
  CHECK(contains(polygon, p));
  for (size_t k = 0; k < polygon.size(); ++k)
    CHECK(distance_to_segment(p, polygon[k], polygon[(k + 1) % polygon.size()]) > 0);
}

}  // namespace

TEST_CASE("grid_width: 2^-20 m from 96 m on, finer below, rounded down to a power of two") {
  const double automatic = std::nan("");
  CHECK(grid_width(96, automatic) == 0x1p-20);
  CHECK(grid_width(1e6, automatic) == 0x1p-20);
  CHECK(grid_width(95, automatic) == 0x1p-21);  // 9.5e-7 is just below 2^-20 = 9.537e-7
  CHECK(grid_width(10, automatic) == 0x1p-24);  // 1e-7 lies between 2^-24 and 2^-23
  CHECK(grid_width(1, automatic) == 0x1p-27);
  CHECK(grid_width(300, 0.001) == 0x1p-10);
  CHECK(grid_width(300, 0x1p-10) == 0x1p-10);
  CHECK(grid_width(300, 0.9) == 0.5);
}

TEST_CASE("arrange: no lines make no faces") {
  const Arrangement a = arrange({}, kGrid, {0, 0});
  CHECK(a.face.empty());
  CHECK(a.grid == kGrid);
}

TEST_CASE("arrange: a cross in a square makes four faces, from the lower left") {
  const Arrangement a = arrange({kSquare, {{2, -1}, {2, 5}}, {{0, 2}, {4, 2}}}, kGrid, {1, 1});
  check_topology(a);
  REQUIRE(a.face.size() == 4);
  CHECK(corners(a, 0) == Polygon{{0, 0}, {2, 0}, {2, 2}, {0, 2}});
  CHECK(corners(a, 1) == Polygon{{2, 0}, {4, 0}, {4, 2}, {2, 2}});
  CHECK(corners(a, 2)[0] == Vec2{0, 2});
  CHECK(corners(a, 3)[0] == Vec2{2, 2});
  CHECK(a.point.size() == 9);
  CHECK(a.edge.size() == 12);
  CHECK(count_source(a, 0) == 8);
  CHECK(count_source(a, 1) == 2);
  CHECK(count_source(a, 2) == 2);
  REQUIRE(a.dead_ends.size() == 2);  // what sticks out
  for (const Polyline& l : a.dead_ends) CHECK(norm(l.back() - l.front()) == 1);
}

TEST_CASE("arrange: of coincident lines the first in the list is the source") {
  const Polyline left{{-1, 2}, {3, 2}}, right{{1, 2}, {5, 2}};  // both run along (1, 2) to (3, 2)
  const Arrangement a = arrange({kSquare, left, right}, kGrid, {0, 0}),
                    b = arrange({kSquare, right, left}, kGrid, {0, 0});
  check_topology(a);
  const auto source_at = [](const Arrangement& net, Vec2 middle) {
    for (size_t e = 0; e < net.edge.size(); ++e) {
      const Vec2 p = net.point[net.edge[e][0]], q = net.point[net.edge[e][1]];
      if (distance_to_segment(middle, p, q) == 0) return net.edge_source[e];
    }
    return -1;
  };
  CHECK(source_at(a, {0.5, 2}) == 1);
  CHECK(source_at(a, {2, 2}) == 1);
  CHECK(source_at(a, {3.5, 2}) == 2);
  CHECK(source_at(b, {0.5, 2}) == 2);
  CHECK(source_at(b, {2, 2}) == 1);
  CHECK(source_at(b, {3.5, 2}) == 1);
  CHECK(a.face.size() == 2);
}

TEST_CASE("arrange: lines nearer than half a cell are one, farther than two cells are two") {
  const auto faces = [](double shift) {
    const Arrangement a =
        arrange({kSquare, {{0, 2}, {4, 2}}, {{0, 2 + shift}, {4, 2 + shift}}}, kGrid, {0, 0});
    check_topology(a);
    return a.face.size();
  };
  CHECK(faces(0.49 * kGrid) == 2);
  CHECK(faces(2.01 * kGrid) == 3);
}

TEST_CASE("arrange: a line that ends inside a face bounds nothing") {
  const Arrangement a = arrange({kSquare, {{1, 1}, {3, 3}}, {{4, 2}, {3.5, 2}}}, kGrid, {0, 0});
  check_topology(a);
  REQUIRE(a.face.size() == 1);
  CHECK(a.face[0].point.size() == 5);  // the foot of the second line stays a flat corner
  CHECK(a.dead_ends.size() == 2);
}

TEST_CASE("arrange: a face around another is told apart with its holes") {
  const Polyline inner{{1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}}, other{{3, 3}, {3.5, 3}, {3, 3.5}, {3, 3}};
  const Arrangement a = arrange({kSquare, inner, other}, kGrid, {0, 0});
  check_topology(a);
  REQUIRE(a.face.size() == 2);
  CHECK(corners(a, 0)[0] == Vec2{1, 1});
  REQUIRE(a.rings_of_holed.size() == 1);
  REQUIRE(a.rings_of_holed[0].size() == 3);
  CHECK(std::abs(signed_area(a.rings_of_holed[0][0])) == 16);
  CHECK(std::abs(signed_area(a.rings_of_holed[0][1])) + std::abs(signed_area(a.rings_of_holed[0][2])) ==
        1.125);
}

TEST_CASE(
    "arrange: far from the origin nothing is lost, and the order of the lines does not matter for the "
    "faces") {
  const Vec2 far{5e6, -4e6};
  const double grid = 0x1p-27;  // finest at 5e6 m: 2^-30 m is the last digit of a coordinate
  std::vector<Polyline> lines{
      {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}, {{0, 0.25}, {1, 0.75}}, {{0.25, 0}, {0.5, 1}}};
  const Arrangement near = arrange(lines, grid, {0, 0});
  for (Polyline& l : lines)
    for (Vec2& p : l) p += far;
  const Arrangement a = arrange(lines, grid, far);
  std::reverse(lines.begin(), lines.end());
  const Arrangement b = arrange(lines, grid, far);
  check_topology(a);
  REQUIRE(a.face.size() == 4);
  CHECK(a.point == b.point);
  for (size_t f = 0; f < 4; ++f) {
    CHECK(a.face[f].point == b.face[f].point);
    for (const Vec2 p : corners(a, f)) CHECK(std::fmod((p.x - far.x) / grid, 1.0) == 0);
    Polygon shifted = corners(near, f);
    for (Vec2& p : shifted) p += far;
    CHECK(corners(a, f) == shifted);
  }
}

TEST_CASE("interior_point lies strictly inside polygons that do not hold their centroid") {
  check_inside({{0, 0}, {1, 0}, {0, 1}});
  check_inside({{0, 0}, {5, 0}, {5, 5}, {4, 5}, {4, 1}, {1, 1}, {1, 5}, {0, 5}});  // U
  check_inside({{0, 0}, {5, 0}, {5, 1}, {1, 1}, {1, 4}, {5, 4}, {5, 5}, {0, 5}});  // C
  check_inside(
      {{0, 0}, {1, 0}, {1, 9}, {9, 9}, {9, 1}, {3, 1}, {3, 6}, {2, 6}, {2, 0}, {10, 0}, {10, 10}, {0, 10}});
  check_inside({{0, 0}, {1e6, 1}, {1e6, 1 + 1e-6}});                                     // needle
  check_inside({{5e6, 5e6}, {5e6 + 1, 5e6}, {5e6 + 1, 5e6 + 1e-6}, {5e6, 5e6 + 1e-6}});  // flat, far away
  check_inside({{-3, 0}, {0, -1}, {3, 0}, {0, 1}});  // corners level with it
  check_inside({{0, 0}, {4, 0}, {4, 2}, {3, 2}, {3, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 0.8}});
}

TEST_CASE("interior_point does not lie on a corner that reaches up to the height of the centroid") {
  // rectangle 12 x 5 less a triangle 10 x 3: (60 x 2.5 - 15 x 1) / 45 = 3, the height of the triangle
  check_inside({{-6, 0}, {-5, 0}, {0, 3}, {5, 0}, {6, 0}, {6, 5}, {-6, 5}});
  check_inside({{-6, 5}, {-6, 0}, {6, 0}, {6, 5}, {5, 5}, {0, 2}, {-5, 5}});  // the same from above
}

}  // namespace test_arrangement
