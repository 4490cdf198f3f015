#pragma once
// Voronoi diagram and Delaunay triangulation of points (GEOS), as edges.

#include <utility>
#include <vector>

#include "talus/geometry/polygon.h"

namespace talus {

/// Edges between the Voronoi cells of `points`, cut off at some distance around them.
/// Throws std::runtime_error when GEOS fails.
std::vector<std::pair<Vec2, Vec2>> voronoi_edges(const std::vector<Vec2>& points);

/// Edges of the Delaunay triangles of `points`. Throws std::runtime_error when GEOS fails.
std::vector<std::pair<Vec2, Vec2>> delaunay_edges(const std::vector<Vec2>& points);

}  // namespace talus
