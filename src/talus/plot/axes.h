#pragma once
// The axes of a section drawn in true proportion: ticks with room for their labels, x and y in metres. Not
// for use outside plot/.

#include <string>
#include <vector>

#include "talus/plot/canvas.h"
#include "talus/plot/scale.h"
#include "talus/plot/sheet.h"

namespace talus::plot {

constexpr double kTickLength = 4, kTickGap = 4;  // [px]

struct Axis {
  Ticks ticks;
  std::vector<std::string> labels;
  double widest = 0;  // label [px]
};

/// Ticks of `range` [m] on an axis of `length` px with room for their labels; a single one where there is
/// room for no two.
/// @param across  labels stand side by side (x), not above each other (y)
Axis make_axis(cairo_t* cr, Range range, double length, bool across);

/// Room that the axes take to the left of the frame and below it [px].
double room_left(const Axis& y);
double room_below();

/// Draws the two axes, their labels and "x [m]", "y [m]".
void draw_axes(cairo_t* cr, const View& view, const Axis& x, const Axis& y);

/// A straight line of whole pixels.
void draw_rule(cairo_t* cr, Vec2 from, Vec2 to);

}  // namespace talus::plot
