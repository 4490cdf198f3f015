#pragma once
// Is a polygon simple, do two polygons overlap: robust answers from GEOS, for the checks before a run.

#include <string>

#include "talus/geometry/polygon.h"

namespace talus {

/// "" when `polygon` is simple with at least three corners and non-zero area; otherwise what is wrong and
/// where, for example "crosses or touches itself at (0.5, 0.5)".
std::string polygon_defect(const Polygon& polygon);

struct Overlap {
  double area = 0;  // [m2] 0 when the polygons touch or lie apart
  Vec2 at;          // a point inside the common part
};

/// Common part of two simple polygons.
Overlap polygon_overlap(const Polygon& a, const Polygon& b);

}  // namespace talus
