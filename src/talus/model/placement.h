#pragma once
// Where a shape of the model file stands: turned about a point, then moved.

#include <cmath>
#include <optional>

#include "talus/geometry/polygon.h"

namespace talus {

struct Placement {
  double angle = 0;           // [rad] counter-clockwise
  std::optional<Vec2> about;  // [m] none: the middle of the shape
  Vec2 move;                  // [m]

  bool is_given() const { return angle != 0 || move != Vec2{}; }
  /// Where `p` of a shape with its middle at `middle` comes to lie.
  Vec2 apply(Vec2 p, Vec2 middle) const {
    if (angle == 0) return p + move;
    const double c = std::cos(angle), s = std::sin(angle);
    const Vec2 pivot = about.value_or(middle), d = p - pivot;
    return pivot + Vec2{c * d.x - s * d.y, s * d.x + c * d.y} + move;
  }
  /// All corners of a polygon; its middle is the centroid, or its first corner when it has no area.
  void apply(Polygon& polygon) const {
    if (!is_given() || polygon.empty()) return;
    const Vec2 centroid = polygon.size() > 2 ? polygon_moments(polygon).centroid : polygon.front();
    const Vec2 middle = is_finite(centroid) ? centroid : polygon.front();
    for (Vec2& p : polygon) p = apply(p, middle);
  }
};

}  // namespace talus
