#pragma once
// Artificial sub-division of a polygon: edges of Voronoi cells or Delaunay triangles about a jittered
// lattice.

#include <utility>
#include <vector>

#include "talus/model/model.h"

namespace talus {

/// Edges that cover `polygon` and reach beyond it. Deterministic for a seed.
/// Throws std::runtime_error when GEOS fails.
std::vector<std::pair<Vec2, Vec2>> tessellate(const TessellationInput& input, const Polygon& polygon,
                                              uint64_t seed);

}  // namespace talus
