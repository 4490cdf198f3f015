#pragma once
// Forces that push out through what third blocks cover: tips between two blocks. Theory: docs/theory.md 12.1.

#include <vector>

#include "talus/geometry/polygon.h"

namespace talus::audit {

/// Sine of 5 degrees: a force that is further off a side is not along its normal.
inline constexpr double kOffSide = 0.0871557427476582;

/// Where two blocks press on each other.
struct Pressed {
  Vec2 place, middle;    // of the force, of what is pressed [m]
  double depth, length;  // [m]
};

/// A block near one that presses, and by how much the two are in each other there [m].
struct Third {
  const Polygon* polygon;
  double closure;
};

/// Whether a block has a side near there to which a force is normal, within 5 degrees.
/// @param way  of the force: unit vector out of the block
bool has_side(const Polygon& block, Vec2 way, const Pressed& at);

/// How far off the sides of a block the force is with which it presses another one, where third blocks cover one of the
/// sides that it goes out through.
/// @param way  of the force: unit vector out of the block
/// @return  sine of the angle to the normal of the nearest side that is not covered, 1 where there is none; 0 where it is
///          within 5 degrees, or where no side within 85 degrees is covered all along what is near
double through_covered(const Polygon& block, const std::vector<Third>& thirds, Vec2 way, const Pressed& at);

}  // namespace talus::audit
