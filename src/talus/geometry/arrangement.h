#pragma once
// From a heap of lines to the faces they enclose: noding on a grid and polygonizing (GEOS), with the topology
// and the source of every edge put back. All corners are multiples of the grid; faces share them exactly.

#include <array>
#include <vector>

#include "talus/geometry/polygon.h"

namespace talus {

struct Arrangement {
  struct Face {
    std::vector<int> point;  // corners, counter-clockwise
    std::vector<int> edge;   // edge[k] runs from point[k] to point[k + 1]
  };

  double grid = 0;                            // [m]
  std::vector<Vec2> point;                    // [n_points] distinct
  std::vector<std::array<int, 2>> edge;       // [n_edges] points, lower index first
  std::vector<std::array<int, 2>> edge_face;  // [n_edges] faces to the left and right; -1: outside
  std::vector<int> edge_source;               // [n_edges] the first line that runs along it
  std::vector<Face> face;                     // [n_faces] sorted by lowest, then leftmost corner

  std::vector<Polyline> dead_ends;  // noded lines, or parts of them, that bound no face [m]
  std::vector<std::vector<Polyline>>
      rings_of_holed;  // faces with holes, which are not in `face`: outer ring, holes
};

/// Width of the grid for a model of size `extent` [m]: `wanted` rounded down to a power of two, or 2^-20 m
/// and at most 1e-8 of the extent when `wanted` is NaN.
double grid_width(double extent, double wanted);

/// Nodes `lines` on the grid and collects the faces. Where two lines run along one edge the one that comes
/// first in the list is its source. Cost N log N. Throws std::runtime_error when GEOS fails or gives lines
/// that bound no valid face.
/// @param grid  a power of two [m], larger than 2^-52 of the coordinates relative to `origin`
Arrangement arrange(const std::vector<Polyline>& lines, double grid, Vec2 origin);

/// A point inside a simple polygon: the middle of the widest stretch at the height of its centroid.
/// @pre area is not zero
Vec2 interior_point(const Polygon& polygon);

}  // namespace talus
