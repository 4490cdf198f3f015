// A7d: a pressure pulse on the wall of a cylindrical cavity, a quarter of it in bonded triangles.

#include <numbers>

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_cavity {

using namespace talus;
using namespace talus::test;

namespace {

constexpr int kRings = 24, kSectors = 10;
constexpr double kWall = 1, kEdge = 6;  // radii [m]

Vec2 polar(double ring, double sector) {
  const double angle = 0.5 * std::numbers::pi * sector / kSectors;
  const double r = kWall * std::pow(kEdge / kWall, ring / kRings);
  return {sector == kSectors ? 0 : r * std::cos(angle), r * std::sin(angle)};
}

std::string segment(Vec2 a, Vec2 b) {
  return fmt::format("[[{:.17g}, {:.17g}], [{:.17g}, {:.17g}]]", a.x, a.y, b.x, b.y);
}

// Rings of cells, each four triangles around its middle; pressure inside, a viscous edge outside.
std::string cavity() {
  std::string text = R"toml(
talus = 1
[material.rock]
density = 2650
young = "50 GPa"
poisson = 0.25
[joint.glue]
kind = "bonded"
[contact]
joint = "glue"
[history.pulse]
expression = "t < 0.5e-3 ? 5e6*(1-cos(2*_pi*t/0.5e-3)) : 0"
duration = "1 ms"
[[support]]
name = "floor"
edge = [[1, 0], [6, 0]]
x = "free"
[[support]]
name = "wall"
edge = [[0, 1], [0, 6]]
y = "free"
[[monitor]]
name = "r1"
point = [1, 0]
[[monitor]]
name = "r3"
point = [3, 0]
[[stage]]
name = "blast"
kind = "dynamic"
duration = "1.2 ms"
)toml";
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) {
      const Vec2 corner[4] = {polar(i, j), polar(i + 1, j), polar(i + 1, j + 1), polar(i, j + 1)};
      const Vec2 middle = 0.25 * (corner[0] + corner[1] + corner[2] + corner[3]);
      for (int k = 0; k < 4; ++k) {
        const Vec2 a = corner[k], b = corner[(k + 1) % 4];
        text += fmt::format(
            "[[block]]\nname = \"c{}-{}-{}\"\nmaterial = \"rock\"\npolygon = [[{:.17g}, {:.17g}], [{:.17g}, "
            "{:.17g}], [{:.17g}, {:.17g}]]\n",
            i, j, k, a.x, a.y, b.x, b.y, middle.x, middle.y);
      }
    }
  }
  for (int j = 0; j < kSectors; ++j) {
    text += fmt::format("[[load]]\nname = \"wall{}\"\npressure = \"pulse\"\nedge = {}\n", j,
                        segment(polar(0, j), polar(0, j + 1)));
    text += fmt::format("[[boundary]]\nname = \"edge{}\"\nkind = \"viscous\"\nedge = {}\n", j,
                        segment(polar(kRings, j), polar(kRings, j + 1)));
  }
  return text;
}

}  // namespace

TEST_CASE("A7d pressure pulse in a cavity: radial displacement and velocity") {
  const CaseResult r = run_case(cavity());
  const auto largest = [&r](const char* column) {
    const auto& v = r.column(column);
    return *std::max_element(v.begin(), v.end());
  };
  // Laplace transform of the exact solution, inverted numerically (good to 4e-5). Triangles of a tenth of a
  // radian around a chord of 9 degrees are stiff by 1 to 2 %
  check_close("A7d displacement of the wall [m]", largest("r1.displacement_x"), 1.5052e-4, 5e-2, 2e-2);
  check_close("A7d displacement at 3 a [m]", largest("r3.displacement_x"), 7.448e-5, 5e-2, 2e-2);
  check_close("A7d velocity of the wall [m/s]", largest("r1.velocity_x"), 0.6820, 5e-2, 2e-2);
  check_close("A7d velocity at 3 a [m/s]", largest("r3.velocity_x"), 0.3525, 5e-2, 2e-2);
  check_below("A7d energy left over / largest term", r.run.closure(), 1e-2, 1e-6);
}

}  // namespace test_cavity
