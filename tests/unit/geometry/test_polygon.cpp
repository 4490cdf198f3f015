#include "talus/base/index.h"
#include "talus/geometry/polygon.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>
#include "support/relative.h"

namespace test_polygon {

using namespace talus;
using namespace talus::test;

namespace {

struct Shape {
  std::string name;
  Polygon polygon;
  PolygonMoments exact;  // by hand
};

std::vector<Shape> shapes() {
  const double b = 3, h = 2;
  // right triangle with legs b, h: second moments b^3 h/36, b h^3/36 and product -b^2 h^2/72
  const double xx = b * b * b * h / 36, yy = b * h * h * h / 36, xy = -b * b * h * h / 72;
  // L: 2 x 2 without its upper right quarter: three unit squares at (.5,.5), (1.5,.5), (.5,1.5). About the
  // centroid (5/6, 5/6): 3/12 + (1/3)^2 + (2/3)^2 + (1/3)^2 = 11/12 along each axis;
  // product: 1/9 - 2/9 - 2/9 = -1/3
  return {{"triangle", {{0, 0}, {b, 0}, {0, h}}, {b * h / 2, {b / 3, h / 3}, {xx, xy, xy, yy}}},
          {"square", {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {4, {0, 0}, {4.0 / 3, 0, 0, 4.0 / 3}}},
          {"L-shape",
           {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
           {3, {5.0 / 6, 5.0 / 6}, {11.0 / 12, -1.0 / 3, -1.0 / 3, 11.0 / 12}}}};
}

void check_moments(const Polygon& polygon, const PolygonMoments& exact, double tolerance) {
  const PolygonMoments m = polygon_moments(polygon);
  const double length = std::sqrt(exact.area), fourth = exact.area * exact.area;
  CHECK(std::abs(m.area - exact.area) <= tolerance * exact.area);
  CHECK(norm(m.centroid - exact.centroid) <= tolerance * length + 1e-16 * norm(exact.centroid));
  const Mat2 off = m.second - exact.second;
  CHECK(std::sqrt(contract(off, off)) <= tolerance * fourth);
  CHECK(std::abs(m.second.xy - m.second.yx) <= tolerance * fourth);
}

std::vector<std::pair<int, int>> all_close_pairs(const std::vector<Box>& boxes, double margin) {
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < count_of(boxes); ++i) {
    for (size_t j = i + 1; j < boxes.size(); ++j) {
      const Box &a = boxes[i], &b = boxes[j];
      if (std::max(a.min.x - b.max.x, b.min.x - a.max.x) <= margin &&
          std::max(a.min.y - b.max.y, b.min.y - a.max.y) <= margin)
        pairs.emplace_back(i, static_cast<int>(j));
    }
  }
  return pairs;
}

}  // namespace

TEST_CASE("moments of simple shapes are exact, in either order and from every first corner") {
  for (const Shape& s : shapes()) {
    CAPTURE(s.name);
    Polygon polygon = s.polygon;
    for (size_t turn = 0; turn < polygon.size(); ++turn) {
      std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
      // a few dozen operations of round-off 1.1e-16 each
      check_moments(polygon, s.exact, 1e-14);
      CHECK(signed_area(polygon) == relative(s.exact.area, 1e-14));
    }
    std::reverse(polygon.begin(), polygon.end());
    check_moments(polygon, s.exact, 1e-14);
    CHECK(signed_area(polygon) == relative(-s.exact.area, 1e-14));
  }
}

TEST_CASE("moments keep their digits far from the origin") {
  const Vec2 far{1e6, -1e6};
  for (const Shape& s : shapes()) {
    CAPTURE(s.name);
    // the corners, multiples of 1/3 at 1e6 m, are rounded by 1e-10 m; relative to metres that is below 1e-9
    Polygon polygon = s.polygon;
    for (Vec2& p : polygon) p = far + p / 3;
    PolygonMoments exact = s.exact;
    exact.area /= 9, exact.second = (1.0 / 81) * exact.second, exact.centroid = far + exact.centroid / 3;
    check_moments(polygon, exact, 1e-9);
  }
}

TEST_CASE("contains knows inside, outside, boundary and notch") {
  const Polygon l = shapes()[2].polygon;
  CHECK(contains(l, {0.5, 0.5}));
  CHECK(contains(l, {0.5, 1.5}));
  CHECK_FALSE(contains(l, {1.5, 1.5}));  // in the notch
  CHECK_FALSE(contains(l, {-0.1, 1}));   // level with corners
  CHECK_FALSE(contains(l, {3, 1}));
  CHECK(contains(l, {0.5, 1}));
  CHECK(contains(l, {0, 1}));  // on an edge
  CHECK(contains(l, {1, 1}));  // on a corner
  CHECK_FALSE(contains(l, {2.1, 0.5}, 0.09));
  CHECK(contains(l, {2.1, 0.5}, 0.11));
  CHECK(contains(l, {1.05, 1.05}, 0.06));
}

TEST_CASE("distance_to_segment") {
  CHECK(distance_to_segment({1, 2}, {0, 0}, {3, 0}) == relative(2, 1e-14));
  CHECK(distance_to_segment({-3, 4}, {0, 0}, {3, 0}) == relative(5, 1e-14));  // before its beginning
  CHECK(distance_to_segment({6, -4}, {0, 0}, {3, 0}) == relative(5, 1e-14));  // behind its end
  CHECK(distance_to_segment({3, 4}, {0, 0}, {0, 0}) == relative(5, 1e-14));   // no length
}

TEST_CASE("bounding_box") {
  const Box box = bounding_box(std::vector<Vec2>{{1, -2}, {-3, 5}, {0, 7}});
  CHECK(box.min == Vec2{-3, -2});
  CHECK(box.max == Vec2{1, 7});
}

TEST_CASE("close_pairs equals the comparison of all with all") {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-50, 50), power(-4, 1.5), fraction(0, 1);
    std::vector<Box> boxes;
    for (int i = 0; i < 300; ++i) {
      const Vec2 at{place(random), place(random)};
      boxes.push_back({at, at + Vec2{std::pow(10, power(random)), std::pow(10, power(random))}});
    }
    if (seed % 3 == 0) boxes.push_back({{-200, -1}, {200, 1}});  // one box across everything
    for (const double margin : {0.0, 0.3 * fraction(random), 10.0}) {
      CAPTURE(margin);
      const auto expected = all_close_pairs(boxes, margin);
      REQUIRE(expected.size() > 30);
      CHECK(close_pairs(boxes, margin) == expected);  // in the same, rising, order
    }
  }
}

TEST_CASE("close_pairs finds neighbours that share an edge or a corner only") {
  std::vector<Box> boxes;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) boxes.push_back({{0.1 * i, 0.1 * j}, {0.1 * (i + 1), 0.1 * (j + 1)}});
  CHECK(close_pairs(boxes, 0).size() == 2 * 30 + 2 * 25);
  CHECK(close_pairs({}, 1).empty());
  CHECK(close_pairs({{{0, 0}, {1, 1}}}, 1).empty());
  CHECK(close_pairs({{{0, 0}, {0, 0}}, {{0, 0}, {0, 0}}}, 0).size() == 1);
}

}  // namespace test_polygon
