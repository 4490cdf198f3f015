#pragma once
// The force between two convex blocks by the energy of what they have in common, in a way of its own: nearest sides by
// halving, sums over triangles, finite differences. Theory: docs/theory.md (3.2), 12.1.

#include "talus/geometry/polygon.h"

namespace talus::audit {

struct OverlapForce {
  double area = 0;   // of what the two have in common [m2]; 0: nothing
  Vec2 force;        // on a, over stiffness and thickness [m2]
  double chord = 0;  // extent of the overlap across the force [m]
};

/// Half the integral of the distances to the nearest line of either outline, over their common part [m3].
/// @pre  both are convex and counter-clockwise
double overlap_energy(const Polygon& a, const Polygon& b);

/// Minus the gradient of that energy as a moves: central differences over a thousandth of the overlap's width.
/// @pre  both are convex and counter-clockwise
OverlapForce overlap_force(const Polygon& a, const Polygon& b);

}  // namespace talus::audit
