#include <algorithm>

#include "talus/base/index.h"
#include "talus/cut/layout.h"
#include "talus/geometry/polygon_check.h"

namespace talus {

namespace {

// Edges of cut blocks shorter than this [cells of the grid] are looked at twice when flat corners are left
// out.
constexpr double kShort = 8;

// A corner is flat when it lies within a cell of the grid on the line between the corners kept beside it, and
// the edges on both sides have one origin.
void add_cut_block(const Cut& cut, const CutBlock& block, const Model& model, BlockShape& out) {
  const size_t n = block.point.size();
  const auto place = [&](size_t k) { return cut.point[block.point[k % n]]; };
  const auto origin = [&](size_t k) { return cut.edge_origin[block.edge[k % n]]; };
  // between corners k0 and k1 (exclusive) all lie on the chord
  const auto straight = [&](size_t k0, size_t k1) {
    for (size_t k = k0 + 1; k < k1; ++k)
      if (distance_to_segment(place(k), place(k0), place(k1)) > cut.grid) return false;
    return true;
  };
  const auto turns = [&](size_t k) {
    return origin(k) != origin(k + n - 1) || !straight(k + n - 1, k + n + 1);
  };
  size_t first = 0;
  while (first < n && !turns(first)) ++first;
  if (first == n) first = 0;
  std::vector<size_t> kept{first};
  for (size_t k = first + 1; k < first + n; ++k) {
    const bool one_origin = origin(k) == origin(k - 1);
    if (!one_origin || !straight(kept.back(), k + 1)) kept.push_back(k);
  }
  // corners a few cells apart may cross a line drawn past another of them
  bool crossed = kept.size() < 3;
  if (!crossed && kept.size() < n) {
    Polygon trial;
    for (const size_t i : kept) trial.push_back(place(i));
    bool is_small = polygon_width(polygon_moments(cut.polygon(block))) < kShort * cut.grid;
    for (size_t k = 0; k < n; ++k) is_small = is_small || norm(place(k + 1) - place(k)) < kShort * cut.grid;
    crossed = is_small && !polygon_defect(trial).empty();
  }
  if (crossed) {
    kept.clear();
    for (size_t k = 0; k < n; ++k) kept.push_back(k);
  }
  const CutRegion& region = cut.regions[block.region];
  for (const size_t k : kept) {
    out.polygon.push_back(place(k));
    out.edge_origin.push_back(origin(k));
    const int own = cut.origins[origin(k)].joint;
    out.edge_joint.push_back(own >= 0 ? own : region.joint >= 0 ? region.joint : model.default_joint);
  }
  out.material = region.material;
  out.kind = region.kind;
}

}  // namespace

std::vector<BlockShape> shapes_of(const Model& model, const Cut& cut, const std::vector<CutBlock>& blocks) {
  std::vector<BlockShape> shapes;
  for (const CutBlock& b : blocks) {
    BlockShape shape;
    shape.name = cut.name(b);
    shape.id = b.id;
    shape.group = b.opening >= 0 ? count_of(cut.regions) + b.opening : b.region;
    add_cut_block(cut, b, model, shape);
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

}  // namespace talus
