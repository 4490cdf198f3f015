#pragma once
// From a heap of lines to the faces they enclose: noding on a grid and polygonizing (GEOS), with the topology
// and the source of every edge put back. All corners are multiples of the grid; faces share them exactly.

#include <array>
#include <functional>
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
  std::vector<Polyline> cuts;       // that opened holes; as sources they are numbered after the lines
  int opened = 0;                   // faces with holes that were opened
  std::vector<std::vector<Polyline>> rings_of_holed;  // faces with holes that were not: outer ring, holes
};

/// Width of the grid for a model of size `extent` [m]: `wanted` rounded down to a power of two, or 2^-20 m
/// and at most 1e-8 of the extent when `wanted` is NaN.
double grid_width(double extent, double wanted);

/// Nodes `lines` on the grid and collects the faces. Where two lines run along one edge the one that comes
/// first in the list is its source. Cost N log N. Throws std::runtime_error when GEOS fails or gives lines
/// that bound no valid face.
/// @param grid      a power of two [m], larger than 2^-52 of the coordinates relative to `origin`
/// @param is_solid  whether a face with holes around this point must become faces without, by short cuts
///                  (open_holes.h). Dead ends are gone by then. None: no face
Arrangement arrange(const std::vector<Polyline>& lines, double grid, Vec2 origin,
                    const std::function<bool(Vec2)>& is_solid = nullptr);

}  // namespace talus
