#include "talus/plot/block_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/output/colours.h"
#include "talus/output/files.h"
#include "talus/plot/animated_png.h"
#include "talus/plot/axes.h"
#include "talus/plot/block_scenery.h"
#include "talus/plot/film.h"
#include "talus/plot/sheet.h"

namespace talus::plot {
namespace {

// Sizes in px.
constexpr double kBarGap = 10, kRow = 19;
constexpr double kLargestWidth = 860, kLargestHeight = 780;  // of the frame
constexpr double kBarWidth = 260, kBarHeight = 14;
constexpr double kThinOutline = 7;  // blocks smaller than this have no outline

constexpr Color of(const Rgb& c) { return {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0}; }
constexpr Color kSlipped = of(kSlippedColour), kOpen = of(kOpenColour);

using Anchors = std::array<Rgb, 9>;

Color mix(const Anchors& anchors, double share) {
  const double s = std::clamp(share, 0.0, 1.0) * static_cast<double>(anchors.size() - 1);
  const size_t i = std::min(static_cast<size_t>(s), anchors.size() - 2);
  const auto part = [&](size_t c) {
    return (anchors[i][c] + (s - static_cast<double>(i)) * (anchors[i + 1][c] - anchors[i][c])) / 255;
  };
  return {part(0), part(1), part(2)};
}

struct Prefix {
  double factor = 1;
  std::string unit;
};

Prefix readable(double most, const std::string& unit) {
  static constexpr std::array<std::pair<double, const char*>, 6> kPrefixes{
      {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "\u00b5"}}};
  for (const auto& [factor, text] : kPrefixes) {
    if (factor > 1 && (unit == "m" || unit == "m/s")) continue;
    if (most >= factor) return {factor, text + unit};
  }
  return {1, unit};
}

bool in_window(const Polygon& polygon, const Box& box) {
  const Box own = bounding_box(polygon);
  return own.max.x >= box.min.x && own.min.x <= box.max.x && own.max.y >= box.min.y && own.min.y <= box.max.y;
}

// The range of the colours. @param side  of two-sided ones: -1 where all values are negative, 1: positive; these have one
// half of the colours
struct Colouring {
  double low = 0, high = 1, least = 0, most = 0;
  int side = 0;
};

// 2 % of the blocks in sight at either end lie beyond it.
Colouring colouring_of(const Box& box, const Scenery& s, const std::optional<Range>& given) {
  Colouring c;
  std::vector<double> values;
  for (const Scenery::Shape& shape : s.shapes)
    if (in_window(shape.polygon, box) && is_drawable(shape.value)) values.push_back(shape.value);
  if (values.empty() || !s.quantity) return c;
  std::sort(values.begin(), values.end());
  const size_t cut = values.size() / 50;
  c.least = values.front(), c.most = values.back();
  c.low = given ? given->lo : values[cut], c.high = given ? given->hi : values[values.size() - 1 - cut];
  if (s.quantity->signed_values) {
    const double below = given ? given->lo : c.least, above = given ? given->hi : c.most;
    c.side = above <= 0 ? -1 : below >= 0 ? 1 : 0;
    const double size = std::max(std::abs(c.low), std::abs(c.high));
    c.low = c.side > 0 ? 0 : -size, c.high = c.side < 0 ? 0 : size;
  } else {
    c.low = std::min(0.0, c.low);
  }
  if (!(c.high > c.low)) c.high = c.low + 1;
  return c;
}

struct Sheet {
  View view;
  Axis x, y;
  double width = 0, height = 0;
  Colouring colouring;
};

Box box_of(const BlockPicture& picture, const Scenery& s) {
  if (picture.window) return *picture.window;
  std::vector<Vec2> all;
  for (const Scenery::Shape& shape : s.shapes)
    all.insert(all.end(), shape.polygon.begin(), shape.polygon.end());
  if (all.empty()) all = {{0, 0}, {1, 1}};
  return bounding_box(all);
}

int foot_rows(const Scenery& s) {
  return (s.quantity ? 3 : 1) + (s.slip > 0) + (s.opening > 0) + !s.bolts.empty() + s.ruptured +
         !s.crosses.empty() + !s.chains.empty() + (s.slip_arrows && s.slip > 0);
}

Sheet make_sheet(cairo_t* cr, const Box& box, const Scenery& scenery) {
  Sheet s;
  View& v = s.view;
  const Range x = widened({box.min.x, box.max.x}), y = widened({box.min.y, box.max.y});
  v.middle = {x.lo + x.length() / 2, y.lo + y.length() / 2};
  v.scale = std::min((kLargestWidth - 2 * kPad) / x.length(), (kLargestHeight - 2 * kPad) / y.length());
  v.frame.w = std::max(420.0, std::ceil(x.length() * v.scale + 2 * kPad));
  v.frame.h = std::max(140.0, std::ceil(y.length() * v.scale + 2 * kPad));
  s.x = make_axis(cr, v.x_range(), v.frame.w, true);
  s.y = make_axis(cr, v.y_range(), v.frame.h, false);
  v.frame.x = std::ceil(kMargin + room_left(s.y)), v.frame.y = kMargin + kTitleRow;
  s.width = std::ceil(v.frame.right() + std::max(kMargin, s.x.widest / 2 + 4));
  s.height = std::ceil(v.frame.bottom() + room_below() + kBarGap + foot_rows(scenery) * kRow + kMargin);
  return s;
}

void trace(cairo_t* cr, const View& view, const Polygon& polygon) {
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 p = view.to_sheet(polygon[k]);
    k == 0 ? cairo_move_to(cr, p.x, p.y) : cairo_line_to(cr, p.x, p.y);
  }
  cairo_close_path(cr);
}

// @param share  of the range of the colours
Color color_at(const Scenery& s, const Colouring& c, double share) {
  if (!s.quantity->signed_values) return mix(kOneSided, share);
  const double t = std::clamp(share, 0.0, 1.0);
  return mix(kTwoSided, c.side == 0 ? t : c.side < 0 ? 0.5 * t : 0.5 + 0.5 * t);
}

Color color_of(const Scenery& s, const Colouring& c, const Scenery::Shape& shape) {
  if (!s.quantity)
    return of(kKindColours.at(std::min<size_t>(static_cast<size_t>(shape.kind), kKindColours.size() - 1)));
  return is_drawable(shape.value) ? color_at(s, c, (shape.value - c.low) / (c.high - c.low)) : Color{1, 0, 1};
}

// A joint from end to end; a point alone as a dot, which is never too small to be seen.
void segment(cairo_t* cr, const View& view, Vec2 from, Vec2 to, const Pen& pen) {
  const Vec2 p = view.to_sheet(from), q = view.to_sheet(to);
  set_pen(cr, pen);
  if (norm(q - p) < 0.5) {
    cairo_new_path(cr);
    cairo_arc(cr, p.x, p.y, 1 + pen.width / 2, 0, 2 * std::numbers::pi);
    cairo_fill(cr);
    return;
  }
  cairo_move_to(cr, p.x, p.y);
  cairo_line_to(cr, q.x, q.y);
  cairo_stroke(cr);
}

Pen slip_pen(double share) { return {kSlipped, 1 + 3 * share, {}}; }
Pen open_pen() { return {kOpen, 2, {4, 3}}; }

Pen bolt_pen(const Scenery& s, const Scenery::Bolt& b) {
  if (b.ruptured) return {of(kBoltRuptured), 2.5, {3, 2}};
  if (b.axial < 0 || s.tension <= 0) return {of(kBoltPressed), 1.5, {}};
  const double share = b.axial / s.tension;
  const Color pale = of(kBoltPale), dark = of(kBoltDark);
  const auto mixed = [share](double from, double to) { return from + share * (to - from); };
  return {{mixed(pale.r, dark.r), mixed(pale.g, dark.g), mixed(pale.b, dark.b)}, 1.4 + 2.3 * share, {}};
}

void arrow(cairo_t* cr, Vec2 from, Vec2 along, const Pen& pen) {
  const double length = norm(along), head = std::min(5.0, 0.4 * length);
  if (length < 1) return;
  const Vec2 tip = from + along, d = along / length;
  set_pen(cr, pen);
  cairo_move_to(cr, from.x, from.y);
  cairo_line_to(cr, tip.x, tip.y);
  for (const double side : {-0.5, 0.5}) {
    cairo_move_to(cr, tip.x, tip.y);
    cairo_line_to(cr, tip.x - head * (d.x + side * d.y), tip.y - head * (d.y - side * d.x));
  }
  cairo_stroke(cr);
}

constexpr double kSlipArrow = 34, kBeside = 6;  // [px] the longest arrow; from its joint

// Half the longest cross [px]: it fits into most blocks.
double cross_size(const View& view, const Box& box, const Scenery& s) {
  std::vector<double> sizes;
  for (const Scenery::Shape& shape : s.shapes)
    if (in_window(shape.polygon, box)) sizes.push_back(std::sqrt(std::abs(signed_area(shape.polygon))));
  if (sizes.empty()) return 0;
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<long>(sizes.size() / 2), sizes.end());
  return std::clamp(0.45 * view.scale * sizes[sizes.size() / 2], 4.0, 45.0);
}

bool inside(Vec2 p, const Box& box) {
  return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y;
}

void draw_overlays(cairo_t* cr, const View& view, const Box& box, const Scenery& s) {
  for (const Scenery::Chain& c : s.chains) {
    if (c.force <= kLeastDrawn * s.force) continue;
    for (size_t k = 0; k + 1 < c.places.size(); ++k)
      segment(cr, view, c.places[k], c.places[k + 1], {of(kForceColour), 0.4 + 4 * c.force / s.force, {}});
  }
  const double longest = s.crosses.empty() ? 0 : cross_size(view, box, s);
  double stress = 0;  // the largest in sight
  for (const Scenery::Cross& c : s.crosses)
    if (inside(c.centre, box)) stress = std::max({stress, std::abs(c.first), std::abs(c.second)});
  for (const Scenery::Cross& c : s.crosses) {
    if (!inside(c.centre, box) || stress == 0) continue;
    const Vec2 middle = view.to_sheet(c.centre), x{c.axis.x, -c.axis.y}, y{c.axis.y, c.axis.x};
    for (const bool ground : {true, false})  // a pale rim tells it from any colour below
      for (const auto& [axis, value] : {std::pair(x, c.first), std::pair(y, c.second)}) {
        const Vec2 half = longest * std::abs(value) / stress * axis;
        set_pen(cr,
                ground ? Pen{kWhite, 3, {}} : Pen{of(value < 0 ? kPressedColour : kPulledColour), 1.4, {}});
        cairo_move_to(cr, middle.x - half.x, middle.y - half.y);
        cairo_line_to(cr, middle.x + half.x, middle.y + half.y);
        cairo_stroke(cr);
      }
  }
  if (!s.slip_arrows) return;
  for (const Scenery::Joint& j : s.joints) {
    if (j.slip <= kLeastDrawn * s.slip || norm(j.moved) == 0) continue;
    const Vec2 along = kSlipArrow * j.slip / s.slip / norm(j.moved) * Vec2{j.moved.x, -j.moved.y};
    const Vec2 middle = view.to_sheet(0.5 * (j.from + j.to)) + kBeside * Vec2{j.inward.x, -j.inward.y};
    arrow(cr, middle - 0.5 * along, along, {{0.1, 0.1, 0.1}, 1.3, {}});
  }
}

void draw_scene(cairo_t* cr, const Sheet& sheet, const Scenery& s) {
  const View& view = sheet.view;
  // all that the frame shows, which may be wider than what was asked for
  const Box box{{view.x_range().lo, view.y_range().lo}, {view.x_range().hi, view.y_range().hi}};
  cairo_save(cr);
  cairo_rectangle(cr, view.frame.x, view.frame.y, view.frame.w, view.frame.h);
  cairo_clip(cr);
  for (const Scenery::Shape& shape : s.shapes) {
    if (!in_window(shape.polygon, box)) continue;
    const Color fill = color_of(s, sheet.colouring, shape);
    trace(cr, view, shape.polygon);
    set_color(cr, fill);
    cairo_fill_preserve(cr);
    const Box own = bounding_box(shape.polygon);
    const double size = view.scale * std::max(own.max.x - own.min.x, own.max.y - own.min.y);
    // outlines of tiny blocks would hide their colour; a rim of their own closes the seams
    set_pen(cr, size > kThinOutline ? Pen{{0.2, 0.2, 0.2}, 0.5, {}} : Pen{fill, 0.4, {}});
    cairo_stroke(cr);
  }
  for (const Scenery::Joint& j : s.joints)
    if (j.slip > kLeastDrawn * s.slip) segment(cr, view, j.from, j.to, slip_pen(j.slip / s.slip));
  for (const Scenery::Joint& j : s.joints)
    if (j.opening > kLeastDrawn * s.opening) segment(cr, view, j.from, j.to, open_pen());
  for (const Scenery::Bolt& b : s.bolts)
    if (view.scale * norm(b.to - b.from) > 0.5)  // across a closed joint there is nothing to see
      segment(cr, view, b.from, b.to, bolt_pen(s, b));
  draw_overlays(cr, view, box, s);
  cairo_restore(cr);
}

std::string with_unit(double value, const std::string& unit) {
  const Prefix p = readable(std::abs(value), unit);
  return fmt::format("{:.3g} {}", value / p.factor, p.unit);
}

void draw_foot(cairo_t* cr, const Sheet& sheet, const Scenery& s) {
  const double x = sheet.view.frame.x, sample = 37;
  double y = sheet.view.frame.bottom() + room_below() + kBarGap + kRow / 2;
  set_font(cr, kFontSize);
  const auto text = [&](const std::string& words, double at, double anchor = 0) {
    set_color(cr, kText);
    draw_text(cr, words, at, y, anchor);
  };
  if (s.quantity) {
    const Colouring& c = sheet.colouring;
    const Prefix p = readable(std::max(std::abs(c.low), std::abs(c.high)), s.quantity->unit);
    text(fmt::format("{}{} [{}]", s.quantity->title, s.against.empty() ? "" : ", relative to " + s.against,
                     p.unit),
         x);
    std::string beyond;
    if (c.most > c.high) beyond = fmt::format("largest {:.3g}", c.most / p.factor);
    if (c.least < c.low)
      beyond += fmt::format("{}least {:.3g}", beyond.empty() ? "" : ", ", c.least / p.factor);
    y += kRow;
    constexpr int kSteps = 64;
    for (int k = 0; k < kSteps; ++k) {
      set_color(cr, color_at(s, c, (k + 0.5) / kSteps));
      cairo_rectangle(cr, x + k * kBarWidth / kSteps, y - kBarHeight / 2, kBarWidth / kSteps + 0.5,
                      kBarHeight);
      cairo_fill(cr);
    }
    if (!beyond.empty()) text("beyond the colours: " + beyond, x + kBarWidth + 24);
    y += kRow;
    const Ticks ticks = nice_ticks(c.low / p.factor, c.high / p.factor, 5);
    for (const double tick : ticks.values) {
      const double at = x + kBarWidth * (tick - c.low / p.factor) / ((c.high - c.low) / p.factor);
      set_pen(cr, {kText, 1, {}});
      cairo_move_to(cr, crisp(at - 0.5), y - kRow + kBarHeight / 2);
      cairo_line_to(cr, crisp(at - 0.5), y - kRow + kBarHeight / 2 + 4);
      cairo_stroke(cr);
      text(fmt::format("{:.4g}", std::abs(tick) < 1e-9 * ticks.step ? 0 : tick), at, 0.5);
    }
    y += kRow;
  } else {
    double at = x;
    for (int k = 0; k < count_of(kBlockKinds); ++k) {
      if (std::none_of(s.shapes.begin(), s.shapes.end(), [k](const auto& one) { return one.kind == k; }))
        continue;
      set_color(cr, of(kKindColours[k]));
      cairo_rectangle(cr, at, y - 6, 12, 12);
      cairo_fill(cr);
      text(kBlockKinds[k], at + 18);
      at += 34 + text_width(cr, kBlockKinds[k]);
    }
    y += kRow;
  }
  const auto line = [&](const Pen& pen) {
    set_pen(cr, pen);
    cairo_move_to(cr, x, y);
    cairo_line_to(cr, x + sample - 7, y);
    cairo_stroke(cr);
  };
  if (s.slip > 0) {
    line(slip_pen(1));
    text(fmt::format("{} slip of joints, the wider the more, at most {}",
                     s.residual ? "residual" : "accumulated", with_unit(s.slip, "m")),
         x + sample);
    y += kRow;
  }
  if (s.opening > 0) {
    line(open_pen());
    text("open joints of blocks still near each other, at most " + with_unit(s.opening, "m"), x + sample);
    y += kRow;
  }
  if (!s.bolts.empty()) {
    line(bolt_pen(s, {{}, {}, s.tension, false}));
    text(fmt::format("bolts: tension, dark green {}{}; grey in compression", with_unit(s.tension, "N"),
                     s.pressed > 0 ? ", pressed by at most " + with_unit(s.pressed, "N") : ""),
         x + sample);
    y += kRow;
    if (s.ruptured) {
      line(bolt_pen(s, {{}, {}, 0, true}));
      text("bolts ruptured there", x + sample);
      y += kRow;
    }
  }
  if (!s.crosses.empty()) {
    line({of(kPressedColour), 1.1, {}});
    text("principal stresses, blue pressed, red pulled, of all blocks at most " + with_unit(s.stress, "Pa"),
         x + sample);
    y += kRow;
  }
  if (!s.chains.empty()) {
    line({of(kForceColour), 4.4, {}});
    text("contact forces, the wider the more, at most " + with_unit(s.force, "N"), x + sample);
    y += kRow;
  }
  if (s.slip_arrows && s.slip > 0) {
    arrow(cr, {x, y}, {sample - 7, 0}, {{0.1, 0.1, 0.1}, 1.3, {}});
    text("slip: the way of the block in which the arrow lies against the one beyond the joint", x + sample);
  }
}

// A picture ready to be drawn.
struct Prepared {
  Scenery scenery;
  Sheet sheet;
};

Prepared prepared(const BlockPicture& picture) {
  Prepared out{scenery_of(picture), {}};
  const Box box = box_of(picture, out.scenery);
  const auto seen = [&box](const Scenery::Shape& shape) { return in_window(shape.polygon, box); };
  if (!out.scenery.shapes.empty() && std::none_of(out.scenery.shapes.begin(), out.scenery.shapes.end(), seen))
    throw Error(kExitUsage, fmt::format("no block lies in the window ({:g}, {:g}) to ({:g}, {:g})", box.min.x,
                                        box.min.y, box.max.x, box.max.y));
  out.sheet = make_sheet(make_measuring_context().get(), box, out.scenery);
  out.sheet.colouring = colouring_of(box, out.scenery, picture.colours);
  return out;
}

void draw(cairo_t* cr, const BlockPicture& picture, const Prepared& p) {
  const View& view = p.sheet.view;
  draw_scene(cr, p.sheet, p.scenery);
  draw_axes(cr, view, p.sheet.x, p.sheet.y);
  const double title_y = kMargin + kTitleSize / 2;
  set_color(cr, kText);
  set_font(cr, kFontSize);
  const std::string time = fmt::format(
      "t = {:.6g} s{}", picture.time,
      picture.deformation == 1 ? "" : fmt::format(", displacements {:g} times", picture.deformation));
  const double time_width = text_width(cr, time);
  draw_text(cr, time, view.frame.right(), title_y, 1);
  set_font(cr, kTitleSize, true);
  draw_text(cr, fitted(cr, picture.title, view.frame.w - time_width - 20), view.frame.x, title_y, 0);
  draw_foot(cr, p.sheet, p.scenery);
}

}  // namespace

const std::vector<std::string>& block_quantities() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const BlockQuantity& q : kBlockQuantities) list.emplace_back(q.name);
    return list;
  }();
  return names;
}

const std::vector<std::string>& overlay_names() {
  static const std::vector<std::string> names{"principal", "forces", "slip"};
  return names;
}

void write_block_picture(const BlockPicture& picture, const std::filesystem::path& stem) {
  const Prepared p = prepared(picture);
  write_picture(stem, p.sheet.width, p.sheet.height, [&](cairo_t* cr) { draw(cr, picture, p); });
}

std::string block_picture_svg(const BlockPicture& picture) {
  const Prepared p = prepared(picture);
  return picture_svg(p.sheet.width, p.sheet.height, [&](cairo_t* cr) { draw(cr, picture, p); });
}

Extent extent_of(const BlockPicture& picture) {
  const Scenery s = scenery_of(picture);
  Extent out{box_of(picture, s), {0, 0}};
  std::vector<double> values;
  for (const Scenery::Shape& shape : s.shapes)
    if (is_drawable(shape.value)) values.push_back(shape.value);
  std::sort(values.begin(), values.end());
  if (!values.empty())
    out.values = {values[values.size() / 50], values[values.size() - 1 - values.size() / 50]};
  return out;
}

void write_animation(const std::function<BlockPicture(size_t)>& make, size_t count, double seconds,
                     const std::filesystem::path& path) {
  std::vector<std::string> frames;
  double width = 0, height = 0;
  for (size_t k = 0; k < count; ++k) {
    const BlockPicture picture = make(k);
    const Prepared p = prepared(picture);
    // frames of one size: legends grow as joints slip
    width = std::max(width, p.sheet.width), height = std::max(height, p.sheet.height);
  }
  for (size_t k = 0; k < count; ++k) {
    const BlockPicture picture = make(k);
    const Prepared p = prepared(picture);
    frames.push_back(picture_png(width, height, 1, [&](cairo_t* cr) { draw(cr, picture, p); }));
  }
  if (path.extension() == ".mp4")
    write_film(frames, seconds, path);
  else
    write_file(path, animated_png(frames, seconds));
}

}  // namespace talus::plot
