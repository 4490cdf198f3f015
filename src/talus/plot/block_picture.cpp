#include "talus/plot/block_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "talus/base/error.h"
#include "talus/output/block_quantity.h"
#include "talus/output/colours.h"
#include "talus/plot/axes.h"
#include "talus/plot/sheet.h"

namespace talus::plot {
namespace {

// Sizes in px.
constexpr double kBarGap = 10, kRow = 19;
constexpr double kLargestWidth = 860, kLargestHeight = 780;  // of the frame
constexpr double kBarWidth = 260, kBarHeight = 14;
constexpr double kThinOutline = 7;  // blocks smaller than this have no outline

constexpr Color of(const Rgb& c) { return {c[0] / 255.0, c[1] / 255.0, c[2] / 255.0}; }
constexpr Color kPale{0.86, 0.88, 0.90}, kSlipped = of(kSlippedColour), kOpen = of(kOpenColour);

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

struct Shape {
  Polygon polygon;  // [m] as drawn
  double value = 0;
};

// A point without another end has one place.
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
  bool residual = true;                           // the slip is what is left of it, not all of it to and fro
  double low = 0, high = 1, least = 0, most = 0;  // of the colours; of all values
  int side = 0;  // -1: all values are negative, 1: positive, and have one half of the two-sided colours
  const BlockQuantity* quantity = nullptr;
};

void take_blocks(const BlockPicture& picture, size_t quantity, Scenery& s) {
  const Shapes& shapes = picture.shapes;
  const BlockFrame& f = picture.blocks;
  for (size_t k = 0; k < shapes.id.size(); ++k) {
    if (!f.present[k]) continue;
    Shape shape;
    const Vec2 centre = shapes.centre[k];
    for (auto v = static_cast<size_t>(shapes.begin[k]); v < static_cast<size_t>(shapes.begin[k + 1]); ++v) {
      const Vec2 u = f.displacement[k] + f.gradient[k] * (shapes.corner[v] - centre);
      shape.polygon.push_back(shapes.corner[v] + picture.deformation * u);
    }
    if (s.quantity)
      shape.value = block_quantities_of(f.displacement[k], f.velocity[k], f.stress[k])[quantity];
    s.shapes.push_back(std::move(shape));
  }
}

// Where a point is drawn that moves with a block.
Vec2 place_of(const BlockPicture& picture, int block, Vec2 now) {
  if (picture.deformation == 1) return now;
  return now + (picture.deformation - 1) * displacement_of(picture.shapes, picture.blocks, block, now);
}

// Joints from end to end, and points that have no other end.
void take_joints(const BlockPicture& picture, Scenery& s) {
  const ContactPoints& c = *picture.contacts;
  s.residual = c.has("residual_slip");
  const std::vector<double>&partner = c.at("partner"), &state = c.at("state"), &opening = c.at("opening"),
        &block = c.at("block_a"), &slip = c.at(s.residual ? "residual_slip" : "accumulated_slip");
  for (size_t i = 0; i < c.size(); ++i) {
    if (partner[i] >= 0 && partner[i] < static_cast<double>(i)) continue;  // seen from its other end
    const auto j =
        partner[i] < 0 || partner[i] >= static_cast<double>(c.size()) ? i : static_cast<size_t>(partner[i]);
    const auto place = [&](size_t e) { return place_of(picture, static_cast<int>(block[e]), c.point[e]); };
    JointSegment joint{place(i), place(j), 0, 0};
    for (const size_t e : {i, j}) {
      if (state[e] == 1 || state[e] == 2) joint.slip = std::max(joint.slip, std::abs(slip[e]));
      if (state[e] == 2) joint.opening = std::max(joint.opening, opening[e]);
    }
    if (joint.slip == 0 && joint.opening == 0) continue;
    s.slip = std::max(s.slip, joint.slip), s.opening = std::max(s.opening, joint.opening);
    s.joints.push_back(joint);
  }
}

void take_bolts(const BlockPicture& picture, Scenery& s) {
  const BoltPieces& b = *picture.bolts;
  for (size_t i = 0; i < b.size(); ++i) {
    s.bolts.push_back({b.from[i], b.to[i], b.axial_force[i], b.condition[i] == 2});
    s.tension = std::max(s.tension, b.axial_force[i]), s.pressed = std::max(s.pressed, -b.axial_force[i]);
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

Pen bolt_pen(const Scenery& s, const BoltSegment& b) {
  if (b.ruptured) return {of(kBoltRuptured), 2.5, {3, 2}};
  if (b.axial < 0 || s.tension <= 0) return {of(kBoltPressed), 1.5, {}};
  const double share = b.axial / s.tension;
  const Color pale = of(kBoltPale), dark = of(kBoltDark);
  const auto mixed = [share](double from, double to) { return from + share * (to - from); };
  return {{mixed(pale.r, dark.r), mixed(pale.g, dark.g), mixed(pale.b, dark.b)}, 1.4 + 2.3 * share, {}};
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
    if (j.slip > kLeastDrawn * s.slip) segment(cr, view, j.from, j.to, slip_pen(j.slip / s.slip));
  for (const JointSegment& j : s.joints)
    if (j.opening > kLeastDrawn * s.opening) segment(cr, view, j.from, j.to, open_pen());
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
  if (picture.contacts) take_joints(picture, scenery);
  if (picture.bolts) take_bolts(picture, scenery);
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
        "t = {:.6g} s{}", picture.time,
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
