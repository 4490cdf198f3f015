#include "talus/plot/block_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "talus/base/error.h"
#include "talus/output/block_quantity.h"
#include "talus/plot/axes.h"
#include "talus/plot/sheet.h"

namespace talus::plot {
namespace {

// Sizes in px.
constexpr double kBarGap = 10, kRow = 19;
constexpr double kLargestWidth = 860, kLargestHeight = 780;  // of the frame
constexpr double kBarWidth = 260, kBarHeight = 14;
constexpr double kThinOutline = 7;  // blocks smaller than this have no outline

constexpr double kDrawn = 0.02;  // joints of a smaller share of the largest slip are drawn thin

constexpr Color kPale{0.86, 0.88, 0.90}, kSlipped{0.90, 0.33, 0.05}, kOpen{0.03, 0.19, 0.42};

// One-sided: lightness falls evenly (after cividis), so that grey print keeps the order. Two-sided: blue,
// pale, orange-brown, which the colour-blind tell apart.
using Anchors = std::array<std::array<int, 3>, 9>;
constexpr Anchors kOneSided{{{255, 240, 150},
                             {236, 214, 92},
                             {196, 182, 108},
                             {166, 157, 117},
                             {138, 134, 120},
                             {112, 113, 115},
                             {87, 93, 109},
                             {57, 72, 107},
                             {0, 32, 77}}};
constexpr Anchors kTwoSided{{{5, 48, 97},
                             {33, 102, 172},
                             {67, 147, 195},
                             {146, 197, 222},
                             {236, 236, 236},
                             {253, 197, 130},
                             {241, 130, 55},
                             {200, 70, 10},
                             {127, 39, 4}}};

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

struct Shape {
  Polygon polygon;  // [m] as drawn
  double value = 0;
};

struct JointSegment {
  Vec2 from, to;
  double slip = 0, opening = 0;  // [m]
};

struct BoltSegment {
  Vec2 from, to;
  double axial = 0;
  bool ruptured = false;
};

struct Scenery {
  std::vector<Shape> shapes;
  std::vector<JointSegment> joints;
  std::vector<BoltSegment> bolts;
  double slip = 0, opening = 0, tension = 0, pressed = 0;
  double low = 0, high = 1, least = 0, most = 0;  // of the colours; of all values
  int side = 0;  // -1: all values are negative, 1: positive, and have one half of the two-sided colours
  const BlockQuantity* quantity = nullptr;
};

Vec2 point_at(const VtkFrame::Array& a, size_t i) { return {a.values[3 * i], a.values[3 * i + 1]}; }

void take_blocks(const BlockPicture& picture, size_t quantity, Scenery& s) {
  const VtkFrame& f = picture.blocks;
  const auto& points = f.at("Points", 3);
  const auto corners = static_cast<long>(points.tuples());
  const auto& moved = f.at("displacement [m]", 3, corners);
  const auto& velocity = f.at("velocity [m s-1]", 3, corners);
  const auto& ends = f.at("offsets", 1);
  const auto& stress = f.at("stress xx yy xy [Pa]", 3, static_cast<long>(ends.tuples()));
  size_t v = 0;
  for (size_t b = 0; b < ends.tuples(); ++b) {
    if (!(ends.values[b] >= static_cast<double>(v + 3) && ends.values[b] <= static_cast<double>(corners)))
      throw FileError(f.file + ": a block has less than three corners, or more than there are");
    const auto end = static_cast<size_t>(ends.values[b]);
    Shape shape;
    Vec2 u, rate;
    const size_t begin = v;
    for (; v < end; ++v) {
      const Vec2 d = point_at(moved, v);
      shape.polygon.push_back(point_at(points, v) + (picture.deformation - 1) * d);
      u += d, rate += point_at(velocity, v);
    }
    const auto n = static_cast<double>(v - begin);
    const double* t = &stress.values[3 * b];
    if (s.quantity) shape.value = block_quantities_of(u / n, rate / n, {t[0], t[2], t[2], t[1]})[quantity];
    s.shapes.push_back(std::move(shape));
  }
}

// Joints from end to end.
void take_joints(const VtkFrame& f, Scenery& s) {
  const auto& points = f.at("Points", 3);
  const auto n = static_cast<long>(points.tuples());
  if (!f.has("partner")) return;  // written before ends knew each other
  const auto& partner = f.at("partner", 1, n);
  const auto& state = f.at("state", 1, n);
  const auto& slip = f.at("slip [m]", 1, n);
  const auto& opening = f.at("opening [m]", 1, n);
  for (size_t i = 0; i < points.tuples(); ++i) {
    if (!(partner.values[i] > static_cast<double>(i) && partner.values[i] < static_cast<double>(n))) continue;
    const auto j = static_cast<size_t>(partner.values[i]);
    JointSegment joint{point_at(points, i), point_at(points, j), 0, 0};
    for (const size_t e : {i, j}) {
      const double condition = state.values[e];
      if (condition == 1 || condition == 2) joint.slip = std::max(joint.slip, slip.values[e]);
      if (condition == 2) joint.opening = std::max(joint.opening, opening.values[e]);
    }
    if (joint.slip == 0 && joint.opening == 0) continue;
    s.slip = std::max(s.slip, joint.slip), s.opening = std::max(s.opening, joint.opening);
    s.joints.push_back(joint);
  }
}

void take_bolts(const VtkFrame& f, Scenery& s) {
  const auto& points = f.at("Points", 3);
  const auto n = static_cast<long>(points.tuples() / 2);
  const auto& axial = f.at("axial force [N]", 1, n);
  const auto& condition = f.at("condition", 1, n);
  if (points.tuples() % 2 != 0) throw FileError(f.file + ": a piece of a bolt has one end");
  for (size_t i = 0; i < axial.tuples(); ++i) {
    s.bolts.push_back(
        {point_at(points, 2 * i), point_at(points, 2 * i + 1), axial.values[i], condition.values[i] == 2});
    s.tension = std::max(s.tension, axial.values[i]), s.pressed = std::max(s.pressed, -axial.values[i]);
  }
}

bool in_window(const Polygon& polygon, const Box& box) {
  const Box own = bounding_box(polygon);
  return own.max.x >= box.min.x && own.min.x <= box.max.x && own.max.y >= box.min.y && own.min.y <= box.max.y;
}

// The range of the colours: 2 % of the blocks in sight at either end lie beyond it.
void set_range(const Box& box, Scenery& s) {
  std::vector<double> values;
  for (const Shape& shape : s.shapes)
    if (in_window(shape.polygon, box) && is_drawable(shape.value)) values.push_back(shape.value);
  if (values.empty()) return;
  std::sort(values.begin(), values.end());
  const size_t cut = values.size() / 50;
  s.least = values.front(), s.most = values.back();
  s.low = values[cut], s.high = values[values.size() - 1 - cut];
  if (s.quantity->signed_values) {
    s.side = s.most <= 0 ? -1 : s.least >= 0 ? 1 : 0;
    const double size = std::max(std::abs(s.low), std::abs(s.high));
    s.low = s.side > 0 ? 0 : -size, s.high = s.side < 0 ? 0 : size;
  } else {
    s.low = std::min(0.0, s.low);
  }
  if (!(s.high > s.low)) s.high = s.low + 1;
}

struct Sheet {
  View view;
  Axis x, y;
  double width = 0, height = 0;
  std::vector<std::string> notes;  // rows below the frame, behind their sign
};

Box box_of(const BlockPicture& picture, const Scenery& s) {
  if (picture.window) return *picture.window;
  std::vector<Vec2> all;
  for (const Shape& shape : s.shapes) all.insert(all.end(), shape.polygon.begin(), shape.polygon.end());
  if (all.empty()) all = {{0, 0}, {1, 1}};
  return bounding_box(all);
}

int foot_rows(const Scenery& s) {
  return (s.quantity ? 2 : 0) + (s.slip > 0 ? 1 : 0) + (s.opening > 0 ? 1 : 0) + (s.bolts.empty() ? 0 : 1);
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
Color color_at(const Scenery& s, double share) {
  if (!s.quantity->signed_values) return mix(kOneSided, share);
  const double t = std::clamp(share, 0.0, 1.0);
  return mix(kTwoSided, s.side == 0 ? t : s.side < 0 ? 0.5 * t : 0.5 + 0.5 * t);
}

Color color_of(const Scenery& s, double value) {
  return s.quantity ? color_at(s, (value - s.low) / (s.high - s.low)) : kPale;
}

void segment(cairo_t* cr, const View& view, Vec2 from, Vec2 to, const Pen& pen) {
  const Vec2 p = view.to_sheet(from), q = view.to_sheet(to);
  set_pen(cr, pen);
  cairo_move_to(cr, p.x, p.y);
  cairo_line_to(cr, q.x, q.y);
  cairo_stroke(cr);
}

Pen slip_pen(double share) { return {kSlipped, share <= kDrawn ? 0.7 : 1 + 3 * share, {}}; }
Pen open_pen() { return {kOpen, 2, {4, 3}}; }

Pen bolt_pen(const Scenery& s, const BoltSegment& b) {
  if (b.ruptured) return {{0, 0, 0}, 2.5, {3, 2}};
  if (b.axial < 0 || s.tension <= 0) return {{0.42, 0.42, 0.42}, 1.5, {}};
  const double share = b.axial / s.tension;
  return {{0.62 * (1 - share), 0.30 + 0.48 * (1 - share), 0.16 + 0.45 * (1 - share)}, 1.4 + 2.3 * share, {}};
}

void draw_scene(cairo_t* cr, const View& view, const Box& box, const Scenery& s) {
  cairo_save(cr);
  cairo_rectangle(cr, view.frame.x, view.frame.y, view.frame.w, view.frame.h);
  cairo_clip(cr);
  for (const Shape& shape : s.shapes) {
    if (!in_window(shape.polygon, box)) continue;
    const Color fill = is_drawable(shape.value) ? color_of(s, shape.value) : Color{1, 0, 1};
    trace(cr, view, shape.polygon);
    set_color(cr, fill);
    cairo_fill_preserve(cr);
    const Box own = bounding_box(shape.polygon);
    const double size = view.scale * std::max(own.max.x - own.min.x, own.max.y - own.min.y);
    // outlines of tiny blocks would hide their colour; a rim of their own closes the seams
    set_pen(cr, size > kThinOutline ? Pen{{0.2, 0.2, 0.2}, 0.5, {}} : Pen{fill, 0.4, {}});
    cairo_stroke(cr);
  }
  for (const JointSegment& j : s.joints)
    if (j.slip > 0) segment(cr, view, j.from, j.to, slip_pen(j.slip / s.slip));
  for (const JointSegment& j : s.joints)
    if (j.opening > kDrawn * s.opening) segment(cr, view, j.from, j.to, open_pen());
  for (const BoltSegment& b : s.bolts) segment(cr, view, b.from, b.to, bolt_pen(s, b));
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
    const Prefix p = readable(std::max(std::abs(s.low), std::abs(s.high)), s.quantity->unit);
    text(fmt::format("{} [{}]", s.quantity->title, p.unit), x);
    std::string beyond;
    if (s.most > s.high) beyond = fmt::format("largest {:.3g}", s.most / p.factor);
    if (s.least < s.low)
      beyond += fmt::format("{}least {:.3g}", beyond.empty() ? "" : ", ", s.least / p.factor);
    y += kRow;
    const std::string low = fmt::format("{:.3g}", s.low / p.factor),
                      high = fmt::format("{:.3g}", s.high / p.factor);
    text(low, x);
    const double from = x + text_width(cr, low) + 8;
    constexpr int kSteps = 64;
    for (int k = 0; k < kSteps; ++k) {
      set_color(cr, color_at(s, (k + 0.5) / kSteps));
      cairo_rectangle(cr, from + k * kBarWidth / kSteps, y - kBarHeight / 2, kBarWidth / kSteps + 0.5,
                      kBarHeight);
      cairo_fill(cr);
    }
    text(high + (beyond.empty() ? "" : "    beyond the colours: " + beyond), from + kBarWidth + 8);
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
    text("joints that slipped, the wider the more, at most " + with_unit(s.slip, "m"), x + sample);
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
  }
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

void write_block_picture(const BlockPicture& picture, const std::filesystem::path& stem) {
  Scenery scenery;
  size_t quantity = 0;
  for (size_t q = 0; q < kBlockQuantities.size(); ++q)
    if (picture.quantity == kBlockQuantities[q].name) scenery.quantity = &kBlockQuantities[quantity = q];
  take_blocks(picture, quantity, scenery);
  if (picture.contacts) take_joints(*picture.contacts, scenery);
  if (picture.bolts) take_bolts(*picture.bolts, scenery);
  const Box box = box_of(picture, scenery);
  if (std::none_of(scenery.shapes.begin(), scenery.shapes.end(),
                   [&box](const Shape& shape) { return in_window(shape.polygon, box); }))
    throw Error(kExitUsage, fmt::format("no block lies in the window ({:g}, {:g}) to ({:g}, {:g})", box.min.x,
                                        box.min.y, box.max.x, box.max.y));
  if (scenery.quantity) set_range(box, scenery);
  const Sheet sheet = make_sheet(make_measuring_context().get(), box, scenery);
  const auto draw_all = [&](cairo_t* cr) {
    draw_scene(cr, sheet.view, box, scenery);
    draw_axes(cr, sheet.view, sheet.x, sheet.y);
    const double title_y = kMargin + kTitleSize / 2;
    set_color(cr, kText);
    set_font(cr, kFontSize);
    const std::string time = fmt::format(
        "t = {:.6g} s{}", picture.blocks.time,
        picture.deformation == 1 ? "" : fmt::format(", displacements {:g} times", picture.deformation));
    const double time_width = text_width(cr, time);
    draw_text(cr, time, sheet.view.frame.right(), title_y, 1);
    set_font(cr, kTitleSize, true);
    draw_text(cr, fitted(cr, picture.title, sheet.view.frame.w - time_width - 20), sheet.view.frame.x,
              title_y, 0);
    draw_foot(cr, sheet, scenery);
  };
  write_picture(stem, sheet.width, sheet.height, draw_all);
}

}  // namespace talus::plot
