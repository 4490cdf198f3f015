#pragma once
// Which region of the section a point belongs to, and the parts of a line inside the regions.

#include <string>
#include <vector>

#include "talus/model/model.h"

namespace talus {

/// A region or an arch, ready to be cut.
struct CutRegion {
  std::string name;
  Polygon polygon;  // counter-clockwise
  std::vector<std::string> sides;
  int material = -1, joint = -1;
  BlockKind kind = BlockKind::kDeformable;
  Where where = {};
};

class RegionMap {
 public:
  /// Regions in the order of the file, then arches.
  explicit RegionMap(const Model& model);

  const std::vector<CutRegion>& list() const { return regions_; }
  /// The last region that holds `point`, boundary included within `tolerance` [m]; -1: none.
  int region_at(Vec2 point, double tolerance = 0) const;
  /// Box around all regions, or around one.
  Box box(int region = -1) const;
  /// Parts of the segment that lie in some region, or in the one given.
  std::vector<std::vector<Vec2>> clip(Vec2 from, Vec2 to, int region = -1) const;
  /// Parts of the segment, a side of region `region`, that no later region covers.
  std::vector<std::vector<Vec2>> uncovered(Vec2 from, Vec2 to, int region) const;

 private:
  template <class Wanted>
  std::vector<std::vector<Vec2>> parts(Vec2 from, Vec2 to, const Wanted& wanted) const;

  std::vector<CutRegion> regions_;
  std::vector<Box> boxes_;
};

/// Corners of an arch: intrados from the last springing to the first, then extrados back. [2 (voussoirs + 1)]
Polygon arch_polygon(const ArchInput& arch);

}  // namespace talus
