// A6c: a cantilever of bonded triangles is one of linear finite elements.

#include "support/run_case.h"
#include "support/tolerance.h"
#include "support/triangle_fem.h"
#include "talus/base/index.h"

namespace test_cantilever {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kLength = 4, kHeight = 1;  // [m]
constexpr Elastic kRock = {1e8, 0.25};

// The grid with both diagonals in every cell: corner (i, j), then the middles of the cells.
TriangleMesh crossed(int nx, int ny) {
  TriangleMesh out;
  const double a = kLength / nx, b = kHeight / ny;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) out.node.push_back({a * i, b * j});
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int low = j * (nx + 1) + i, high = low + nx + 1;
      const int middle = count_of(out.node);
      out.node.push_back({a * (i + 0.5), b * (j + 0.5)});
      for (const auto& [p, q] : {std::pair(low, low + 1), std::pair(low + 1, high + 1),
                                 std::pair(high + 1, high), std::pair(high, low)})
        out.triangle.push_back({p, q, middle});
    }
  }
  return out;
}

// Deflection of the middle of the free end [m] under `force` [N] spread over it, downwards > 0.
double finite_elements(int nx, int ny, double force) {
  const TriangleMesh mesh = crossed(nx, ny);
  std::vector<Vec2> load(mesh.node.size());
  std::map<int, double> held;
  for (int j = 0; j <= ny; ++j) {
    const int wall = j * (nx + 1), end = wall + nx;
    held[2 * wall] = held[2 * wall + 1] = 0;
    load[end].y = -force / ny * (j == 0 || j == ny ? 0.5 : 1);
  }
  return -displacements(mesh, kRock, load, held)[ny / 2 * (nx + 1) + nx].y;
}

// Steps far above the stable limit of the explicit ones: the way to rest does not matter. The contact error
// allowed is a share of the load, as the deflection is.
CaseResult blocks(int nx, int ny, double force) {
  return run_case(fmt::format(R"(
talus = 1
[material.rock]
density = 2500
young = {1}
poisson = {2}
[joint.glue]
kind = "bonded"
[history.force]
time = [0, 1]
value = [{0}, {0}]
[[grid]]
name = "beam"
min = [0, 0]
max = [{3}, {4}]
cells = [{5}, {6}]
pattern = "crossed_triangles"
material = "rock"
joint = "glue"
[[support]]
name = "wall"
edge = [[0, 0], [0, {4}]]
[[load]]
name = "end"
edge = [[{3}, 0], [{3}, {4}]]
traction_y = "force"
[[monitor]]
name = "end"
point = [{3}, {7}]
[[monitor]]
name = "wall"
support = "wall"
[[stage]]
name = "rest"
kind = "static"
duration = 100
elasticity = "implicit"
time_step = "10 ms"
damping_local = 0
damping_mass = "25 1/s"
unbalanced = 1e-9
[solver]
tolerance = {8}
)",
                              -force / kHeight, kRock.young, kRock.poisson, kLength, kHeight, nx, ny,
                              kHeight / 2, 1e-13 * force));
}

}  // namespace

TEST_CASE("A6c cantilever of bonded triangles: deflection of the finite elements") {
  struct Case {
    int nx, ny;
    double deflection;  // [m] under 10 kN, by another program of constant-strain triangles (7 digits)
  };
  for (const Case k : {Case{8, 2, 2.119734e-2}, Case{16, 4, 2.389877e-2}}) {
    const std::string name = fmt::format("A6c {}x{}x4 triangles ", k.nx, k.ny);
    const double linear = finite_elements(k.nx, k.ny, 1e4);
    check_close(name + "finite elements, by two programs", linear, k.deflection, 1e-6, 3e-7);
    // the load at which the beam turns by 1e-2: the blocks turn with it, the finite elements do not, and
    // the second order of that is 1e-4
    const CaseResult bent = blocks(k.nx, k.ny, 1e4);
    check_close(name + "deflection / finite elements", -bent.column("end.displacement_y").back() / linear, 1,
                1e-3, 1e-4);
    check_close(name + "reaction / load", bent.column("wall.reaction_y").back() / 1e4, 1, 1e-6, 1e-9);
    check_below(name + "energy left over / largest term", bent.run.closure(), 1e-2, 1e-3);
    // a thousandth of it: the second order is gone, what is left is the balance asked for
    const CaseResult small = blocks(k.nx, k.ny, 10);
    check_close(name + "the same, a thousandth of the load",
                -small.column("end.displacement_y").back() / (linear / 1000), 1, 1e-6, 1e-7);
  }
}

}  // namespace test_cantilever
