#pragma once
// The rectangle of most test scenes.

#include "talus/geometry/polygon.h"

namespace talus::test {

/// Counter-clockwise from the lower left corner (x0, y0) [m]; (x1, y1) is the upper right one.
inline Polygon box_polygon(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

}  // namespace talus::test
