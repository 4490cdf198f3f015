#pragma once
// Plane meshes of Gmsh: ASCII files of format 2.2 and 4.1.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "talus/base/vec2.h"

namespace talus {

struct MeshElement {
  std::array<int, 4> node{-1, -1, -1, -1};  // counter-clockwise
  int corners = 3;                          // 3 or 4
  int group = -1;                           // of surfaces; -1: in none
  int tag = 0;                              // of the file

  /// Node at corner k, counted around.
  int at(int k) const { return node[k % corners]; }
};

struct MeshEdge {
  int from = 0, to = 0;
  int group = 0;  // of curves
};

struct Mesh {
  std::vector<Vec2> node;  // in units of the file
  std::vector<MeshElement> elements;
  std::vector<MeshEdge> edges;                            // lines of physical groups
  std::vector<std::string> surface_groups, curve_groups;  // names; a group without one has its number
};

/// Reads the text of a .msh file. Triangles and quadrilaterals become elements, turned counter-clockwise;
/// lines of physical groups become edges; points are passed over. Throws InputError naming file and line for
/// anything else: other formats, binary files, elements in space or of higher order, nodes that are not
/// there, a text that ends in the middle.
Mesh read_msh(const std::string& file, std::string_view text);

}  // namespace talus
