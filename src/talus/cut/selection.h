#pragma once
// Which corners and edges of blocks a place of the model file means: a point, a segment, a line by its name.

#include <vector>

#include "talus/cut/layout.h"

namespace talus {

/// Corner `vertex` of block `block`.
struct SelectedCorner {
  int block = 0;
  int vertex = -1;  // -1: `point` inside the block
  Vec2 point;       // [m]
};

/// The material points at a place: corners of its edges; at a point all corners there, else the point of the
/// first block around it. Empty when it touches no block.
std::vector<SelectedCorner> selected_corners(const Layout& layout, const Selection& place);

/// Edge `edge` of block `block`, which runs from corner `edge` to the next one.
struct SelectedEdge {
  int block = 0;
  int edge = 0;
  Vec2 from, to;  // [m] the block lies to the left

  double length() const { return norm(to - from); }
  Vec2 normal() const { return turn_right(to - from) / length(); }  // outward
};

/// Block edges along the segment or line of a place. @pre  the place is no point
std::vector<SelectedEdge> selected_edges(const Layout& layout, const Selection& place);

/// Of the edges of a place, those with nothing on their other side, and the first that another block covers
/// in part (block -1: none is).
struct OuterEdges {
  std::vector<SelectedEdge> edges;
  SelectedEdge partly{-1, 0, {}, {}};
  int covered_by = -1;
};
OuterEdges outer_edges(const Layout& layout, const Selection& place);

}  // namespace talus
