#include "talus/cut/cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/cut/slivers.h"
#include "talus/geometry/arrangement.h"

namespace talus {

namespace {

// Noding moves lines by less than a cell of the grid: a face within this many cells of a region belongs to
// it.
constexpr double kNear = 2;

class Cutter {
 public:
  Cutter(const Model& model, Findings& findings)
      : model_(model),
        findings_(findings),
        regions_(model),
        traces_(make_traces(model, regions_, findings)) {}

  Cut cut() {
    Cut out;
    const Box box = regions_.box();
    const double extent = std::max(box.max.x - box.min.x, box.max.y - box.min.y);
    out.grid = grid_width(extent, model_.cut.grid);
    const double farthest =
        std::max({std::abs(box.min.x), std::abs(box.min.y), std::abs(box.max.x), std::abs(box.max.y)});
    if (extent / out.grid > 0x1p46 || farthest / out.grid > 0x1p53) {
      findings_.error(
          model_.cut.where_grid, "cut.grid",
          fmt::format("{:.3g} m is too fine for a model of {:.3g} m whose coordinates reach {:.3g} m",
                      out.grid, extent, farthest),
          "coordinates have no digits left for it: give a wider grid, or move the model to the origin");
      return {};
    }
    // corners that are two cells apart stay apart
    if (!(extent / out.grid >= 2)) {
      findings_.error(
          model_.cut.where_grid, "cut.grid",
          fmt::format("{:.3g} m is coarser than a model of {:.3g} m: all of it would be one point",
                      model_.cut.grid, extent),
          "leave it out, or give a thousandth of the smallest block");
      return {};
    }
    if (extent / out.grid < 1e4)
      findings_.warning(model_.cut.where_grid, "cut.grid",
                        fmt::format("{:.3g} m is coarse for a model of {:.3g} m", out.grid, extent),
                        "corners move by up to half of it");
    // places relative to a corner of the grid near the middle: all digits for the noding
    const Vec2 middle = 0.5 * (box.min + box.max);
    origin_ = {std::round(middle.x / out.grid) * out.grid, std::round(middle.y / out.grid) * out.grid};

    const Arrangement net = arrange_without_holes(out);
    take_over(net, out);
    name_outline(out);
    for (const OpeningInput& o : model_.openings) out.openings.push_back(o.name);
    check_use(out);
    return with_slivers(model_, std::move(out));
  }

 private:
  // Faces with holes are no blocks: they are opened by glued cuts, whose origin comes last.
  Arrangement arrange_without_holes(Cut& out) {
    std::vector<Polyline> lines;
    for (const Trace& t : traces_.traces) lines.push_back(t.line);
    Arrangement net = arrange(lines, out.grid, origin_,
                              [&](Vec2 p) { return regions_.region_at(p, kNear * out.grid) >= 0; });
    out.bridges = net.opened;
    if (net.cuts.empty()) return net;
    const int construction = count_of(traces_.origins);
    traces_.origins.push_back({"(construction)", OriginKind::kConstruction, model_.bonded_joint});
    for (const Polyline& line : net.cuts) traces_.traces.push_back({line, construction});
    return net;
  }

  void take_over(const Arrangement& net, Cut& out) {
    out.regions = regions_.list();
    out.origins = traces_.origins;
    out.joint_sets = std::move(traces_.joint_sets);
    out.surveys = std::move(traces_.surveys);
    out.point = net.point;
    out.edge = net.edge;
    out.edge_line = net.edge_source;
    for (const int line : net.edge_source) out.edge_origin.push_back(traces_.traces[line].origin);
    out.dead_ends = net.dead_ends;
    for (const Polyline& l : out.dead_ends)
      for (size_t k = 0; k + 1 < l.size(); ++k) out.dead_end_length += norm(l[k + 1] - l[k]);
    std::vector<Box> opening_boxes;
    for (const OpeningInput& o : model_.openings) opening_boxes.push_back(bounding_box(o.polygon));
    for (const Arrangement::Face& face : net.face) {
      CutBlock b;
      b.point = face.point;
      b.edge = face.edge;
      const Vec2 inside = interior_point(out.polygon(b));
      b.region = regions_.region_at(inside, kNear * out.grid);
      if (b.region < 0) continue;  // between regions
      for (int o = 0; o < count_of(opening_boxes); ++o) {
        const Box& box = opening_boxes[o];
        if (inside.x >= box.min.x && inside.x <= box.max.x && inside.y >= box.min.y &&
            inside.y <= box.max.y && contains(model_.openings[o].polygon, inside))
          b.opening = o;
      }
      b.id = count_of(out.whole);
      out.whole.push_back(std::move(b));
    }
  }

  // An edge with a block on one side only lies on the outline, even if an opening or a fault runs along it,
  // too: supports along that side must find it.
  void name_outline(Cut& out) const {
    std::vector<int> blocks_at(out.edge.size(), 0);
    for (const CutBlock& b : out.whole)
      for (const int e : b.edge) ++blocks_at[e];
    for (size_t e = 0; e < out.edge.size(); ++e) {
      int& origin = out.edge_origin[e];
      if (blocks_at[e] != 1 || out.origins[origin].kind == OriginKind::kSide) continue;
      const Vec2 p = out.point[out.edge[e][0]], q = out.point[out.edge[e][1]];
      for (const Trace& t : traces_.traces) {
        if (out.origins[t.origin].kind != OriginKind::kSide) continue;
        if (distance_to_segment(p, t.line[0], t.line[1]) > kNear * out.grid ||
            distance_to_segment(q, t.line[0], t.line[1]) > kNear * out.grid)
          continue;
        origin = t.origin;
        break;
      }
    }
  }

  // Openings that hold no rock are a mistake.
  void check_use(const Cut& out) {
    std::vector<bool> used(model_.openings.size(), false);
    std::vector<bool> has_blocks(out.regions.size(), false);
    for (const CutBlock& b : out.whole) {
      has_blocks[b.region] = true;
      if (b.opening >= 0) used[b.opening] = true;
    }
    for (size_t r = 0; r < model_.regions.size(); ++r)
      if (!has_blocks[r])
        findings_.warning(model_.regions[r].where, "region." + model_.regions[r].name, "has no block",
                          "regions later in the file, or arches, cover it");
    for (size_t o = 0; o < used.size(); ++o)
      if (!used[o])
        findings_.error(model_.openings[o].where, "opening." + model_.openings[o].name, "holds no rock",
                        "it lies outside every region, or a later opening covers it");
  }

  const Model& model_;
  Findings& findings_;
  RegionMap regions_;
  TraceSet traces_;
  Vec2 origin_;
};

}  // namespace

Cut with_slivers(const Model& model, Cut cut) {
  cut.blocks = cut.whole;
  cut.slivers = {};
  treat_slivers(model, cut);
  const auto is_out = [&model](const CutBlock& b) {
    return b.opening >= 0 && !model.openings[b.opening].kept;
  };
  const size_t before = cut.blocks.size();
  cut.blocks.erase(std::remove_if(cut.blocks.begin(), cut.blocks.end(), is_out), cut.blocks.end());
  cut.taken_out = static_cast<int>(before - cut.blocks.size());
  return cut;
}

// Theory 10.
Cut cut_model(const Model& model, Findings& findings) {
  TALUS_ASSERT(model.shapes_readable);
  if (model.regions.empty() && model.arches.empty()) return {};
  const int errors = findings.error_count();
  Cutter cutter(model, findings);
  if (findings.error_count() > errors) return {};
  return cutter.cut();
}

}  // namespace talus
