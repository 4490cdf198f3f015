#include "talus/plot/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "talus/base/index.h"
#include "talus/plot/canvas.h"
#include "talus/plot/scale.h"

namespace talus::plot {
namespace {

// Sizes in px.
constexpr double kFontSize = 13, kTitleSize = 15, kMargin = 12;
constexpr double kLegendRow = 19, kLegendSample = 30, kLegendGap = 7, kLegendColumnGap = 20;
constexpr double kTickLength = 4, kLabelGap = 8;
constexpr int kColors = 8;

struct Color {
  double r, g, b;
};

struct Box {
  double x, y, w, h;
  double right() const { return x + w; }
  double bottom() const { return y + h; }
};

struct Axis {
  Range range{0, 1};
  Ticks ticks;
  std::vector<std::string> labels;
  double widest_label = 0;
};

struct LegendEntry {
  const Curve* curve;
  std::string text;
  double width;         // sample and text
  double x = 0, y = 0;  // left end and middle height
};

struct Layout {
  double width = 0, height = 0;
  Box plot{};
  Axis x, y;
  std::string title, x_label, y_label;
  std::vector<LegendEntry> legend;
  bool has_data = false;
};

// ---------------------------------------------------------------------------------------------- colours

// Okabe and Ito's colours for all kinds of colour vision, the ones that stand out best on white first. Their
// black is lightened so that the darker dashes of the same index stand out from it.
constexpr std::array<Color, kColors> kPalette{{{0.000, 0.447, 0.698},    // blue
                                               {0.835, 0.369, 0.000},    // vermilion
                                               {0.000, 0.620, 0.451},    // bluish green
                                               {0.800, 0.475, 0.655},    // reddish purple
                                               {0.902, 0.624, 0.000},    // orange
                                               {0.337, 0.706, 0.914},    // sky blue
                                               {0.420, 0.420, 0.420},    // black
                                               {0.900, 0.840, 0.160}}};  // yellow, darkened for white paper

int palette_index(const Curve& curve) {
  return ((curve.color % (2 * kColors)) + 2 * kColors) % (2 * kColors);
}

Color curve_color(const Curve& curve) {
  const Color c = kPalette[static_cast<std::size_t>(palette_index(curve) % kColors)];
  const auto blend = [&c](double share, double other) {
    return Color{share * c.r + (1 - share) * other, share * c.g + (1 - share) * other,
                 share * c.b + (1 - share) * other};
  };
  if (curve.style == Style::kDashed) return blend(0.4, 0);  // stands out where it covers its solid partner
  if (curve.style == Style::kThin) return blend(0.45, 1);
  return c;
}

std::vector<double> dash_pattern(const Curve& curve) {
  const bool second_round = palette_index(curve) >= kColors;
  const std::vector<double> dashes = second_round ? std::vector<double>{2, 3} : std::vector<double>{6, 5};
  if (curve.style == Style::kDashed) return dashes;
  return second_round ? std::vector<double>{12, 2.5, 2, 2.5} : std::vector<double>{};
}

void set_color(cairo_t* cr, Color c) { cairo_set_source_rgb(cr, c.r, c.g, c.b); }
void set_grey(cairo_t* cr, double level) { cairo_set_source_rgb(cr, level, level, level); }

void set_pen(cairo_t* cr, const Curve& curve) {
  const std::vector<double> dashes = dash_pattern(curve);
  set_color(cr, curve_color(curve));
  cairo_set_line_width(cr, curve.style == Style::kThin ? 0.8 : curve.style == Style::kDashed ? 1.5 : 2);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cr, dashes.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  cairo_set_dash(cr, dashes.data(), count_of(dashes), 0);
}

void set_rule(cairo_t* cr, double grey) {
  set_grey(cr, grey);
  cairo_set_line_width(cr, 1);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_SQUARE);
  cairo_set_dash(cr, nullptr, 0, 0);
}

// ------------------------------------------------------------------------------------------------ ranges

// Range of the finite values among `values` whose partner lies within `window`; grows `range`.
void extend(Range& range, const std::vector<double>& values, const std::vector<double>& partner,
            Range window) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_drawable(values[i]) || !is_drawable(partner[i])) continue;
    if (partner[i] < window.lo || partner[i] > window.hi) continue;
    range.lo = std::min(range.lo, values[i]);
    range.hi = std::max(range.hi, values[i]);
  }
}

Range axis_range(Range data, const std::optional<double>& min, const std::optional<double>& max,
                 double margin) {
  Range r = data.lo <= data.hi ? data : Range{0, 1};
  r = widened(r);
  const double pad = margin * r.length();
  r = {r.lo - pad, r.hi + pad};
  if (min && is_drawable(*min)) r.lo = *min;
  if (max && is_drawable(*max)) r.hi = *max;
  return widened(r);
}

void set_ranges(const Figure& figure, Layout& layout) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr Range kEverything{-kInfinity, kInfinity}, kNothing{kInfinity, -kInfinity};
  Range x = kNothing, y = kNothing;
  for (const Curve& curve : figure.curves) extend(x, curve.x, curve.y, kEverything);
  layout.x.range = axis_range(x, figure.x_min, figure.x_max, 0);
  for (const Curve& curve : figure.curves) extend(y, curve.y, curve.x, layout.x.range);
  layout.y.range = axis_range(y, figure.y_min, figure.y_max, 0.05);
  layout.has_data = x.lo <= x.hi;
}

// ------------------------------------------------------------------------------------------------ layout

void set_ticks(cairo_t* cr, Axis& axis, int target) {
  axis.ticks = nice_ticks(axis.range.lo, axis.range.hi, target);
  axis.labels = tick_labels(axis.ticks);
  axis.widest_label = 0;
  for (const std::string& label : axis.labels) {
    axis.widest_label = std::max(axis.widest_label, text_width(cr, label));
  }
}

// As many ticks as fit beside each other with their labels; kinds have one each.
void set_x_ticks(cairo_t* cr, const std::vector<std::string>& names, Axis& axis, double width) {
  if (!names.empty()) {
    axis.ticks = {};
    axis.labels.clear(), axis.widest_label = 0;
    const double room = std::max(10.0, width / static_cast<double>(names.size()) - 8);
    for (size_t k = 0; k < names.size(); ++k) {
      axis.ticks.values.push_back(static_cast<double>(k + 1));
      axis.labels.push_back(fit_text(cr, names[k], room));
      axis.widest_label = std::max(axis.widest_label, text_width(cr, axis.labels.back()));
    }
    return;
  }
  for (int target = std::clamp(static_cast<int>(width / 65), 2, 40); target >= 2; --target) {
    set_ticks(cr, axis, target);
    const double spacing = axis.ticks.step / axis.range.length() * width;
    if (axis.widest_label + 16 <= spacing) return;
  }
}

// Puts the entries into rows with aligned columns and returns the number of rows.
std::size_t place_in_rows(std::vector<LegendEntry>& entries, double left, double top, double available) {
  const std::size_t count = entries.size();
  if (count == 0) return 0;
  // Computed and exact curves mostly come in pairs, which an even number of columns keeps together.
  const auto dashed = std::count_if(entries.begin(), entries.end(), [](const LegendEntry& entry) {
    return entry.curve->style == Style::kDashed;
  });
  const bool pairs = 2 * dashed == static_cast<std::ptrdiff_t>(count);
  std::vector<double> widths;
  for (std::size_t rows = 1; rows <= count; ++rows) {
    const std::size_t columns = (count + rows - 1) / rows;
    if (pairs && columns > 1 && columns % 2 == 1) continue;
    widths.assign(columns, 0);
    for (std::size_t i = 0; i < count; ++i) {
      widths[i % columns] = std::max(widths[i % columns], entries[i].width);
    }
    double total = kLegendColumnGap * static_cast<double>(columns - 1);
    for (double width : widths) total += width;
    if (total <= available) break;
  }
  double x = left;
  for (std::size_t column = 0; column < widths.size(); ++column) {
    for (std::size_t i = column; i < count; i += widths.size()) {
      entries[i].x = x;
      entries[i].y = top + (static_cast<double>(i / widths.size()) + 0.5) * kLegendRow;
    }
    x += widths[column] + kLegendColumnGap;
  }
  return (count + widths.size() - 1) / widths.size();
}

// Rows under the title cost no width; a column at the right is better when they would become many. Shrinks
// the plot area by the space taken.
void place_legend(std::vector<LegendEntry>& entries, double figure_width, Box& plot) {
  double widest = 0;
  for (const LegendEntry& entry : entries) widest = std::max(widest, entry.width);
  const std::size_t rows = place_in_rows(entries, plot.x, plot.y, figure_width - kMargin - plot.x);
  const bool column_fits =
      widest <= 0.3 * figure_width && static_cast<double>(entries.size()) * kLegendRow <= plot.h;
  if (rows > 4 && column_fits) {
    plot.w -= std::max(0.0, widest + 2 * kLabelGap + plot.right() - (figure_width - kMargin));
    for (std::size_t i = 0; i < entries.size(); ++i) {
      entries[i].x = plot.right() + 2 * kLabelGap;
      entries[i].y = plot.y + (static_cast<double>(i) + 0.5) * kLegendRow;
    }
  } else if (rows > 0) {
    const double taken = static_cast<double>(rows) * kLegendRow + 6;
    plot.y += taken;
    plot.h -= taken;
  }
}

std::vector<LegendEntry> legend_entries(cairo_t* cr, const Figure& figure, double available) {
  std::vector<LegendEntry> entries;
  for (const Curve& curve : figure.curves) {
    if (!curve.in_legend || curve.label.empty()) continue;
    const std::string text = fit_text(cr, curve.label, available - kLegendSample - kLegendGap);
    entries.push_back({&curve, text, kLegendSample + kLegendGap + text_width(cr, text)});
  }
  return entries;
}

Layout make_layout(cairo_t* cr, const Figure& figure) {
  Layout layout;
  layout.width = std::isfinite(figure.width) ? std::clamp(figure.width, 240.0, 8000.0) : 760;
  layout.height = std::isfinite(figure.height) ? std::clamp(figure.height, 180.0, 8000.0) : 460;
  set_ranges(figure, layout);

  set_font(cr, kFontSize);
  const double y_label_width = figure.y_label.empty() ? 0 : kFontSize + kLabelGap;
  const double x_label_height = figure.x_label.empty() ? 0 : kFontSize + kLabelGap;
  const double below = kTickLength + 4 + kFontSize + x_label_height + kMargin;
  const double header = kMargin + (figure.title.empty() ? 0 : kTitleSize + 10);

  // The width of the tick labels decides where the legend starts and the rows of the legend decide how many
  // ticks there are; a second pass settles that.
  double plot_height = layout.height - header - below;
  const double least_height = 0.5 * plot_height;
  for (int pass = 0; pass < 2; ++pass) {
    set_ticks(cr, layout.y, std::clamp(static_cast<int>(plot_height / 36), 2, 40));
    const double left = kMargin + y_label_width + layout.y.widest_label + kTickLength + 4;
    layout.plot = {left, header, layout.width - left - kMargin, layout.height - header - below};
    set_x_ticks(cr, figure.x_names, layout.x, layout.plot.w);
    layout.plot.w -= std::max(0.0, layout.x.widest_label / 2 - kMargin + 4);  // a label at the right end
    layout.legend = legend_entries(cr, figure, layout.width - kMargin - left);
    place_legend(layout.legend, layout.width, layout.plot);
    layout.plot.w = std::max(layout.plot.w, 40.0);  // never negative, even if labels then stick out
    const double missing = std::ceil(std::max(0.0, least_height - layout.plot.h));
    layout.height += missing;
    layout.plot.h += missing;
    plot_height = layout.plot.h;
  }
  set_x_ticks(cr, figure.x_names, layout.x, layout.plot.w);
  layout.x_label = fit_text(cr, figure.x_label, layout.plot.w);
  layout.y_label = fit_text(cr, figure.y_label, layout.plot.h);
  set_font(cr, kTitleSize, true);
  layout.title = fit_text(cr, figure.title, layout.width - kMargin - layout.plot.x);
  return layout;
}

// ----------------------------------------------------------------------------------------------- drawing

// Pixel position; bounded, because lines are cut with products of these numbers.
double to_pixel(double value, Range range, double start, double length) {
  return std::clamp(start + (value - range.lo) / range.length() * length, -1e9, 1e9);
}

Point to_pixels(Point p, const Layout& layout) {
  const Box& plot = layout.plot;
  return {to_pixel(p.x, layout.x.range, plot.x, plot.w),
          to_pixel(p.y, layout.y.range, plot.bottom(), -plot.h)};
}

// Cuts the segment ab to the box (Liang and Barsky); false when nothing of it is inside. Needed besides the
// clip of the surface because cairo cannot hold coordinates beyond some million px.
bool cut_to_box(Point& a, Point& b, const Box& box) {
  const Point d{b.x - a.x, b.y - a.y};
  double from = 0, to = 1;
  const auto cut = [&from, &to](double slope, double room) {
    if (slope == 0) return room >= 0;
    const double t = room / slope;
    if (slope < 0) from = std::max(from, t);
    if (slope > 0) to = std::min(to, t);
    return from <= to;
  };
  if (!cut(-d.x, a.x - box.x) || !cut(d.x, box.right() - a.x)) return false;
  if (!cut(-d.y, a.y - box.y) || !cut(d.y, box.bottom() - a.y)) return false;
  const Point start = a;
  if (to < 1) b = {start.x + to * d.x, start.y + to * d.y};
  if (from > 0) a = {start.x + from * d.x, start.y + from * d.y};
  return true;
}

void draw_piece(cairo_t* cr, const std::vector<Point>& piece, const Layout& layout) {
  constexpr double kBeyond = 5;  // cut ends lie outside the visible area
  const Box& plot = layout.plot;
  const Box box{plot.x - kBeyond, plot.y - kBeyond, plot.w + 2 * kBeyond, plot.h + 2 * kBeyond};
  if (piece.size() == 1) {  // a line of no length would not show
    Point p = to_pixels(piece[0], layout), q = p;
    if (!cut_to_box(p, q, box)) return;
    cairo_arc(cr, p.x, p.y, 2, 0, 2 * std::numbers::pi);
    cairo_fill(cr);
    return;
  }
  bool pen_down = false;
  for (std::size_t i = 1; i < piece.size(); ++i) {
    Point a = to_pixels(piece[i - 1], layout), b = to_pixels(piece[i], layout);
    const Point end = b;
    if (!cut_to_box(a, b, box)) {
      pen_down = false;
      continue;
    }
    if (!pen_down) cairo_move_to(cr, a.x, a.y);
    cairo_line_to(cr, b.x, b.y);
    pen_down = b.x == end.x && b.y == end.y;
  }
  cairo_stroke(cr);
}

void draw_curves(cairo_t* cr, const Figure& figure, const Layout& layout) {
  const Box& plot = layout.plot;
  const Range range = layout.x.range;
  cairo_save(cr);
  cairo_rectangle(cr, plot.x, plot.y - 1, plot.w + 1, plot.h + 2);
  cairo_clip(cr);
  for (const Style style : {Style::kThin, Style::kSolid, Style::kDashed}) {
    for (const Curve& curve : figure.curves) {
      if (curve.style != style) continue;
      set_pen(cr, curve);
      const double per_px = style == Style::kThin ? kPixelDensity : 1;  // wide lines hide finer detail
      const int columns = static_cast<int>(std::ceil(plot.w * per_px));
      for (const auto& piece : reduce_by_column(curve.x, curve.y, range.lo, range.hi, columns)) {
        draw_piece(cr, piece, layout);
      }
    }
  }
  cairo_restore(cr);
}

// Lines of width 1 at half px fill whole pixels at both densities.
double crisp(double v) { return std::floor(v) + 0.5; }

void draw_line(cairo_t* cr, double x1, double y1, double x2, double y2) {
  cairo_move_to(cr, crisp(x1), crisp(y1));
  cairo_line_to(cr, crisp(x2), crisp(y2));
  cairo_stroke(cr);
}

void draw_grid(cairo_t* cr, const Layout& layout) {
  constexpr double kGridGrey = 0.9, kZeroGrey = 0.68;
  const Box& plot = layout.plot;
  for (const double level : {kGridGrey, kZeroGrey}) {  // zero lines last, across the others
    set_rule(cr, level);
    for (double v : layout.x.ticks.values) {
      const double x = to_pixel(v, layout.x.range, plot.x, plot.w);
      if ((v == 0) == (level == kZeroGrey)) draw_line(cr, x, plot.y, x, plot.bottom());
    }
    for (double v : layout.y.ticks.values) {
      const double y = to_pixel(v, layout.y.range, plot.bottom(), -plot.h);
      if ((v == 0) == (level == kZeroGrey)) draw_line(cr, plot.x, y, plot.right(), y);
    }
  }
}

void draw_axes(cairo_t* cr, const Layout& layout) {
  const Box& plot = layout.plot;
  set_rule(cr, 0.25);
  draw_line(cr, plot.x, plot.y, plot.x, plot.bottom());
  draw_line(cr, plot.x, plot.bottom(), plot.right(), plot.bottom());
  set_font(cr, kFontSize);
  const double label_y = plot.bottom() + kTickLength + 4 + kFontSize / 2;
  for (std::size_t i = 0; i < layout.x.labels.size(); ++i) {
    const double x = to_pixel(layout.x.ticks.values[i], layout.x.range, plot.x, plot.w);
    draw_line(cr, x, plot.bottom(), x, plot.bottom() + kTickLength);
    draw_text(cr, layout.x.labels[i], x, label_y, 0.5);
  }
  for (std::size_t i = 0; i < layout.y.labels.size(); ++i) {
    const double y = to_pixel(layout.y.ticks.values[i], layout.y.range, plot.bottom(), -plot.h);
    draw_line(cr, plot.x - kTickLength, y, plot.x, y);
    draw_text(cr, layout.y.labels[i], plot.x - kTickLength - 4, y, 1);
  }
  set_grey(cr, 0.1);
  draw_text(cr, layout.x_label, plot.x + plot.w / 2, label_y + kFontSize + kLabelGap, 0.5);
  cairo_save(cr);
  cairo_translate(cr, kMargin + kFontSize / 2, plot.y + plot.h / 2);
  cairo_rotate(cr, -std::numbers::pi / 2);
  draw_text(cr, layout.y_label, 0, 0, 0.5);
  cairo_restore(cr);
}

void draw_legend(cairo_t* cr, const Layout& layout) {
  set_font(cr, kFontSize);
  for (const LegendEntry& entry : layout.legend) {
    set_pen(cr, *entry.curve);
    cairo_move_to(cr, entry.x, crisp(entry.y));
    cairo_line_to(cr, entry.x + kLegendSample, crisp(entry.y));
    cairo_stroke(cr);
    set_grey(cr, 0.1);
    draw_text(cr, entry.text, entry.x + kLegendSample + kLegendGap, entry.y, 0);
  }
}

void draw(cairo_t* cr, const Figure& figure, const Layout& layout) {
  draw_grid(cr, layout);
  draw_curves(cr, figure, layout);
  draw_axes(cr, layout);
  draw_legend(cr, layout);
  set_grey(cr, 0.1);
  if (!layout.has_data) {
    draw_text(cr, "no data", layout.plot.x + layout.plot.w / 2, layout.plot.y + layout.plot.h / 2, 0.5);
  }
  set_font(cr, kTitleSize, true);
  draw_text(cr, layout.title, layout.plot.x, kMargin + kTitleSize / 2, 0);
}

}  // namespace

void write_figure(const Figure& figure, const std::filesystem::path& stem) {
  for (const Curve& curve : figure.curves) {
    if (curve.x.size() == curve.y.size()) continue;
    throw std::invalid_argument("curve '" + curve.label + "': " + std::to_string(curve.x.size()) +
                                " values of x but " + std::to_string(curve.y.size()) + " of y");
  }
  const Layout layout = make_layout(make_measuring_context().get(), figure);
  write_picture(stem, layout.width, layout.height, [&](cairo_t* cr) { draw(cr, figure, layout); });
}

}  // namespace talus::plot
