// Meshes in the layout: names, groups, materials, joints along curves, and what is told of wrong ones.

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "support/layout_case.h"
#include "talus/base/index.h"
#include "talus/cut/check_places.h"
#include "talus/cut/selection.h"
#include "talus/model/read_model.h"

namespace test_layout_mesh {

using namespace talus;

namespace {

// Two squares of rock and one of clay side by side: 1 x 1 each, the second cut into two triangles.
const std::string kMesh = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
4
1 1 "floor"
1 2 "weak"
2 3 "rock"
2 4 "clay"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1 0 0
3 2 0 0
4 3 0 0
5 0 1 0
6 1 1 0
7 2 1 0
8 3 1 0
$EndNodes
$Elements
8
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 1 2 1 1 3 4
4 1 2 2 2 7 3
5 3 2 3 1 1 2 6 5
6 2 2 3 1 2 3 7
7 2 2 3 1 2 7 6
8 3 2 4 2 3 4 8 7
$EndElements
)";

const std::string kModel = R"(talus = 1
[material.rock]
density = 2700
young = "5 GPa"
poisson = 0.2
[material.soil]
density = 2000
young = "1 GPa"
poisson = 0.3
[joint.weak]
friction_angle = "20 deg"
[joint.glue]
kind = "bonded"
[[mesh]]
name = "m"
file = "m.msh"
unit = "mm"
material = "soil"
[[support]]
name = "held"
along = "floor"
)";

struct Case {
  explicit Case(const std::string& text, const std::string& mesh = kMesh)
      : folder(std::filesystem::temp_directory_path() / ("talus_mesh_layout_" + std::to_string(getpid()))),
        findings("m.toml", text) {
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "m.msh") << mesh;
    model = read_model((folder / "m.toml").string(), text, {}, findings);
    if (model.shapes_readable) layout = checked_layout(model, findings);
    std::filesystem::remove_all(folder);
  }
  std::filesystem::path folder;
  Findings findings;
  Model model;
  Layout layout;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  REQUIRE(text.find(from) != std::string::npos);
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("mesh: elements are blocks, surfaces give materials and groups, curves joints and names") {
  const Case c(kModel);
  INFO(c.findings.render());
  CHECK(c.findings.error_count() == 0);
  REQUIRE(c.layout.blocks.size() == 4);
  CHECK(c.layout.blocks[0].name == "m[0]");
  CHECK(c.layout.blocks[0].polygon[1] == Vec2{1e-3, 0});  // in mm
  CHECK(c.model.materials[c.layout.blocks[1].material].name == "rock");
  CHECK(c.model.materials[c.layout.blocks[3].material].name == "soil");  // "clay" is no material
  CHECK(c.layout.blocks_called("m").size() == 4);
  CHECK(c.layout.blocks_called("m-rock").size() == 3);
  CHECK(c.layout.blocks_called("m-clay").size() == 1);
  // between the second triangle and the clay lies the curve "weak"; all else is glued
  const auto joint = [&c](int a, int b) {
    for (int ea = 0; ea < count_of(c.layout.blocks[a].polygon); ++ea) {
      const BlockShape& x = c.layout.blocks[a];
      for (int eb = 0; eb < count_of(c.layout.blocks[b].polygon); ++eb) {
        const BlockShape& y = c.layout.blocks[b];
        if (x.polygon[ea] == y.polygon[(eb + 1) % y.polygon.size()] &&
            x.polygon[(ea + 1) % x.polygon.size()] == y.polygon[eb])
          return c.model.joints[c.layout.joint_at({a, ea}, {b, eb})];
      }
    }
    return JointProperty{};
  };
  CHECK(joint(0, 2).bonded);
  CHECK(joint(1, 2).bonded);
  CHECK(joint(1, 3).name == "weak");
  CHECK(selected_corners(c.layout, c.model.supports[0]).size() ==
        6);  // two each of three blocks on the floor
}

TEST_CASE("mesh: a joint for the whole, and contact pairs of its groups") {
  const Case c(replaced(kModel, "unit = \"mm\"", "joint = \"weak\"") +
               "[[contact_pair]]\nbetween = [\"m-rock\", \"m-clay\"]\njoint = \"glue\"\n");
  INFO(c.findings.render());
  CHECK(c.findings.error_count() == 0);
  const auto name = [&c](int joint) { return c.model.joints[joint].name; };
  CHECK(name(c.layout.joint_of_pair(c.layout.blocks[1].group, c.layout.blocks[3].group)) == "glue");
  CHECK(name(c.layout.blocks[0].edge_joint[1]) == "weak");
}

TEST_CASE("mesh: its outside meets other blocks by the joint of [contact], its inside is glued") {
  const Case c(kModel +
               "[contact]\njoint = \"weak\"\n[[block]]\nname = \"b\"\nmaterial = \"rock\"\n"
               "polygon = [[0, 1e-3], [1e-3, 1e-3], [1e-3, 2e-3], [0, 2e-3]]\n");
  INFO(c.findings.render());
  CHECK(c.findings.error_count() == 0);
  const auto name = [&c](int joint) { return c.model.joints[joint].name; };
  REQUIRE(c.layout.blocks[0].name == "b");
  CHECK(name(c.layout.joint_at({0, 0}, {1, 2})) == "weak");  // floor of b on the top of the square
  CHECK(name(c.layout.blocks[1].edge_joint[1]) == "(glued)");
  CHECK(name(c.layout.blocks[1].edge_joint[3]) == "weak");
}

TEST_CASE("mesh: wrong ones are told") {
  const auto told = [](const std::string& text, const std::string& part, const std::string& mesh = kMesh) {
    const std::string found = Case(text, mesh).findings.render();
    INFO(found);
    CHECK(found.find(part) != std::string::npos);
  };
  told(replaced(kModel, "m.msh", "n.msh"), "n.msh: cannot be read");
  told(replaced(kModel, "\"mm\"", "\"furlong\""), "mesh.m.unit: \"furlong\" is not known");
  told(replaced(kModel, "material = \"soil\"\n", ""), "no [material.clay] for its physical group \"clay\"");
  told(replaced(kModel, "along = \"floor\"", "along = \"flor\""), "did you mean \"floor\"?");
  told(kModel, "cannot be read", kMesh.substr(0, 300));
  told(kModel, "element 5", replaced(kMesh, "1 2 6 5", "1 6 2 5"));
  // a third triangle over the second, in the same surface
  told(kModel, "overlaps",
       replaced(replaced(kMesh, "$Elements\n8\n", "$Elements\n9\n"), "8 3 2 4", "9 2 2 3 1 2 3 6\n8 3 2 4"));
  told(kModel + "[[block]]\nname = \"m\"\nmaterial = \"rock\"\npolygon = [[5, 0], [6, 0], [6, 1]]\n",
       "is called \"m\"");
  told(kModel + "[[block]]\nname = \"b\"\nmaterial = \"rock\"\npolygon = [[0, 0], [6, 0], [6, 1]]\n",
       "overlaps");
}

}  // namespace test_layout_mesh
