#include "talus/plot/conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

#include "talus/base/index.h"
#include "talus/cut/selection.h"

namespace talus::plot {
namespace {

constexpr double kApart = 24;                        // [px] between marks along an edge
constexpr double kArrowLength = 26, kArrowHead = 6;  // [px]
constexpr double kPinSize = 9, kRollerRadius = 4;    // [px]
constexpr double kBandGap = 3, kBandWidth = 3.2;     // [px] from the edge; of the band
constexpr std::size_t kMostNames = 5;                // of one entry in the legend

constexpr Color kSupport{0.15, 0.15, 0.15}, kViscous{0.05, 0.45, 0.50}, kLoad{0.72, 0.10, 0.35},
    kMotion{0.60, 0.05, 0.60}, kSpan{0.25, 0.25, 0.25};
// in the order of BoundaryKind
constexpr std::array<Color, 5> kBoundaryColors{
    {kViscous, {0.35, 0.20, 0.65}, {0.55, 0.40, 0.05}, {0.10, 0.50, 0.20}, {0.60, 0.15, 0.15}}};
constexpr Color kBolts[] = {
    {0.05, 0.15, 0.60}, {0.00, 0.42, 0.15}, {0.55, 0.10, 0.10}, {0.40, 0.10, 0.55}};  // types

Vec2 unit(Vec2 v) {
  const double length = norm(v);
  return length > 0 ? (1 / length) * v : Vec2{1, 0};
}

// A direction of the section on the sheet, whose y points down.
Vec2 on_sheet(Vec2 direction) { return {direction.x, -direction.y}; }

// Where a mark may stand, and the outward direction there.
struct Place {
  Vec2 at, outward;
};

// Collects what has the same label: conditions in the order in which their first one came.
class Collection {
 public:
  explicit Collection(const Model& model) : model_(model) {}

  // `what` begins the label, the names of all that are alike end it.
  Condition& add(Symbol symbol, Color color, const std::string& what, const std::string& name,
                 const std::vector<int>& stages = {}, Vec2 sample = {1, 0}) {
    const std::string key = what + in_stages(stages);
    for (std::size_t i = 0; i < list_.size(); ++i)
      if (keys_[i] == key && list_[i].symbol == symbol && dot(list_[i].sample, sample) > 0.999) {
        if (!name.empty()) names_[i].push_back(name);
        return list_[i];
      }
    list_.push_back({symbol, color, {}, {}, sample});
    keys_.push_back(key);
    names_.emplace_back();
    if (!name.empty()) names_.back().push_back(name);
    return list_.back();
  }

  std::vector<Condition> take() {
    for (std::size_t i = 0; i < list_.size(); ++i) {
      std::vector<std::string>& names = names_[i];
      names.erase(std::unique(names.begin(), names.end()), names.end());
      std::string text = keys_[i];
      for (std::size_t k = 0; k < std::min(names.size(), kMostNames); ++k)
        text += (k == 0 ? ": " : ", ") + names[k];
      if (names.size() > kMostNames) text += fmt::format(" and {} more", names.size() - kMostNames);
      list_[i].label = text;
    }
    return std::move(list_);
  }

 private:
  std::string in_stages(const std::vector<int>& stages) const {
    std::string text;
    for (const int s : stages)
      text += fmt::format("{}\"{}\"", text.empty() ? " in " : ", ", model_.stages[at(s)].name);
    return text;
  }

  const Model& model_;
  std::vector<Condition> list_;
  std::vector<std::string> keys_;
  std::vector<std::vector<std::string>> names_;
};

// Places along the edges, or at the points, that a selection means.
class Places {
 public:
  Places(const Layout& layout, const View& view) : layout_(layout), view_(view) {}

  std::vector<Place> of(const Selection& selection) const {
    Spaced spaced;
    if (selection.is_edge || !selection.along.empty())
      for (const SelectedEdge& e : selected_edges(layout_, selection)) {
        const Vec2 a = view_.to_sheet(e.from), b = view_.to_sheet(e.to);
        const int parts = std::max(1, static_cast<int>(norm(b - a) / kApart));
        for (int k = 0; k < parts; ++k) spaced.add({a + ((k + 0.5) / parts) * (b - a), on_sheet(e.normal())});
      }
    if (!spaced.places.empty()) return spaced.places;
    for (const SelectedCorner& c : selected_corners(layout_, selection)) {
      const Vec2 middle = polygon_moments(layout_.blocks[at(c.block)].polygon).centroid;
      spaced.add({view_.to_sheet(c.point), on_sheet(unit(c.point - middle))});
    }
    return spaced.places;
  }

  // The edges themselves.
  std::vector<std::pair<Vec2, Vec2>> edges(const Selection& selection) const {
    std::vector<std::pair<Vec2, Vec2>> list;
    for (const SelectedEdge& e : selected_edges(layout_, selection))
      list.push_back({view_.to_sheet(e.from), view_.to_sheet(e.to)});
    return list;
  }

 private:
  // Places apart from each other, sought in squares as wide as that: an edge may be that of a million blocks.
  struct Spaced {
    static constexpr double kLeast = 0.7 * kApart;
    std::vector<Place> places;
    std::map<std::pair<int, int>, std::vector<Vec2>> squares;

    void add(const Place& p) {
      const int i = static_cast<int>(std::floor(p.at.x / kLeast)),
                j = static_cast<int>(std::floor(p.at.y / kLeast));
      for (int di = -1; di <= 1; ++di)
        for (int dj = -1; dj <= 1; ++dj)
          if (const auto square = squares.find({i + di, j + dj}); square != squares.end())
            for (const Vec2 o : square->second)
              if (norm(o - p.at) < kLeast) return;
      squares[{i, j}].push_back(p.at);
      places.push_back(p);
    }
  };

  const Layout& layout_;
  const View& view_;
};

bool moves(const Motion& m) { return m.history >= 0; }

// Along the axis, away from the block.
Vec2 along_axis(Vec2 axis, Vec2 outward) { return dot(axis, outward) < 0 ? -1.0 * axis : axis; }

void add_supports(const Model& model, const Places& places, Collection& all) {
  constexpr Vec2 kX{1, 0}, kDown{0, 1};
  for (const SupportInput& s : model.supports) {
    const std::vector<Place> at = places.of(s);
    const auto add = [&](Symbol symbol, Color color, const char* what, Vec2 axis) {
      Condition& c = all.add(symbol, color, what, s.name, s.stages, axis);
      for (const Place& p : at)
        c.marks.push_back({p.at, symbol == Symbol::kPin ? p.outward : along_axis(axis, p.outward),
                           kArrowLength, s.where.line});
    };
    const bool x = s.x.kind == Motion::kFixed, y = s.y.kind == Motion::kFixed;
    if (x && y) add(Symbol::kPin, kSupport, "held", kDown);
    if (x && !y) add(Symbol::kRoller, kSupport, "held along x", kX);
    if (y && !x) add(Symbol::kRoller, kSupport, "held along y", kDown);
    if (moves(s.x)) add(Symbol::kTwoWay, kMotion, "moved along x", kX);
    if (moves(s.y)) add(Symbol::kTwoWay, kMotion, "moved along y", kDown);
  }
}

void add_boundaries(const Model& model, const Places& places, Collection& all) {
  for (const BoundaryInput& b : model.boundaries) {
    const BoundaryEntry& kind = entry(b.kind);
    const Color& color = kBoundaryColors.at(place_of(b.kind) % kBoundaryColors.size());
    Condition& band = all.add(Symbol::kBand, color, kind.title, b.name, b.stages);
    const auto add_edges = [&](const Selection& selection) {
      for (const auto& [from, to] : places.edges(selection))
        band.marks.push_back({from, unit(to - from), norm(to - from), b.where.line});
    };
    add_edges(b);
    if (kind.two_sided) add_edges(b.opposite);
    if (b.history_x < 0 && b.history_y < 0) continue;
    const char* along = b.history_y < 0   ? "waves along x come in"
                        : b.history_x < 0 ? "waves along y come in"
                                          : "waves along x and y come in";
    Condition& wave = all.add(Symbol::kArrow, kViscous, along, b.name, b.stages, {0, -1});
    for (const Place& p : places.of(b))
      wave.marks.push_back({p.at, -1.0 * p.outward, kArrowLength, b.where.line});
  }
}

void add_loads(const Model& model, const Places& places, Collection& all) {
  for (const LoadInput& l : model.loads) {
    const Vec2 push = on_sheet(unit({l.x.factor, l.y.factor}));
    if (l.kind == LoadKind::kAcceleration) {
      all.add(Symbol::kArrow, kLoad,
              l.block.empty() ? "acceleration of all blocks" : "acceleration of " + l.block, l.name, l.stages,
              push);
      continue;
    }
    const bool is_force = l.kind == LoadKind::kForce, is_pressure = l.pressure.is_given();
    Condition& c = all.add(Symbol::kArrow, kLoad,
                           is_force      ? "force"
                           : is_pressure ? "pressure"
                                         : "traction",
                           l.name, l.stages, is_pressure ? Vec2{0, 1} : push);
    for (const Place& p : places.of(l))
      c.marks.push_back({p.at, is_pressure ? -1.0 * p.outward : push, kArrowLength, l.where.line});
  }
}

void add_motions(const Model& model, const View& view, Collection& all) {
  for (const BlockInput& b : model.blocks) {
    const Vec2 middle = view.to_sheet(polygon_moments(b.polygon).centroid);
    if (moves(b.motion_x))
      all.add(Symbol::kTwoWay, kMotion, "moved along x", b.name)
          .marks.push_back({middle, {1, 0}, kArrowLength, b.where.line});
    if (moves(b.motion_y))
      all.add(Symbol::kTwoWay, kMotion, "moved along y", b.name, {}, {0, 1})
          .marks.push_back({middle, {0, 1}, kArrowLength, b.where.line});
    if (norm(b.velocity) > 0) {
      const Vec2 way = on_sheet(unit(b.velocity));
      all.add(Symbol::kArrow, kMotion, "starts at a velocity", b.name, {}, way)
          .marks.push_back({middle + (kArrowLength / 2) * way, way, kArrowLength, b.where.line});
    }
  }
  for (const GridInput& g : model.grids) {
    if (!(norm(g.velocity) > 0)) continue;
    const Vec2 own = 0.5 * (g.min + g.max), middle = g.place.apply(own, own),
               way = on_sheet(unit(g.velocity));
    all.add(Symbol::kArrow, kMotion, "starts at a velocity", g.name, {}, way)
        .marks.push_back({view.to_sheet(middle) + (kArrowLength / 2) * way, way, kArrowLength, g.where.line});
  }
}

void add_bolts(const Model& model, const View& view, Collection& all) {
  std::map<std::pair<int, int>, int> count;
  for (const BoltInput& b : model.bolts) ++count[{b.type, b.stage}];
  for (const BoltInput& b : model.bolts) {
    const std::string what = fmt::format("{} of type {}", counted(at(count[{b.type, b.stage}]), "bolt"),
                                         model.bolt_types[at(b.type)].name);
    const std::vector<int> stages = at(b.stage) < model.stages.size() && model.stages.size() > 1
                                        ? std::vector<int>{b.stage}
                                        : std::vector<int>{};
    const Vec2 head = view.to_sheet(b.from), toe = view.to_sheet(b.to);
    all.add(Symbol::kBar, kBolts[at(b.type) % std::size(kBolts)], what, "", stages)
        .marks.push_back({head, unit(toe - head), norm(toe - head), b.where.line});
  }
}

void add_spans(const Model& model, const View& view, Collection& all) {
  for (const MonitorInput& m : model.monitors) {
    if (m.kind != MonitorKind::kConvergence && m.kind != MonitorKind::kCrack) continue;
    const Vec2 a = view.to_sheet(m.point), b = view.to_sheet(m.other);
    all.add(Symbol::kBar, kSpan, m.kind == MonitorKind::kCrack ? "crack gauge" : "measured length", m.name)
        .marks.push_back({a, unit(b - a), norm(b - a), m.where.line});
  }
}

// ------------------------------------------------------------------------------------------------ drawing

// A triangle as wide as high, behind its tip.
void add_triangle(cairo_t* cr, Vec2 tip, Vec2 back) {
  const Vec2 half = 0.5 * turn_right(back), base = tip + back;
  cairo_move_to(cr, tip.x, tip.y);
  for (const Vec2 p : {base + half, base - half}) cairo_line_to(cr, p.x, p.y);
  cairo_close_path(cr);
}

void line(cairo_t* cr, Vec2 a, Vec2 b) {
  cairo_move_to(cr, a.x, a.y);
  cairo_line_to(cr, b.x, b.y);
  cairo_stroke(cr);
}

void draw_pin(cairo_t* cr, const Mark& m, Color color) {
  add_triangle(cr, m.at, kPinSize * m.direction);
  set_color(cr, kWhite);
  cairo_fill_preserve(cr);
  set_pen(cr, {color, 1.1, {}});
  cairo_stroke(cr);
}

void draw_roller(cairo_t* cr, const Mark& m, Color color) {
  const Vec2 side = turn_right(m.direction), middle = m.at + kRollerRadius * m.direction,
             track = m.at + (2 * kRollerRadius + 1.2) * m.direction;
  cairo_new_sub_path(cr);
  cairo_arc(cr, middle.x, middle.y, kRollerRadius, 0, 2 * std::numbers::pi);
  set_color(cr, kWhite);
  cairo_fill_preserve(cr);
  set_pen(cr, {color, 1.1, {}});
  cairo_stroke(cr);
  line(cr, track - (1.3 * kRollerRadius) * side, track + (1.3 * kRollerRadius) * side);
}

void draw_arrow(cairo_t* cr, const Mark& m, Color color, bool both) {
  const Vec2 from = m.at - (both ? 0.5 * m.length : m.length) * m.direction;
  const Vec2 tip = both ? m.at + (0.5 * m.length) * m.direction : m.at;
  // a white rim keeps it apart from joints
  set_pen(cr, {kWhite, 4, {}});
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
  line(cr, from, tip);
  set_pen(cr, {color, 1.6, {}});
  line(cr, both ? from + kArrowHead * m.direction : from, tip - kArrowHead * m.direction);
  add_triangle(cr, tip, -kArrowHead * m.direction);
  if (both) add_triangle(cr, from, kArrowHead * m.direction);
  cairo_fill(cr);
}

// The block lies to the left of its edge in the section, to the right on a sheet whose y points down.
void draw_band(cairo_t* cr, const Mark& m, Color color) {
  const Vec2 beside = kBandGap * Vec2{-m.direction.y, m.direction.x};
  set_pen(cr, {color, kBandWidth, {}});
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
  line(cr, m.at + beside, m.at + m.length * m.direction + beside);
}

void draw_bar(cairo_t* cr, const Mark& m, Color color) {
  constexpr double kHead = 3.5;  // [px] half the plate
  const Vec2 end = m.at + m.length * m.direction, side = kHead * turn_right(m.direction);
  set_pen(cr, {kWhite, 3, {}});
  line(cr, m.at, end);
  set_pen(cr, {color, 1.4, {}});
  line(cr, m.at, end);
  line(cr, m.at - side, m.at + side);
}

void draw_mark(cairo_t* cr, Symbol symbol, const Mark& m, Color color) {
  switch (symbol) {
    case Symbol::kPin:
      return draw_pin(cr, m, color);
    case Symbol::kRoller:
      return draw_roller(cr, m, color);
    case Symbol::kTwoWay:
      return draw_arrow(cr, m, color, true);
    case Symbol::kArrow:
      return draw_arrow(cr, m, color, false);
    case Symbol::kBand:
      return draw_band(cr, m, color);
    case Symbol::kBar:
      return draw_bar(cr, m, color);
  }
}

}  // namespace

std::vector<Condition> conditions_of(const Model& model, const Layout& layout, const View& view) {
  const Places places(layout, view);
  Collection all(model);
  if (!layout.blocks.empty()) {
    add_supports(model, places, all);
    add_boundaries(model, places, all);
    add_loads(model, places, all);
    add_motions(model, view, all);
  }
  add_bolts(model, view, all);
  add_spans(model, view, all);
  if (norm(model.gravity) > 0)
    all.add(Symbol::kArrow, kSpan, fmt::format("gravity {:.4g} m/s\u00b2", norm(model.gravity)), "", {},
            on_sheet(unit(model.gravity)));
  return all.take();
}

void draw_condition(cairo_t* cr, const Condition& condition) {
  for (const Mark& mark : condition.marks) draw_mark(cr, condition.symbol, mark, condition.color);
}

void draw_sample(cairo_t* cr, const Condition& condition, const Rect& place) {
  constexpr double kLength = 18;  // [px] room for upright ones is less than a row
  const Vec2 middle = place.middle(), way = condition.sample;
  Mark mark{middle, way, kLength};
  switch (condition.symbol) {
    case Symbol::kPin:
      mark.at = middle - (kPinSize / 2) * way;
      break;
    case Symbol::kRoller:
      mark.at = middle - kRollerRadius * way;
      break;
    case Symbol::kArrow:
      mark.at = middle + (kLength / 2) * way;
      break;
    case Symbol::kBand:
    case Symbol::kBar:
      mark = {{place.x, middle.y - (condition.symbol == Symbol::kBand ? kBandGap : 0)}, {1, 0}, place.w};
      break;
    case Symbol::kTwoWay:
      break;
  }
  draw_mark(cr, condition.symbol, mark, condition.color);
}

}  // namespace talus::plot
