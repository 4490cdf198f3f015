#pragma once
// Polygons of common outlines. Curves become equal-area segments: the polygon encloses what the curve
// encloses.

#include "talus/geometry/polygon.h"

namespace talus {

/// Regular polygon of `segments` edges with the area of the circle, counter-clockwise from the angle 0.
/// @pre diameter > 0 [m], segments >= 3
Polygon circle_polygon(Vec2 center, double diameter, int segments);

/// Height of the arc of an angle over its chord [m].
double sagitta(double radius, double angle);

/// Half a circle on straight walls over a flat floor, counter-clockwise from the lower left corner. The half
/// circle has `segments` edges; its ends lie on the walls.
/// @param center  of the half circle, at the height where the walls end
/// @param height  from the floor to the crown [m], at least width / 2
Polygon horseshoe_polygon(Vec2 center, double width, double height, int segments);

}  // namespace talus
