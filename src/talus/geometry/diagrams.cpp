#include "talus/geometry/diagrams.h"

#include <stdexcept>

#include "talus/geometry/geos.h"

namespace talus {

namespace {

// Edges of what `make` draws about the points, which come relative to the first.
std::vector<std::pair<Vec2, Vec2>> edges_of(const std::vector<Vec2>& points, const auto& make) {
  if (points.empty()) return {};
  const GEOSContextHandle_t context = geos().context();
  const auto input = geos().make_lines({points}, points[0]);
  const auto lines = geos().own(input ? make(context, input.get()) : nullptr);
  if (!lines) throw std::runtime_error("the sub-division of a region failed");
  std::vector<std::pair<Vec2, Vec2>> edges;
  const int n = GEOSGetNumGeometries_r(context, lines.get());
  for (int i = 0; i < n; ++i) {
    const std::vector<Vec2> corners = geos().corners_of(GEOSGetGeometryN_r(context, lines.get(), i));
    for (size_t k = 0; k + 1 < corners.size(); ++k)
      edges.emplace_back(points[0] + corners[k], points[0] + corners[k + 1]);
  }
  return edges;
}

}  // namespace

std::vector<std::pair<Vec2, Vec2>> voronoi_edges(const std::vector<Vec2>& points) {
  return edges_of(points, [](GEOSContextHandle_t context, const GEOSGeometry* input) {
    return GEOSVoronoiDiagram_r(context, input, nullptr, 0, 1);
  });
}

std::vector<std::pair<Vec2, Vec2>> delaunay_edges(const std::vector<Vec2>& points) {
  return edges_of(points, [](GEOSContextHandle_t context, const GEOSGeometry* input) {
    return GEOSDelaunayTriangulation_r(context, input, 0, 1);
  });
}

}  // namespace talus
