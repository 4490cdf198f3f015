#include "talus/plot/name_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace talus::plot {
namespace {

constexpr double kMarkerRadius = 3.5, kMarkerRim = 1.5;  // [px]
constexpr double kMonitorFont = 12, kWidestName = 150;   // [px]
constexpr std::size_t kMostNames = 400;  // of monitors: looking for room costs the square of their number

using Segment = std::pair<Vec2, Vec2>;  // on the sheet

Rect centered(Vec2 middle, double w, double h) { return {middle.x - w / 2, middle.y - h / 2, w, h}; }

Rect marker_box(Vec2 marker) {
  constexpr double kSize = 2 * (kMarkerRadius + kMarkerRim);
  return centered(marker, kSize, kSize);
}

bool overlap(const Rect& a, const Rect& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

bool is_inside(const Rect& inner, const Rect& outer) {
  return inner.x >= outer.x && inner.right() <= outer.right() && inner.y >= outer.y &&
         inner.bottom() <= outer.bottom();
}

// Whether part of the segment lies in the rectangle (Liang and Barsky).
bool meets(const Rect& rect, const Segment& segment) {
  const auto [a, b] = segment;
  const Vec2 d = b - a;
  double from = 0, to = 1;
  const auto cut = [&from, &to](double slope, double room) {
    if (slope == 0) return room >= 0;
    if (slope < 0) from = std::max(from, room / slope);
    if (slope > 0) to = std::min(to, room / slope);
    return from <= to;
  };
  return cut(-d.x, a.x - rect.x) && cut(d.x, rect.right() - a.x) && cut(-d.y, a.y - rect.y) &&
         cut(d.y, rect.bottom() - a.y);
}

bool meets_any(const Rect& rect, const std::vector<Segment>& segments) {
  return std::any_of(segments.begin(), segments.end(), [&](const Segment& s) { return meets(rect, s); });
}

void add_to_sheet(const std::vector<Vec2>& line, bool closed, const View& view, std::vector<Segment>& list) {
  for (std::size_t k = 0; k + (closed ? 0 : 1) < line.size(); ++k)
    list.push_back({view.to_sheet(line[k]), view.to_sheet(line[(k + 1) % line.size()])});
}

// Finds room for one name after the other.
class Placer {
 public:
  /// @param borders  thick lines, better not covered
  Placer(const Rect& room, const std::vector<Vec2>& markers, std::vector<Segment> borders)
      : room_(room), borders_(std::move(borders)) {
    for (const Vec2 marker : markers) taken_.push_back(marker_box(marker));
  }

  /// In the box or nowhere.
  std::optional<Name> place(const Name& name) {
    if (!is_free(name)) return {};
    taken_.push_back(name.box);
    if (name.from) leaders_.push_back({*name.from, name.end_of_leader()});
    return name;
  }

  /// Close to the marker, if possible on no border, else as near as there is room.
  std::optional<Name> place_near(Vec2 marker, const std::string& text, double width) {
    constexpr std::array kDistances{8.0, 16.0, 26.0, 38.0, 52.0, 70.0, 92.0, 120.0};  // [px]
    for (const Rect& box : boxes_around(marker, width, kDistances[0])) {
      if (meets_any(box, borders_)) continue;
      if (const auto name = place({text, kMonitorFont, box, {}})) return name;
    }
    for (const double distance : kDistances) {
      const auto from = distance > kDistances[0] ? std::optional(marker) : std::nullopt;
      for (const Rect& box : boxes_around(marker, width, distance))
        if (const auto name = place({text, kMonitorFont, box, from})) return name;
    }
    return {};
  }

 private:
  static std::vector<Rect> boxes_around(Vec2 marker, double width, double distance) {
    // right, left, above, below, then between them
    constexpr std::array kTurns{0, 8, 4, 12, 2, 14, 6, 10, 1, 15, 3, 13, 7, 9, 5, 11};
    constexpr double kHeight = kMonitorFont + 2;
    std::vector<Rect> boxes;
    for (const int turn : kTurns) {
      const double angle = turn * std::numbers::pi / 8;
      const Vec2 away{std::cos(angle) * (distance + width / 2), -std::sin(angle) * (distance + kHeight / 2)};
      boxes.push_back(centered(marker + away, width, kHeight));
    }
    return boxes;
  }

  bool is_free(const Name& name) const {
    if (!is_inside(name.box, room_) || meets_any(name.box, leaders_)) return false;
    for (const Rect& rect : taken_)
      if (overlap(name.box, rect)) return false;
    if (!name.from) return true;
    const Segment leader{*name.from, name.end_of_leader()};
    const Rect own = marker_box(*name.from);
    for (const Rect& rect : taken_)
      if ((rect.x != own.x || rect.y != own.y) && meets(rect, leader)) return false;
    return true;
  }

  Rect room_;
  std::vector<Segment> borders_;
  std::vector<Rect> taken_;  // markers, then names
  std::vector<Segment> leaders_;
};

// The name in the middle of the opening, if it fits there.
std::optional<Name> place_inside(cairo_t* cr, const OpeningInput& opening, const std::string& label,
                                 const View& view, Placer& placer) {
  constexpr double kAir = 8;  // [px] around the name
  std::vector<Segment> outline;
  add_to_sheet(opening.polygon, true, view, outline);
  const Vec2 middle = polygon_moments(opening.polygon).centroid;
  if (!contains(opening.polygon, middle)) return {};
  for (const double size : {kFontSize, 11.0, 9.0}) {
    set_font(cr, size);
    const std::string text = fitted(cr, label, view.frame.w);
    const Rect box = centered(view.to_sheet(middle), text_width(cr, text) + kAir, size + kAir);
    if (meets_any(box, outline)) continue;
    if (const auto name = placer.place({text, size, box, {}})) return name;
  }
  return {};
}

// " (2)" behind the name of what the second stage takes out.
std::string stage_mark(const Model& model, const std::string& name) {
  for (std::size_t s = 0; s < model.stages.size(); ++s) {
    const std::vector<std::string>& out = model.stages[s].excavate;
    if (std::find(out.begin(), out.end(), name) != out.end()) return " (" + std::to_string(s + 1) + ")";
  }
  return "";
}

// Text that can be read above lines of any colour.
void draw_name(cairo_t* cr, const Name& name) {
  constexpr double kRim = 1.6;
  constexpr int kCopies = 12;
  set_font(cr, name.size);
  const Vec2 middle = name.box.middle();
  set_color(cr, kWhite);
  for (int i = 0; i < kCopies; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCopies;
    draw_text(cr, name.text, middle.x + kRim * std::cos(angle), middle.y + kRim * std::sin(angle), 0.5);
  }
  set_color(cr, kText);
  draw_text(cr, name.text, middle.x, middle.y, 0.5);
}

}  // namespace

Vec2 Name::end_of_leader() const {
  return {std::clamp(from->x, box.x, box.right()), std::clamp(from->y, box.y, box.bottom())};
}

Names place_names(cairo_t* cr, const Model& model, const Cut& cut, const Layout& layout, const View& view,
                  const Rect& room) {
  Names out;
  if (layout.blocks.empty()) return out;
  std::vector<std::string> monitors;  // names of those in sight
  for (const MonitorInput& monitor : model.monitors) {
    Vec2 place = monitor.point;
    if (monitor.kind == MonitorKind::kBlock) {
      const std::vector<int> blocks = layout.blocks_called(monitor.target_a);
      if (blocks.empty()) continue;
      place = polygon_moments(layout.blocks[at(blocks.front())].polygon).centroid;
    } else if (monitor.kind != MonitorKind::kPoint) {
      continue;
    }
    const Vec2 p = view.to_sheet(place);
    if (!is_inside(Rect{p.x, p.y, 0, 0}, view.frame)) continue;
    out.markers.push_back(p);
    monitors.push_back(monitor.name);
  }
  std::vector<Segment> borders;
  for (const CutRegion& region : cut.regions) add_to_sheet(region.polygon, true, view, borders);
  for (const OpeningInput& opening : model.openings) add_to_sheet(opening.polygon, true, view, borders);
  for (const FaultInput& fault : model.faults) add_to_sheet(fault.points, false, view, borders);

  Placer placer(room, out.markers, std::move(borders));
  for (const OpeningInput& opening : model.openings) {
    const std::string label = opening.name + stage_mark(model, opening.name);
    if (const auto name = place_inside(cr, opening, label, view, placer)) out.names.push_back(*name);
  }
  set_font(cr, kMonitorFont);
  for (std::size_t i = 0; i < monitors.size(); ++i) {
    std::optional<Name> name;
    if (i < kMostNames) {
      const std::string text = fitted(cr, monitors[i], kWidestName);
      name = placer.place_near(out.markers[i], text, text_width(cr, text) + 2);
    }
    if (name) out.names.push_back(*name);
    out.left_out += !name;
  }
  return out;
}

void draw_marker(cairo_t* cr, Vec2 p) {
  cairo_new_sub_path(cr);
  cairo_arc(cr, p.x, p.y, kMarkerRadius + kMarkerRim, 0, 2 * std::numbers::pi);
  set_color(cr, kWhite);
  cairo_fill(cr);
  cairo_arc(cr, p.x, p.y, kMarkerRadius, 0, 2 * std::numbers::pi);
  set_color(cr, kText);
  cairo_fill(cr);
}

void draw_names(cairo_t* cr, const Names& names) {
  for (const Pen& pen : {Pen{kWhite, 3, {}}, Pen{kText, 0.8, {}}}) {
    set_pen(cr, pen);
    for (const Name& name : names.names) {
      if (!name.from) continue;
      const Vec2 end = name.end_of_leader();
      cairo_move_to(cr, name.from->x, name.from->y);
      cairo_line_to(cr, end.x, end.y);
    }
    cairo_stroke(cr);
  }
  for (const Vec2 p : names.markers) draw_marker(cr, p);
  for (const Name& name : names.names) draw_name(cr, name);
}

}  // namespace talus::plot
