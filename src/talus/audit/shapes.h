#pragma once
// Polygons of the audit: common parts, closed unions, how deep a point lies. Simple and slow where that is
// safer: nothing here is shared with the search for contacts.

#include <span>
#include <vector>

#include "talus/audit/frame.h"
#include "talus/geometry/polygon.h"

namespace talus::audit {

struct Common {
  double area = 0;  // [m2]
  Vec2 at;          // a point of it
};

/// Counter-clockwise without a notch; corners of straight sides are none.
bool is_convex(std::span<const Vec2> polygon);

/// Common part of two simple polygons: clipped where one is convex, by GEOS elsewhere.
Common common_part(const Polygon& a, const Polygon& b);

/// How a corner of one block moves against its foot on an edge of another [m/s].
/// @param along     of the foot, as share of the edge
/// @param velocity  which of the blocks' velocities; where it is empty the block is at rest
Vec2 moves_against(const Block& a, size_t corner, const Block& b, size_t edge, double along,
                   std::vector<Vec2> Block::*velocity);

/// Velocity of a place that moves with a block, whose motion is affine [m/s].
Vec2 velocity_at(const Block& block, Vec2 place, std::vector<Vec2> Block::*velocity);

/// What of a convex polygon lies at or below the line through `point` with outward normal `normal`.
Polygon cut_below(std::span<const Vec2> polygon, Vec2 point, Vec2 normal);

/// How deep `point` lies inside the polygon [m]: distance from its boundary; < 0 outside.
double depth_in(std::span<const Vec2> polygon, Vec2 point);

/// Distance between two simple polygons that do not overlap [m].
double distance_between(std::span<const Vec2> a, std::span<const Vec2> b);

/// Area over the extent along `tangent`: mean thickness of the polygon across it [m].
double mean_thickness(std::span<const Vec2> polygon, Vec2 tangent);

/// Sides of the outline of the union of `polygons` near `place`, hair gaps up to twice `closing` filled.
/// @param reach  of the square around `place` that is looked at [m]
struct Side {
  Vec2 from, to;  // the union lies on its left
};
std::vector<Side> outline_near(const std::vector<const Polygon*>& polygons, Vec2 place, double reach,
                               double closing);

}  // namespace talus::audit
