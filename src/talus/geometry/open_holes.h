#pragma once
// Short cuts that divide a polygon with holes into simple polygons.

#include <vector>

#include "talus/geometry/polygon.h"

namespace talus {

/// Segments that, with the rings, enclose simple polygons only. Islands are taken up as a spanning tree
/// would, the nearest to what is there already first, each by two cuts that part as far as a fiftieth
/// more than their least length allows: about twice the length of the shortest tree of cuts between the
/// rings. Where that would leave a piece below `least_area`, cuts are longer, or the pieces as large as can
/// be. Cost: islands times corners of all rings.
/// @param rings       the outer ring, then the islands, in either order; they may touch in single points [m]
/// @param least_area  of a piece [m2]
/// @param near        corners so near to the end of a cut take it up [m]
std::vector<Polyline> opening_cuts(const std::vector<Polyline>& rings, double least_area, double near);

}  // namespace talus
