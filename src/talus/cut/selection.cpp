#include "talus/cut/selection.h"

#include <algorithm>

#include "talus/base/error.h"
#include "talus/base/index.h"

namespace talus {

namespace {

std::vector<int> candidates_of(const Layout& layout, const Selection& place) {
  if (!place.block.empty()) return layout.blocks_called(place.block);
  std::vector<int> all;
  for (int i = 0; i < count_of(layout.blocks); ++i) all.push_back(i);
  return all;
}

bool is_along(const Layout& layout, const BlockShape& b, size_t edge, const std::string& name) {
  return layout.origins[b.edge_origin[edge]] == name;
}

// Looks at the other side of edges.
class OtherSide {
 public:
  explicit OtherSide(const Layout& layout) : layout_(layout) {
    for (const BlockShape& b : layout.blocks) boxes_.push_back(bounding_box(b.polygon));
  }

  // The block beyond the point at `share` of the edge, -1: none.
  int beyond(const SelectedEdge& e, double share) const {
    const double step = 4 * layout_.touching + kStepShare * e.length();
    const Vec2 p = e.from + share * (e.to - e.from) + step * e.normal();
    for (int i = 0; i < count_of(boxes_); ++i) {
      const Box& box = boxes_[i];
      if (i == e.block || p.x < box.min.x || p.x > box.max.x || p.y < box.min.y || p.y > box.max.y) continue;
      if (contains(layout_.blocks[i].polygon, p)) return i;
    }
    return -1;
  }

 private:
  // How far beyond an edge is looked, as share of its length.
  static constexpr double kStepShare = 1e-6;

  const Layout& layout_;
  std::vector<Box> boxes_;
};

}  // namespace

std::vector<SelectedCorner> selected_corners(const Layout& layout, const Selection& place) {
  const double tolerance = point_tolerance(layout);
  const std::vector<int> candidates = candidates_of(layout, place);
  std::vector<SelectedCorner> corners;
  if (!place.along.empty()) {
    for (const int i : candidates) {
      const BlockShape& b = layout.blocks[i];
      const int n = count_of(b.edge_origin);
      for (int k = 0; k < n; ++k)
        if (is_along(layout, b, k, place.along) || is_along(layout, b, (k + n - 1) % n, place.along))
          corners.push_back({i, k, b.polygon[k]});
    }
    return corners;
  }
  for (const int i : candidates) {
    const Polygon& polygon = layout.blocks[i].polygon;
    const auto on_segment = [&](size_t k) {
      return distance_to_segment(polygon[k % polygon.size()], place.from, place.to) <= tolerance;
    };
    for (int k = 0; k < count_of(polygon); ++k) {
      const bool edge_here = on_segment(k + 1) || on_segment(k + polygon.size() - 1);
      if (on_segment(k) && (edge_here || !place.is_edge)) corners.push_back({i, k, polygon[k]});
    }
  }
  if (corners.empty() && !place.is_edge) {
    // no corner at the point: the first block around it
    for (const int i : blocks_at(layout, place.from, tolerance)) {
      if (std::find(candidates.begin(), candidates.end(), i) == candidates.end()) continue;
      corners.push_back({i, -1, place.from});
      break;
    }
  }
  return corners;
}

std::vector<SelectedEdge> selected_edges(const Layout& layout, const Selection& place) {
  TALUS_ASSERT(place.is_edge || !place.along.empty());
  const double tolerance = point_tolerance(layout);
  std::vector<SelectedEdge> edges;
  for (const int i : candidates_of(layout, place)) {
    const BlockShape& b = layout.blocks[i];
    const int n = count_of(b.polygon);
    const auto on_segment = [&](size_t k) {
      return distance_to_segment(b.polygon[k % n], place.from, place.to) <= tolerance;
    };
    for (int k = 0; k < n; ++k) {
      const bool chosen = place.along.empty()
                              ? on_segment(k) && on_segment(k + 1)
                              : k < count_of(b.edge_origin) && is_along(layout, b, k, place.along);
      if (chosen) edges.push_back({i, k, b.polygon[k], b.polygon[(k + 1) % n]});
    }
  }
  return edges;
}

OuterEdges outer_edges(const Layout& layout, const Selection& place) {
  const OtherSide other(layout);
  OuterEdges out;
  for (const SelectedEdge& e : selected_edges(layout, place)) {
    int covered = 0, by = -1;
    constexpr double kShares[] = {0.05, 0.275, 0.5, 0.725, 0.95};
    for (const double share : kShares) {
      const int block = other.beyond(e, share);
      if (block >= 0) ++covered, by = block;
    }
    if (covered == 0) out.edges.push_back(e);
    if (covered > 0 && covered < static_cast<int>(std::size(kShares)) && out.partly.block < 0)
      out.partly = e, out.covered_by = by;
  }
  return out;
}

}  // namespace talus
