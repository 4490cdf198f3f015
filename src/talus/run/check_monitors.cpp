#include "talus/run/check_monitors.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "talus/base/text.h"

namespace talus {

namespace {

void check_point(const Layout& layout, Vec2 point, const Where& where, const std::string& path,
                 Findings& findings) {
  if (block_of_point(layout, point) >= 0) return;
  double nearest = std::numeric_limits<double>::infinity();
  std::string name;
  for (const BlockShape& b : layout.blocks) {
    for (size_t i = 0; i < b.polygon.size(); ++i) {
      const double d = distance_to_segment(point, b.polygon[i], b.polygon[(i + 1) % b.polygon.size()]);
      if (d < nearest) nearest = d, name = b.name;
    }
  }
  findings.error(where, path, fmt::format("({:g}, {:g}) lies outside every block", point.x, point.y),
                 fmt::format("the nearest block, \"{}\", is {:.3g} m away", name, nearest));
}

// A point of a block that a stage takes out tells nothing from then on.
void warn_of_dug(const Model& model, const Layout& layout, Vec2 point, const Where& where,
                 const std::string& path, Findings& findings) {
  const int block = block_of_point(layout, point);
  if (block < 0) return;
  for (const StageInput& stage : model.stages)
    for (const std::string& name : stage.excavate) {
      const std::vector<int> out = layout.blocks_called(name);
      if (std::find(out.begin(), out.end(), block) == out.end()) continue;
      findings.warning(
          where, path,
          fmt::format(
              "({:g}, {:g}) lies in block \"{}\", which stage \"{}\" takes out: it tells nothing from then on",
              point.x, point.y, layout.blocks[block].name, stage.name),
          "to follow the rock that stays, move the point a little into it");
      return;
    }
}

// What a monitor is relative to: a support, a free field, or blocks.
void check_reference(const Model& model, const Layout& layout, const MonitorInput& m, Findings& findings) {
  for (const SupportInput& s : model.supports)
    if (s.name == m.relative_to) return;
  for (const BoundaryInput& b : model.boundaries)
    if (b.name == m.relative_to && b.kind == BoundaryKind::kFreeField) return;
  if (!layout.blocks_called(m.relative_to).empty()) return;
  std::vector<std::string> names = layout.groups;
  for (const SupportInput& s : model.supports) names.push_back(s.name);
  for (const BoundaryInput& b : model.boundaries)
    if (b.kind == BoundaryKind::kFreeField) names.push_back(b.name);
  const std::string near = closest_name(m.relative_to, names);
  findings.error(
      m.where_relative, "monitor." + m.name + ".relative_to",
      fmt::format("there is no support, free-field boundary or block called \"{}\"", m.relative_to),
      near.empty() ? fmt::format("there is {}", join_or(names)) : fmt::format("did you mean \"{}\"?", near));
}

}  // namespace

void check_monitors(const Model& model, const Layout& layout, Findings& findings) {
  if (!layout.sound || layout.blocks.empty()) return;
  for (const MonitorInput& m : model.monitors) {
    const std::string path = "monitor." + m.name;
    const bool of_two = m.kind == MonitorKind::kConvergence || m.kind == MonitorKind::kCrack;
    if (m.kind == MonitorKind::kPoint || of_two) check_point(layout, m.point, m.where, path, findings);
    if (of_two) check_point(layout, m.other, m.where, path, findings);
    if (m.kind == MonitorKind::kPoint || of_two) warn_of_dug(model, layout, m.point, m.where, path, findings);
    if (of_two) warn_of_dug(model, layout, m.other, m.where, path, findings);
    if (m.kind == MonitorKind::kCentroid && layout.blocks_called(m.target_a).empty())
      unknown_block(layout, m.target_a, m.where, path, findings);
    for (const Vec2 point : m.relative_to_points)
      check_point(layout, point, m.where_relative, path, findings);
    if (!m.relative_to.empty()) check_reference(model, layout, m, findings);
    if (m.kind == MonitorKind::kBlock) {
      const std::vector<int> called = layout.blocks_called(m.target_a);
      if (called.empty()) unknown_block(layout, m.target_a, m.where, path, findings);
      if (called.size() > 1)
        findings.error(
            m.where, path, fmt::format("\"{}\" is {} blocks, not one", m.target_a, called.size()),
            fmt::format("name one of its blocks, for example \"{}\"", layout.blocks[called[0]].name));
    }
    if (m.kind == MonitorKind::kContact && m.target_a == m.target_b && !m.target_a.empty())
      findings.error(m.where, path, fmt::format("names \"{}\" twice", m.target_a),
                     "name the two partners of the contact");
    if (m.kind == MonitorKind::kContact) {
      for (const std::string& name : {m.target_a, m.target_b})
        if (layout.blocks_called(name).empty()) unknown_block(layout, name, m.where, path, findings);
    }
  }
}

}  // namespace talus
