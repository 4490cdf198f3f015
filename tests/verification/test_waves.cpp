// A4: longitudinal waves in a column of bonded blocks.

#include <complex>
#include <numbers>

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_waves {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kH = 0.2, kYoung = 20e9, kDensity = 2500;  // [m], [Pa], [kg/m3]
const double kSpeed = std::sqrt(kYoung / kDensity);         // 2828.43 m/s, nu = 0
const double kBlockTime = kH / kSpeed;                      // transit of one block [s]

// A horizontal column from x = 0, driven at x = 0 by the history "drive" (velocity, from a formula).
struct Column {
  int blocks = 100;
  double impedance_ratio = 0;  // > 0: a second column of blocks_2 blocks follows, with Z2/Z1 = this
  int blocks_2 = 0;
  bool fixed_end = false;
  std::string drive;
  double drive_time = 0;       // [s]
  double duration = 0;         // [s]
  double courant = 0.5;        // c dt / h of the stiffer part
  std::vector<double> points;  // monitors p0, p1, ...: in blocks from the driven end

  std::string text() const {
    const double end = blocks * kH, r = impedance_ratio > 0 ? impedance_ratio : 1;
    std::string out = fmt::format(R"(
talus = 1
[material.a]
density = {0}
young = {1}
poisson = 0
[material.b]
density = {0}
young = {2}
poisson = 0
[joint.glue]
kind = "bonded"
[history.drive]
expression = "{3}"
duration = {4}
samples = 20000
[[grid]]
name = "a"
min = [0, 0]
max = [{5}, {6}]
cells = [{7}, 1]
material = "a"
joint = "glue"
[[support]]
name = "drive"
edge = [[0, 0], [0, {6}]]
x = {{ velocity = "drive" }}
y = "free"
[[support]]
name = "level"
point = [0, 0]
x = "free"
[[stage]]
name = "wave"
kind = "dynamic"
duration = {8}
time_step = {9}
)",
                                  kDensity, kYoung, kYoung * r * r, drive, drive_time, end, kH, blocks,
                                  duration, courant * kBlockTime / std::max(r, 1.0));
    double last = end;
    if (impedance_ratio > 0) {
      last = end + blocks_2 * kH;
      out += fmt::format(
          "[[grid]]\nname = \"b\"\nmin = [{}, 0]\nmax = [{}, {}]\ncells = [{}, 1]\nmaterial = \"b\"\njoint = "
          "\"glue\"\n"
          "[[contact_pair]]\nbetween = [\"a\", \"b\"]\njoint = \"glue\"\n",
          end, last, kH, blocks_2);
    }
    if (fixed_end)
      out += fmt::format(
          "[[support]]\nname = \"end\"\nedge = [[{0}, 0], [{0}, {1}]]\n[[monitor]]\nname = \"end\"\nsupport "
          "= \"end\"\n",
          last, kH);
    for (size_t i = 0; i < points.size(); ++i)
      out += fmt::format("[[monitor]]\nname = \"p{}\"\npoint = [{}, {}]\n", i, points[i] * kH, kH / 2);
    return out;
  }
};

// Wave number x h of the bonded chain (linear finite elements with consistent mass) under central
// differences.
double discrete_kh(double omega, double dt) {
  const double ws =
      2 / dt * std::sin(omega * dt / 2) * kBlockTime;  // frequency of the semi-discrete chain, x h/c
  return std::acos((6 - 2 * ws * ws) / (6 + ws * ws));
}

std::string pulse(double length) {
  return fmt::format("t < {0:.17g} ? 0.5*(1-cos(2*_pi*t/{0:.17g})) : 0", length);
}

double extreme(const CaseResult& r, const std::string& column, double from, double to) {
  const auto &t = r.column("t [s]"), &v = r.column(column);
  double best = 0;
  for (size_t i = 0; i < t.size(); ++i)
    if (t[i] >= from && t[i] <= to && std::abs(v[i]) > std::abs(best)) best = v[i];
  return best;
}

}  // namespace

TEST_CASE("A4a longitudinal wave: phase speed follows the discrete dispersion law") {
  for (const int n : {8, 10, 20}) {
    const double period = n * kBlockTime, omega = 2 * std::numbers::pi / period;
    Column column;
    column.blocks = 160;
    // three periods to swell, then steady: no front of high frequencies
    column.drive =
        fmt::format("(t < {0:.17g} ? 0.5*(1-cos(_pi*t/{0:.17g})) : 1)*sin({1:.17g}*t)", 3 * period, omega);
    const double from = 160 * kBlockTime;  // steady at block 60; the far end answers there at 260 h/c
    const int periods = static_cast<int>(85.0 / n);
    column.duration = from + periods * period;
    column.drive_time = column.duration;
    column.points = {20, 60};
    const CaseResult r = run_case(column.text());

    // phase difference from one Fourier coefficient over whole periods (a whole number of steps)
    const auto& t = r.column("t [s]");
    std::complex<double> c[2];
    const int steps = static_cast<int>(std::lround(periods * period / (t[1] - t[0])));
    for (int k = 0; k < 2; ++k) {
      const auto& v = r.column(fmt::format("p{}.velocity_x", k));
      for (size_t i = t.size() - static_cast<size_t>(steps); i < t.size(); ++i)
        c[k] += v[i] * std::polar(1.0, -omega * t[i]);
    }
    const double kh = discrete_kh(omega, t[1] - t[0]);
    double lag = -std::arg(c[1] / c[0]);  // modulo 2 pi; 40 blocks apart
    lag += 2 * std::numbers::pi * std::round((40 * kh - lag) / (2 * std::numbers::pi));
    const double speed = omega * kBlockTime / (lag / 40), law = omega * kBlockTime / kh;
    check_close(fmt::format("A4a phase speed / c at {} steps of h/c a period", n), speed, law, 3e-3, 5e-4);
    check_below(fmt::format("A4a n={} energy left over / largest term", n), r.run.closure(), 1e-2, 1e-3);
  }
}

TEST_CASE("A4b longitudinal wave: free and fixed end") {
  // a smooth pulse 40 blocks long (>= 20 per wavelength): discretisation 0.1 % at this length
  Column column;
  column.blocks = 100;
  column.drive = pulse(40 * kBlockTime);
  column.drive_time = 41 * kBlockTime;
  column.duration = 160 * kBlockTime;
  column.points = {100, 40};
  const CaseResult free_end = run_case(column.text());
  check_close("A4b free end, velocity / incident", extreme(free_end, "p0.velocity_x", 0, 1), 2, 1e-2, 3e-3);
  check_below("A4b free end, energy left over / largest term", free_end.run.closure(), 1e-2, 1e-3);

  column.fixed_end = true;
  column.points = {50, 40};
  const CaseResult fixed = run_case(column.text());
  const double incident = kDensity * kSpeed * 1.0 * kH;  // rho c v A, the wall pushes back
  check_close("A4b fixed end, stress / incident", -extreme(fixed, "end.reaction_x", 0, 1) / incident, 2, 1e-2,
              3e-3);
  check_below("A4b fixed end, energy left over / largest term", fixed.run.closure(), 1e-2, 1e-3);
}

TEST_CASE("A4b longitudinal wave: reflected and transmitted share at a step of impedance") {
  for (const double ratio : {0.5, 2.0, 4.0}) {
    Column column;
    column.blocks = 120;
    column.impedance_ratio = ratio;
    column.blocks_2 = static_cast<int>(60 * std::max(ratio, 1.0));
    column.drive = pulse(40 * kBlockTime);
    column.drive_time = 41 * kBlockTime;
    column.duration = 205 * kBlockTime;
    column.points = {70, 120 + 10 * ratio};
    const CaseResult r = run_case(column.text());
    // incident at block 70: 70..110 h/c; its reflection 170..210, peak at 190; transmitted at 130..170
    const double reflected = extreme(r, "p0.velocity_x", 165 * kBlockTime, 205 * kBlockTime);
    const double transmitted = extreme(r, "p1.velocity_x", 125 * kBlockTime, 175 * kBlockTime);
    check_close(fmt::format("A4b Z2/Z1={:g} reflected / incident", ratio), reflected,
                (1 - ratio) / (1 + ratio), 1e-2, 3e-3, 1);
    check_close(fmt::format("A4b Z2/Z1={:g} transmitted / incident", ratio), transmitted, 2 / (1 + ratio),
                1e-2, 3e-3);
    check_below(fmt::format("A4b Z2/Z1={:g} energy left over / largest term", ratio), r.run.closure(), 1e-2,
                1e-3);
  }
}

}  // namespace test_waves
