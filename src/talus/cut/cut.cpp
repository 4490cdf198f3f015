#include "talus/cut/cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "talus/cut/slivers.h"
#include "talus/geometry/arrangement.h"

namespace talus {

namespace {

// Noding moves lines by less than a cell of the grid: a face within this many cells of a region belongs to
// it.
constexpr double kNear = 2;

// A cut through a hole may meet another hole; each round opens at least one.
constexpr int kMostRounds = 1000;

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
    if (extent / out.grid > 0x1p46) {
      findings_.error(model_.cut.where, "cut.grid",
                      fmt::format("{:.3g} m is too fine for a model of {:.3g} m", out.grid, extent),
                      "coordinates have no digits left for it: give a wider grid or leave it out");
      return {};
    }
    if (extent / out.grid < 1e4)
      findings_.warning(model_.cut.where, "cut.grid",
                        fmt::format("{:.3g} m is coarse for a model of {:.3g} m", out.grid, extent),
                        "corners move by up to half of it");
    // places relative to a corner of the grid near the middle: all digits for the noding
    const Vec2 middle = 0.5 * (box.min + box.max);
    origin_ = {std::round(middle.x / out.grid) * out.grid, std::round(middle.y / out.grid) * out.grid};

    const Arrangement net = arrange_without_holes(out);
    take_over(net, out);
    std::vector<bool> removed;
    for (const OpeningInput& o : model_.openings) {
      out.openings.push_back(o.name);
      removed.push_back(!o.kept);
    }
    out.blocks = out.whole;
    treat_slivers(model_.cut, removed, out);
    const auto is_out = [&](const CutBlock& b) {
      return b.opening >= 0 && removed[static_cast<size_t>(b.opening)];
    };
    const size_t before = out.blocks.size();
    out.blocks.erase(std::remove_if(out.blocks.begin(), out.blocks.end(), is_out), out.blocks.end());
    out.taken_out = static_cast<int>(before - out.blocks.size());
    check_use(out);
    return out;
  }

 private:
  // Faces with holes are no blocks: a level cut through the middle of each hole, from side to side of its
  // face.
  Arrangement arrange_without_holes(Cut& out) {
    std::vector<Polyline> lines;
    for (const Trace& t : traces_.traces) lines.push_back(t.line);
    int construction = -1;
    for (int round = 0; round < kMostRounds; ++round) {
      Arrangement net = arrange(lines, out.grid, origin_);
      const size_t before = lines.size();
      for (const auto& rings : net.rings_of_holed) {
        const auto cuts = level_cuts(rings);
        if (regions_.region_at(0.5 * (cuts[0].first + cuts[0].second), kNear * out.grid) < 0)
          continue;  // no rock
        if (construction < 0) {
          construction = static_cast<int>(traces_.origins.size());
          traces_.origins.push_back({"(construction)", OriginKind::kConstruction, model_.bonded_joint});
        }
        for (const auto& [a, b] : cuts) {
          lines.push_back({a, b});
          traces_.traces.push_back({{a, b}, construction});
        }
        ++out.bridges;
      }
      if (lines.size() == before) return net;
    }
    throw std::runtime_error("blocks with holes could not be opened by cuts");
  }

  // Pieces inside the face of the level line through the middle of its first hole.
  static std::vector<std::pair<Vec2, Vec2>> level_cuts(const std::vector<Polyline>& rings) {
    const Box hole = bounding_box(rings[1]);
    const double y = 0.5 * (hole.min.y + hole.max.y);
    std::vector<double> x;
    for (const Polyline& ring : rings) {
      for (size_t k = 0; k < ring.size(); ++k) {
        const Vec2 a = ring[k], b = ring[(k + 1) % ring.size()];
        if ((a.y > y) != (b.y > y)) x.push_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
      }
    }
    std::sort(x.begin(), x.end());
    std::vector<std::pair<Vec2, Vec2>> cuts;
    for (size_t k = 0; k + 1 < x.size(); k += 2) cuts.push_back({{x[k], y}, {x[k + 1], y}});
    return cuts;
  }

  void take_over(const Arrangement& net, Cut& out) {
    out.regions = regions_.list();
    out.origins = traces_.origins;
    out.joint_sets = std::move(traces_.joint_sets);
    out.point = net.point;
    out.edge = net.edge;
    for (const int line : net.edge_source)
      out.edge_origin.push_back(traces_.traces[static_cast<size_t>(line)].origin);
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
      for (size_t o = 0; o < opening_boxes.size(); ++o) {
        const Box& box = opening_boxes[o];
        if (inside.x >= box.min.x && inside.x <= box.max.x && inside.y >= box.min.y &&
            inside.y <= box.max.y && contains(model_.openings[o].polygon, inside))
          b.opening = static_cast<int>(o);
      }
      b.id = static_cast<int>(out.whole.size());
      out.whole.push_back(std::move(b));
    }
  }

  // Openings that hold no rock are a mistake.
  void check_use(const Cut& out) {
    std::vector<bool> used(model_.openings.size(), false);
    for (const CutBlock& b : out.whole)
      if (b.opening >= 0) used[static_cast<size_t>(b.opening)] = true;
    for (size_t o = 0; o < used.size(); ++o)
      if (!used[o])
        findings_.error(model_.openings[o].where, "opening." + model_.openings[o].name,
                        "lies outside every region", "move it, or extend a region");
  }

  const Model& model_;
  Findings& findings_;
  RegionMap regions_;
  TraceSet traces_;
  Vec2 origin_;
};

}  // namespace

Polygon Cut::polygon(const CutBlock& block) const {
  Polygon out;
  out.reserve(block.point.size());
  for (const int p : block.point) out.push_back(point[static_cast<size_t>(p)]);
  return out;
}

std::string Cut::name(const CutBlock& block) const {
  const std::string& group = block.opening >= 0 ? openings[static_cast<size_t>(block.opening)]
                                                : regions[static_cast<size_t>(block.region)].name;
  return fmt::format("{}[{}]", group, block.id);
}

Cut cut_model(const Model& model, Findings& findings) {
  if (model.regions.empty() && model.arches.empty()) return {};
  const int errors = findings.error_count();
  Cutter cutter(model, findings);
  if (findings.error_count() > errors) return {};
  return cutter.cut();
}

}  // namespace talus
