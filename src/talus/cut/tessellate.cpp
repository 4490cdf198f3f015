#include "talus/cut/tessellate.h"

#include <cmath>

#include "talus/base/random.h"
#include "talus/geometry/diagrams.h"

namespace talus {

namespace {

// Interior points of triangles stay this share of their distance away from the outline.
constexpr double kFromOutline = 0.55;

// Points of a triangular lattice of pitch `pitch` over `box`, each moved by up to irregularity / 2 of the
// pitch.
std::vector<Vec2> lattice(const Box& box, double pitch, double irregularity, Random& random) {
  std::vector<Vec2> points;
  const double row = pitch * std::sqrt(0.75);
  const auto rows = static_cast<int64_t>(std::ceil((box.max.y - box.min.y) / row));
  const auto columns = static_cast<int64_t>(std::ceil((box.max.x - box.min.x) / pitch));
  for (int64_t j = 0; j <= rows; ++j) {
    for (int64_t i = 0; i <= columns; ++i) {
      // two numbers per point, used or not: a point does not depend on the others
      const double radius = 0.5 * irregularity * pitch * std::sqrt(random.uniform());
      const double angle = 6.283185307179586 * random.uniform();
      points.push_back(
          {box.min.x + pitch * (static_cast<double>(i) + (j % 2 != 0 ? 0.5 : 0)) + radius * std::cos(angle),
           box.min.y + row * static_cast<double>(j) + radius * std::sin(angle)});
    }
  }
  return points;
}

}  // namespace

std::vector<std::pair<Vec2, Vec2>> tessellate(const TessellationInput& input, const Polygon& polygon,
                                              uint64_t seed) {
  Random random(stream_seed(seed, input.name));
  const Box box = bounding_box(polygon);
  if (!input.triangles) {
    // a lattice of pitch p has cells of p^2 sqrt(3)/2
    const double pitch = input.size / std::sqrt(std::sqrt(0.75));
    const Vec2 margin{2 * pitch, 2 * pitch};
    return voronoi_edges(lattice({box.min - margin, box.max + margin}, pitch, input.irregularity, random));
  }
  std::vector<Vec2> points;
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()];
    const auto pieces = std::max<int64_t>(1, std::llround(norm(b - a) / input.size));
    for (int64_t i = 0; i < pieces; ++i)
      points.push_back(a + (static_cast<double>(i) / static_cast<double>(pieces)) * (b - a));
  }
  const auto is_free = [&](Vec2 p) {
    if (!contains(polygon, p)) return false;
    for (size_t k = 0; k < polygon.size(); ++k)
      if (distance_to_segment(p, polygon[k], polygon[(k + 1) % polygon.size()]) < kFromOutline * input.size)
        return false;
    return true;
  };
  for (const Vec2 p : lattice(box, input.size, input.irregularity, random))
    if (is_free(p)) points.push_back(p);
  return delaunay_edges(points);
}

}  // namespace talus
