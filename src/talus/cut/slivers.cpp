#include "talus/cut/slivers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "talus/base/index.h"
#include "talus/base/rank.h"

namespace talus {

namespace {

// A block thinner than this share of its length, or than so many cells of the grid, is a hair: its moments
// have no digits left, and the two joints along it are one.
constexpr double kThinnest = 1e-5, kHairCells = 4;

constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

struct Measure {
  double area = 0, width = 0, length = 0;
  Vec2 centroid;
};

Measure measure(const Polygon& polygon) {
  const PolygonMoments m = polygon_moments(polygon);
  const double width = polygon_width(m);
  return {m.area, width, m.area / width, m.centroid};
}

bool meet(const Box& a, const Box& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y;
}

class SliverTreatment {
 public:
  SliverTreatment(const Model& model, Cut& cut)
      : model_(model), cut_(cut), table_(cut.slivers), edge_blocks_(cut.edge.size(), {-1, -1}) {
    gone_.assign(cut.blocks.size(), false);
    for (int i = 0; i < count_of(cut.blocks); ++i) {
      const CutBlock& b = cut.blocks[i];
      judged_.push_back(b.opening < 0 || model.openings[b.opening].kept);
      measures_.push_back(measure(cut.polygon(b)));
      for (const int e : b.edge) attach(e, i);
    }
    find_openings();
  }

  void run() {
    set_limits();
    for (const Rule rule : {Rule::kHairs, Rule::kFacets, Rule::kGlued}) merge_all(rule);
    if (model_.cut.slivers == SliverPolicy::kMerge) {
      find_inside();
      merge_all(Rule::kJointSets);
    }
    wait_for(Rule::kJointSets);
    for (const auto& [area, i] : waiting_) {
      const bool remove = model_.cut.slivers == SliverPolicy::kDelete;
      note(i, remove ? SliverAction::kDeleted : SliverAction::kKept, -1);
      if (remove) gone_[i] = true;
    }
    finish();
  }

 private:
  enum class Rule { kHairs, kFacets, kGlued, kJointSets };

  // ------------------------------------------------------------------------------------------ what is small

  void set_limits() {
    const CutInput& in = model_.cut;
    for (int r = 0; r < count_of(cut_.regions); ++r) {
      std::vector<double> areas, widths;
      // of the rock outside openings: limits must not depend on what is taken out
      for (const bool everywhere : {false, true})
        for (size_t i = 0; i < measures_.size() && (!everywhere || areas.empty()); ++i)
          if (cut_.blocks[i].region == r && (everywhere || cut_.blocks[i].opening < 0))
            areas.push_back(measures_[i].area), widths.push_back(measures_[i].width);
      SliverLimits limits;
      if (!areas.empty()) limits.median_area = median(areas), limits.median_width = median(widths);
      const bool is_arch = r >= count_of(model_.regions);
      const double area = is_arch ? kUnset : model_.regions[r].sliver_area;
      const double width = is_arch ? kUnset : model_.regions[r].sliver_width;
      limits.area =
          std::max(std::isnan(area) ? in.sliver_area : area, in.sliver_area_share * limits.median_area);
      limits.width =
          std::max(std::isnan(width) ? in.sliver_width : width, in.sliver_width_share * limits.median_width);
      table_.limits.push_back(limits);
    }
  }

  const SliverLimits& limits_of(int i) const { return table_.limits[cut_.blocks[i].region]; }

  // Theory 10.3.
  bool is_sliver(int i) const {
    const Measure& m = measures_[i];
    const SliverLimits& limits = limits_of(i);
    return judged_[i] && (m.area < limits.area || m.width < limits.width || is_hair(i));
  }

  // Theory 10.3.
  bool is_hair(int i) const {
    const Measure& m = measures_[i];
    return judged_[i] && m.width < std::max(kHairCells * cut_.grid, kThinnest * m.length);
  }

  // Thin among its own kind: cells are as small as they were asked for.
  bool is_thin_cell(int i) const {
    const Measure& m = measures_[i];
    const SliverLimits& limits = limits_of(i);
    return judged_[i] && (m.area < model_.cut.sliver_area_share * limits.median_area ||
                          m.width < model_.cut.sliver_width_share * limits.median_width);
  }

  bool is_small(Rule rule, int i) const {
    switch (rule) {
      case Rule::kHairs:
        return is_hair(i);
      case Rule::kFacets:
        return judged_[i] && facet_of(i) >= 0;
      case Rule::kGlued:
        return is_thin_cell(i);
      case Rule::kJointSets:
        return is_sliver(i);
    }
    return false;
  }

  // ------------------------------------------------------------------------------------------- what is where

  void attach(int edge, int block) {
    auto& pair = edge_blocks_[edge];
    pair[pair[0] < 0 ? 0 : 1] = block;
  }
  int across(int edge, int block) const {
    const auto& pair = edge_blocks_[edge];
    return pair[0] == block ? pair[1] : pair[0];
  }

  Vec2 place(int point) const { return cut_.point[point]; }
  double length(int edge) const {
    const auto& [a, b] = cut_.edge[edge];
    return norm(place(b) - place(a));
  }
  const Origin& origin(int edge) const { return cut_.origins[cut_.edge_origin[edge]]; }

  void find_openings() {
    for (size_t k = 0; k < cut_.origins.size(); ++k) {
      opening_of_.push_back(-1);
      for (int o = 0; o < count_of(model_.openings); ++o)
        if (cut_.origins[k].kind == OriginKind::kOpening && cut_.origins[k].name == model_.openings[o].name)
          opening_of_.back() = o;
    }
  }

  // How far two outlines of one curve lie apart: each strays from it by up to the height of an arc over its
  // chord.
  double facet_height(int opening) const { return 2 * model_.openings[opening].sagitta; }

  // The opening along whose facets block i lies whole, between the arc and the chord; -1: none.
  int facet_of(int i) const {
    const CutBlock& b = cut_.blocks[i];
    std::map<int, std::vector<int>> along;
    for (const int e : b.edge) {
      const int o = opening_of_[cut_.edge_origin[e]];
      if (o >= 0 && across(e, i) >= 0 && measures_[i].width < facet_height(o)) along[o].push_back(e);
    }
    for (const auto& [o, edges] : along) {
      const double height = facet_height(o);
      bool near = true;
      for (const int p : b.point) {
        double distance = std::numeric_limits<double>::infinity();
        for (const int e : edges) {
          const auto& [from, to] = cut_.edge[e];
          distance = std::min(distance, distance_to_segment(place(p), place(from), place(to)));
        }
        near = near && distance <= height;
      }
      if (near) return o;
    }
    return -1;
  }

  // Blocks that touch no free face, opening or support, and lines that reach the outline or an opening.
  // Beyond a side with an absorbing boundary the rock goes on: it is an end of lines, but no free face
  // (theory 10.3).
  void find_inside() {
    std::vector<bool> is_free(cut_.point.size(), false), is_end(cut_.point.size(), false);
    for (int e = 0; e < count_of(cut_.edge); ++e) {
      const auto [a, b] = edge_blocks_[e];
      if (a < 0) continue;  // of no block, or merged away
      const bool is_face =
          b < 0 || origin(e).kind == OriginKind::kOpening || cut_.blocks[a].opening != cut_.blocks[b].opening;
      if (!is_face) continue;
      for (const int p : cut_.edge[e]) {
        is_end[p] = true;
        if (b >= 0 || !rock_goes_on(origin(e).name)) is_free[p] = true;
      }
    }
    for (size_t e = 0; e < cut_.edge_line.size(); ++e) {
      if (edge_blocks_[e][0] < 0) continue;
      const int line = cut_.edge_line[e];
      if (line >= count_of(reaches_)) reaches_.resize(line + 1, false);
      for (const int p : cut_.edge[e]) reaches_[line] = reaches_[line] || is_end[p];
    }
    for (size_t i = 0; i < cut_.blocks.size(); ++i) {
      const CutBlock& b = cut_.blocks[i];
      const auto touches = [&is_free](int p) { return is_free[p]; };
      inside_.push_back(std::none_of(b.point.begin(), b.point.end(), touches) && !is_held(b));
    }
  }

  bool rock_goes_on(const std::string& side) const {
    return std::any_of(model_.boundaries.begin(), model_.boundaries.end(), [&side](const BoundaryInput& b) {
      return b.along == side || (entry(b.kind).two_sided && b.opposite.along == side);
    });
  }

  // whether a support acts on the block, or so near that it may
  bool is_held(const CutBlock& b) const {
    const Box box = bounding_box(cut_.polygon(b));
    const std::string name = cut_.name(b);
    return std::any_of(model_.supports.begin(), model_.supports.end(), [&](const SupportInput& s) {
      if (!s.along.empty())
        return std::any_of(b.edge.begin(), b.edge.end(), [&](int e) { return origin(e).name == s.along; });
      if (!s.block.empty() && s.block != name && s.block + "[" != name.substr(0, s.block.size() + 1))
        return false;
      return meet(box, bounding_box(Polygon{s.from, s.is_edge ? s.to : s.from}));
    });
  }

  // -------------------------------------------------------------------------------------------- what may go

  // Theory 10.3.
  bool may_open(Rule rule, int edge, int i, int facet) const {
    const Origin& from = origin(edge);
    const bool is_glued = from.joint == model_.bonded_joint;
    switch (rule) {
      case Rule::kHairs:
        return true;
      case Rule::kFacets:
        return opening_of_[cut_.edge_origin[edge]] == facet && (from.joint < 0 || is_glued);
      case Rule::kGlued:
        return from.kind == OriginKind::kConstruction || (from.kind == OriginKind::kTessellation && is_glued);
      case Rule::kJointSets:
        return from.kind == OriginKind::kJointSet && inside_[i] && inside_[across(edge, i)] &&
               (!reaches_[cut_.edge_line[edge]] || is_named(from));
    }
    return false;
  }

  bool is_named(const Origin& from) const {
    const auto& names = model_.cut.merge_along;
    return std::find(names.begin(), names.end(), from.name) != names.end();
  }

  // ------------------------------------------------------------------------------------------- what is done

  void wait_for(Rule rule) {
    waiting_.clear();
    for (int i = 0; i < count_of(measures_); ++i)
      if (!gone_[i] && is_small(rule, i)) waiting_.insert({measures_[i].area, i});
  }

  // Smallest first; those that no neighbour can take wait until a neighbour has changed.
  void merge_all(Rule rule) {
    wait_for(rule);
    bool progress = true;
    while (progress) {
      progress = false;
      std::vector<std::pair<double, int>> stuck;
      while (!waiting_.empty()) {
        const auto [area, i] = *waiting_.begin();
        waiting_.erase(waiting_.begin());
        if (merge_one(rule, i))
          progress = true;
        else
          stuck.emplace_back(area, i);
      }
      waiting_.insert(stuck.begin(), stuck.end());
    }
  }

  bool merge_one(Rule rule, int i) {
    const CutBlock& block = cut_.blocks[i];
    const int facet = rule == Rule::kFacets ? facet_of(i) : -1;
    struct Border {
      int other = -1;
      double length = 0;
      bool may_open = true;
      bool is_named = false;  // a joint that somebody drew
    };
    std::map<int, Border> shared;
    for (const int e : block.edge) {
      const int other = across(e, i);
      if (other < 0) continue;
      const CutBlock& o = cut_.blocks[other];
      if (o.region != block.region || (o.opening != block.opening && rule != Rule::kFacets)) continue;
      Border& border = shared[other];
      border.other = other;
      border.length += length(e);
      border.may_open = border.may_open && may_open(rule, e, i, facet);
      border.is_named =
          border.is_named || origin(e).kind == OriginKind::kFault || origin(e).kind == OriginKind::kSurveyed;
    }
    std::vector<Border> order;
    for (const auto& [other, border] : shared)
      if (border.may_open) order.push_back(border);
    std::stable_sort(order.begin(), order.end(), [](const Border& x, const Border& y) {
      return x.is_named != y.is_named ? y.is_named : x.length > y.length;
    });
    for (const Border& border : order) {
      CutBlock merged;
      if (!joined(i, border.other, merged)) continue;
      merge(rule, i, border.other, std::move(merged));
      return true;
    }
    return false;
  }

  void merge(Rule rule, int i, int other, CutBlock merged) {
    waiting_.erase({measures_[other].area, other});
    note(i, rule == Rule::kJointSets ? SliverAction::kMerged : SliverAction::kNeedle, other);
    for (const int e : cut_.blocks[i].edge) {
      auto& pair = edge_blocks_[e];
      for (int& b : pair)
        if (b == i) b = other;
      if (pair[0] != pair[1]) continue;
      pair = {-1, -1};
      if (rule == Rule::kJointSets) table_.opened.push_back(e);
    }
    gone_[i] = true;
    receiver_[other] = true;
    cut_.blocks[other].point = std::move(merged.point);
    cut_.blocks[other].edge = std::move(merged.edge);
    measures_[other] = measure(cut_.polygon(cut_.blocks[other]));
    if (is_small(rule, other)) waiting_.insert({measures_[other].area, other});
  }

  // The ring around both blocks; false when it is not one simple ring.
  bool joined(int i, int j, CutBlock& out) const {
    struct Step {
      int edge, to;
    };
    std::map<int, Step> from;  // start point -> its edge of the ring
    for (const auto& [block, other] : {std::pair(i, j), std::pair(j, i)}) {
      const CutBlock& b = cut_.blocks[block];
      for (size_t k = 0; k < b.edge.size(); ++k) {
        if (across(b.edge[k], block) == other) continue;
        if (!from.insert({b.point[k], {b.edge[k], b.point[(k + 1) % b.point.size()]}}).second) return false;
      }
    }
    if (from.empty()) return false;
    const CutBlock& receiver = cut_.blocks[j];
    int start = -1;  // a corner of the receiver keeps its place as the first
    for (const int p : receiver.point)
      if (start < 0 && from.count(p)) start = p;
    if (start < 0) return false;
    for (int p = start;;) {
      const Step& step = from.at(p);
      out.point.push_back(p);
      out.edge.push_back(step.edge);
      p = step.to;
      if (p == start) break;
      if (!from.count(p) || out.point.size() > from.size()) return false;
    }
    return out.point.size() == from.size();
  }

  void note(int i, SliverAction action, int into) {
    const Measure& m = measures_[i];
    table_.rows.push_back(
        {cut_.blocks[i].id, m.area, m.width, m.centroid, action, into < 0 ? -1 : cut_.blocks[into].id});
    table_.needles += action == SliverAction::kNeedle;
    table_.merged += action == SliverAction::kMerged;
    table_.kept += action == SliverAction::kKept;
    table_.deleted += action == SliverAction::kDeleted;
    if (action == SliverAction::kDeleted) table_.deleted_area += m.area;
  }

  void finish() {
    std::vector<CutBlock> left;
    for (int i = 0; i < count_of(cut_.blocks); ++i) {
      if (gone_[i]) continue;
      table_.receivers += receiver_.count(i) > 0;
      left.push_back(std::move(cut_.blocks[i]));
    }
    cut_.blocks = std::move(left);
  }

  const Model& model_;
  Cut& cut_;
  SliverTable& table_;
  std::vector<std::array<int, 2>> edge_blocks_;
  std::vector<bool> gone_, judged_;
  std::vector<Measure> measures_;
  std::set<std::pair<double, int>> waiting_;  // (area, block)
  std::map<int, bool> receiver_;
  std::vector<int> opening_of_;  // [origins] -1: none
  std::vector<bool> inside_;     // [blocks]
  std::vector<bool> reaches_;    // [lines]
};

}  // namespace

void treat_slivers(const Model& model, Cut& cut) { SliverTreatment(model, cut).run(); }

}  // namespace talus
