#include "talus/audit/overlap_energy.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include "support/box_polygon.h"
#include "support/relative.h"
#include "talus/audit/shapes.h"

namespace test_overlap_energy {

using namespace talus;
using namespace talus::test;
using namespace talus::audit;

TEST_CASE("overlap energy: a block on a wider one, by the closed form") {
  for (const double c : {1e-8, 1e-4, 0.05}) {
    const Polygon below = box_polygon(-1, -1, 2, 0), above = box_polygon(0, -c, 1, 1 - c);
    CHECK(overlap_energy(above, below) == approx(c * c * (0.5 - c / 6)).epsilon(1e-7));
    const OverlapForce f = overlap_force(above, below);
    // differences of a cubic over a thousandth of the width, and round-off of 1e-12 of the size
    CHECK(f.force.y == approx(c * (1 - 0.5 * c)).epsilon(1e-5));
    CHECK(std::abs(f.force.x) < 1e-5 * f.force.y);
    CHECK(f.chord == approx(1));
    CHECK(f.area == approx(c));
    CHECK(norm(f.force + overlap_force(below, above).force) < 1e-5 * norm(f.force));
  }
  CHECK(overlap_force(box_polygon(0, 0, 1, 1), box_polygon(2, 0, 3, 1)).area == 0);
}

TEST_CASE("overlap energy: a corner pushes along the side too where one block stands back") {
  // both end level on the left: the triangles there cancel; on the right the corner of a alone pushes, by c^2/4
  const double c = 0.01;
  const OverlapForce f = overlap_force(box_polygon(0, -c, 1, 1), box_polygon(0, -1, 2, 0));
  CHECK(std::abs(f.force.x) == approx(0.25 * c * c).epsilon(1e-3));
}

TEST_CASE("overlap energy: a toe is as long as what has closed of it") {
  // a block that leans by 1e-3 about a point 0.4 m from its corner
  const Polygon above{{0, -4e-4}, {1, 6e-4}, {1, 1}, {0, 1}};
  const OverlapForce f = overlap_force(above, box_polygon(-1, -1, 2, 0));
  CHECK(f.chord == approx(0.4));
  CHECK(f.force.y == approx(0.5 * 0.4 * 4e-4).epsilon(1e-3));
}

TEST_CASE("overlap energy: polygons of five and six sides, corner in side, against a sum over a raster") {
  Polygon a, b;
  for (int k = 0; k < 6; ++k) a.push_back({std::cos(k * 1.0472), std::sin(k * 1.0472)});
  for (int k = 0; k < 5; ++k)
    b.push_back({1.5 + std::cos(0.3 + k * 1.2566), 0.2 + std::sin(0.3 + k * 1.2566)});
  const auto depth = [](const Polygon& p, Vec2 x) {
    double least = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < p.size(); ++k) {
      const Vec2 side = p[(k + 1) % p.size()] - p[k];
      least = std::min(least, cross(side, x - p[k]) / norm(side));
    }
    return least;
  };
  constexpr int kRaster = 1500;
  const double from = 0.4, cell = 0.7 / kRaster;
  double sum = 0;
  for (int i = 0; i < kRaster; ++i)
    for (int j = -kRaster; j < kRaster; ++j) {
      const Vec2 x{from + (i + 0.5) * cell, (j + 0.5) * cell};
      const double in_a = depth(a, x), in_b = depth(b, x);
      if (in_a > 0 && in_b > 0) sum += 0.5 * (in_a + in_b) * cell * cell;
    }
  CHECK(sum > 0.01);
  CHECK(overlap_energy(a, b) == approx(sum).epsilon(1e-4));  // cells at the border count whole or not
}

TEST_CASE("overlap energy: a corner on a straight side is none, and far from zero the force is the same") {
  const double c = 1e-4;
  Polygon below{{-1, -1}, {2, -1}, {2, 0}, {0.4, 0}, {-1, 0}}, above = box_polygon(0, -c, 1, 1 - c);
  const OverlapForce near = overlap_force(above, below);
  CHECK(near.force.y == approx(c * (1 - 0.5 * c)).epsilon(1e-5));
  for (Polygon* p : {&above, &below})
    for (Vec2& x : *p) x += Vec2{65536, -65536};
  CHECK(overlap_force(above, below).force.y == approx(near.force.y).epsilon(1e-6));
}

}  // namespace test_overlap_energy
