#include "talus/report/section_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "talus/base/index.h"
#include "talus/base/version.h"
#include "talus/output/cut_report.h"
#include "talus/output/read_frames.h"
#include "talus/output/vtk.h"
#include "talus/plot/conditions.h"
#include "talus/plot/cut_layers.h"
#include "talus/report/chunks.h"
#include "talus/report/pack.h"
#include "talus/report/packed_frames.h"

namespace talus::report {

namespace {

using json = nlohmann::ordered_json;

constexpr double kSheet = 1100;  // [px] the picture that symbols are placed on

std::string colour_of(const plot::Color& c) {
  const auto byte = [](double v) { return static_cast<int>(std::lround(255 * std::clamp(v, 0.0, 1.0))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(c.r), byte(c.g), byte(c.b));
}

const char* origin_word(OriginKind kind) {
  switch (kind) {
    case OriginKind::kOpening:
      return "opening";
    case OriginKind::kSide:
      return "side";
    case OriginKind::kFault:
      return "fault";
    case OriginKind::kSurveyed:
      return "traces";
    case OriginKind::kMasonry:
      return "masonry";
    case OriginKind::kArch:
      return "arch";
    case OriginKind::kTessellation:
      return "tessellation";
    case OriginKind::kJointSet:
      return "joint set";
    case OriginKind::kConstruction:
      return "construction cut";
  }
  return "";
}

const char* symbol_word(plot::Symbol symbol) {
  switch (symbol) {
    case plot::Symbol::kPin:
      return "pin";
    case plot::Symbol::kRoller:
      return "roller";
    case plot::Symbol::kTwoWay:
      return "two_way";
    case plot::Symbol::kArrow:
      return "arrow";
    case plot::Symbol::kBand:
      return "band";
    case plot::Symbol::kBar:
      return "bar";
  }
  return "";
}

// Blocks by their index: numbers that stay (BlockShape::id) are those of a cut alone.
Shapes shapes_in(const Layout& layout, const std::vector<BlockRow>& rows) {
  Shapes s;
  s.begin.push_back(0);
  for (int i = 0; i < count_of(layout.blocks); ++i) {
    const Polygon& polygon = layout.blocks[i].polygon;
    s.id.push_back(i);
    s.corner.insert(s.corner.end(), polygon.begin(), polygon.end());
    s.begin.push_back(count_of(s.corner));
    s.centre.push_back(rows[i].centroid);
  }
  return s;
}

// A sheet that the whole section fits on.
plot::View sheet_of(const Shapes& shapes, const Model& model) {
  std::vector<Vec2> points = shapes.corner;
  for (const BoltInput& bolt : model.bolts) points.insert(points.end(), {bolt.from, bolt.to});
  if (points.empty()) points = {{0, 0}, {1, 1}};
  const Box box = bounding_box(points);
  plot::View view;
  view.middle = 0.5 * (box.min + box.max);
  view.scale = kSheet / std::max({box.max.x - box.min.x, box.max.y - box.min.y, 1e-9});
  return view;
}

json blocks_json(const Layout& layout, const std::vector<BlockRow>& rows, Chunks& chunks) {
  json names = json::array();
  std::vector<int> kinds, materials, groups;
  std::vector<double> area, width, aspect, step;
  for (size_t i = 0; i < layout.blocks.size(); ++i) {
    const BlockShape& b = layout.blocks[i];
    names.push_back(b.name);
    kinds.push_back(place_of(b.kind)), materials.push_back(b.material), groups.push_back(b.group);
    area.push_back(rows[i].area), width.push_back(rows[i].width), aspect.push_back(rows[i].aspect);
    step.push_back(std::isfinite(rows[i].step) ? rows[i].step : 0);
  }
  Packer p;
  p.integers(kinds), p.integers(materials), p.integers(groups);
  p.floats(area), p.floats(width), p.floats(aspect), p.floats(step);
  return {{"names", names}, {"data", chunks.add(p.text())}};
}

// Of each edge of each block, in the order of the corners: which line it is drawn as, where it comes from, its joint.
json edges_json(const Layout& layout, Chunks& chunks) {
  std::vector<int> origins, joints;
  for (const BlockShape& b : layout.blocks)
    for (size_t k = 0; k < b.polygon.size(); ++k) {
      origins.push_back(b.edge_origin.empty() ? -1 : b.edge_origin[k]);
      joints.push_back(b.edge_joint.empty() ? Layout::kNoPair : b.edge_joint[k]);
    }
  Packer p;
  p.integers(origins), p.integers(joints);
  return chunks.add(p.text());
}

// Lines of meshes come before those of the cut, as in Layout::origins.
json origins_json(const Model& model, const Cut& cut, const Layout& layout) {
  json out = json::array();
  for (const MeshInput& m : model.meshes) {
    out.push_back({{"kind", "mesh"}, {"name", m.name}, {"line", m.where.line}});
    for (const std::string& curve : m.mesh.curve_groups)
      out.push_back({{"kind", "curve of a mesh"}, {"name", curve}, {"line", m.where.line}});
  }
  out.erase(out.begin() + static_cast<long>(std::min(out.size(), layout.origins.size() - cut.origins.size())),
            out.end());
  for (const Origin& o : cut.origins)
    out.push_back({{"kind", origin_word(o.kind)}, {"name", o.name}, {"line", o.where.line}});
  return out;
}

json pen_json(const plot::Pen& pen, const std::string& label) {
  return {{"label", label},
          {"colour", colour_of(pen.color)},
          {"width", pen.width},
          {"dashed", !pen.dashes.empty()}};
}

json layers_json(const Model& model, const Cut& cut, const Layout& layout, double joint_width) {
  json out = json::array();
  const auto first = static_cast<int>(layout.origins.size() - cut.origins.size());
  for (const plot::Layer& layer : plot::make_lines(model, cut, layout, joint_width)) {
    json j = pen_json(layer.pen, layer.label);
    j["origins"] = json::array();
    for (const int o : layer.origins) j["origins"].push_back(first + o);
    out.push_back(j);
  }
  return out;
}

json segments_json(const std::vector<std::pair<Vec2, Vec2>>& list, Vec2 origin, Chunks& chunks) {
  std::vector<double> x0, y0, x1, y1;
  for (const auto& [a, b] : list) {
    x0.push_back(a.x - origin.x), y0.push_back(a.y - origin.y);
    x1.push_back(b.x - origin.x), y1.push_back(b.y - origin.y);
  }
  Packer p;
  p.floats(x0), p.floats(y0), p.floats(x1), p.floats(y1);
  return {{"count", list.size()}, {"data", chunks.add(p.text())}};
}

// Lengths of arrows are on the screen; those of bands and bars in the section [m].
json conditions_json(const Model& model, const Layout& layout, const plot::View& view) {
  json out = json::array();
  const Vec2 m = view.frame.middle();
  for (const plot::Condition& c : plot::conditions_of(model, layout, view)) {
    const bool in_section = c.symbol == plot::Symbol::kBand || c.symbol == plot::Symbol::kBar;
    json marks = json::array();
    for (const plot::Mark& mark : c.marks) {
      const double x = view.middle.x + (mark.at.x - m.x) / view.scale,
                   y = view.middle.y - (mark.at.y - m.y) / view.scale;
      marks.push_back({x, y, mark.direction.x, mark.direction.y,
                       in_section ? mark.length / view.scale : mark.length, mark.line});
    }
    out.push_back({{"label", c.label},
                   {"symbol", symbol_word(c.symbol)},
                   {"colour", colour_of(c.color)},
                   {"sample", {c.sample.x, c.sample.y}},
                   {"marks", marks}});
  }
  return out;
}

template <class List>
json named_lines(const List& list) {
  json out = json::array();
  for (const auto& one : list) out.push_back({{"name", one.name}, {"line", one.where.line}});
  return out;
}

// Sections of the file that can be picked by name: kind, name, line; each line once a kind.
json things_json(const Model& model, const Cut& cut, const Layout& layout) {
  json out = json::array();
  std::map<std::pair<std::string, int>, bool> seen;
  const auto add = [&](const std::string& kind, const std::string& name, const Where& where) {
    if (where.line > 0 && !seen[{kind, where.line}])
      seen[{kind, where.line}] = true, out.push_back({{"kind", kind}, {"name", name}, {"line", where.line}});
  };
  for (size_t g = 0; g < layout.groups.size(); ++g) add("blocks", layout.groups[g], layout.group_where[g]);
  for (const Origin& o : cut.origins)
    if (o.kind != OriginKind::kSide) add(origin_word(o.kind), o.name, o.where);
  for (const Material& m : model.materials) add("material", m.name, m.where);
  for (const JointProperty& j : model.joints) add("joint", j.name, j.where);
  for (const SupportInput& s : model.supports) add("support", s.name, s.where);
  for (const BoundaryInput& b : model.boundaries) add("boundary", b.name, b.where);
  for (const LoadInput& l : model.loads) add("load", l.name, l.where);
  for (const BoltInput& b : model.bolts) add("bolt", b.name, b.where);
  for (const MonitorInput& m : model.monitors) add("monitor", m.name, m.where);
  return out;
}

json monitors_json(const Model& model) {
  json out = json::array();
  for (const MonitorInput& m : model.monitors)
    if (m.kind == MonitorKind::kPoint)
      out.push_back({{"name", m.name}, {"at", {m.point.x, m.point.y}}, {"line", m.where.line}});
  return out;
}

json tints_json(const Model& model, const Cut& cut, const Layout& layout) {
  json out = json::object();
  for (const plot::Layer& area : plot::make_areas(model, cut, layout))
    out[area.label] = colour_of(area.pen.color);
  return out;
}

}  // namespace

std::string section_page(const std::string& page, const Model& model, const Cut& cut, const Layout& layout,
                         const std::string& report) {
  Chunks chunks;
  const std::vector<BlockRow> rows = block_rows(model, layout.blocks);
  const Shapes shapes = shapes_in(layout, rows);
  const plot::View view = sheet_of(shapes, model);
  const double joint_width = plot::joint_line_width(cut, layout, view.scale);
  const Vec2 origin = view.middle;

  json groups = json::array();
  for (size_t g = 0; g < layout.groups.size(); ++g)
    groups.push_back({{"name", layout.groups[g]}, {"line", layout.group_where[g].line}});
  json pairs = json::array();
  for (const auto& [two, joint] : layout.pair_joint) pairs.push_back({two.first, two.second, joint});
  std::vector<std::pair<Vec2, Vec2>> merged;
  for (const int e : cut.slivers.opened) {
    const auto& [a, b] = cut.edge[e];
    merged.push_back({cut.point[a], cut.point[b]});
  }
  json dead = segments_json(plot::visible_dead_ends(model, cut), origin, chunks);
  dead["pen"] = pen_json(plot::dead_end_pen(joint_width),
                         fmt::format("dead ends removed: {:.4g} m", cut.dead_end_length));
  json red = segments_json(merged, origin, chunks);
  red["pen"] =
      pen_json(plot::merged_pen(joint_width),
               fmt::format("{} merged: joints removed", plot::counted(cut.slivers.merged, "sliver")));

  const std::string file = std::filesystem::path(model.file).filename().string();
  const json section = {{"title", model.title.empty() ? file : model.title},
                        {"file", file},
                        {"text", model.text},
                        {"report", report},
                        {"origin", {origin.x, origin.y}},
                        {"shapes",
                         {{"blocks", shapes.id.size()},
                          {"corners", shapes.corner.size()},
                          {"data", chunks.add(packed(shapes))}}},
                        {"blocks", blocks_json(layout, rows, chunks)},
                        {"kinds", kBlockKinds},
                        {"materials", named_lines(model.materials)},
                        {"groups", groups},
                        {"joints", named_lines(model.joints)},
                        {"default_joint", layout.default_joint},
                        {"pairs", pairs},
                        {"edges", edges_json(layout, chunks)},
                        {"origins", origins_json(model, cut, layout)},
                        {"layers", layers_json(model, cut, layout, joint_width)},
                        {"dead_ends", dead},
                        {"merged", red},
                        {"conditions", conditions_json(model, layout, view)},
                        {"monitors", monitors_json(model)},
                        {"things", things_json(model, cut, layout)},
                        {"tints", tints_json(model, cut, layout)}};
  const json index = {
      {"program", fmt::format("talus {}", kVersion)}, {"words", words_of_results()}, {"section", section}};
  return filled_page(page, chunks, index);
}

}  // namespace talus::report
