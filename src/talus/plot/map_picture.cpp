#include "talus/plot/map_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "talus/plot/axes.h"
#include "talus/plot/sheet.h"

namespace talus::plot {
namespace {

// Sizes in px.
constexpr double kMargin = 12, kTitleRow = 28, kTitleSize = 15, kGap = 8, kBetween = 28;
constexpr double kLargestWidth = 780, kLargestHeight = 900;  // of a frame
constexpr double kPad = 10, kMarker = 4.5, kRow = 19;

struct Mark {
  const char* text;
  Color color;
  int corners;  // of its sign; 0: a circle
};

// told apart by shape and by colours that the colour-blind tell apart
constexpr std::array<Mark, 5> kMarks{{{"points too close to the one before", {0.55, 0.55, 0.55}, 0},
                                      {"crumbs left out", {0.80, 0.47, 0.65}, 4},
                                      {"doubles left out", {0.90, 0.60, 0.00}, 3},
                                      {"gaps closed", {0.00, 0.45, 0.70}, 0},
                                      {"overshoots cut back", {0.84, 0.37, 0.00}, 4}}};

struct Sheet {
  View left, right;
  Axis x, y;
  double width = 0, height = 0;
};

Sheet make_sheet(cairo_t* cr, const maps::MapReport& report) {
  std::vector<Vec2> points;
  for (const Polyline& ring : report.outlines) points.insert(points.end(), ring.begin(), ring.end());
  for (const maps::MapLine& line : report.before)
    points.insert(points.end(), line.points.begin(), line.points.end());
  if (points.empty()) points = {{0, 0}, {1, 1}};
  const Box box = bounding_box(points);
  const Range x = widened({box.min.x, box.max.x}), y = widened({box.min.y, box.max.y});
  Sheet s;
  View& v = s.left;
  v.middle = {x.lo + x.length() / 2, y.lo + y.length() / 2};
  v.scale = std::min((kLargestWidth - 2 * kPad) / x.length(), (kLargestHeight - 2 * kPad) / y.length());
  v.frame.w = std::max(240.0, std::ceil(x.length() * v.scale + 2 * kPad));
  v.frame.h = std::max(120.0, std::ceil(y.length() * v.scale + 2 * kPad));
  s.x = make_axis(cr, v.x_range(), v.frame.w, true);
  s.y = make_axis(cr, v.y_range(), v.frame.h, false);
  v.frame.x = std::ceil(kMargin + room_left(s.y)), v.frame.y = kMargin + kTitleRow;
  s.right = v;
  s.right.frame.x = std::ceil(v.frame.right() + kBetween + room_left(s.y));
  s.width = std::ceil(s.right.frame.right() + std::max(kMargin, s.x.widest / 2 + 4));
  s.height = std::ceil(v.frame.bottom() + room_below() + kGap + kMarks.size() * kRow + kMargin);
  return s;
}

void draw_line(cairo_t* cr, const View& view, const Polyline& line) {
  for (size_t k = 0; k < line.size(); ++k) {
    const Vec2 p = view.to_sheet(line[k]);
    k == 0 ? cairo_move_to(cr, p.x, p.y) : cairo_line_to(cr, p.x, p.y);
  }
}

void draw_lines(cairo_t* cr, const View& view, const maps::MapReport& report,
                const std::vector<maps::MapLine>& lines) {
  set_pen(cr, {{0.2, 0.2, 0.2},
               std::clamp(300.0 / std::sqrt(static_cast<double>(lines.size()) + 1) / 12, 0.5, 1.2),
               {}});
  for (const maps::MapLine& line : lines) draw_line(cr, view, line.points);
  cairo_stroke(cr);
  set_pen(cr, {{0, 0, 0}, 1.8, {}});
  for (const Polyline& ring : report.outlines) draw_line(cr, view, ring);
  cairo_stroke(cr);
}

void draw_mark(cairo_t* cr, const Mark& mark, Vec2 at, double size) {
  set_pen(cr, {mark.color, 0.3 * size, {}});
  cairo_new_sub_path(cr);
  if (mark.corners == 0) {
    cairo_arc(cr, at.x, at.y, size, 0, 2 * std::numbers::pi);
  } else {
    for (int k = 0; k < mark.corners; ++k) {
      const double angle = 2 * std::numbers::pi * k / mark.corners - std::numbers::pi / 2;
      const Vec2 p{at.x + size * std::cos(angle), at.y + size * std::sin(angle)};
      k == 0 ? cairo_move_to(cr, p.x, p.y) : cairo_line_to(cr, p.x, p.y);
    }
    cairo_close_path(cr);
  }
  cairo_stroke(cr);
}

void draw(cairo_t* cr, const Sheet& s, const maps::MapReport& report) {
  std::array<int, kMarks.size()> count{};
  for (const maps::Mend& m : report.mends) ++count[m.kind];
  // smaller where there are many
  const double size =
      std::clamp(kMarker * std::sqrt(300 / (1.0 + static_cast<double>(report.mends.size()))), 1.5, kMarker);
  draw_lines(cr, s.left, report, report.before);
  draw_lines(cr, s.right, report, report.after);
  for (const maps::Mend& m : report.mends) draw_mark(cr, kMarks[m.kind], s.left.to_sheet(m.at), size);
  draw_axes(cr, s.left, s.x, s.y);
  draw_axes(cr, s.right, s.x, s.y);
  set_color(cr, kText);
  set_font(cr, kTitleSize, true);
  const double title_y = kMargin + kTitleSize / 2;
  draw_text(cr, "as drawn: " + counted(report.before.size(), "line"), s.left.frame.x, title_y, 0);
  draw_text(cr, "cleaned: " + counted(report.after.size(), "line"), s.right.frame.x, title_y, 0);
  set_font(cr, kFontSize);
  double y = s.left.frame.bottom() + room_below() + kGap + kRow / 2;
  for (size_t k = 0; k < kMarks.size(); ++k, y += kRow) {
    draw_mark(cr, kMarks[k], {s.left.frame.x + kMarker, y}, kMarker);
    set_color(cr, kText);
    draw_text(cr, std::to_string(count[k]) + " " + kMarks[k].text, s.left.frame.x + 20, y, 0);
  }
}

}  // namespace

void write_map_picture(const maps::MapReport& report, const std::filesystem::path& stem) {
  const Sheet sheet = make_sheet(make_measuring_context().get(), report);
  write_picture(stem, sheet.width, sheet.height, [&](cairo_t* cr) { draw(cr, sheet, report); });
}

}  // namespace talus::plot
