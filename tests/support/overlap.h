#pragma once
// How far blocks have gone into each other, from their polygons alone: a judge that shares nothing with the
// contact search.

#include <algorithm>
#include <string>

#include "talus/geometry/polygon_check.h"
#include "talus/talus.h"

namespace talus::test {

struct LargestOverlap {
  double share = 0;  // area in common over the area of the smaller block
  std::string between;
};

inline LargestOverlap largest_overlap(const BlockSet& blocks, const State& state) {
  std::vector<Polygon> polygons;
  std::vector<Box> boxes;
  for (int i = 0; i < blocks.count; ++i) {
    Polygon p;
    for (int v = 0; v < blocks.vertex_count(i); ++v)
      p.push_back(blocks.centroid[i] + offset_now(state, i, blocks.corner({i, v})));
    boxes.push_back(bounding_box(p));
    polygons.push_back(std::move(p));
  }
  LargestOverlap largest;
  for (const auto& [i, j] : close_pairs(boxes, 0)) {
    const Polygon &a = polygons[i], &b = polygons[j];
    const double share = polygon_overlap(a, b).area / std::min(signed_area(a), signed_area(b));
    if (share > largest.share) largest = {share, blocks.name[i] + " and " + blocks.name[j]};
  }
  return largest;
}

}  // namespace talus::test
