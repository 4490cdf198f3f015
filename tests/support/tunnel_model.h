#pragma once
// A circular tunnel in rock under in-situ stress, dug into one quarter of a ring of bonded triangles: as a
// model, as finite elements, and as the exact solution for an unbounded rock (Kirsch).
//
//     y                  The outer edge, at ten radii, moves as the exact solution says; on both axes
//     |---__             rollers stand for the other quarters of a ring of four times as many blocks.
//     | ring `.          Each cell of the grid is cut by both diagonals; rings grow outwards from about
//     |--.     \\         the width of a sector at the wall.
//     |core|    |
//     +----+----+-- x

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "support/triangle_fem.h"
#include "talus/base/index.h"

namespace talus::test {

struct Tunnel {
  int rings, sectors;                             // of the quarter
  double vertical = 30e6, horizontal = 15e6;      // in-situ pressures [Pa]
  double shear = 2.8e9, bulk = 3.9e9;             // moduli of the rock [Pa]
  bool at_once = false;                           // the core goes in a static stage, with all its tractions
  static constexpr double kWall = 1, kEdge = 10;  // radii [m]

  Elastic rock() const {
    return {9 * bulk * shear / (3 * bulk + shear), (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear))};
  }

  int count() const { return 4 * rings * sectors; }

  /// Corner of the grid [m], on the axes exactly on them.
  Vec2 corner(int ring, int sector) const {
    const double angle = 0.5 * std::numbers::pi * sector / sectors;
    const double r = kWall * std::pow(kEdge / kWall, std::pow(static_cast<double>(ring) / rings, 1.3));
    return {sector == sectors ? 0 : r * std::cos(angle), sector == 0 ? 0 : r * std::sin(angle)};
  }

  int node(int ring, int sector) const { return ring * (sectors + 1) + sector; }

  TriangleMesh mesh() const {
    TriangleMesh out;
    for (int i = 0; i <= rings; ++i)
      for (int j = 0; j <= sectors; ++j) out.node.push_back(corner(i, j));
    for (int i = 0; i < rings; ++i) {
      for (int j = 0; j < sectors; ++j) {
        const int middle = count_of(out.node);
        const int around[] = {node(i, j + 1), node(i, j), node(i + 1, j), node(i + 1, j + 1)};
        Vec2 sum;
        for (const int n : around) sum = sum + out.node[n];
        out.node.push_back(0.25 * sum);
        for (int k = 0; k < 4; ++k) out.triangle.push_back({around[k], around[(k + 1) % 4], middle});
      }
    }
    return out;
  }

  /// Displacement [m] at `p` by the excavation, in unbounded rock: of Kirsch's stresses, plane strain.
  Vec2 exact(Vec2 p) const {
    const double r = norm(p), nu = rock().poisson, share = kWall * kWall / (r * r);
    const double twice = 2 * std::atan2(p.y, p.x), scale = kWall * kWall / (4 * shear * r);
    const double along =
        -scale * (horizontal + vertical + (horizontal - vertical) * (4 * (1 - nu) - share) * std::cos(twice));
    const double across = scale * (horizontal - vertical) * (2 * (1 - 2 * nu) + share) * std::sin(twice);
    const Vec2 out = (1 / r) * p;
    return along * out + across * turn_left(out);
  }

  /// Displacements of the nodes of mesh() by finite elements.
  /// @param edge_moves  false: the outer edge stands still
  std::vector<Vec2> finite_elements(bool edge_moves = true) const {
    const TriangleMesh grid = mesh();
    std::vector<Vec2> force(grid.node.size());
    for (int j = 0; j < sectors; ++j) {
      // the core no longer pushes: as if the wall were pulled towards the middle by what it bore
      const Vec2 chord = corner(0, j + 1) - corner(0, j), inward = turn_left(chord);
      for (const int k : {j, j + 1}) {
        Vec2& f = force[node(0, k)];
        f = f + 0.5 * Vec2{horizontal * inward.x, vertical * inward.y};
      }
    }
    std::map<int, double> held;
    for (int i = 0; i <= rings; ++i) held[2 * node(i, 0) + 1] = held[2 * node(i, sectors)] = 0;
    for (int j = 0; j <= sectors; ++j) {
      const Vec2 u = edge_moves ? exact(corner(rings, j)) : Vec2{};
      held[2 * node(rings, j)] = u.x, held[2 * node(rings, j) + 1] = u.y;
    }
    return displacements(grid, rock(), force, held);
  }

  /// The model: at rest under the in-situ stress with its core, then dug. Block "t<n>" is triangle n of
  /// mesh(). Monitors "side" and "crown" at the wall, "side_block": the stress of triangle 0, at the wall.
  /// @param mesh_file  the triangles as [[mesh]] of this file, "ring[<n>]"; "": as blocks
  std::string text(const std::string& mesh_file = "") const;
  /// The same for triangles of another mesh of the ring.
  std::string text(const std::string& mesh_file, const TriangleMesh& grid, double step) const;

  /// mesh() as Gmsh writes it, in format 4.1 or 2.2: physical surface "rock", physical curve "wall".
  std::string msh(bool version4) const;
};

inline std::string Tunnel::msh(bool version4) const {
  const TriangleMesh grid = mesh();
  std::string out = fmt::format(
      "$MeshFormat\n{} 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 5 \"wall\"\n2 9 "
      "\"rock\"\n$EndPhysicalNames\n",
      version4 ? "4.1" : "2.2");
  const size_t nodes = grid.node.size(), triangles = grid.triangle.size();
  if (version4) out += "$Entities\n0 1 1 0\n3 0 0 0 1 1 0 1 5 0\n4 0 0 0 10 10 0 1 9 1 3\n$EndEntities\n";
  out +=
      version4 ? fmt::format("$Nodes\n1 {0} 1 {0}\n2 4 0 {0}\n", nodes) : fmt::format("$Nodes\n{}\n", nodes);
  if (version4)
    for (size_t i = 0; i < nodes; ++i) out += fmt::format("{}\n", i + 1);
  for (size_t i = 0; i < nodes; ++i)
    out += (version4 ? "" : fmt::format("{} ", i + 1)) +
           fmt::format("{} {} 0\n", grid.node[i].x, grid.node[i].y);
  out += "$EndNodes\n$Elements\n";
  out += version4 ? fmt::format("2 {0} 1 {0}\n1 3 1 {1}\n", sectors + triangles, sectors)
                  : fmt::format("{}\n", sectors + triangles);
  for (int j = 0; j < sectors; ++j)
    out += fmt::format("{}{} {}\n", version4 ? fmt::format("{} ", j + 1) : fmt::format("{} 1 2 5 3 ", j + 1),
                       node(0, j) + 1, node(0, j + 1) + 1);
  if (version4) out += fmt::format("2 4 2 {}\n", triangles);
  for (size_t t = 0; t < triangles; ++t)
    out += fmt::format(
        "{}{} {} {}\n",
        version4 ? fmt::format("{} ", sectors + t + 1) : fmt::format("{} 2 2 9 4 ", sectors + t + 1),
        grid.triangle[t][0] + 1, grid.triangle[t][1] + 1, grid.triangle[t][2] + 1);
  return out + "$EndElements\n";
}

inline std::string Tunnel::text(const std::string& mesh_file) const {
  return text(mesh_file, mesh(), 1.6e-3 / rings);
}

inline std::string Tunnel::text(const std::string& mesh_file, const TriangleMesh& grid, double step) const {
  const auto polygon = [](const std::vector<Vec2>& corners) {
    std::string out;
    for (const Vec2 v : corners)
      out += fmt::format("{}[{:.17g}, {:.17g}]", out.empty() ? "" : ", ", v.x, v.y);
    return "[" + out + "]";
  };
  const std::string dig = at_once ? "kind = \"static\"\nduration = 1"
                                  : fmt::format(
                                        "kind = \"dynamic\"\nduration = \"10 ms\"\nelasticity = "
                                        "\"implicit\"\ntime_step = {:.17g}\ndamping_mass = \"400 "
                                        "1/s\"\nrelaxation = [[0, 0], [\"10 ms\", 1]]",
                                        step);
  std::string out = fmt::format(R"(talus = 1
[material.rock]
density = 2600
young = {:.17g}
poisson = {:.17g}
[joint.glue]
kind = "bonded"
[contact]
joint = "glue"
[in_situ]
stress_xx = {:.17g}
stress_yy = {:.17g}
[[support]]
name = "floor"
edge = [[0, 0], [{edge}, 0]]
x = "free"
[[support]]
name = "wall"
edge = [[0, 0], [0, {edge}]]
y = "free"
[[monitor]]
name = "side"
point = [{wall:.10g}, 0]
[[monitor]]
name = "crown"
point = [0, {wall:.10g}]
[[monitor]]
name = "side_block"
block = "{first}"
[[stage]]
name = "in_situ"
kind = "static"
duration = 1
[[stage]]
name = "dig"
{dig}
excavate = ["core"]
[[stage]]
name = "rest"
kind = "static"
duration = 1
elasticity = "implicit"
time_step = {step:.17g}
damping_local = 0
damping_mass = "800 1/s"
unbalanced = 1e-6
[solver]
tolerance = 1e-9
)",
                                rock().young, rock().poisson, -horizontal, -vertical, fmt::arg("edge", kEdge),
                                fmt::arg("step", step), fmt::arg("dig", dig), fmt::arg("wall", kWall + 1e-6),
                                fmt::arg("first", mesh_file.empty() ? "t0" : "ring[0]"));
  std::vector<Vec2> core = {{0, 0}};
  for (int j = 0; j <= sectors; ++j) core.push_back(corner(0, j));
  const auto block = [&out, &polygon](const std::string& name, const std::vector<Vec2>& corners) {
    out +=
        fmt::format("[[block]]\nname = \"{}\"\nmaterial = \"rock\"\npolygon = {}\n", name, polygon(corners));
  };
  block("core", core);
  if (!mesh_file.empty())
    out += fmt::format("[[mesh]]\nname = \"ring\"\nfile = \"{}\"\nmaterial = \"rock\"\n", mesh_file);
  for (size_t t = 0; mesh_file.empty() && t < grid.triangle.size(); ++t) {
    std::vector<Vec2> corners;
    for (const int n : grid.triangle[t]) corners.push_back(grid.node[n]);
    block(fmt::format("t{}", t), corners);
  }
  // the outer edge; what its two ends may do along the axes the rollers say
  std::vector<Vec2> outer;
  for (const Vec2 p : grid.node)
    if (norm(p) > kEdge - 1e-6) outer.push_back(p);
  for (size_t j = 0; j < outer.size(); ++j) {
    const Vec2 p = outer[j], u = exact(p);
    out += fmt::format(
        "[history.x{0}]\ntime = [0, 0.01]\nvalue = [0, {1:.17g}]\n[history.y{0}]\ntime = [0, 0.01]\n"
        "value = [0, {2:.17g}]\n[[support]]\nname = \"edge{0}\"\npoint = [{3:.17g}, {4:.17g}]\n",
        j, u.x, u.y, p.x, p.y);
    for (const char axis : {'x', 'y'}) {
      const bool on_roller = (axis == 'x' ? p.x : p.y) == 0;
      out += on_roller ? fmt::format("{} = \"free\"\n", axis)
                       : fmt::format("{0} = {{ displacement = \"{0}{1}\" }}\n", axis, j);
    }
  }
  return out;
}

}  // namespace talus::test
