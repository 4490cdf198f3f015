#include "talus/geometry/polygon_check.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

namespace test_polygon_check {

using namespace talus;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const Polygon kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

Polygon moved(Polygon polygon, Vec2 by) {
  for (Vec2& p : polygon) p += by;
  return polygon;
}

}  // namespace

TEST_CASE("a simple polygon has no defect, in either order and far away") {
  CHECK(polygon_defect(kSquare) == "");
  CHECK(polygon_defect({{0, 1}, {1, 1}, {1, 0}, {0, 0}}) == "");
  CHECK(polygon_defect({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}) == "");
  CHECK(polygon_defect(moved(kSquare, {1e6, -1e6})) == "");
  CHECK(polygon_defect({{0, 0}, {1, 0}, {2, 0}, {2, 1}}) == "");  // a corner within a straight side
  CHECK(polygon_defect({{0, 0}, {1, 0}, {1, 1e-6}}) == "");       // thin, still a polygon
}

TEST_CASE("defects are named with their place") {
  SUBCASE("bow tie") {
    const std::string text = polygon_defect({{0, 0}, {1, 1}, {1, 0}, {0, 1}});
    CHECK(has(text, "crosses"));
    CHECK(has(text, "(0.5, 0.5)"));
  }
  SUBCASE("bow tie far from the origin") {
    const std::string text = polygon_defect(moved({{0, 0}, {100, 100}, {100, 0}, {0, 100}}, {1000, 2000}));
    CHECK(has(text, "(1050, 2050)"));
  }
  SUBCASE("a corner touches another side") {
    CHECK(has(polygon_defect({{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}), "touches itself"));
  }
  SUBCASE("an edge without length") {
    const std::string text = polygon_defect({{0, 0}, {1, 0}, {1, 0}, {0, 1}});
    CHECK(has(text, "length zero"));
    CHECK(has(text, "corners 2 and 3"));
    CHECK(has(text, "(1, 0)"));
  }
  SUBCASE("the first corner given again as the last") {
    CHECK(has(polygon_defect({{0, 0}, {1, 0}, {0, 1}, {0, 0}}), "corners 4 and 1"));
  }
  SUBCASE("too few corners") {
    CHECK(has(polygon_defect({{0, 0}, {1, 0}}), "has 2 corners"));
    CHECK(has(polygon_defect({}), "has 0 corners"));
  }
  SUBCASE("all corners on a line") { CHECK(polygon_defect({{0, 0}, {1, 0}, {3, 0}}) != ""); }
  SUBCASE("thinner than round-off can tell") {
    CHECK(has(polygon_defect({{0, 0}, {1, 0}, {0.5, 1e-13}}), "has no area"));
  }
  SUBCASE("not a number") {
    CHECK(polygon_defect({{0, 0}, {1, 0}, {0, std::numeric_limits<double>::quiet_NaN()}}) != "");
  }
}

TEST_CASE("polygons that touch share nothing") {
  CHECK(polygon_overlap(kSquare, moved(kSquare, {1, 0})).area == 0);    // a side
  CHECK(polygon_overlap(kSquare, moved(kSquare, {1, 0.5})).area == 0);  // half a side
  CHECK(polygon_overlap(kSquare, moved(kSquare, {1, 1})).area == 0);    // a corner
  CHECK(polygon_overlap(kSquare, moved(kSquare, {2, 0})).area == 0);    // apart
}

TEST_CASE("overlap area and a point inside") {
  // one intersection of short polygons: a few roundings of 1e-16
  constexpr double kRound = 1e-14;
  const auto check = [](const Polygon& a, const Polygon& b, double area) {
    const Overlap overlap = polygon_overlap(a, b);
    CHECK(std::abs(overlap.area - area) <= kRound * area);
    CHECK(contains(a, overlap.at));
    CHECK(contains(b, overlap.at));
  };
  SUBCASE("identical") { check(kSquare, kSquare, 1); }
  SUBCASE("identical in the other order") { check(kSquare, {{0, 1}, {1, 1}, {1, 0}, {0, 0}}, 1); }
  SUBCASE("one inside another") {
    const Polygon small{{0.25, 0.25}, {0.75, 0.25}, {0.75, 0.75}, {0.25, 0.75}};
    check(kSquare, small, 0.25);
    check(small, kSquare, 0.25);
  }
  SUBCASE("a quarter") { check(kSquare, moved(kSquare, {0.5, 0.5}), 0.25); }
  SUBCASE("far from the origin, with coordinates that are exact there") {
    const Vec2 far{1048576, -1048576};
    check(moved(kSquare, far), moved(kSquare, far + Vec2{0.5, 0.5}), 0.25);
  }
  SUBCASE("a body in the notch of another shares nothing with it") {
    const Polygon l{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    CHECK(polygon_overlap(l, moved(kSquare, {1, 1})).area == 0);
  }
}

}  // namespace test_polygon_check
