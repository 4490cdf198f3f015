#include "talus/plot/axes.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

namespace talus::plot {
namespace {

constexpr double kNameGap = 8;  // [px] between labels and the name of the axis

}  // namespace

Axis make_axis(cairo_t* cr, Range range, double length, bool across) {
  constexpr double kDense = 65;                       // between ticks; one step for both axes
  constexpr double kBetween = 20, kBetweenLines = 8;  // labels
  Axis axis;
  set_font(cr, kFontSize);
  for (int target = std::max(3, static_cast<int>(length / kDense)); target > 0; --target) {
    const Ticks ticks = nice_ticks(range.lo, range.hi, target);
    if (ticks.values.empty()) continue;  // never for 3: their step is shorter than the range
    axis = {ticks, tick_labels(ticks), 0};
    for (const std::string& label : axis.labels) axis.widest = std::max(axis.widest, text_width(cr, label));
    const double spacing = ticks.step / range.length() * length;
    if (spacing >= (across ? axis.widest + kBetween : kFontSize + kBetweenLines)) return axis;
  }
  if (axis.labels.empty()) return axis;
  axis.ticks.values = {axis.ticks.values[axis.ticks.values.size() / 2]};
  axis.labels = tick_labels(axis.ticks);
  return axis;
}

double room_left(const Axis& y) { return kFontSize + kNameGap + y.widest + kTickLength + kTickGap; }

double room_below() { return kTickLength + kTickGap + 2 * kFontSize + kNameGap; }

void draw_rule(cairo_t* cr, Vec2 from, Vec2 to) {
  cairo_move_to(cr, crisp(from.x), crisp(from.y));
  cairo_line_to(cr, crisp(to.x), crisp(to.y));
  cairo_stroke(cr);
}

void draw_axes(cairo_t* cr, const View& view, const Axis& x_axis, const Axis& y_axis) {
  const Rect& frame = view.frame;
  set_pen(cr, {{0.25, 0.25, 0.25}, 1, {}});
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_SQUARE);
  draw_rule(cr, {frame.x, frame.y}, {frame.x, frame.bottom()});
  draw_rule(cr, {frame.x, frame.bottom()}, {frame.right(), frame.bottom()});
  set_font(cr, kFontSize);
  const double label_y = frame.bottom() + kTickLength + kTickGap + kFontSize / 2;
  for (std::size_t i = 0; i < x_axis.labels.size(); ++i) {
    const double x = view.to_sheet({x_axis.ticks.values[i], 0}).x;
    draw_rule(cr, {x, frame.bottom()}, {x, frame.bottom() + kTickLength});
    draw_text(cr, x_axis.labels[i], x, label_y, 0.5);
  }
  for (std::size_t i = 0; i < y_axis.labels.size(); ++i) {
    const double y = view.to_sheet({0, y_axis.ticks.values[i]}).y;
    draw_rule(cr, {frame.x - kTickLength, y}, {frame.x, y});
    draw_text(cr, y_axis.labels[i], frame.x - kTickLength - kTickGap, y, 1);
  }
  set_color(cr, kText);
  draw_text(cr, "x [m]", frame.middle().x, label_y + kFontSize + kNameGap, 0.5);
  cairo_save(cr);
  cairo_translate(cr, frame.x - room_left(y_axis) + kFontSize / 2, frame.middle().y);
  cairo_rotate(cr, -std::numbers::pi / 2);
  draw_text(cr, "y [m]", 0, 0, 0.5);
  cairo_restore(cr);
}

}  // namespace talus::plot
