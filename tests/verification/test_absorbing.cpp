// A4c: what a viscous edge reflects of a wave that comes straight in; static reactions kept; energy.

#include <complex>
#include <numbers>

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_absorbing {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kH = 0.2, kTall = 0.4, kYoung = 20e9, kPoisson = 0.25,
                 kDensity = 2500;  // [m], [Pa], [-], [kg/m3]
const double kC11 = kYoung * (1 - kPoisson) / ((1 + kPoisson) * (1 - 2 * kPoisson));
const double kC33 = kYoung / (2 * (1 + kPoisson));
constexpr int kBlocks = 48;

// A row of blocks along x that moves only along x (P) or only along y (S), driven at x = 0 by a velocity that
// swells to a steady sine, absorbed at the other end.
std::string column(bool shear, double period, double duration, double dt) {
  const char *moving = shear ? "y" : "x", *held = shear ? "x" : "y";
  return fmt::format(R"toml(
talus = 1
[material.a]
density = {0}
young = {1}
poisson = {2}
[joint.glue]
kind = "bonded"
[history.drive]
expression = "(t < {3:.17g} ? 0.5e-3*(1-cos(_pi*t/{3:.17g})) : 1e-3)*sin(2*_pi*t/{4:.17g})"
duration = {5:.17g}
samples = 20000
[[grid]]
name = "a"
min = [0, 0]
max = [{6}, {7}]
cells = [{8}, 1]
material = "a"
joint = "glue"
[[support]]
name = "below"
edge = [[0, 0], [{6}, 0]]
{9} = "fixed"
{10} = "free"
[[support]]
name = "above"
edge = [[0, {7}], [{6}, {7}]]
{9} = "fixed"
{10} = "free"
[[support]]
name = "drive"
edge = [[0, 0], [0, {7}]]
{10} = {{ velocity = "drive" }}
{9} = "free"
[[boundary]]
name = "end"
kind = "viscous"
edge = [[{6}, 0], [{6}, {7}]]
[[stage]]
name = "wave"
kind = "dynamic"
duration = {5:.17g}
time_step = {11:.17g}
)toml",
                     kDensity, kYoung, kPoisson, 4 * period, period, duration, kBlocks * kH, kTall, kBlocks,
                     held, moving, dt);
}

// Reflection of the discrete row (linear elements with consistent mass, central differences, mean velocity at
// the dashpot): displacement exp(i(wt - k j)) + R exp(i(wt + k j)) put into the equation of the last node.
// Units of block, wave speed and density.
double discrete_reflection(double kh, double dt) {
  const std::complex<double> i(0, 1);
  const double ws = std::sqrt(6 * (1 - std::cos(kh)) / (2 + std::cos(kh)));
  const double w = 2 / dt * std::asin(ws * dt / 2);
  const auto end = [&](double k) {
    return 1.0 - ws * ws / 3 + i * std::sin(w * dt) / dt - (1 + ws * ws / 6) * std::exp(-i * k);
  };
  return std::abs(end(-kh) / end(kh));
}

double wave_number(double omega, double dt) {
  const double ws = 2 / dt * std::sin(omega * dt / 2);
  return std::acos((6 - 2 * ws * ws) / (6 + ws * ws));
}

}  // namespace

TEST_CASE("A4c the discrete reflection of a dashpot follows its table") {
  const double table[][2] = {{4, .0200},  {6, .0068},  {8, .0035},  {10, .0022},
                             {12, .0015}, {16, .0008}, {20, .0005}, {40, .0001}};
  for (const auto& [n, r] : table)
    CHECK(std::abs(discrete_reflection(2 * std::numbers::pi / n, 0.5) - r) < 0.6e-4);  // its last digit
}

TEST_CASE("A4c viscous end: P and S waves, reflection of the discrete row") {
  for (const bool shear : {false, true}) {
    // pressure governs the stable step: shear waves get half of the P wave's 0.5 of a block in a step
    const double c = std::sqrt((shear ? kC33 : kC11) / kDensity), block_time = kH / c,
                 courant = shear ? 0.25 : 0.5;
    const int steps = shear ? 4 : 2;  // in a block transit

    for (const int n : {6, 10, 16}) {  // steps of h/c in a period
      const double period = n * block_time;
      const int periods = 4;
      const double duration = (3 * kBlocks + 8 * n + periods * n) * block_time;
      const CaseResult r = run_case(
          column(shear, period, duration, courant * block_time) +
          fmt::format(
              "[[monitor]]\nname = \"p0\"\npoint = [{}, {}]\n[[monitor]]\nname = \"p1\"\npoint = [{}, {}]\n",
              16 * kH, kTall / 2, (16 + n / 4 + 1) * kH, kTall / 2));
      const auto& t = r.column("t [s]");
      const double omega = 2 * std::numbers::pi / period, kh = wave_number(omega * block_time, courant);
      std::complex<double> v[2];
      for (int k = 0; k < 2; ++k) {
        const auto& at = r.column(fmt::format("p{}.velocity_{}", k, shear ? "y" : "x"));
        for (size_t i = t.size() - static_cast<size_t>(steps * n * periods); i < t.size(); ++i)
          v[k] += at[i] * std::polar(1.0, -omega * t[i]);
      }
      // forward A and backward B from two points: v = A exp(-i kh j) + B exp(i kh j), j from the absorbing
      // end
      const int j0 = 16 - kBlocks, j1 = 16 + n / 4 + 1 - kBlocks;
      const auto e = [kh](int j) { return std::polar(1.0, kh * j); };
      const auto d = e(-j0) * e(j1) - e(j0) * e(-j1);
      const auto forward = (v[0] * e(j1) - v[1] * e(j0)) / d, back = (e(-j0) * v[1] - e(-j1) * v[0]) / d;
      const double reflected = std::abs(back / forward), law = discrete_reflection(kh, courant);
      const std::string what = fmt::format("A4c {} n={} reflection", shear ? "S" : "P", n);
      // what the swell and the first front leave behind is below 1e-3
      check_close(what + " against the discrete row", reflected, law, 1e-3, 2e-4, 1);
      if (n >= 10) check_below(what, reflected, 1e-2, 4e-3);
      check_below(what + ": energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
    }
  }
}

namespace {

// A column of rock on a viscous base, settled under its weight, then left alone.
const std::string kSettled = R"toml(
talus = 1
[model]
gravity = [0, -10]
[material.a]
density = 2000
young = "1 GPa"
poisson = 0
[joint.glue]
kind = "bonded"
[[grid]]
name = "a"
min = [0, 0]
max = [2, 10]
cells = [2, 10]
material = "a"
joint = "glue"
[[boundary]]
name = "base"
kind = "viscous"
edge = [[0, 0], [2, 0]]
[[stage]]
name = "settle"
kind = "static"
duration = "20 s"
unbalanced = 1e-8
[[stage]]
name = "stay"
kind = "dynamic"
duration = "0.3 s"
)toml";

}  // namespace

TEST_CASE("static reactions stay when a viscous base takes over: a settled column keeps still") {
  double fastest = 0, reaction = 0, moved = 0, start = 0;
  const CaseResult r = run_case(kSettled, {}, [&](const Instant& i) {
    if (i.stage != 1) return;
    double sum = 0;
    for (size_t k = 0; k < i.state.boundaries.size(); ++k)
      sum += i.state.boundaries[k].force[0] * i.scene.boundaries.points[k].normal.y;
    if (i.stage_start) reaction = sum, start = i.state.displacement[0].y;
    moved = std::max(moved, std::abs(i.state.displacement[0].y - start));
    for (size_t k = 0; k < i.state.rate.size(); ++k)
      fastest = std::max(fastest, norm(rate_now(i.work, i.state, k).a));
  });
  CHECK(r.run.stages[0].at_rest);
  check_close("kept reaction of the base [N]", reaction, 2000.0 * 10 * 20, 1e-6, 1e-8);
  // forces are balanced to 1e-8 of the weight and velocities have fallen to 1e-8 of g H/c = 0.14 m/s: against
  // the dashpot rho c of the base 1e-8 g H/c. An iterative solver may add its tolerance, 1e-8 m in a step of
  // 1 ms. Without the reactions: 0.14 m/s
  check_below("velocity after the change of stage [m/s]", fastest, 1e-5, 1e-8);
  check_below("displacement after it [m]", moved, 1e-8, 1e-10);
  check_below("settled column: energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
}

TEST_CASE("a run that starts with a dynamic stage has no reactions: the column sinks at g H / c") {
  std::string text = kSettled;
  const size_t a = text.find("[[stage]]"), b = text.find("[[stage]]", a + 1);
  text.erase(a, b - a);
  double speed = 0;
  run_case(text, {}, [&](const Instant& i) { speed = rate_now(i.work, i.state, 0).a.y; });
  // the base carries the weight with its dashpot once waves have died out: v = rho g H / (rho c)
  const double c = std::sqrt(1e9 / 2000);
  check_close("sinking on a dashpot [m/s]", speed, -10 * 10 / c, 1e-2, 1e-3);
}

TEST_CASE("static = roller and free: what stands in static stages") {
  // gravity along x too: a roller holds along its normal only, so the static stage must not come to rest
  for (const auto& [hold, x, y] : {std::tuple{"roller", 0.0, 4e5}, std::tuple{"fixed", 4e4, 4e5}}) {
    double fx = 0, fy = 0;
    std::string text = kSettled;
    text.replace(text.find("[0, -10]"), 8, "[-1, -10]");
    text.replace(text.find("edge = [[0, 0], [2, 0]]"), 0, fmt::format("static = \"{}\"\n", hold));
    text.replace(text.find("duration = \"20 s\""), 17, "duration = \"40 s\"");
    if (std::string(hold) == "roller")
      text += "[[support]]\nname = \"side\"\nedge = [[0, 0], [0, 10]]\ny = \"free\"\n";
    run_case(text, {}, [&](const Instant& i) {
      if (i.stage != 1 || !i.stage_start) return;
      for (size_t k = 0; k < i.state.boundaries.size(); ++k) {
        const BoundaryPoint& p = i.scene.boundaries.points[k];
        const Vec2 f =
            i.state.boundaries[k].kept[0] * p.normal + i.state.boundaries[k].kept[1] * turn_right(p.normal);
        fx += f.x, fy += f.y;
      }
    });
    check_close(fmt::format("{} base: kept reaction along x [N]", hold), fx, x, 1e-6, 1e-8, 4e5);
    check_close(fmt::format("{} base: kept reaction along y [N]", hold), fy, y, 1e-6, 1e-8);
  }
}

}  // namespace test_absorbing
