#include "talus/plot/cut_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <set>

#include "talus/base/rank.h"
#include "talus/plot/edge_chains.h"

namespace talus::plot {
namespace {

// Okabe and Ito's colours for all kinds of colour vision, without black and grey, which have a meaning of
// their own here, and without yellow, which is lost in thin lines on white.
constexpr std::array<Color, 6> kPalette{{{0.000, 0.447, 0.698},    // blue
                                         {0.835, 0.369, 0.000},    // vermilion
                                         {0.000, 0.620, 0.451},    // bluish green
                                         {0.800, 0.475, 0.655},    // reddish purple
                                         {0.902, 0.624, 0.000},    // orange
                                         {0.337, 0.706, 0.914}}};  // sky blue

// Of materials, pale enough for every line above to stand out.
constexpr std::array<Color, 6> kTints{{{0.975, 0.955, 0.905},    // sand
                                       {0.885, 0.930, 0.970},    // blue
                                       {0.890, 0.950, 0.880},    // green
                                       {0.970, 0.900, 0.890},    // rose
                                       {0.925, 0.900, 0.960},    // violet
                                       {0.930, 0.930, 0.930}}};  // grey
constexpr Color kKeptTint{1.0, 0.925, 0.55}, kFixedTint{0.74, 0.74, 0.74};
constexpr Color kBlack{0, 0, 0}, kDeadEndGrey{0.6, 0.6, 0.6}, kRed{0.86, 0.08, 0.08};

// Darker in every second round.
Color palette_color(int index) {
  const Color c = kPalette[at(index) % kPalette.size()];
  const double shade = at(index) / kPalette.size() % 2 == 0 ? 1 : 0.5;
  return {shade * c.r, shade * c.g, shade * c.b};
}

Pen pen_of(OriginKind kind, int color, double joint_width) {
  switch (kind) {
    case OriginKind::kOpening:
      return {kBlack, std::clamp(2.0 * joint_width, 1.2, 2.4), {}};
    case OriginKind::kSide:
      return {kBlack, std::clamp(1.8 * joint_width, 1.0, 2.2), {}};
    case OriginKind::kConstruction:
      return {kMidGrey, joint_width, {4, 3}};
    case OriginKind::kFault:
      return {palette_color(color), std::clamp(2.2 * joint_width, 0.9, 2.8), {}};
    default:
      return {palette_color(color), joint_width, {}};
  }
}

std::string degrees_text(double radians) {
  const double tenths = std::round(radians * 180 / std::numbers::pi * 10);
  return fmt::format("{}{:g}\u00b0", tenths < 0 ? "\u2212" : "", std::abs(tenths) / 10);
}

std::string joint_name(const Model& model, int joint) {
  return joint < 0 ? "hard and frictionless" : "joint \"" + model.joints[at(joint)].name + "\"";
}

// The joint along lines of an origin; "" where it differs from region to region, or is none.
std::string joint_text(const Model& model, const Cut& cut, const Origin& origin) {
  if (origin.kind == OriginKind::kSide || origin.kind == OriginKind::kConstruction) return "";
  if (origin.joint >= 0) return "; " + joint_name(model, origin.joint);
  int joint = cut.regions.empty() ? -1 : cut.regions.front().joint;
  for (const CutRegion& region : cut.regions)
    if (region.joint != joint) return "";
  return "; " + joint_name(model, joint < 0 ? model.default_joint : joint);
}

std::string label_of(const Cut& cut, const Origin& origin) {
  if (origin.kind == OriginKind::kSide) return "outline";
  if (origin.kind == OriginKind::kConstruction) return "construction cut, glued";
  if (origin.kind == OriginKind::kSurveyed)
    for (const SurveyNote& note : cut.surveys)
      if (note.name == origin.name) return origin.name + ": " + counted(at(note.inside), "trace");
  if (origin.kind == OriginKind::kJointSet)
    for (const JointSetNote& note : cut.joint_sets)
      if (note.name == origin.name)
        return origin.name + ": " + degrees_text(note.angle) + ", " + counted(at(note.traces), "trace");
  return origin.name;
}

// Blocks that were not cut, and what lies between them: joints of grids and pairs, and the default elsewhere.
std::string written_label(const Model& model, const Layout& layout, std::size_t count) {
  const bool alone = count == layout.blocks.size();
  std::string text = alone ? counted(count, "block") : counted(count, "other block");
  if (count < 2) return text;
  std::set<std::string> own;
  for (const auto& [groups, joint] : layout.pair_joint)
    if (std::max(groups.first, groups.second) < layout.first_mesh_group) own.insert(joint_name(model, joint));
  constexpr std::size_t kMost = 2;  // names
  if (own.empty() || own.size() > kMost)
    return text + "; between them " + joint_name(model, model.default_joint);
  for (const std::string& name : own) text += (name == *own.begin() ? "; " : ", ") + name;
  return text + ", elsewhere " + joint_name(model, model.default_joint);
}

}  // namespace

double joint_line_width(const Cut& cut, const Layout& layout, double scale) {
  constexpr double kShare = 0.055;
  std::vector<double> areas;
  for (const CutBlock& block : cut.blocks) areas.push_back(std::abs(signed_area(cut.polygon(block))));
  for (const BlockShape& block : layout.blocks)
    if (!layout.was_cut(block)) areas.push_back(std::abs(signed_area(block.polygon)));
  if (areas.empty()) return 1;
  return std::clamp(kShare * std::sqrt(median(std::move(areas))) * scale, 0.15, 1.6);
}

std::vector<Layer> make_areas(const Model& model, const Cut& cut, const Layout& layout) {
  constexpr int kFixed = INT_MAX - 1, kKept = INT_MAX;  // behind all materials
  std::map<int, Layer> areas;
  for (const CutBlock& block : cut.blocks) {
    const CutRegion& region = cut.regions[at(block.region)];
    int key = region.kind == BlockKind::kFixed ? kFixed : region.material;
    if (block.opening >= 0) key = kKept;
    std::vector<int>& edges = areas[key].edges;
    edges.insert(edges.end(), block.edge.begin(), block.edge.end());
  }
  for (const BlockShape& block : layout.blocks)
    if (!layout.was_cut(block))
      areas[block.kind == BlockKind::kFixed ? kFixed : block.material].polygons.push_back(block.polygon);
  std::vector<Layer> list;
  for (auto& [key, area] : areas) {
    area.edges = outline_edges(std::move(area.edges));
    area.pen.color = key == kKept ? kKeptTint : key == kFixed ? kFixedTint : kTints[at(key) % kTints.size()];
    area.label = key == kKept ? "kept in openings" : key == kFixed ? "fixed" : "";
    if (at(key) < model.materials.size()) area.label = "material " + model.materials[at(key)].name;
    list.push_back(std::move(area));
  }
  return list;
}

std::vector<Layer> make_lines(const Model& model, const Cut& cut, const Layout& layout, double joint_width) {
  constexpr std::size_t kOpenings = 0, kSides = 1, kOthers = 2;
  std::vector<Layer> lines(kOthers + cut.origins.size());
  const auto place = [&cut](std::size_t origin) {
    const OriginKind kind = cut.origins[origin].kind;
    return kind == OriginKind::kOpening ? kOpenings : kind == OriginKind::kSide ? kSides : kOthers + origin;
  };
  int color = 0, openings = 0;  // origins keep their colour even when none of their edges is left
  std::string names;
  for (std::size_t o = 0; o < cut.origins.size(); ++o) {
    const Origin& origin = cut.origins[o];
    Layer& own = lines[place(o)];
    own.pen = pen_of(origin.kind, color, joint_width);
    own.label = label_of(cut, origin) + joint_text(model, cut, origin);
    own.origins.push_back(static_cast<int>(o));
    color += place(o) >= kOthers && origin.kind != OriginKind::kConstruction;
    if (place(o) == kOpenings) names += (openings++ == 0 ? "" : ", ") + origin.name;
  }
  lines[kOpenings].label = (openings == 1 ? "opening " : "openings ") + names;

  std::vector<int> edges;
  for (const CutBlock& block : cut.blocks) edges.insert(edges.end(), block.edge.begin(), block.edge.end());
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const int edge : edges) lines[place(at(cut.edge_origin[at(edge)]))].edges.push_back(edge);

  Layer written{{kBlack, std::clamp(joint_width, 0.4, 1.2), {}}, "", {}};
  for (const BlockShape& block : layout.blocks)
    if (!layout.was_cut(block)) written.polygons.push_back(block.polygon);
  written.label = written_label(model, layout, written.polygons.size());
  lines.push_back(std::move(written));
  std::erase_if(lines, [](const Layer& layer) { return layer.edges.empty() && layer.polygons.empty(); });
  return lines;
}

Pen merged_pen(double joint_width) { return {kRed, std::max(2 * joint_width, 2.0), {}}; }

Pen dead_end_pen(double joint_width) { return {kDeadEndGrey, 0.8 * joint_width, {}}; }

std::vector<std::pair<Vec2, Vec2>> visible_dead_ends(const Model& model, const Cut& cut) {
  const auto is_in_empty_opening = [&model](Vec2 p) {
    const auto holds = [p](const OpeningInput& o) { return !o.kept && contains(o.polygon, p); };
    return std::any_of(model.openings.begin(), model.openings.end(), holds);
  };
  std::vector<std::pair<Vec2, Vec2>> segments;
  for (const Polyline& line : cut.dead_ends)
    for (std::size_t k = 0; k + 1 < line.size(); ++k)
      if (!is_in_empty_opening(0.5 * (line[k] + line[k + 1]))) segments.push_back({line[k], line[k + 1]});
  return segments;
}

}  // namespace talus::plot
