#pragma once
// What the parts of a cut picture share: rectangles, colours, pens, the way from the section to the sheet,
// and texts. Places on the sheet are in px from its upper left corner, y down. Not for use outside plot/.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "talus/base/index.h"
#include "talus/base/vec2.h"
#include "talus/plot/canvas.h"
#include "talus/plot/scale.h"

namespace talus::plot {

constexpr double kFontSize = 13;  // [px] of all texts but title and monitor names
constexpr double kTitleSize = 15, kTitleRow = 28, kMargin = 12;  // [px]
constexpr double kPad = 10;                                      // [px] from the model to the frame

struct Color {
  double r = 0, g = 0, b = 0;
};

constexpr Color kWhite{1, 1, 1}, kText{0.1, 0.1, 0.1}, kMidGrey{0.45, 0.45, 0.45};

struct Rect {
  double x = 0, y = 0, w = 0, h = 0;
  double right() const { return x + w; }
  double bottom() const { return y + h; }
  Vec2 middle() const { return {x + w / 2, y + h / 2}; }
};

struct Pen {
  Color color;
  double width = 1;
  std::vector<double> dashes;  // [px] drawn, left out, and so on; empty: a full line
};

/// Where the section lies on the sheet.
struct View {
  Rect frame;        // [px]
  Vec2 middle;       // [m] in the middle of the frame
  double scale = 1;  // [px/m]

  Vec2 to_sheet(Vec2 p) const {
    const Vec2 m = frame.middle();
    return {m.x + (p.x - middle.x) * scale, m.y - (p.y - middle.y) * scale};
  }
  Range x_range() const { return {middle.x - frame.w / 2 / scale, middle.x + frame.w / 2 / scale}; }
  Range y_range() const { return {middle.y - frame.h / 2 / scale, middle.y + frame.h / 2 / scale}; }
};

/// An index as the containers of the standard library want it.
inline std::size_t at(int index) { return static_cast<std::size_t>(index); }

inline void set_color(cairo_t* cr, Color c) { cairo_set_source_rgb(cr, c.r, c.g, c.b); }

inline void set_pen(cairo_t* cr, const Pen& pen) {
  set_color(cr, pen.color);
  cairo_set_line_width(cr, pen.width);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cr, pen.dashes.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  cairo_set_dash(cr, pen.dashes.data(), count_of(pen.dashes), 0);
}

/// A coordinate [px] such that a line of width 1 there fills whole pixels in both files. Rounding of `v` must
/// not move it to the next one.
inline double crisp(double v) { return std::floor(v + 1e-6) + 0.5; }

/// fit_text() for texts of any length: it measures piece by piece, which takes forever from the end of a very
/// long one.
inline std::string fitted(cairo_t* cr, const std::string& text, double available) {
  std::size_t end = std::min<std::size_t>(text.size(), 300);  // bytes: more than any sheet has room for
  const auto is_within_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
  while (end > 0 && end < text.size() && is_within_character(text[end])) --end;
  return fit_text(cr, text.substr(0, end), available);
}

/// "1 block", "20 blocks"
inline std::string counted(std::size_t count, const std::string& word) {
  return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

}  // namespace talus::plot
