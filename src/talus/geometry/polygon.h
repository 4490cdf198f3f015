#pragma once
// Exact integrals over simple polygons (simplex integration: signed triangles from one vertex) and
// point queries. Theory: docs/theory.md section 1.

#include <span>
#include <vector>

#include "talus/base/vec2.h"

namespace talus {

using Polygon = std::vector<Vec2>;   // vertices in order, the last joins the first, [m]
using Polyline = std::vector<Vec2>;  // vertices from end to end, [m]

/// Signed area [m2]; > 0 for counter-clockwise order.
double signed_area(std::span<const Vec2> polygon);

struct PolygonMoments {
  double area = 0;  // [m2], > 0
  Vec2 centroid;    // [m]
  Mat2 second;      // integral of X X^T about the centroid [m4], symmetric
};

/// Area, centroid and second moments of a simple polygon in either order.
/// Coordinates far from the origin lose nothing: all integrals are taken from the first vertex.
/// @pre area is not zero
PolygonMoments polygon_moments(std::span<const Vec2> polygon);

/// Width [m] of the rectangle with the same area and the same smaller second moment: sqrt(12 s2 / area).
double polygon_width(const PolygonMoments& moments);

/// Whether `point` lies inside the polygon or within `tolerance` [m] of its boundary.
bool contains(std::span<const Vec2> polygon, Vec2 point, double tolerance = 0);

/// A point well inside a simple polygon, away from the heights of its corners. Cost n^2.
/// @pre area is not zero
Vec2 interior_point(const Polygon& polygon);

/// Distance [m] of `point` from the segment a-b.
double distance_to_segment(Vec2 point, Vec2 a, Vec2 b);

struct Box {
  Vec2 min, max;
};

/// Smallest axis-parallel box around `points`. @pre not empty
Box bounding_box(std::span<const Vec2> points);

/// Pairs (i < j) of boxes closer than `margin` [m] along both axes, in rising order.
/// Uniform grid with cells of the mean box size; cost N log N for boxes of similar size.
std::vector<std::pair<int, int>> close_pairs(const std::vector<Box>& boxes, double margin);

/// The same, or only some of them where there are more than about `most`: of boxes that all lie in one place.
struct SomePairs {
  std::vector<std::pair<int, int>> pairs;
  bool all = true;
};
SomePairs some_close_pairs(const std::vector<Box>& boxes, double margin, size_t most);

}  // namespace talus
