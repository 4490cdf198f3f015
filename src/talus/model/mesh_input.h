#pragma once
// A mesh taken as blocks.

#include <string>
#include <vector>

#include "talus/geometry/polygon.h"
#include "talus/mesh/read_msh.h"
#include "talus/model/cut_input.h"
#include "talus/schema/findings.h"

namespace talus {

/// One [[mesh]].
struct MeshInput {
  std::string name;
  Mesh mesh;                        // nodes in [m]
  int material = -1;                // of elements whose group names none
  std::vector<int> group_material;  // [surface groups]
  int joint = -1;                   // between elements, -1: glued
  std::vector<int> curve_joint;     // [curve groups] -1: that of the mesh
  BlockKind kind = BlockKind::kDeformable;
  Where where;

  /// Corners of an element, counter-clockwise.
  Polygon polygon(const MeshElement& e) const;
};

}  // namespace talus
