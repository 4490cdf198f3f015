#include "talus/cut/slivers.h"

#include <algorithm>
#include <map>
#include <set>

namespace talus {

namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// A block thinner than this share of its length is a sliver whatever the limits: its moments have no digits
// left.
constexpr double kThinnest = 1e-5;

struct Measure {
  double area = 0, width = 0, length = 0;
  Vec2 centroid;
};

Measure measure(const Polygon& polygon) {
  const PolygonMoments m = polygon_moments(polygon);
  const double width = polygon_width(m);
  return {m.area, width, m.area / width, m.centroid};
}

class SliverTreatment {
 public:
  SliverTreatment(const CutInput& input, const std::vector<bool>& removed, Cut& cut)
      : input_(input), cut_(cut), table_(cut.slivers), edge_blocks_(cut.edge.size(), {-1, -1}) {
    gone_.assign(cut.blocks.size(), false);
    for (size_t i = 0; i < cut.blocks.size(); ++i) {
      const CutBlock& b = cut.blocks[i];
      judged_.push_back(b.opening < 0 || !removed[static_cast<size_t>(b.opening)]);
      measures_.push_back(measure(cut.polygon(b)));
      for (const int e : b.edge) attach(e, static_cast<int>(i));
    }
  }

  void run() {
    std::vector<double> areas, widths;
    // of the rock outside openings: limits must not depend on what is taken out
    for (const bool everywhere : {false, true})
      for (size_t i = 0; i < measures_.size() && (!everywhere || areas.empty()); ++i)
        if (everywhere || cut_.blocks[i].opening < 0)
          areas.push_back(measures_[i].area), widths.push_back(measures_[i].width);
    if (areas.empty()) return;
    table_.median_area = median(areas), table_.median_width = median(widths);
    table_.area_limit = std::max(input_.sliver_area, input_.sliver_area_share * table_.median_area);
    table_.width_limit = std::max(input_.sliver_width, input_.sliver_width_share * table_.median_width);

    for (size_t i = 0; i < measures_.size(); ++i)
      if (is_sliver(static_cast<int>(i))) waiting_.insert({measures_[i].area, static_cast<int>(i)});
    if (input_.slivers == SliverPolicy::kMerge) merge_all();
    for (const auto& [area, i] : waiting_) {
      const bool remove = input_.slivers == SliverPolicy::kDelete;
      note(i, remove ? SliverAction::kDeleted : SliverAction::kKept, -1);
      if (remove) gone_[static_cast<size_t>(i)] = true;
    }
    finish();
  }

 private:
  bool is_sliver(int i) const {
    const Measure& m = measures_[static_cast<size_t>(i)];
    return judged_[static_cast<size_t>(i)] &&
           (m.area < table_.area_limit || m.width < table_.width_limit || m.width < kThinnest * m.length);
  }

  void attach(int edge, int block) {
    auto& pair = edge_blocks_[static_cast<size_t>(edge)];
    pair[pair[0] < 0 ? 0 : 1] = block;
  }
  int across(int edge, int block) const {
    const auto& pair = edge_blocks_[static_cast<size_t>(edge)];
    return pair[0] == block ? pair[1] : pair[0];
  }

  double length(int edge) const {
    const auto& [a, b] = cut_.edge[static_cast<size_t>(edge)];
    return norm(cut_.point[static_cast<size_t>(b)] - cut_.point[static_cast<size_t>(a)]);
  }

  // Smallest first; those that no neighbour can take wait until a neighbour has changed.
  void merge_all() {
    bool progress = true;
    while (progress) {
      progress = false;
      std::vector<std::pair<double, int>> stuck;
      while (!waiting_.empty()) {
        const auto [area, i] = *waiting_.begin();
        waiting_.erase(waiting_.begin());
        if (merge_one(i))
          progress = true;
        else
          stuck.emplace_back(area, i);
      }
      waiting_.insert(stuck.begin(), stuck.end());
    }
  }

  bool merge_one(int i) {
    const CutBlock& block = cut_.blocks[static_cast<size_t>(i)];
    struct Border {
      int other = -1;
      double length = 0;
      bool is_fault = false;
    };
    std::map<int, Border> shared;
    for (const int e : block.edge) {
      const int other = across(e, i);
      if (other < 0) continue;
      const CutBlock& o = cut_.blocks[static_cast<size_t>(other)];
      if (o.region != block.region || o.opening != block.opening) continue;
      Border& border = shared[other];
      border.other = other;
      border.length += length(e);
      const auto origin = static_cast<size_t>(cut_.edge_origin[static_cast<size_t>(e)]);
      border.is_fault = border.is_fault || cut_.origins[origin].kind == OriginKind::kFault;
    }
    // the longest edge first, but a fault stays whole as long as another neighbour can take the sliver
    std::vector<Border> order;
    for (const auto& [other, border] : shared) order.push_back(border);
    std::stable_sort(order.begin(), order.end(), [](const Border& x, const Border& y) {
      return x.is_fault != y.is_fault ? y.is_fault : x.length > y.length;
    });
    for (const Border& border : order) {
      const int other = border.other;
      CutBlock merged;
      if (!joined(i, other, merged)) continue;
      waiting_.erase({measures_[static_cast<size_t>(other)].area, other});
      note(i, SliverAction::kMerged, other);
      for (const int e : block.edge) {
        auto& pair = edge_blocks_[static_cast<size_t>(e)];
        for (int& b : pair)
          if (b == i) b = other;
        if (pair[0] == pair[1]) pair = {-1, -1};
      }
      gone_[static_cast<size_t>(i)] = true;
      receiver_[other] = true;
      cut_.blocks[static_cast<size_t>(other)].point = std::move(merged.point);
      cut_.blocks[static_cast<size_t>(other)].edge = std::move(merged.edge);
      measures_[static_cast<size_t>(other)] = measure(cut_.polygon(cut_.blocks[static_cast<size_t>(other)]));
      if (is_sliver(other)) waiting_.insert({measures_[static_cast<size_t>(other)].area, other});
      return true;
    }
    return false;
  }

  // The ring around both blocks; false when it is not one simple ring.
  bool joined(int i, int j, CutBlock& out) const {
    struct Step {
      int edge, to;
    };
    std::map<int, Step> from;  // start point -> its edge of the ring
    for (const auto& [block, other] : {std::pair(i, j), std::pair(j, i)}) {
      const CutBlock& b = cut_.blocks[static_cast<size_t>(block)];
      for (size_t k = 0; k < b.edge.size(); ++k) {
        if (across(b.edge[k], block) == other) continue;
        if (!from.insert({b.point[k], {b.edge[k], b.point[(k + 1) % b.point.size()]}}).second) return false;
      }
    }
    if (from.empty()) return false;
    const CutBlock& receiver = cut_.blocks[static_cast<size_t>(j)];
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
    const Measure& m = measures_[static_cast<size_t>(i)];
    table_.rows.push_back({cut_.blocks[static_cast<size_t>(i)].id, m.area, m.width, m.centroid, action,
                           into < 0 ? -1 : cut_.blocks[static_cast<size_t>(into)].id});
    table_.merged += action == SliverAction::kMerged;
    table_.kept += action == SliverAction::kKept;
    table_.deleted += action == SliverAction::kDeleted;
    if (action == SliverAction::kDeleted) table_.deleted_area += m.area;
  }

  void finish() {
    std::vector<CutBlock> left;
    for (size_t i = 0; i < cut_.blocks.size(); ++i) {
      if (gone_[i]) continue;
      table_.receivers += receiver_.count(static_cast<int>(i)) > 0;
      left.push_back(std::move(cut_.blocks[i]));
    }
    cut_.blocks = std::move(left);
  }

  const CutInput& input_;
  Cut& cut_;
  SliverTable& table_;
  std::vector<std::array<int, 2>> edge_blocks_;
  std::vector<bool> gone_, judged_;
  std::vector<Measure> measures_;
  std::set<std::pair<double, int>> waiting_;  // (area, block)
  std::map<int, bool> receiver_;
};

}  // namespace

void treat_slivers(const CutInput& input, const std::vector<bool>& removed, Cut& cut) {
  SliverTreatment(input, removed, cut).run();
}

}  // namespace talus
