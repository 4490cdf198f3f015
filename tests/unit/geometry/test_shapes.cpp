#include "support/relative.h"
#include "talus/base/index.h"
#include "talus/geometry/shapes.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "talus/geometry/polygon_check.h"

namespace test_shapes {

using namespace talus;

namespace {

constexpr double kPi = std::numbers::pi;

// Area of n terms, each rounded by 1e-16 of the square of the coordinates: 1e-12 leaves room for 1e4 of them.
constexpr double kRound = 1e-12;

}  // namespace

TEST_CASE("a circle of any number of segments has the area of the circle, regular about its centre") {
  for (const int n : {3, 4, 5, 8, 32, 1000}) {
    for (const Vec2 center : {Vec2{0, 0}, Vec2{-3, 7}}) {
      CAPTURE(n);
      const Polygon p = circle_polygon(center, 9.8, n);
      REQUIRE(count_of(p) == n);
      CHECK(polygon_defect(p) == "");
      const double area = kPi * 4.9 * 4.9;
      CHECK(std::abs(signed_area(p) - area) < kRound * area);  // > 0: counter-clockwise
      CHECK(p[0].y == center.y);
      CHECK(p[0].x > center.x + 4.9);
      for (size_t i = 0; i < p.size(); ++i) {
        const double angle = 2 * kPi * static_cast<double>(i) / n, r = norm(p[0] - center);
        CHECK(norm(p[i] - center - r * Vec2{std::cos(angle), std::sin(angle)}) < kRound * r);
      }
    }
  }
  // three segments by hand: half the side of a triangle of area pi is sqrt(pi / sqrt 3), R = 2 / sqrt 3 times
  // that
  const Polygon three = circle_polygon({0, 0}, 2, 3);
  CHECK(three[0].x == test::approx(2 / std::sqrt(3.0) * std::sqrt(kPi / std::sqrt(3.0))).epsilon(kRound));
}

TEST_CASE("a horseshoe has the area of the half circle on its walls") {
  for (const int n : {2, 3, 8, 33}) {
    for (const double height : {5.0, 3.0, 2.5}) {
      CAPTURE(n);
      CAPTURE(height);
      const Vec2 center{10, -4};
      const double width = 4, r = 2;
      const Polygon p = horseshoe_polygon(center, width, height, n);
      CHECK(polygon_defect(p) == "");
      const double area = width * (height - r) + kPi * r * r / 2;
      CHECK(std::abs(signed_area(p) - area) < kRound * area);
      REQUIRE(count_of(p) == n + 3);
      CHECK(p[0] == Vec2{8, -4 - (height - r)});
      CHECK(p[1] == Vec2{12, -4 - (height - r)});
      CHECK(p[2] == Vec2{12, -4});
      CHECK(p.back() == Vec2{8, -4});
      for (size_t i = 3; i + 1 < p.size(); ++i) CHECK(norm(p[i] - center) > r);
    }
  }
}

TEST_CASE("a horseshoe as high as half its width is the half circle alone") {
  const Polygon p = horseshoe_polygon({0, 1}, 4, 2, 6);
  REQUIRE(p.size() == 7);
  CHECK(polygon_defect(p) == "");
  CHECK(p.front() == Vec2{2, 1});
  CHECK(p.back() == Vec2{-2, 1});
  CHECK(std::abs(signed_area(p) - 2 * kPi) < kRound);
}

}  // namespace test_shapes
