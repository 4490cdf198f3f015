// A6j by meshes of Gmsh: the tunnel of test_tunnel.cpp read from files, and a mesh that Gmsh made itself.

#include <filesystem>
#include <fstream>
#include <map>

#include "support/run_case.h"
#include "support/source_file.h"
#include "support/tolerance.h"
#include "support/tunnel_model.h"
#include "talus/base/index.h"
#include "talus/base/text_file.h"
#include "talus/mesh/read_msh.h"

namespace test_mesh_tunnel {

using namespace talus;
using namespace talus::test;

namespace {

constexpr int kRings = 8, kSectors = 12;

// At a hundredth of the stress: the second order (1 % of strain would be 1 %) does not show.
Tunnel tunnel(int sectors) {
  Tunnel t{kRings, sectors};
  t.vertical /= 100, t.horizontal /= 100;
  t.at_once = other_formulation() == "penalty";
  return t;
}

class MeshFile {
 public:
  explicit MeshFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / fmt::format("talus_mesh_{}.msh", getpid())) {
    std::ofstream(path_) << text;
  }
  ~MeshFile() { std::filesystem::remove(path_); }
  MeshFile(const MeshFile&) = delete;
  MeshFile& operator=(const MeshFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

double crown(const CaseResult& r) { return -r.column("crown.displacement_y").back(); }
double side(const CaseResult& r) { return -r.column("side.displacement_x").back(); }

}  // namespace

TEST_CASE(
    "A6j from a mesh file: the discrete value of the triangles, and that of the same blocks to the last "
    "digits" *
    doctest::test_suite("optimised")) {
  const Tunnel t = tunnel(kSectors);
  const std::vector<Vec2> u = t.finite_elements();
  const double discrete = -u[t.node(0, t.sectors)].y;
  const CaseResult blocks = run_case(t.text());
  for (const bool version4 : {true, false}) {
    const MeshFile file(t.msh(version4));
    const CaseResult r = run_case(t.text(file.path()));
    check_close("A6j mesh file, crown, blocks / finite elements", crown(r) / discrete, 1, 5e-3, 5e-4);
    check_close("A6j mesh file / blocks given one by one", crown(r) / crown(blocks), 1, 1e-9, 1e-12);
  }
}

TEST_CASE("A6j by an unstructured mesh that Gmsh made" * doctest::test_suite("optimised")) {
  // a ring with 24 edges at its wall (tests/fixtures/quarter_ring.geo); the core is one block with as many
  const std::string file = source_file("tests/fixtures/quarter_ring.msh");
  const Mesh read = read_msh(file, read_text_file(file));
  TriangleMesh grid;
  grid.node = read.node;
  for (const MeshElement& e : read.elements) grid.triangle.push_back({e.node[0], e.node[1], e.node[2]});
  const Tunnel t = tunnel(24);
  std::vector<Vec2> force(grid.node.size());
  std::map<int, double> held;
  for (int i = 0; i < count_of(grid.node); ++i) {
    const Vec2 p = grid.node[i];
    const int k = 2 * i;
    if (p.x == 0) held[k] = 0;
    if (p.y == 0) held[k + 1] = 0;
    if (norm(p) < Tunnel::kEdge - 1e-6) continue;
    const Vec2 far = t.exact(p);
    if (p.x != 0) held[k] = far.x;
    if (p.y != 0) held[k + 1] = far.y;
  }
  int wall = 0;
  for (const MeshEdge& e : read.edges) {
    if (read.curve_groups[e.group] != "wall") continue;
    ++wall;
    Vec2 a = grid.node[e.from], b = grid.node[e.to];
    if (cross(a, b) < 0) std::swap(a, b);
    const Vec2 inward = turn_left(b - a);  // what the core bore pulls towards the middle
    for (const int n : {e.from, e.to}) {
      Vec2& f = force[n];
      f = f + 0.5 * Vec2{t.horizontal * inward.x, t.vertical * inward.y};
    }
  }
  REQUIRE(wall == t.sectors);  // the core of the model has as many
  const std::vector<Vec2> u = displacements(grid, t.rock(), force, held);
  double crown_of_elements = 0, side_of_elements = 0;
  for (size_t i = 0; i < grid.node.size(); ++i) {
    if (norm(grid.node[i] - Vec2{0, 1}) < 1e-9) crown_of_elements = -u[i].y;
    if (norm(grid.node[i] - Vec2{1, 0}) < 1e-9) side_of_elements = -u[i].x;
  }
  const CaseResult r = run_case(t.text(file, grid, 1e-4));
  check_close("A6j Gmsh's mesh, crown, blocks / finite elements", crown(r) / crown_of_elements, 1, 5e-3,
              5e-4);
  check_close("A6j Gmsh's mesh, side, blocks / finite elements", side(r) / side_of_elements, 1, 5e-3, 2e-3);
  check_close("A6j Gmsh's mesh, crown, blocks / exact", crown(r) / -t.exact({0, 1}).y, 1, 3e-2, 1e-2);
  check_below("A6j Gmsh's mesh, energy left over / largest term", r.run.closure(), 1e-2, 1e-3);
}

}  // namespace test_mesh_tunnel
