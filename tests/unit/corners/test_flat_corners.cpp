// Corners on straight sides: where a joint ends on the other side, or a side has two sources.

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "support/block_scene.h"
#include "support/relative.h"
#include "talus/corners/corner_rows.h"
#include "talus/step/scene.h"

namespace test_flat_corners {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kMargin = 0.05;

Scene scene_of(const std::vector<Polygon>& polygons) { return laid_out_scene(plain_rock(), polygons); }

std::vector<ContactPoint> touch(const Scene& s, int a, int b) {
  std::vector<ContactPoint> out;
  touch_blocks(s.blocks, start_state(s), a, b, kMargin, out);
  return out;
}

// The lower block's top runs from x = 4 to 0 with a corner at x = 2 that lies `bump` above the line.
Polygon lower(double bump) { return {{0, 0}, {4, 0}, {4, 1}, {2, 1 + bump}, {0, 1}}; }

double total_length(const std::vector<ContactPoint>& points) {
  double sum = 0;
  for (const ContactPoint& p : points) sum += p.length;
  return sum;
}

}  // namespace

TEST_CASE("a face over a flat corner has two ends, and both stand for half of it") {
  // 1e-6 is less than half a cell of the grid against the metre: rounding of a real model
  for (const double bump : {0.0, 1e-6, -1e-6}) {
    CAPTURE(bump);
    const Scene s = scene_of({lower(bump), {{0.5, 1}, {3, 1}, {3, 2}, {0.5, 2}}});
    const auto points = touch(s, 0, 1);
    REQUIRE(points.size() == 2);
    for (const ContactPoint& p : points) {
      CHECK(p.key.block_a == 1);                      // the upper block's corners act on the lower's top
      CHECK(p.length == approx(1.25).epsilon(1e-5));  // the bump tilts the face by 1e-6
    }
    CHECK(points[0].partner == 1);
    CHECK(points[1].partner == 0);
    // both ends name the same edges: of the upper block its bottom, of the lower the one under the middle, x
    // = 1.75
    CHECK(points[0].face_edge_a == 0);
    CHECK(points[0].face_edge_b == 3);
    CHECK(points[1].face_edge_a == points[0].face_edge_a);
    CHECK(points[1].face_edge_b == points[0].face_edge_b);
  }
}

TEST_CASE("flat corners on both sides at different places: still one face of two points") {
  const Scene s = scene_of({lower(0), {{0.5, 1}, {1.5, 1}, {3, 1}, {3, 2}, {0.5, 2}}});
  const auto points = touch(s, 0, 1);
  REQUIRE(points.size() == 2);
  CHECK(total_length(points) == approx(2.5).epsilon(1e-14));
}

TEST_CASE("two blocks whose joint ends at a flat corner: a face of two points each") {
  for (const double bump : {0.0, 1e-6, -1e-6}) {
    CAPTURE(bump);
    const Scene s = scene_of(
        {lower(bump), {{0, 1}, {2, 1 + bump}, {2, 2}, {0, 2}}, {{2, 1 + bump}, {4, 1}, {4, 2}, {2, 2}}});
    for (const int other : {1, 2}) {
      const auto points = touch(s, 0, other);
      REQUIRE(points.size() == 2);
      CHECK(total_length(points) == approx(2).epsilon(1e-12));
      CHECK(std::abs(points[0].gap) < 1e-15);
      CHECK(std::abs(points[1].gap) < 1e-15);
    }
  }
}

TEST_CASE("a corner that comes down on a flat corner touches one edge") {
  const Scene s = scene_of({lower(0), {{2, 1.001}, {2.5, 1.5}, {2, 2}, {1.5, 1.5}}});
  const auto points = touch(s, 0, 1);
  REQUIRE(points.size() == 1);
  CHECK(points[0].key.block_a == 1);
  CHECK(points[0].gap == approx(0.001).epsilon(1e-12));
}

TEST_CASE("a corner that turns by more than the limit is a corner") {
  // 1e-3 up at the middle: slopes of 5e-4, turn 1e-3 > 1e-4; the peak touches the flat bottom above it
  const Scene s = scene_of({lower(1e-3), {{0.5, 1.001}, {3, 1.001}, {3, 2}, {0.5, 2}}});
  bool peak = false;
  for (const ContactPoint& p : touch(s, 0, 1)) peak = peak || (p.key.block_a == 0 && p.key.vertex == 3);
  CHECK(peak);
}

}  // namespace test_flat_corners
