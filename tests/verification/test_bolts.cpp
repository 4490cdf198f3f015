// A8: rock bolts. Pull-out of a grouted bar against the same bar solved by shooting from its free end and
// against the continuous bar; an anchored bolt across a sliding joint against the statics of its block;
// rupture, pretension and the energy ledger.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/supports/bar.h"

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kPi = std::numbers::pi;

// --- A8a: a bar of 25 mm in 1 GPa of grout that slips at 200 kN/m, 3 m on either side of a joint ---

const double kEA = 200e9 * kPi * 0.025 * 0.025 / 4;
constexpr double kGrout = 1e9, kBond = 2e5, kLength = 3;

// Force and head displacement of a bar of n segments whose free end slips by `end`.
std::pair<double, double> march(int n, double end) {
  const double h = kLength / n;
  double u = end, force = 0;
  for (int i = n; i >= 0; --i) {
    force += std::min(kGrout * u, kBond) * (i == 0 || i == n ? 0.5 * h : h);
    if (i > 0) u += force * h / kEA;
  }
  return {u, force};
}

// Force at a displacement of the head, by bisection on the slip of the free end.
double shooting(int n, double head) {
  double low = 0, high = head;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (march(n, middle).first < head ? low : high) = middle;
  }
  return march(n, 0.5 * (low + high)).second;
}

// The continuous bar: elastic, then with a zone of length xp that slips.
double continuous(double head) {
  const double b = std::sqrt(kGrout / kEA), us = kBond / kGrout;
  if (head <= us) return kEA * b * std::tanh(b * kLength) * head;
  double low = 0, high = kLength;
  const auto at = [&](double xp) {
    const double elastic = kBond / b * std::tanh(b * (kLength - xp));
    return std::pair(us + elastic * xp / kEA + kBond * xp * xp / (2 * kEA), elastic + kBond * xp);
  };
  for (int k = 0; k < 200; ++k) {
    const double xp = 0.5 * (low + high);
    (at(xp).first < head ? low : high) = xp;
  }
  return at(0.5 * (low + high)).second;
}

// Two fixed-shape blocks on either side of x = 0; the right one is drawn away by 2 x head. By symmetry the
// bar slips by `head` at the joint on either side.
std::string pull_text(int n, double head) {
  return fmt::format(R"(talus = 1
[material.rock]
density = 2500
[history.draw]
time = [0, 0.1]
value = [0, {:.17g}]
[[block]]
name = "left"
polygon = [[-3, -1], [0, -1], [0, 1], [-3, 1]]
material = "rock"
kind = "fixed"
[[block]]
name = "right"
polygon = [[0, -1], [3, -1], [3, 1], [0, 1]]
material = "rock"
kind = "rigid"
[[support]]
name = "drawn"
edge = [[3, -1], [3, 1]]
x = {{ displacement = "draw" }}
[bolt_type.bar]
kind = "grouted"
diameter = "25 mm"
grout_stiffness = "1 GPa"
bond_strength = "200 kN/m"
spacing = "2 m"
dowel_stiffness = 0
segment_length = {:.17g}
[[bolt]]
name = "b"
from = [-3, 0.1]
to = [3, 0.1]
type = "bar"
[[monitor]]
name = "m"
bolt = "b"
[[monitor]]
name = "hold"
support = "drawn"
[[stage]]
name = "draw"
kind = "dynamic"
duration = 0.12
time_step = 1e-3
)",
                     2 * head, kLength / n);
}

double pulled(int n, double head) {
  const CaseResult r = run_case(pull_text(n, head));
  const double force = r.column("m.axial_force [N]").back();
  // per metre of thickness the support holds half of a bolt every 2 m
  check_close(fmt::format("A8a N={} {:g} mm: reaction x spacing / bolt force", n, 1e3 * head),
              2 * r.column("hold.reaction_x [N]").back() / force, 1, 1e-9, 1e-12);
  check_below("A8a energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
  return force;
}

}  // namespace

TEST_CASE("A8a pull-out of a grouted bolt, elastic and with slip") {
  const double printed[3] = {34738.3, 32218.0, 31556.5};
  int k = 0;
  for (const int n : {10, 20, 40}) {
    // the shooting itself, against numbers of an independent program given to 0.05 N
    check_close(fmt::format("A8a N={} shooting, 0.1 mm [N]", n), shooting(n, 1e-4), printed[k++], 2e-6, 2e-6);
    for (const double head : {1e-4, 1e-3}) {
      const double force = pulled(n, head);
      check_close(fmt::format("A8a N={} force at {:g} mm [N]", n, 1e3 * head), force, shooting(n, head), 1e-6,
                  1e-8);
      // point springs are too stiff by 2.8 % at N = 20 where half a spring sits at the head: the continuous
      // bar is compared with the elongation at the middle of the head's spring taken off
      if (n == 20 && head > 5e-4)
        check_close("A8a N=20 against the continuous bar, 1 mm", force, continuous(head), 2e-2, 2e-2);
    }
  }
}
