#pragma once
// What a cut picture shows of the blocks, sorted by how it is drawn: areas by material, lines by where they
// come from, dead ends. Colours, widths and labels are chosen here; nothing is drawn.

#include <string>
#include <utility>
#include <vector>

#include "talus/cut/layout.h"
#include "talus/plot/sheet.h"

namespace talus::plot {

/// Edges of the cut, and polygons of blocks that were not cut, that are drawn in one go.
struct Layer {
  Pen pen;  // its colour fills an area
  std::string label;
  std::vector<int> edges;
  std::vector<Polygon> polygons = {};  // [m]
  std::vector<int> origins = {};       // of the cut that its lines come from
};

/// Width [px] that leaves the blocks to be seen, from an arch of 20 to a slope of 100 000: a share of the
/// size of the median block.
/// @param scale  [px/m]
double joint_line_width(const Cut& cut, const Layout& layout, double scale);

/// Areas in one tint: materials, then fixed rock, then rock kept in openings.
std::vector<Layer> make_areas(const Model& model, const Cut& cut, const Layout& layout);

/// Lines of one origin, each edge once, most important first; then the outlines of blocks that were not cut.
/// Openings share a layer, and so do sides. Labels name the joint along the line.
std::vector<Layer> make_lines(const Model& model, const Cut& cut, const Layout& layout, double joint_width);

/// Of edges that merging has taken away: red, and wide enough to be seen.
Pen merged_pen(double joint_width);
Pen dead_end_pen(double joint_width);

/// Segments [m] of the dead ends in the rock that is left: in an empty opening they would not mean anything.
std::vector<std::pair<Vec2, Vec2>> visible_dead_ends(const Model& model, const Cut& cut);

}  // namespace talus::plot
