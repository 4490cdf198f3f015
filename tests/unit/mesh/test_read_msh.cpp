// Meshes of Gmsh: both formats, groups, and what is told of wrong files.

#include <doctest/doctest.h>

#include <string>

#include "talus/base/error.h"
#include "talus/mesh/read_msh.h"

namespace test_read_msh {

using namespace talus;

namespace {

// a square of 2 cut into two triangles, beside it a quadrilateral; one curve of a group
const std::string k22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 7 "south side"
2 1 "rock"
2 2 "soil"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 2 0 0
3 2 2 0
4 0 2 0
10 4 0 0
11 4 2 0
$EndNodes
$Elements
5
1 15 2 0 1 1
2 1 2 7 1 1 2
3 2 2 1 1 1 2 3
4 2 2 1 1 1 4 3
5 3 2 2 2 2 10 11 3
$EndElements
)";

const std::string k41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
1 7 "south side"
2 1 "rock"
2 2 "soil"
$EndPhysicalNames
$Entities
1 1 2 0
1 0 0 0 0
1 0 0 0 2 0 0 1 7 2 1 -2
1 0 0 0 2 2 0 1 1 3 1 2 3
2 2 0 0 4 2 0 1 2 0
$EndEntities
$Comments
anything at all
$EndComments
$Nodes
2 6 1 11
0 1 0 1
1
0 0 0
2 1 0 5
2
3
4
10
11
2 0 0
2 2 0
0 2 0
4 0 0
4 2 0
$EndNodes
$Elements
4 5 1 5
0 1 15 1
1 1
1 1 1 1
2 1 2
2 1 2 2
3 1 2 3
4 1 4 3
2 2 3 1
5 2 10 11 3
$EndElements
)";

std::string defect(const std::string& text) {
  try {
    read_msh("m.msh", text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("msh: formats 2.2 and 4.1 give the same mesh") {
  for (const std::string& text : {k22, k41}) {
    const Mesh m = read_msh("m.msh", text);
    CHECK(m.node.size() == 6);
    REQUIRE(m.elements.size() == 3);
    CHECK(m.surface_groups == std::vector<std::string>{"rock", "soil"});
    CHECK(m.curve_groups == std::vector<std::string>{"south side"});
    CHECK(m.elements[0].group == 0);
    CHECK(m.elements[2].group == 1);
    CHECK(m.elements[2].corners == 4);
    REQUIRE(m.edges.size() == 1);
    CHECK(m.node[m.edges[0].to] == Vec2{2, 0});
    for (const MeshElement& e : m.elements) {  // the second triangle stood clockwise in the file
      double twice_area = 0;
      const auto at = [&](int k) { return m.node[e.node[k % e.corners]]; };
      for (int k = 0; k < e.corners; ++k) twice_area += cross(at(k), at(k + 1));
      CHECK(twice_area == (e.corners == 3 ? 4 : 8));
    }
  }
}

TEST_CASE("msh: groups that run the other way have their names, heights of round-off are level") {
  CHECK(read_msh("m.msh", replaced(k41, "0 1 7 2 1 -2", "0 1 -7 2 1 -2")).curve_groups[0] == "south side");
  CHECK(read_msh("m.msh", replaced(k22, "2 1 2 7 1 1 2", "2 1 2 -7 1 1 2")).curve_groups[0] == "south side");
  CHECK(read_msh("m.msh", replaced(k22, "3 2 2 0", "3 2 2 1e-17")).node.size() == 6);
}

TEST_CASE("msh: a text cut off anywhere is told, never read as a smaller mesh") {
  for (const std::string& text : {k22, k41})
    for (size_t n = 0; n + 2 < text.size(); ++n) {
      INFO(n);
      CHECK(!defect(text.substr(0, n)).empty());
    }
}

TEST_CASE("msh: wrong files are told with file and line") {
  CHECK(defect("").find("does not begin with $MeshFormat") != std::string::npos);
  CHECK(defect("solid stl\n").find("m.msh:1") == 0);
  CHECK(defect(replaced(k22, "2.2 0 8", "4.0 0 8")).find("m.msh:2: format 4.0 is not read") == 0);
  CHECK(defect(replaced(k22, "2.2 0 8", "2.2 1 8")).find("binary") != std::string::npos);
  CHECK(defect(replaced(k22, "3 2 2 0", "3 2 2 1")).find("m.msh:14: node 3 is not in the plane") == 0);
  CHECK(defect(replaced(k22, "4 0 2 0", "3 0 2 0")).find("node 3 comes twice") != std::string::npos);
  CHECK(defect(replaced(k22, "1 2 3\n", "1 2 99\n")).find("node 99 is not in $Nodes") != std::string::npos);
  CHECK(defect(replaced(k22, "1 1 2 3\n", "1 1 2 1\n")).find("element 3 has no area") != std::string::npos);
  CHECK(defect(replaced(k22, "5 3 2", "5 9 2")).find("element 5 is of type 9") != std::string::npos);
  CHECK(defect(replaced(k22, "10 4 0 0", "10 4e999 0 0")).find("m.msh:16: expected a number") == 0);
  CHECK(defect(replaced(k22, "10 4 0 0", "10 nan 0 0")).find("not finite") != std::string::npos);
  CHECK(defect(replaced(k22, "\n6\n", "\n99999999999\n")).find("is not possible") != std::string::npos);
  CHECK(defect(replaced(k41, "2 2 3 1\n", "2 9 3 1\n")).find("entity 9 is not in $Entities") !=
        std::string::npos);
  CHECK(defect(replaced(k41, "$Comments", "$PartitionedEntities")).find("partitioned") != std::string::npos);
  CHECK(defect(replaced(k41, "1 0 0 0 2 2 0 1 1 3", "1 0 0 0 2 2 0 2 1 2 3")).find("2 physical groups") !=
        std::string::npos);
}

}  // namespace test_read_msh
