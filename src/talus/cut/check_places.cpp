#include "talus/cut/check_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/text.h"
#include "talus/cut/selection.h"

namespace talus {

namespace {

// Two supports that hold one corner along one axis must ask for the same motion.
void check_contradictions(const Model& model, const Layout& layout, Findings& findings) {
  std::map<std::pair<int, int>, std::vector<const SupportInput*>> holders;
  for (const SupportInput& s : model.supports)
    for (const SelectedCorner& c : selected_corners(layout, s))
      if (c.vertex >= 0) holders[{c.block, c.vertex}].push_back(&s);
  const auto differ = [](const Motion& p, const Motion& q) {
    const bool both = p.kind != Motion::kFree && q.kind != Motion::kFree;
    return both && (p.kind != q.kind || p.history != q.history);
  };
  for (const auto& [corner, list] : holders) {
    for (size_t i = 0; i < list.size(); ++i) {
      for (size_t j = i + 1; j < list.size(); ++j) {
        const SupportInput &first = *list[i], &other = *list[j];
        if ((!differ(first.x, other.x) && !differ(first.y, other.y)) || !first.meets(other)) continue;
        findings.error(
            other.where, "support." + other.name,
            fmt::format("moves a corner of \"{}\" otherwise than support \"{}\" does",
                        layout.blocks[corner.first].name, first.name),
            "make one of them \"free\" along that axis, shorten it, or let them act in different stages");
        return;
      }
    }
  }
}

// Whether the line and the block that a place names exist.
bool names_exist(const Layout& layout, const Selection& place, const Where& where, const std::string& path,
                 const std::string& key, Findings& findings) {
  if (!place.along.empty() &&
      std::find(layout.origins.begin(), layout.origins.end(), place.along) == layout.origins.end()) {
    const std::string near = closest_name(place.along, layout.origins);
    findings.error(where, path + "." + key,
                   fmt::format("there is no side, opening, fault or joint set called \"{}\"", place.along),
                   !near.empty()            ? fmt::format("did you mean \"{}\"?", near)
                   : layout.origins.empty() ? "the file has no [[region]]"
                                            : fmt::format("there is {}", join_or(layout.origins)));
    return false;
  }
  if (!place.block.empty() && layout.blocks_called(place.block).empty()) {
    unknown_block(layout, place.block, place.where_block, path + ".block", findings);
    return false;
  }
  return true;
}

void check_corners(const Layout& layout, const Selection& place, const Where& where, const std::string& path,
                   Findings& findings) {
  if (!names_exist(layout, place, where, path, "along", findings)) return;
  if (!selected_corners(layout, place).empty()) return;
  findings.error(where, path,
                 !place.along.empty() ? fmt::format("no block edge is left along \"{}\"", place.along)
                 : place.is_edge      ? "no block edge lies on the segment"
                                      : "the point lies on no block",
                 !place.along.empty() ? "see with talus cut which edges there are"
                 : place.is_edge      ? "give a segment along block edges, corners included"
                                      : "give a point of a block");
}

void check_edges(const Layout& layout, const Selection& place, const Where& where, const std::string& path,
                 const std::string& key, Findings& findings) {
  if (!place.is_edge && place.along.empty()) return;  // told by the reader
  if (!names_exist(layout, place, where, path, key, findings)) return;
  const OuterEdges outer = outer_edges(layout, place);
  if (outer.partly.block >= 0) {
    const auto name = [&layout](int b) { return layout.blocks[b].name; };
    findings.error(
        where, path,
        fmt::format("an edge of \"{}\" from ({:g}, {:g}) to ({:g}, {:g}) is covered in part by \"{}\"",
                    name(outer.partly.block), outer.partly.from.x, outer.partly.from.y, outer.partly.to.x,
                    outer.partly.to.y, name(outer.covered_by)),
        "cut the block where the other one ends, or choose other edges with block = \"NAME\"");
    return;
  }
  if (!outer.edges.empty()) return;
  const bool inside = !selected_edges(layout, place).empty();
  findings.error(where, path,
                 inside                 ? "every edge there has a block on its other side"
                 : !place.along.empty() ? fmt::format("no block edge is left along \"{}\"", place.along)
                                        : "no block edge lies on the segment",
                 inside ? "choose edges at the outside of the model or of an opening taken out"
                 : !place.along.empty() ? "see with talus cut which edges there are"
                                        : "give a segment along whole block edges");
}

void check_load(const Layout& layout, const LoadInput& l, Findings& findings) {
  const std::string path = "load." + l.name;
  if (l.has_place) {
    if (l.kind == LoadKind::kForce)
      check_corners(layout, l, l.where, path, findings);
    else
      check_edges(layout, l, l.where, path, "along", findings);
    return;
  }
  if (l.block.empty()) return;
  const std::vector<int> loaded = layout.blocks_called(l.block);
  if (loaded.empty()) unknown_block(layout, l.block, l.where, path + ".block", findings);
  const auto held = [&](int i) {
    const BlockKind kind = layout.blocks[i].kind;
    return kind == BlockKind::kFixed || kind == BlockKind::kDriven;
  };
  if (!loaded.empty() && std::all_of(loaded.begin(), loaded.end(), held))
    findings.warning(l.where, path + ".block",
                     fmt::format("\"{}\" is fixed or driven: the load has no effect", l.block));
}

// Every block is excavated once, and what changes is there and not excavated.
void check_stages(const Model& model, const Layout& layout, Findings& findings) {
  std::map<int, const StageInput*> gone;
  for (int k = 0; k < count_of(model.stages); ++k) {
    const StageInput& stage = model.stages[k];
    for (const std::string& name : stage.excavate) {
      const std::vector<int> called = layout.blocks_called(name);
      const std::string path = "stage." + stage.name + ".excavate";
      if (called.empty()) unknown_block(layout, name, stage.where_excavate, path, findings);
      for (const int i : called) {
        const auto [it, fresh] = gone.insert({i, &stage});
        if (fresh) continue;
        findings.error(stage.where_excavate, path,
                       fmt::format("takes out \"{}\" of \"{}\", which stage \"{}\" has taken out already",
                                   layout.blocks[i].name, name, it->second->name),
                       "name every group and block once");
        break;
      }
    }
    for (const ChangeInput& c : model.changes) {
      if (c.stage != k || c.block.empty()) continue;
      const std::vector<int> called = layout.blocks_called(c.block);
      if (called.empty()) unknown_block(layout, c.block, c.where, "change.block", findings);
      for (const int i : called) {
        const BlockKind kind = layout.blocks[i].kind;
        const std::string block = layout.blocks[i].name;
        if (gone.count(i))
          findings.error(c.where, "change.block", fmt::format("\"{}\" is excavated by then", block),
                         "leave it out of the change");
        else if (c.kind != ChangeInput::kSame && (kind == BlockKind::kFixed || kind == BlockKind::kDriven))
          findings.error(c.where, "change.kind",
                         fmt::format("\"{}\" is fixed or driven from the start", block),
                         "start with a deformable or rigid block and fix it in the first stage");
        else if (c.material >= 0 && kind == BlockKind::kDeformable &&
                 std::isnan(model.materials[c.material].young + model.materials[c.material].poisson))
          findings.error(c.where, "change.material",
                         fmt::format("\"{}\" deforms, and material \"{}\" has no young or poisson", block,
                                     model.materials[c.material].name),
                         "give both in its section");
        else
          continue;
        break;
      }
    }
  }
  if (gone.size() == layout.blocks.size() && !gone.empty())
    findings.error(model.stages.back().where, "stage.excavate", "no block is left");
}

}  // namespace

void check_places(const Model& model, const Layout& layout, Findings& findings) {
  TALUS_ASSERT(layout.sound && !layout.blocks.empty());
  for (const LoadInput& l : model.loads) check_load(layout, l, findings);
  check_contradictions(model, layout, findings);
  check_stages(model, layout, findings);
  for (const SupportInput& s : model.supports)
    check_corners(layout, s, s.where, "support." + s.name, findings);
  for (const BoundaryInput& b : model.boundaries) {
    const std::string path = "boundary." + b.name;
    check_edges(layout, b, b.where, path, "along", findings);
    if (entry(b.kind).two_sided)
      check_edges(layout, b.opposite, b.where_opposite, path, b.opposite.along.empty() ? "to_edge" : "to",
                  findings);
  }
}

Layout checked_layout(const Model& model, const Cut& cut, Findings& findings) {
  Layout layout = make_layout(model, cut, findings);
  if (layout.sound && !layout.blocks.empty()) check_places(model, layout, findings);
  return layout;
}

Layout checked_layout(const Model& model, Findings& findings) {
  return checked_layout(model, cut_or_read(model, findings), findings);
}

}  // namespace talus
