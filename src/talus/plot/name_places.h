#pragma once
// Markers of monitored points and blocks, and where the names of monitors and of openings go on a cut
// picture: beside their markers, not over each other nor over other markers; at the end of a thin line where
// it is crowded.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "talus/cut/layout.h"
#include "talus/plot/sheet.h"

namespace talus::plot {

struct Name {
  std::string text;
  double size = 0;           // of the font [px]
  Rect box;                  // the text stands in its middle
  std::optional<Vec2> from;  // the marker, when the name stands so far away that a line leads there

  /// Where the line ends: the point of the box nearest to the marker.
  Vec2 end_of_leader() const;
};

struct Names {
  std::vector<Vec2> markers;  // [px]
  std::vector<Name> names;    // of openings and monitors
  std::size_t left_out = 0;   // monitors without name, for want of room
};

/// Places markers and names. Monitors outside the frame have none, and neither has a model without blocks.
/// Openings that a stage takes out have its number behind their name.
/// @param room  names stay inside
Names place_names(cairo_t* cr, const Model& model, const Cut& cut, const Layout& layout, const View& view,
                  const Rect& room);

/// Draws one marker, for the legend.
void draw_marker(cairo_t* cr, Vec2 p);

/// Draws lines, markers and, with a white rim that keeps them legible above everything else, the names.
void draw_names(cairo_t* cr, const Names& names);

}  // namespace talus::plot
