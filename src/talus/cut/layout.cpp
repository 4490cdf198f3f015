#include "talus/cut/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/memory.h"
#include "talus/base/text.h"
#include "talus/cut/blocks_file.h"
#include "talus/cut/expected.h"
#include "talus/geometry/polygon_check.h"

namespace talus {

BlockShape::BlockShape() = default;
BlockShape::BlockShape(const BlockShape&) = default;
BlockShape::BlockShape(BlockShape&&) noexcept = default;
BlockShape& BlockShape::operator=(const BlockShape&) = default;
BlockShape& BlockShape::operator=(BlockShape&&) noexcept = default;
BlockShape::~BlockShape() = default;

Layout::Layout() = default;
Layout::Layout(const Layout&) = default;
Layout::Layout(Layout&&) noexcept = default;
Layout& Layout::operator=(const Layout&) = default;
Layout& Layout::operator=(Layout&&) noexcept = default;
Layout::~Layout() = default;

namespace {

// Overlap smaller than this share of the smaller block is round-off of the coordinates, not a mistake.
constexpr double kOverlapShare = 1e-9;

// Lengths below this share of the model's size are the same point.
constexpr double kPointShare = 1e-9;

void add_grid(const GridInput& g, int group, Layout& layout) {
  // corners from one formula, so that neighbours share them to the last bit
  const auto x = [&g](int i) {
    return i == g.columns ? g.max.x : g.min.x + (g.max.x - g.min.x) * i / g.columns;
  };
  const auto y = [&g](int j) { return j == g.rows ? g.max.y : g.min.y + (g.max.y - g.min.y) * j / g.rows; };
  const Vec2 middle = 0.5 * (g.min + g.max);
  const auto add = [&](std::string name, Polygon polygon) {
    BlockShape b;
    b.name = std::move(name);
    b.id = count_of(layout.blocks);
    b.group = group;
    b.polygon = std::move(polygon);
    if (g.place.is_given())
      for (Vec2& p : b.polygon) p = g.place.apply(p, middle);
    b.material = g.material;
    b.kind = g.kind;
    b.velocity = g.velocity;
    layout.blocks.push_back(std::move(b));
  };
  for (int j = 0; j < g.rows; ++j) {
    for (int i = 0; i < g.columns; ++i) {
      const Vec2 a{x(i), y(j)}, b{x(i + 1), y(j)}, c{x(i + 1), y(j + 1)}, d{x(i), y(j + 1)};
      if (g.pattern == GridPattern::kRectangles) {
        add(fmt::format("{}[{},{}]", g.name, i, j), {a, b, c, d});
      } else {
        const Vec2 center = 0.5 * (a + c);
        const Vec2 corner[4] = {a, b, c, d};
        for (int k = 0; k < 4; ++k)
          add(fmt::format("{}[{},{},{}]", g.name, i, j, k), {corner[k], corner[(k + 1) % 4], center});
      }
    }
  }
}

// Blocks of a mesh, with a group for it and one for each of its physical surfaces; edges are named after
// their curve, or the mesh.
void add_mesh(const Model& model, const MeshInput& m, Layout& layout) {
  const int first_group = count_of(layout.groups);
  const int first_origin = count_of(layout.origins);
  layout.groups.push_back(m.name);
  for (const std::string& group : m.mesh.surface_groups) {
    layout.mesh_of[count_of(layout.groups)] = first_group;
    layout.groups.push_back(m.name + "-" + group);
  }
  layout.group_where.resize(layout.groups.size(), m.where);
  layout.origins.push_back(m.name);
  layout.origins.insert(layout.origins.end(), m.mesh.curve_groups.begin(), m.mesh.curve_groups.end());
  std::map<std::pair<int, int>, int> curve_of;
  for (const MeshEdge& e : m.mesh.edges) curve_of[std::minmax(e.from, e.to)] = e.group;
  const int between = m.joint >= 0 ? m.joint : model.bonded_joint;
  std::map<std::pair<int, int>, int> users;  // elements along each edge
  for (const MeshElement& e : m.mesh.elements)
    for (int k = 0; k < e.corners; ++k) ++users[std::minmax(e.at(k), e.at(k + 1))];
  for (size_t i = 0; i < m.mesh.elements.size(); ++i) {
    const MeshElement& e = m.mesh.elements[i];
    BlockShape b;
    b.name = fmt::format("{}[{}]", m.name, i);
    b.id = count_of(layout.blocks);
    b.group = first_group + 1 + e.group;
    b.polygon = m.polygon(e);
    b.material = e.group < 0 ? m.material : m.group_material[e.group];
    b.kind = m.kind;
    for (int k = 0; k < e.corners; ++k) {
      const std::pair<int, int> ends = std::minmax(e.at(k), e.at(k + 1));
      const auto curve = curve_of.find(ends);
      const int joint = curve == curve_of.end() ? -1 : m.curve_joint[curve->second];
      b.edge_origin.push_back(first_origin + (curve == curve_of.end() ? 0 : 1 + curve->second));
      // the outside meets other bodies, as that of a region does
      b.edge_joint.push_back(joint >= 0 ? joint : users.at(ends) > 1 ? between : model.default_joint);
    }
    layout.blocks.push_back(std::move(b));
  }
}

void add_cut(const Model& model, const Cut& cut, Layout& layout) {
  layout.first_cut_group = count_of(layout.groups);
  layout.touching = 2 * cut.grid;
  const int first_origin = count_of(layout.origins);
  for (const Origin& o : cut.origins) layout.origins.push_back(o.name);
  const auto add_group = [&](const std::string& name, const Where& where) {
    layout.groups.push_back(name);
    layout.group_where.push_back(where);
  };
  for (const RegionInput& r : model.regions) add_group(r.name, r.where);
  for (const ArchInput& a : model.arches) add_group(a.name, a.where);
  for (const OpeningInput& o : model.openings) add_group(o.name, o.where);
  const int first_id = count_of(layout.blocks);
  for (BlockShape& shape : shapes_of(model, cut, cut.blocks)) {
    shape.id += first_id;
    shape.group += layout.first_cut_group;
    for (int& origin : shape.edge_origin) origin += first_origin;
    layout.blocks.push_back(std::move(shape));
  }
}

// Of pairs of blocks whose boxes meet; stops when nobody would read on.
void check_overlaps_of(const std::vector<std::pair<int, int>>& pairs, const std::vector<Box>& boxes,
                       const Layout& layout, Findings& findings) {
  constexpr int kEnough = 100;
  std::set<std::pair<int, int>> told;  // groups; one place of a cut region is enough
  int found = 0;
  for (const auto& [i, j] : pairs) {
    if (found == kEnough) return;
    const BlockShape &a = layout.blocks[i], &b = layout.blocks[j];
    const bool cut_a = layout.was_cut(a), cut_b = layout.was_cut(b);
    const bool in_mesh = a.group >= layout.first_mesh_group && !cut_a;  // from outside: anything may be wrong
    if ((a.group == b.group && !in_mesh) || (cut_a && cut_b)) continue;  // these share their corners exactly
    const Overlap overlap = polygon_overlap(a.polygon, b.polygon);
    const double smaller = std::min(signed_area(a.polygon), signed_area(b.polygon));
    // sides of cut blocks lie on the grid, not exactly where they were drawn
    const double rounding = cut_a || cut_b ? layout.touching * norm(boxes[j].max - boxes[j].min) : 0;
    if (overlap.area <= kOverlapShare * smaller + rounding) continue;
    if ((cut_a || cut_b) && !told.insert(std::minmax(a.group, b.group)).second) continue;
    ++found;
    findings.error(layout.group_where[b.group], b.name,
                   fmt::format("overlaps \"{}\" by {:.3g} m2 around ({:.6g}, {:.6g})", a.name, overlap.area,
                               overlap.at.x, overlap.at.y),
                   "blocks may touch but not share area; move or trim one of them");
  }
}

void check_overlaps(const Layout& layout, Findings& findings) {
  std::vector<Box> boxes;
  for (const BlockShape& b : layout.blocks) boxes.push_back(bounding_box(b.polygon));
  // blocks that share no area have a handful of neighbours: where there are far more, the first show it
  const SomePairs first = some_close_pairs(boxes, 0, 50 * boxes.size() + 10000);
  const int errors = findings.error_count();
  check_overlaps_of(first.pairs, boxes, layout, findings);
  if (!first.all && findings.error_count() == errors)
    check_overlaps_of(close_pairs(boxes, 0), boxes, layout, findings);
}

double model_size(const Layout& layout) {
  Box all = bounding_box(layout.blocks[0].polygon);
  for (const BlockShape& b : layout.blocks) {
    const Box box = bounding_box(b.polygon);
    all.min = {std::min(all.min.x, box.min.x), std::min(all.min.y, box.min.y)};
    all.max = {std::max(all.max.x, box.max.x), std::max(all.max.y, box.max.y)};
  }
  return norm(all.max - all.min);
}

}  // namespace

int Layout::joint_of_pair(int group_a, int group_b) const {
  const auto it = pair_joint.find(std::minmax(group_a, group_b));
  return it == pair_joint.end() ? kNoPair : it->second;
}

int Layout::joint_at(BlockEdge at_a, BlockEdge at_b) const {
  const BlockShape &a = blocks[at_a.block], &b = blocks[at_b.block];
  const int pair = joint_of_pair(a.group, b.group);
  return pair != kNoPair ? pair : joint_by_edges(at_a, at_b);
}

int Layout::joint_by_edges(BlockEdge at_a, BlockEdge at_b) const {
  const BlockShape &a = blocks[at_a.block], &b = blocks[at_b.block];
  const auto own = [](const BlockShape& shape, int edge) { return edge >= 0 && !shape.edge_joint.empty(); };
  const bool has_a = own(a, at_a.edge), has_b = own(b, at_b.edge);
  if (has_a && (!has_b || at_a.block < at_b.block)) return a.edge_joint[at_a.edge];
  if (has_b) return b.edge_joint[at_b.edge];
  return default_joint;
}

// Theory 1.7.
int Layout::joint_at_corner(BlockCorner corner, BlockEdge on) const {
  const int at_edge = joint_at({corner.block, -1}, on);
  const BlockShape& a = blocks[corner.block];
  const auto is_glued = [this](int joint) { return joint >= 0 && !glued.empty() && glued[joint]; };
  if (!is_glued(at_edge) || joint_of_pair(a.group, blocks[on.block].group) != kNoPair) return at_edge;
  const size_t v = corner.corner;
  if (!a.edge_joint.empty())
    for (const size_t edge : {v, v == 0 ? a.edge_joint.size() - 1 : v - 1})
      if (!is_glued(a.edge_joint[edge])) return a.edge_joint[edge];
  return is_glued(default_joint) || default_joint < 0 ? at_edge : default_joint;
}

int Layout::find_group(const std::string& name) const {
  const auto it = std::find(groups.begin(), groups.end(), name);
  return it == groups.end() ? -1 : static_cast<int>(it - groups.begin());
}

std::vector<int> Layout::groups_called(const std::string& name) const {
  const int group = find_group(name);
  if (group < 0) return {};
  std::vector<int> list{group};
  for (const auto& [surface, mesh] : mesh_of)
    if (mesh == group) list.push_back(surface);
  return list;
}

std::vector<int> Layout::blocks_called(const std::string& name) const {
  const std::vector<int> called = groups_called(name);
  std::vector<int> list;
  for (int i = 0; i < count_of(blocks); ++i)
    if (std::find(called.begin(), called.end(), blocks[i].group) != called.end() || blocks[i].name == name)
      list.push_back(i);
  return list;
}

void unknown_block(const Layout& layout, const std::string& name, const Where& where, const std::string& path,
                   Findings& findings) {
  if (name.empty()) return;  // told by the reader
  if (layout.find_group(name) >= 0) {
    findings.error(where, path, fmt::format("\"{}\" has no block left", name),
                   "its rock is taken out, or another region or opening covers it");
    return;
  }
  std::vector<std::string> names = layout.groups;
  for (const BlockShape& b : layout.blocks) names.push_back(b.name);
  const std::string near = closest_name(name, names);
  findings.error(where, path, fmt::format("there is no block, grid or region called \"{}\"", name),
                 near.empty() ? "" : fmt::format("did you mean \"{}\"?", near));
}

namespace {

// Whether the corners of each block have digits for its shape where they lie: the limit of the contact error, 1e-6 of a block
// (solver.limit), has to be more than what coordinates are rounded to.
bool check_digits(const Layout& layout, Findings& findings) {
  constexpr double kRoundedTo = 0x1p-52, kLeastDigits = 1e-6;
  std::set<int> told;
  for (const BlockShape& b : layout.blocks) {
    const Box box = bounding_box(b.polygon);
    const double size = std::max(box.max.x - box.min.x, box.max.y - box.min.y),
                 farthest = std::max(
                     {std::abs(box.min.x), std::abs(box.min.y), std::abs(box.max.x), std::abs(box.max.y)});
    if (farthest * kRoundedTo <= kLeastDigits * size || !told.insert(b.group).second) continue;
    const int group = b.group;
    findings.error(
        layout.group_where[group], layout.groups[group],
        fmt::format("block \"{}\" is {:.3g} m across where coordinates reach {:.3g} m: they have no "
                    "digits left for its shape",
                    b.name, size, farthest),
        "move the model to the origin");
  }
  return told.empty();
}

}  // namespace

Layout make_layout(const Model& model, Findings& findings) {
  return make_layout(model, cut_or_read(model, findings), findings);
}

Layout make_layout(const Model& model, const Cut& cut, Findings& findings) {
  Layout layout;
  layout.default_joint = model.default_joint;
  layout.needles_merged = cut.slivers.needles, layout.slivers_merged = cut.slivers.merged;
  layout.slivers_deleted = cut.slivers.deleted, layout.slivers_kept = cut.slivers.kept;
  if (layout.slivers_merged + layout.slivers_deleted > 0)
    findings.warning(
        model.cut.where_slivers, "cut.slivers",
        fmt::format("merges {} blocks and deletes {}", layout.slivers_merged, layout.slivers_deleted),
        "a mechanism may be hidden there: compare with \"keep\"; talus cut draws the places in red");
  for (const JointProperty& j : model.joints) layout.glued.push_back(j.bonded);
  bool sound = true;
  for (const BlockInput& in : model.blocks) {
    layout.groups.push_back(in.name);
    layout.group_where.push_back(in.where);
    const std::string defect = polygon_defect(in.polygon);
    if (!defect.empty()) {
      findings.error(in.where, "block." + in.name + ".polygon", defect);
      sound = false;
      continue;
    }
    BlockShape b;
    b.name = in.name;
    b.id = count_of(layout.blocks);
    b.group = count_of(layout.groups) - 1;
    b.polygon = in.polygon;
    b.material = in.material;
    b.kind = in.kind;
    b.velocity = in.velocity, b.spin = in.spin;
    b.motion_x = in.motion_x, b.motion_y = in.motion_y, b.motion_rotation = in.motion_rotation;
    if (signed_area(b.polygon) < 0) std::reverse(b.polygon.begin(), b.polygon.end());
    layout.blocks.push_back(std::move(b));
  }
  for (const GridInput& g : model.grids) {
    layout.groups.push_back(g.name);
    layout.group_where.push_back(g.where);
    const int group = count_of(layout.groups) - 1;
    add_grid(g, group, layout);
    layout.pair_joint[{group, group}] = g.joint;
  }
  layout.first_mesh_group = count_of(layout.groups);
  for (const MeshInput& m : model.meshes) add_mesh(model, m, layout);
  add_cut(model, cut, layout);
  for (const ContactPairInput& p : model.contact_pairs) {
    const int a = layout.find_group(p.name_a), b = layout.find_group(p.name_b);
    if (a < 0 || b < 0) {
      const std::string& name = a < 0 ? p.name_a : p.name_b;
      if (layout.blocks_called(name).empty()) {
        unknown_block(layout, name, p.where, "contact_pair.between", findings);
        continue;
      }
      findings.error(p.where, "contact_pair.between", fmt::format("\"{}\" is one block of several", name),
                     "a joint belongs to whole groups: name the grid or region");
      continue;
    }
    if (layout.pair_joint.count(std::minmax(a, b)) && a != b)
      findings.error(p.where, "contact_pair.between",
                     fmt::format("\"{}\" and \"{}\" have a joint already", p.name_a, p.name_b));
    if (a == b) findings.error(p.where, "contact_pair", "names the same group twice");
    for (const int one : layout.groups_called(p.name_a))
      for (const int other : layout.groups_called(p.name_b))
        layout.pair_joint[std::minmax(one, other)] = p.joint;
  }
  if (layout.blocks.empty() && sound)
    findings.error({1, 1, ""}, "block", "the model has no block",
                   "add a [[block]], a [[grid]], a [[mesh]] or a [[region]]");
  sound = sound && check_digits(layout, findings);
  layout.sound = sound;
  if (sound && !layout.blocks.empty()) check_overlaps(layout, findings);
  return layout;
}

Cut cut_or_read(const Model& model, Findings& findings) {
  const int errors = findings.error_count();
  check_expected(model, available_memory(), findings);
  if (findings.error_count() > errors) return {};
  return model.cut.blocks_file.empty() ? cut_model(model, findings) : read_blocks_file(model, findings);
}

double point_tolerance(const Layout& layout) { return kPointShare * model_size(layout); }

std::vector<int> blocks_at(const Layout& layout, Vec2 point, double tolerance) {
  std::vector<int> list;
  for (int i = 0; i < count_of(layout.blocks); ++i) {
    const Box box = bounding_box(layout.blocks[i].polygon);
    if (point.x < box.min.x - tolerance || point.x > box.max.x + tolerance ||
        point.y < box.min.y - tolerance || point.y > box.max.y + tolerance)
      continue;
    if (contains(layout.blocks[i].polygon, point, tolerance)) list.push_back(i);
  }
  return list;
}

int block_of_point(const Layout& layout, Vec2 point) {
  const std::vector<int> blocks = blocks_at(layout, point, point_tolerance(layout));
  return blocks.empty() ? -1 : blocks.front();
}

}  // namespace talus
