#include "talus/plot/cut_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "talus/output/files.h"
#include "talus/plot/canvas.h"
#include "talus/plot/scale.h"

namespace talus::plot {
namespace {

// Sizes in px.
constexpr double kFontSize = 13, kTitleSize = 15, kNameSize = 12, kMargin = 12;
constexpr double kLargestWidth = 1100, kLargestHeight = 1200;  // of the frame
constexpr double kLeastFrame = 64;                             // along either axis
constexpr double kLeastSheet = 480;                            // width: leaves room for the title
constexpr double kPad = 10;                                    // from the model to the frame
constexpr double kTickLength = 4, kLabelGap = 8;
constexpr double kTitleRow = 22;
constexpr double kLegendRow = 19, kLegendSample = 30, kLegendGap = 7, kLegendColumnGap = 24;
constexpr double kMarkerRadius = 3.5, kMarkerRim = 1.5;

constexpr std::size_t kMostLegendEntries = 60;
constexpr std::size_t kMostNames = 400;  // of monitors: looking for room costs the square of their number

struct Color {
  double r, g, b;
};

struct Rect {
  double x = 0, y = 0, w = 0, h = 0;
  double right() const { return x + w; }
  double bottom() const { return y + h; }
  Vec2 middle() const { return {x + w / 2, y + h / 2}; }
};

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// ---------------------------------------------------------------------------------------------- colours

constexpr Color kWhite{1, 1, 1}, kBlack{0, 0, 0}, kText{0.1, 0.1, 0.1}, kRule{0.25, 0.25, 0.25};
constexpr Color kDeadEndGrey{0.6, 0.6, 0.6}, kConstructionGrey{0.45, 0.45, 0.45};

// Okabe and Ito's colours for all kinds of colour vision, without black and grey, which have a meaning of
// their own here, and without yellow, which is lost in thin lines on white.
constexpr std::array<Color, 6> kPalette{{{0.000, 0.447, 0.698},    // blue
                                         {0.835, 0.369, 0.000},    // vermilion
                                         {0.000, 0.620, 0.451},    // bluish green
                                         {0.800, 0.475, 0.655},    // reddish purple
                                         {0.902, 0.624, 0.000},    // orange
                                         {0.337, 0.706, 0.914}}};  // sky blue

// Pale enough for every line above to stand out.
constexpr std::array<Color, 6> kTints{{{0.975, 0.955, 0.905},    // sand
                                       {0.885, 0.930, 0.970},    // blue
                                       {0.890, 0.950, 0.880},    // green
                                       {0.970, 0.900, 0.890},    // rose
                                       {0.925, 0.900, 0.960},    // violet
                                       {0.930, 0.930, 0.930}}};  // grey
constexpr Color kKeptTint{1.0, 0.925, 0.55}, kFixedTint{0.74, 0.74, 0.74};

// The colour of the table, darker in every second round.
template <std::size_t n>
Color color_of(const std::array<Color, n>& table, std::size_t index, double dark) {
  const Color c = table[index % n];
  if (index / n % 2 == 0) return c;
  return {dark * c.r, dark * c.g, dark * c.b};
}

Color palette_color(int index) { return color_of(kPalette, at(index), 0.5); }
Color tint(int material) { return color_of(kTints, at(material), 0.92); }

// ------------------------------------------------------------------------------------------------ texts

// The start of a text that no sheet has room for; measuring all of it piece by piece would take forever.
std::string short_text(const std::string& text) {
  constexpr std::size_t kLongest = 300;  // bytes
  if (text.size() <= kLongest) return text;
  std::size_t end = kLongest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not within a character
  return text.substr(0, end);
}

// Thin spaces between thousands from 10 000 on.
std::string grouped(const std::string& number) {
  const std::size_t whole = std::min(number.find('.'), number.size());
  if (whole < 5) return number;
  std::string text;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (i > 0 && i < whole && (whole - i) % 3 == 0) text += "\u2009";
    text += number[i];
  }
  return text;
}

// "1 block", "20 blocks"
std::string counted(std::size_t count, const std::string& word) {
  return grouped(std::to_string(count)) + " " + word + (count == 1 ? "" : "s");
}

// Three digits, more before the point.
std::string length_text(double meters) {
  if (meters >= 100) return grouped(fmt::format("{:.0f}", meters)) + " m";
  return fmt::format("{:.3g} m", meters);
}

std::string degrees_text(double radians) {
  const double tenths = std::round(radians * 180 / std::numbers::pi * 10);
  return fmt::format("{}{:g}\u00b0", tenths < 0 ? "\u2212" : "", std::abs(tenths) / 10);
}

// Easting and chainage of millions of meters are read in plain digits.
std::vector<std::string> coordinate_labels(const Ticks& ticks) {
  constexpr double kLargestPlain = 1e10;
  double largest = 0;
  for (const double v : ticks.values) largest = std::max(largest, std::abs(v));
  if (largest < 1e6 || largest >= kLargestPlain) return tick_labels(ticks);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(ticks.step) + 1e-9)));
  std::vector<std::string> labels;
  for (const double v : ticks.values)
    labels.push_back((v < 0 ? "\u2212" : "") + grouped(fmt::format("{:.{}f}", std::abs(v), decimals)));
  return labels;
}

// -------------------------------------------------------------------------------------- section to sheet

struct View {
  Rect frame;      // [px]
  Vec2 middle;     // [m] in the middle of the frame
  double scale{};  // [px/m]

  Vec2 to_sheet(Vec2 p) const {
    const Vec2 m = frame.middle();
    return {m.x + (p.x - middle.x) * scale, m.y - (p.y - middle.y) * scale};
  }
  Range x_range() const { return {middle.x - frame.w / 2 / scale, middle.x + frame.w / 2 / scale}; }
  Range y_range() const { return {middle.y - frame.h / 2 / scale, middle.y + frame.h / 2 / scale}; }
};

// Everything the cut has a place for; a cut that failed shows the regions it was to be made from.
std::vector<Vec2> points_in_sight(const Model& model, const Cut& cut) {
  std::vector<Vec2> points;
  const auto add = [&points](Vec2 p) {
    if (is_drawable(p.x) && is_drawable(p.y)) points.push_back(p);
  };
  for (const CutBlock& block : cut.blocks)
    for (const int p : block.point) add(cut.point[at(p)]);
  for (const CutRegion& region : cut.regions)
    for (const Vec2 p : region.polygon) add(p);
  if (!points.empty()) return points;
  for (const RegionInput& region : model.regions)
    for (const Vec2 p : region.polygon) add(p);
  if (points.empty()) points = {{0, 0}, {1, 1}};
  return points;
}

// The frame lies at the corner of the sheet for now.
View make_view(const Model& model, const Cut& cut) {
  const std::vector<Vec2> points = points_in_sight(model, cut);
  const talus::Box box = bounding_box(points);
  const Range x = widened({box.min.x, box.max.x}), y = widened({box.min.y, box.max.y});
  View view;
  view.middle = {x.lo + x.length() / 2, y.lo + y.length() / 2};
  view.scale = std::min((kLargestWidth - 2 * kPad) / x.length(), (kLargestHeight - 2 * kPad) / y.length());
  view.frame.w = std::max(kLeastFrame, std::ceil(x.length() * view.scale + 2 * kPad));
  view.frame.h = std::max(kLeastFrame, std::ceil(y.length() * view.scale + 2 * kPad));
  return view;
}

// ------------------------------------------------------------------------------------------------- lines

struct Pen {
  Color color{};
  double width = 1;
  std::vector<double> dashes;
};

// Edges of the cut that one pen draws.
struct Lines {
  Pen pen;
  std::string label;
  std::vector<int> edges;
};

// Widths that leave the blocks to be seen, from an arch of 20 to a slope of 100 000.
struct Widths {
  double joint = 1, fault = 1, side = 1, opening = 1, dead_end = 1;
};

Widths line_widths(const Cut& cut, double scale) {
  constexpr double kShare = 0.055;  // of the size of the median block
  std::vector<double> areas;
  areas.reserve(cut.blocks.size());
  for (const CutBlock& block : cut.blocks) areas.push_back(std::abs(signed_area(cut.polygon(block))));
  double size = 0;
  if (!areas.empty()) {
    const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
    std::nth_element(areas.begin(), middle, areas.end());
    size = std::sqrt(*middle) * scale;
  }
  const double joint = std::clamp(kShare * size, 0.15, 1.6);
  return {.joint = joint,
          .fault = std::clamp(2.2 * joint, 0.9, 2.8),
          .side = std::clamp(1.8 * joint, 1.0, 2.2),
          .opening = std::clamp(2.0 * joint, 1.2, 2.4),
          .dead_end = 0.8 * joint};
}

Pen pen_of(OriginKind kind, int color, const Widths& widths) {
  switch (kind) {
    case OriginKind::kOpening:
      return {kBlack, widths.opening, {}};
    case OriginKind::kSide:
      return {kBlack, widths.side, {}};
    case OriginKind::kConstruction:
      return {kConstructionGrey, widths.joint, {4, 3}};
    case OriginKind::kFault:
      return {palette_color(color), widths.fault, {}};
    default:
      return {palette_color(color), widths.joint, {}};
  }
}

std::string origin_label(const Cut& cut, const Origin& origin) {
  if (origin.kind == OriginKind::kConstruction) return "construction cut";
  std::string label = short_text(origin.name);
  if (origin.kind != OriginKind::kJointSet) return label;
  for (const JointSetNote& note : cut.joint_sets) {
    if (note.name != origin.name) continue;
    return label + ": " + degrees_text(note.angle) + ", " + counted(at(note.traces), "trace");
  }
  return label;
}

// Edges of the blocks that are left, each once.
std::vector<int> edges_in_use(const Cut& cut) {
  std::vector<int> edges;
  for (const CutBlock& block : cut.blocks) edges.insert(edges.end(), block.edge.begin(), block.edge.end());
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::string openings_label(const Cut& cut, const std::vector<bool>& drawn) {
  std::string names;
  int count = 0;
  for (std::size_t o = 0; o < cut.origins.size(); ++o) {
    if (!drawn[o] || cut.origins[o].kind != OriginKind::kOpening) continue;
    if (count++ > 0) names += ", ";
    if (names.size() < 1000) names += short_text(cut.origins[o].name);
  }
  return (count == 1 ? "opening " : "openings ") + short_text(names);
}

// The lines that are drawn, most important first.
std::vector<Lines> make_lines(const Cut& cut, const Widths& widths) {
  // openings share a pen and an entry of the legend, and so do sides; the others have their own
  constexpr std::size_t kOpenings = 0, kSides = 1, kOthers = 2;
  std::vector<Lines> lines(kOthers + cut.origins.size());
  const auto place = [&cut](std::size_t origin) {
    const OriginKind kind = cut.origins[origin].kind;
    return kind == OriginKind::kOpening ? kOpenings : kind == OriginKind::kSide ? kSides : kOthers + origin;
  };
  int color = 0;  // origins keep theirs even when none of their edges is left
  for (std::size_t o = 0; o < cut.origins.size(); ++o) {
    const Origin& origin = cut.origins[o];
    Lines& own = lines[place(o)];
    own.pen = pen_of(origin.kind, color, widths);
    own.label = place(o) == kSides ? "outline" : origin_label(cut, origin);
    color += place(o) >= kOthers && origin.kind != OriginKind::kConstruction;
  }
  std::vector<bool> drawn(cut.origins.size(), false);
  for (const int edge : edges_in_use(cut)) {
    const std::size_t origin = at(cut.edge_origin[at(edge)]);
    drawn[origin] = true;
    lines[place(origin)].edges.push_back(edge);
  }
  lines[kOpenings].label = openings_label(cut, drawn);
  const auto is_empty = [](const Lines& l) { return l.edges.empty(); };
  lines.erase(std::remove_if(lines.begin(), lines.end(), is_empty), lines.end());
  return lines;
}

// Puts edges end to end, straight on where there is a choice: a few long lines are drawn faster, and in fewer
// bytes, than many short ones.
class Chainer {
 public:
  Chainer(const Cut& cut, const std::vector<int>& edges) : cut_(cut), edges_(edges), taken_(edges.size()) {
    for (std::size_t i = 0; i < edges.size(); ++i)
      for (const int point : cut.edge[at(edges[i])]) ends_.push_back({point, i});
    std::sort(ends_.begin(), ends_.end());
  }

  /// Indices of the points along each chain; the first is the last in one that closes.
  std::vector<std::vector<int>> chains() {
    std::vector<std::vector<int>> list;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (taken_[i]) continue;
      taken_[i] = true;
      const auto [a, b] = cut_.edge[at(edges_[i])];
      std::vector<int> chain{b, a};
      extend(chain);
      std::reverse(chain.begin(), chain.end());
      extend(chain);
      list.push_back(std::move(chain));
    }
    return list;
  }

 private:
  void extend(std::vector<int>& chain) {
    while (true) {
      const int before = chain[chain.size() - 2], here = chain.back();
      const Vec2 along = cut_.point[at(here)] - cut_.point[at(before)];
      double best = -2;
      std::size_t next = 0;
      int there = -1;
      const std::pair<int, std::size_t> first{here, 0};
      for (auto it = std::lower_bound(ends_.begin(), ends_.end(), first);
           it != ends_.end() && it->first == here; ++it) {
        if (taken_[it->second]) continue;
        const auto [a, b] = cut_.edge[at(edges_[it->second])];
        const int other = a == here ? b : a;
        const Vec2 onward = cut_.point[at(other)] - cut_.point[at(here)];
        const double cosine = dot(along, onward) / (norm(along) * norm(onward));
        if (there >= 0 && !(cosine > best)) continue;
        best = cosine, next = it->second, there = other;
      }
      if (there < 0) return;
      taken_[next] = true;
      chain.push_back(there);
    }
  }

  const Cut& cut_;
  const std::vector<int>& edges_;
  std::vector<bool> taken_;                        // [edges]
  std::vector<std::pair<int, std::size_t>> ends_;  // point and place in `edges_`, sorted
};

// The line without the points that nobody would miss (Douglas and Peucker).
std::vector<Vec2> simplified(const std::vector<Vec2>& line) {
  constexpr double kInvisible = 0.05;  // [px]
  if (line.size() < 3) return line;
  std::vector<bool> kept(line.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> spans{{0, line.size() - 1}};
  while (!spans.empty()) {
    const auto [first, last] = spans.back();
    spans.pop_back();
    double farthest = kInvisible;
    std::size_t split = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = distance_to_segment(line[i], line[first], line[last]);
      if (distance > farthest) farthest = distance, split = i;
    }
    if (split == 0) continue;
    kept[split] = true;
    spans.push_back({first, split});
    spans.push_back({split, last});
  }
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (kept[i]) out.push_back(line[i]);
  return out;
}

// ------------------------------------------------------------------------------------------------- areas

// Blocks in one tint.
struct Area {
  Color color{};
  std::string label;
  std::vector<const CutBlock*> blocks;
};

// Materials, then fixed rock, then rock kept in openings.
std::vector<Area> make_areas(const Model& model, const Cut& cut) {
  constexpr int kFixed = INT_MAX - 1, kKept = INT_MAX;
  std::map<int, Area> areas;
  for (const CutBlock& block : cut.blocks) {
    const CutRegion& region = cut.regions[at(block.region)];
    int key = std::max(region.material, 0);
    if (region.kind == BlockKind::kFixed) key = kFixed;
    if (block.opening >= 0) key = kKept;
    areas[key].blocks.push_back(&block);
  }
  std::vector<Area> list;
  for (auto& [key, area] : areas) {
    if (key < kFixed) {
      area.color = tint(key);
      if (at(key) < model.materials.size()) area.label = short_text(model.materials[at(key)].name);
    } else {
      area.color = key == kFixed ? kFixedTint : kKeptTint;
      area.label = key == kFixed ? "fixed" : "kept in openings";
    }
    list.push_back(std::move(area));
  }
  return list;
}

// Closed loops around the blocks, as points: edges between two of them cancel, so that no seams show.
std::vector<std::vector<int>> outlines(const Cut& cut, const std::vector<const CutBlock*>& blocks) {
  std::vector<int> uses(cut.edge.size(), 0);  // forward minus backward
  for (const CutBlock* block : blocks) {
    for (std::size_t k = 0; k < block->edge.size(); ++k) {
      const std::size_t edge = at(block->edge[k]);
      uses[edge] += cut.edge[edge][0] == block->point[k] ? 1 : -1;
    }
  }
  std::vector<std::pair<int, int>> steps;  // from point to point
  for (std::size_t e = 0; e < uses.size(); ++e) {
    const auto [a, b] = cut.edge[e];
    if (uses[e] > 0) steps.push_back({a, b});
    if (uses[e] < 0) steps.push_back({b, a});
  }
  std::sort(steps.begin(), steps.end());
  std::vector<bool> taken(steps.size(), false);
  const auto next_from = [&](int point) {
    auto i = static_cast<std::size_t>(
        std::lower_bound(steps.begin(), steps.end(), std::pair{point, INT_MIN}) - steps.begin());
    while (i < steps.size() && steps[i].first == point && taken[i]) ++i;
    return i < steps.size() && steps[i].first == point ? i : steps.size();
  };
  std::vector<std::vector<int>> loops;
  for (std::size_t start = 0; start < steps.size(); ++start) {
    if (taken[start]) continue;
    loops.emplace_back();
    // as many steps leave a point as arrive: the walk ends where it began
    for (std::size_t i = start; i < steps.size(); i = next_from(steps[i].second)) {
      taken[i] = true;
      loops.back().push_back(steps[i].first);
    }
  }
  return loops;
}

// -------------------------------------------------------------------------------------------------- axes

struct Axis {
  Ticks ticks;
  std::vector<std::string> labels;
  double widest = 0;  // label [px]
};

// Ticks with room for their labels; a single one where there is room for no two.
Axis make_axis(cairo_t* cr, Range range, double length, bool across) {
  constexpr double kDense = 65;                       // [px] between ticks; one step for both axes
  constexpr double kBetween = 20, kBetweenLines = 8;  // [px] between labels
  Axis axis;
  const auto set = [&](int target) {
    axis.ticks = nice_ticks(range.lo, range.hi, target);
    axis.labels = coordinate_labels(axis.ticks);
    axis.widest = 0;
    for (const std::string& label : axis.labels) axis.widest = std::max(axis.widest, text_width(cr, label));
    return !axis.ticks.values.empty();
  };
  set_font(cr, kFontSize);
  for (int target = std::max(2, static_cast<int>(length / kDense)); target > 0; --target) {
    if (!set(target)) continue;
    const double spacing = axis.ticks.step / range.length() * length;
    if (spacing >= (across ? axis.widest + kBetween : kFontSize + kBetweenLines)) return axis;
  }
  for (int target = 1; target < 20; ++target) {
    if (!set(target)) continue;
    const std::size_t middle = axis.ticks.values.size() / 2;
    axis.ticks.values = {axis.ticks.values[middle]};
    axis.labels = coordinate_labels(axis.ticks);
    break;
  }
  return axis;
}

double tick_position(double value, Range range, double start, double length) {
  return start + (value - range.lo) / range.length() * length;
}

// ------------------------------------------------------------------------------------------ names inside

struct Name {
  std::string text;
  double size = kNameSize;
  Rect box;
  std::optional<Vec2> from;  // start of a thin line to a name that stands away from its marker
};

bool overlap(const Rect& a, const Rect& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

bool is_inside(const Rect& inner, const Rect& outer) {
  return inner.x >= outer.x && inner.right() <= outer.right() && inner.y >= outer.y &&
         inner.bottom() <= outer.bottom();
}

// Whether part of the segment lies in the rectangle (Liang and Barsky).
bool meets(const Rect& rect, Vec2 a, Vec2 b) {
  double from = 0, to = 1;
  const auto cut = [&from, &to](double slope, double room) {
    if (slope == 0) return room >= 0;
    if (slope < 0) from = std::max(from, room / slope);
    if (slope > 0) to = std::min(to, room / slope);
    return from <= to;
  };
  const Vec2 d = b - a;
  return cut(-d.x, a.x - rect.x) && cut(d.x, rect.right() - a.x) && cut(-d.y, a.y - rect.y) &&
         cut(d.y, rect.bottom() - a.y);
}

bool cross_each_other(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const auto side = [](Vec2 p, Vec2 q, Vec2 r) { return cross(q - p, r - p) > 0; };
  return side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b);
}

// On the sheet.
using Segment = std::pair<Vec2, Vec2>;

Rect centered(Vec2 middle, double w, double h) { return {middle.x - w / 2, middle.y - h / 2, w, h}; }

Rect marker_box(Vec2 marker) {
  constexpr double kSize = 2 * (kMarkerRadius + kMarkerRim);
  return centered(marker, kSize, kSize);
}

// Names in the openings that are empty, where they fit.
std::vector<Name> opening_names(cairo_t* cr, const Model& model, const Cut& cut, const View& view,
                                const std::vector<Vec2>& markers) {
  constexpr double kAir = 8;  // [px] around the name
  std::vector<Name> names;
  if (cut.blocks.empty()) return names;
  for (const OpeningInput& opening : model.openings) {
    if (opening.kept || opening.polygon.size() < 3) continue;
    Polygon outline;
    for (const Vec2 p : opening.polygon) outline.push_back(view.to_sheet(p));
    if (std::abs(signed_area(outline)) < 1) continue;  // px2
    const Vec2 middle = polygon_moments(outline).centroid;
    if (!contains(outline, middle)) continue;
    for (const double size : {kFontSize, 11.0, 9.0}) {
      set_font(cr, size);
      const std::string text = fit_text(cr, short_text(opening.name), kLargestWidth);
      const Rect box = centered(middle, text_width(cr, text) + kAir, size + kAir);
      bool fits = true;
      for (std::size_t k = 0; k < outline.size(); ++k)
        fits = fits && !meets(box, outline[k], outline[(k + 1) % outline.size()]);
      for (const Name& other : names) fits = fits && !overlap(box, other.box);
      for (const Vec2 marker : markers) fits = fits && !overlap(box, marker_box(marker));
      if (!fits) continue;
      names.push_back({text, size, box, {}});
      break;
    }
  }
  return names;
}

struct Markers {
  std::vector<Vec2> points;  // [px]
  std::vector<Name> names;
  std::size_t left_out = 0;  // names without room
};

// Finds places for the names of markers, beside them if possible, else at the end of a thin line.
class NamePlacer {
 public:
  /// @param room     names stay inside
  /// @param markers  no name covers one
  /// @param borders  thick lines, better not covered either
  /// @param others   names that have their places already
  NamePlacer(const Rect& room, const std::vector<Vec2>& markers, const std::vector<Segment>& borders,
             const std::vector<Name>& others)
      : room_(room), markers_(markers), borders_(borders) {
    for (const Name& name : others) taken_.push_back(name.box);
  }

  std::optional<Name> place(const std::string& text, double width, Vec2 marker) {
    constexpr std::array kDistances{8.0, 16.0, 26.0, 38.0, 52.0, 70.0, 92.0, 120.0};  // [px]
    const auto meets_border = [this](const Name& name) {
      const auto hits = [&name](const Segment& s) { return meets(name.box, s.first, s.second); };
      return std::any_of(borders_.begin(), borders_.end(), hits);
    };
    for (const Name& name : names_around(text, width, marker, kDistances[0]))
      if (is_free(name) && !meets_border(name)) return taken(name);
    for (const double distance : kDistances) {
      for (Name& name : names_around(text, width, marker, distance)) {
        if (distance > kDistances[0]) name.from = marker;
        if (is_free(name)) return taken(name);
      }
    }
    return {};
  }

  /// The point of the name's box nearest to the marker.
  static Vec2 end_of_leader(const Name& name) {
    return {std::clamp(name.from->x, name.box.x, name.box.right()),
            std::clamp(name.from->y, name.box.y, name.box.bottom())};
  }

 private:
  static std::vector<Name> names_around(const std::string& text, double width, Vec2 marker, double distance) {
    // right, left, above, below, then between them
    constexpr std::array kTurns{0, 8, 4, 12, 2, 14, 6, 10, 1, 15, 3, 13, 7, 9, 5, 11};
    constexpr double kHeight = kNameSize + 2;
    std::vector<Name> names;
    for (const int turn : kTurns) {
      const double angle = turn * std::numbers::pi / 8;
      const Vec2 away{std::cos(angle) * (distance + width / 2), -std::sin(angle) * (distance + kHeight / 2)};
      names.push_back({text, kNameSize, centered(marker + away, width, kHeight), {}});
    }
    return names;
  }

  Name taken(const Name& name) {
    taken_.push_back(name.box);
    if (name.from) leaders_.push_back({*name.from, end_of_leader(name)});
    return name;
  }

  bool is_free(const Name& name) const {
    if (!is_inside(name.box, room_)) return false;
    const auto hits = [&name](const Rect& rect) { return overlap(name.box, rect); };
    if (std::any_of(taken_.begin(), taken_.end(), hits)) return false;
    const auto is_under = [&hits](Vec2 marker) { return hits(marker_box(marker)); };
    if (std::any_of(markers_.begin(), markers_.end(), is_under)) return false;
    for (const auto& [a, b] : leaders_)
      if (meets(name.box, a, b)) return false;
    return !name.from || leader_is_free(*name.from, end_of_leader(name));
  }

  bool leader_is_free(Vec2 from, Vec2 to) const {
    for (const Rect& rect : taken_)
      if (meets(rect, from, to)) return false;
    for (const auto& [a, b] : leaders_)
      if (cross_each_other(a, b, from, to)) return false;
    for (const Vec2 marker : markers_)
      if (!(marker == from) && meets(marker_box(marker), from, to)) return false;
    return true;
  }

  Rect room_;
  const std::vector<Vec2>& markers_;
  const std::vector<Segment>& borders_;
  std::vector<Rect> taken_;
  std::vector<Segment> leaders_;
};

std::vector<const MonitorInput*> monitors_in_sight(const Model& model, const View& view) {
  std::vector<const MonitorInput*> list;
  for (const MonitorInput& monitor : model.monitors) {
    if (monitor.kind != MonitorKind::kPoint) continue;
    const Vec2 p = view.to_sheet(monitor.point);
    if (is_inside(Rect{p.x, p.y, 0, 0}, view.frame)) list.push_back(&monitor);
  }
  return list;
}

std::string monitor_text(cairo_t* cr, const MonitorInput& monitor) {
  constexpr double kWidestName = 150;
  set_font(cr, kNameSize);
  return fit_text(cr, short_text(monitor.name), kWidestName);
}

// Outlines, openings and faults, as far as there are few enough to look at for each name.
std::vector<Segment> borders_on_sheet(const Model& model, const Cut& cut, const View& view) {
  constexpr std::size_t kMost = 4000;
  std::vector<Segment> borders;
  const auto add = [&](const std::vector<Vec2>& line, bool closed) {
    if (borders.size() + line.size() > kMost) return;
    for (std::size_t k = 0; k + (closed ? 0 : 1) < line.size(); ++k)
      borders.push_back({view.to_sheet(line[k]), view.to_sheet(line[(k + 1) % line.size()])});
  };
  for (const CutRegion& region : cut.regions) add(region.polygon, true);
  for (const OpeningInput& opening : model.openings) add(opening.polygon, true);
  for (const FaultInput& fault : model.faults) add(fault.points, false);
  return borders;
}

// Names beside markers that are in their places.
void add_names(cairo_t* cr, const std::vector<const MonitorInput*>& monitors, NamePlacer placer,
               Markers& markers) {
  for (std::size_t i = 0; i < monitors.size(); ++i) {
    std::optional<Name> name;
    if (i < kMostNames) {
      const std::string text = monitor_text(cr, *monitors[i]);
      name = placer.place(text, text_width(cr, text) + 2, markers.points[i]);
    }
    if (name) markers.names.push_back(*name);
    markers.left_out += !name;
  }
}

// ------------------------------------------------------------------------------------------------ legend

struct LegendEntry {
  enum Kind { kLine, kSquare, kMarker, kNote };
  Kind kind = kLine;
  std::string text;
  Pen pen;              // of the line; its colour fills the square
  double width = 0;     // sample and text
  double x = 0, y = 0;  // left end and middle height

  double sample() const { return kind == kNote ? 0 : kLegendSample + kLegendGap; }
};

std::vector<LegendEntry> legend_entries(const Cut& cut, const std::vector<Area>& areas,
                                        const std::vector<Lines>& lines, const Markers& markers,
                                        double dead_end) {
  using Entry = LegendEntry;
  std::vector<Entry> list;
  if (areas.size() > 1)
    for (const Area& area : areas) list.push_back({Entry::kSquare, area.label, {area.color, 1, {}}});
  for (const Lines& l : lines) list.push_back({Entry::kLine, l.label, l.pen});
  if (list.size() > kMostLegendEntries) {
    const std::size_t more = list.size() - kMostLegendEntries;
    list.resize(kMostLegendEntries);
    list.push_back({Entry::kNote, fmt::format("and {} more", more), {}});
  }
  if (!cut.dead_ends.empty()) {
    const std::string text = "dead ends removed: " + length_text(cut.dead_end_length);
    list.push_back({Entry::kLine, text, {kDeadEndGrey, dead_end, {}}});
  }
  if (!markers.points.empty()) {
    std::string text = counted(markers.points.size(), "monitored point");
    if (markers.left_out > 0) text += fmt::format(" ({} without name)", markers.left_out);
    list.push_back({Entry::kMarker, text, {}});
  }
  const auto note = [&list](int count, const char* what) {
    if (count > 0) list.push_back({Entry::kNote, counted(at(count), "sliver") + " " + what, {}});
  };
  note(cut.slivers.merged, "merged");
  note(cut.slivers.deleted, "deleted");
  note(cut.slivers.kept, "kept");
  return list;
}

void fit_entries(cairo_t* cr, double available, std::vector<LegendEntry>& entries) {
  set_font(cr, kFontSize);
  for (LegendEntry& entry : entries) {
    entry.text = fit_text(cr, entry.text, available - entry.sample());
    entry.width = entry.sample() + text_width(cr, entry.text);
  }
}

// Puts the entries into rows with aligned columns and returns the height taken.
double place_in_rows(double left, double top, double available, std::vector<LegendEntry>& entries) {
  const std::size_t count = entries.size();
  std::vector<double> widths;
  for (std::size_t columns = count; columns > 0; --columns) {
    widths.assign(columns, 0);
    for (std::size_t i = 0; i < count; ++i)
      widths[i % columns] = std::max(widths[i % columns], entries[i].width);
    double total = kLegendColumnGap * static_cast<double>(columns - 1);
    for (const double width : widths) total += width;
    if (total <= available) break;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t column = i % widths.size();
    entries[i].x = left;
    for (std::size_t c = 0; c < column; ++c) entries[i].x += widths[c] + kLegendColumnGap;
    entries[i].y = top + (static_cast<double>(i / widths.size()) + 0.5) * kLegendRow;
  }
  if (count == 0) return 0;
  return static_cast<double>((count + widths.size() - 1) / widths.size()) * kLegendRow;
}

// ----------------------------------------------------------------------------------------------- picture

// Everything the sheet shows and where; both files are drawn from it.
struct Picture {
  const Cut* cut = nullptr;
  std::vector<Polyline> dead_ends;
  Widths widths;
  View view;
  Axis x, y;
  std::vector<Area> areas;
  std::vector<Lines> lines;
  std::vector<Name> openings;
  Markers markers;
  std::vector<LegendEntry> legend;
  std::string title, count;
  Vec2 count_at;  // right end
  double width = 0, height = 0;
};

// Dead ends in the rock that is left: parts in an empty opening would not mean anything.
std::vector<Polyline> visible_dead_ends(const Model& model, const Cut& cut) {
  std::vector<std::pair<talus::Box, const Polygon*>> empty;
  for (const OpeningInput& o : model.openings)
    if (!o.kept && o.polygon.size() > 2) empty.push_back({bounding_box(o.polygon), &o.polygon});
  std::vector<Polyline> list;
  for (const Polyline& line : cut.dead_ends) {
    Polyline part;
    const auto finish = [&] {
      if (part.size() > 1) list.push_back(part);
      part.clear();
    };
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      const Vec2 p = 0.5 * (line[k] + line[k + 1]);
      const auto holds = [p](const auto& opening) {
        const auto& [box, polygon] = opening;
        if (p.x < box.min.x || p.x > box.max.x || p.y < box.min.y || p.y > box.max.y) return false;
        return contains(*polygon, p);
      };
      if (std::any_of(empty.begin(), empty.end(), holds)) {
        finish();
        continue;
      }
      if (part.empty()) part.push_back(line[k]);
      part.push_back(line[k + 1]);
    }
    finish();
  }
  return list;
}

std::string title_text(const Model& model) {
  if (!model.title.empty()) return short_text(model.title);
  return short_text(std::filesystem::path(model.file).filename().string());
}

std::string count_text(const Cut& cut) {
  std::string text = counted(cut.blocks.size(), "block");
  if (!cut.openings.empty()) text += ", " + counted(cut.openings.size(), "opening");
  return text;
}

// A narrow model has a wider sheet for a long title.
double width_of_title(cairo_t* cr, const Model& model, double left) {
  constexpr double kWidest = 800;
  set_font(cr, kTitleSize, true);
  const std::string title = fit_text(cr, title_text(model), kWidest - left - kMargin);
  return std::ceil(left + text_width(cr, title) + kMargin + 1);
}

// Title at the left and number of blocks at the right, below the title where that needs the whole width.
// Returns the height taken.
double place_title(cairo_t* cr, const Model& model, const Cut& cut, double available, Picture& picture) {
  constexpr double kBetween = 24;
  picture.count = count_text(cut);
  set_font(cr, kFontSize);
  const double count_width = text_width(cr, picture.count);
  set_font(cr, kTitleSize, true);
  const std::string title = title_text(model);
  picture.title = fit_text(cr, title, available);
  const bool one_line = text_width(cr, picture.title) + kBetween + count_width <= available;
  const double left = picture.view.frame.x;
  picture.count_at = {one_line ? left + available : left + count_width, kMargin + kTitleSize / 2};
  if (!one_line) picture.count_at.y += kTitleRow;
  return one_line ? kTitleRow + 6 : 2 * kTitleRow + 6;
}

// Space for names outside of the frame [px].
struct NameMargin {
  double above = 0, right = 0;

  Rect room(const Rect& frame) const { return {frame.x, frame.y - above, frame.w + right, frame.h + above}; }
};

// Slim and flat models leave no room for names inside.
NameMargin widest_margin(cairo_t* cr, const std::vector<const MonitorInput*>& monitors, const Rect& frame) {
  constexpr double kSlim = 400, kFlat = 150, kAbove = 40, kDistance = 40;
  double widest = 0;
  for (std::size_t i = 0; i < std::min(monitors.size(), kMostNames); ++i)
    widest = std::max(widest, text_width(cr, monitor_text(cr, *monitors[i])));
  if (monitors.empty()) return {};
  return {frame.h < kFlat ? kAbove : 0, frame.w < kSlim ? widest + kDistance : 0};
}

void place_names(cairo_t* cr, const Model& model, const std::vector<const MonitorInput*>& monitors,
                 const NameMargin& margin, Picture& picture) {
  const View& view = picture.view;
  Markers& markers = picture.markers;
  markers = {};
  for (const MonitorInput* monitor : monitors) markers.points.push_back(view.to_sheet(monitor->point));
  picture.openings = opening_names(cr, model, *picture.cut, view, markers.points);
  const std::vector<Segment> borders = borders_on_sheet(model, *picture.cut, view);
  add_names(cr, monitors, NamePlacer(margin.room(view.frame), markers.points, borders, picture.openings),
            markers);
}

// As much of the margin as the names need.
NameMargin needed_margin(const Markers& markers, const Rect& frame) {
  constexpr double kRounding = 1;
  NameMargin needed;
  for (const Name& name : markers.names) {
    needed.above = std::max(needed.above, frame.y - name.box.y + kRounding);
    needed.right = std::max(needed.right, name.box.right() - frame.right() + kRounding);
  }
  return needed;
}

// Below the frame, or to the right of one that is higher than wide.
void place_legend(cairo_t* cr, double right, double below, Picture& picture) {
  constexpr double kWidestColumn = 280, kWidestEntry = 420;
  const Rect& frame = picture.view.frame;
  const bool beside = frame.h > frame.w && static_cast<double>(picture.legend.size()) * kLegendRow <= frame.h;
  if (!beside) {
    const double available = picture.width - kMargin - frame.x;
    fit_entries(cr, std::min(kWidestEntry, available), picture.legend);
    picture.height = frame.bottom() + below;
    picture.height += place_in_rows(frame.x, picture.height, available, picture.legend) + kMargin;
    return;
  }
  const double left = std::ceil(right) + 2 * kLabelGap;
  fit_entries(cr, std::max(kWidestColumn, picture.width - kMargin - left), picture.legend);
  double row = frame.y + kLegendRow / 2;
  for (LegendEntry& entry : picture.legend) {
    entry.x = left;
    entry.y = row;
    row += kLegendRow;
    picture.width = std::max(picture.width, left + entry.width + kMargin);
  }
  picture.height = frame.bottom() + below + kMargin;
}

Picture make_picture(cairo_t* cr, const Model& model, const Cut& cut) {
  Picture picture;
  picture.cut = &cut;
  picture.dead_ends = visible_dead_ends(model, cut);
  picture.view = make_view(model, cut);
  picture.widths = line_widths(cut, picture.view.scale);
  picture.areas = make_areas(model, cut);
  picture.lines = make_lines(cut, picture.widths);

  Rect& frame = picture.view.frame;
  picture.x = make_axis(cr, picture.view.x_range(), frame.w, true);
  picture.y = make_axis(cr, picture.view.y_range(), frame.h, false);
  frame.x = std::ceil(kMargin + kFontSize + kLabelGap + picture.y.widest + kTickLength + 4);
  const auto monitors =
      cut.blocks.empty() ? std::vector<const MonitorInput*>{} : monitors_in_sight(model, picture.view);
  place_names(cr, model, monitors, widest_margin(cr, monitors, frame), picture);
  const NameMargin margin = needed_margin(picture.markers, frame);
  const double right = frame.right() + std::max(margin.right, picture.x.widest / 2);
  picture.width = std::max({kLeastSheet, std::ceil(right) + kMargin, width_of_title(cr, model, frame.x)});
  frame.y = kMargin + std::ceil(margin.above) +
            place_title(cr, model, cut, picture.width - kMargin - frame.x, picture);
  place_names(cr, model, monitors, margin, picture);
  picture.legend =
      legend_entries(cut, picture.areas, picture.lines, picture.markers, picture.widths.dead_end);
  const double below = kTickLength + 4 + kFontSize + kLabelGap + kFontSize + kLabelGap;
  place_legend(cr, right, below, picture);
  picture.width = std::ceil(picture.width);
  picture.height = std::ceil(picture.height);
  return picture;
}

// ----------------------------------------------------------------------------------------------- drawing

void set_color(cairo_t* cr, Color c) { cairo_set_source_rgb(cr, c.r, c.g, c.b); }

void set_pen(cairo_t* cr, const Pen& pen) {
  set_color(cr, pen.color);
  cairo_set_line_width(cr, pen.width);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cr, pen.dashes.empty() ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
  cairo_set_dash(cr, pen.dashes.data(), static_cast<int>(pen.dashes.size()), 0);
}

std::vector<Vec2> on_sheet(const Polyline& line, const View& view) {
  std::vector<Vec2> out;
  out.reserve(line.size());
  for (const Vec2 p : line) out.push_back(view.to_sheet(p));
  return out;
}

std::vector<Vec2> on_sheet(const std::vector<int>& points, const Cut& cut, const View& view) {
  std::vector<Vec2> out;
  out.reserve(points.size());
  for (const int p : points) out.push_back(view.to_sheet(cut.point[at(p)]));
  return out;
}

void add_to_path(cairo_t* cr, const std::vector<Vec2>& line, bool closed) {
  const std::vector<Vec2> points = simplified(line);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == 0) cairo_move_to(cr, points[i].x, points[i].y);
    if (i > 0) cairo_line_to(cr, points[i].x, points[i].y);
  }
  if (closed) cairo_close_path(cr);
}

void draw_areas(cairo_t* cr, const Picture& picture) {
  for (const Area& area : picture.areas) {
    set_color(cr, area.color);
    for (const auto& loop : outlines(*picture.cut, area.blocks))
      add_to_path(cr, on_sheet(loop, *picture.cut, picture.view), true);
    cairo_fill(cr);
  }
}

void draw_dead_ends(cairo_t* cr, const Picture& picture) {
  set_pen(cr, {kDeadEndGrey, picture.widths.dead_end, {}});
  for (const Polyline& line : picture.dead_ends) add_to_path(cr, on_sheet(line, picture.view), false);
  cairo_stroke(cr);
}

void draw_lines(cairo_t* cr, const Picture& picture) {
  for (auto lines = picture.lines.rbegin(); lines != picture.lines.rend(); ++lines) {
    set_pen(cr, lines->pen);
    for (const auto& chain : Chainer(*picture.cut, lines->edges).chains()) {
      const bool closed = chain.size() > 2 && chain.front() == chain.back();
      add_to_path(cr, on_sheet(chain, *picture.cut, picture.view), closed);
    }
    cairo_stroke(cr);
  }
}

// Lines of width 1 at half px fill whole pixels at both densities.
double crisp(double v) { return std::floor(v) + 0.5; }

void draw_rule(cairo_t* cr, Vec2 from, Vec2 to) {
  cairo_move_to(cr, crisp(from.x), crisp(from.y));
  cairo_line_to(cr, crisp(to.x), crisp(to.y));
  cairo_stroke(cr);
}

void draw_axes(cairo_t* cr, const Picture& picture) {
  const Rect& frame = picture.view.frame;
  set_pen(cr, {kRule, 1, {}});
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_SQUARE);
  draw_rule(cr, {frame.x, frame.y}, {frame.x, frame.bottom()});
  draw_rule(cr, {frame.x, frame.bottom()}, {frame.right(), frame.bottom()});
  set_font(cr, kFontSize);
  const double label_y = frame.bottom() + kTickLength + 4 + kFontSize / 2;
  for (std::size_t i = 0; i < picture.x.labels.size(); ++i) {
    const double x = tick_position(picture.x.ticks.values[i], picture.view.x_range(), frame.x, frame.w);
    draw_rule(cr, {x, frame.bottom()}, {x, frame.bottom() + kTickLength});
    draw_text(cr, picture.x.labels[i], x, label_y, 0.5);
  }
  for (std::size_t i = 0; i < picture.y.labels.size(); ++i) {
    const double y =
        tick_position(picture.y.ticks.values[i], picture.view.y_range(), frame.bottom(), -frame.h);
    draw_rule(cr, {frame.x - kTickLength, y}, {frame.x, y});
    draw_text(cr, picture.y.labels[i], frame.x - kTickLength - 4, y, 1);
  }
  set_color(cr, kText);
  draw_text(cr, "x [m]", frame.middle().x, label_y + kFontSize + kLabelGap, 0.5);
  cairo_save(cr);
  cairo_translate(cr, kMargin + kFontSize / 2, frame.middle().y);
  cairo_rotate(cr, -std::numbers::pi / 2);
  draw_text(cr, "y [m]", 0, 0, 0.5);
  cairo_restore(cr);
}

// Text that can be read above lines of any colour.
void draw_name(cairo_t* cr, const Name& name) {
  constexpr double kHalo = 1.6;
  constexpr int kCopies = 12;
  set_font(cr, name.size);
  const Vec2 middle = name.box.middle();
  set_color(cr, kWhite);
  for (int i = 0; i < kCopies; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCopies;
    draw_text(cr, name.text, middle.x + kHalo * std::cos(angle), middle.y + kHalo * std::sin(angle), 0.5);
  }
  set_color(cr, kText);
  draw_text(cr, name.text, middle.x, middle.y, 0.5);
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

void draw_markers(cairo_t* cr, const Markers& markers) {
  for (const Pen& pen : {Pen{kWhite, 3, {}}, Pen{kText, 0.8, {}}}) {
    set_pen(cr, pen);
    for (const Name& name : markers.names) {
      if (!name.from) continue;
      const Vec2 end = NamePlacer::end_of_leader(name);
      cairo_move_to(cr, name.from->x, name.from->y);
      cairo_line_to(cr, end.x, end.y);
    }
    cairo_stroke(cr);
  }
  for (const Vec2 p : markers.points) draw_marker(cr, p);
  for (const Name& name : markers.names) draw_name(cr, name);
}

void draw_sample(cairo_t* cr, const LegendEntry& entry) {
  constexpr double kLeastWidth = 1.2, kSquareHeight = 12;
  if (entry.kind == LegendEntry::kMarker) draw_marker(cr, {entry.x + kLegendSample / 2, entry.y});
  if (entry.kind == LegendEntry::kLine) {
    Pen pen = entry.pen;
    pen.width = std::max(pen.width, kLeastWidth);
    set_pen(cr, pen);
    cairo_move_to(cr, entry.x, crisp(entry.y));
    cairo_line_to(cr, entry.x + kLegendSample, crisp(entry.y));
    cairo_stroke(cr);
  }
  if (entry.kind == LegendEntry::kSquare) {
    cairo_rectangle(cr, crisp(entry.x), crisp(entry.y - kSquareHeight / 2), kLegendSample - 1, kSquareHeight);
    set_color(cr, entry.pen.color);
    cairo_fill_preserve(cr);
    set_pen(cr, {kConstructionGrey, 0.6, {}});
    cairo_stroke(cr);
  }
}

void draw_texts(cairo_t* cr, const Picture& picture) {
  set_font(cr, kFontSize);
  for (const LegendEntry& entry : picture.legend) {
    draw_sample(cr, entry);
    set_color(cr, kText);
    draw_text(cr, entry.text, entry.x + entry.sample(), entry.y, 0);
  }
  draw_text(cr, picture.count, picture.count_at.x, picture.count_at.y, 1);
  set_font(cr, kTitleSize, true);
  draw_text(cr, picture.title, picture.view.frame.x, kMargin + kTitleSize / 2, 0);
}

void draw(cairo_t* cr, const Picture& picture) {
  draw_areas(cr, picture);
  draw_dead_ends(cr, picture);
  draw_lines(cr, picture);
  for (const Name& name : picture.openings) draw_name(cr, name);
  draw_axes(cr, picture);
  draw_markers(cr, picture.markers);
  draw_texts(cr, picture);
}

}  // namespace

void write_cut_picture(const Model& model, const Cut& cut, const std::filesystem::path& stem) {
  std::filesystem::path svg = stem, png = stem;
  svg += ".svg";
  png += ".png";
  std::string svg_content, png_content;
  try {
    const Picture picture = make_picture(make_measuring_context().get(), model, cut);
    const auto draw_all = [&picture](cairo_t* cr) { draw(cr, picture); };
    svg_content = svg_bytes(picture.width, picture.height, draw_all);
    png_content = png_bytes(picture.width, picture.height, draw_all);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("cannot draw '" + stem.string() + "': " + error.what());
  }
  write_file(svg, svg_content);
  write_file(png, png_content);
}

}  // namespace talus::plot
