// A6a: a column of bonded blocks under its own weight, at rest and when gravity comes suddenly.

#include <complex>
#include <numbers>

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_column {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kHeight = 10, kWidth = 1, kYoung = 50e6, kDensity = 2000, kG = 9.81;

// nu = 0: the sides are free and the state one-dimensional, in plane strain too
std::string column_text(int n, const std::string& stage) {
  std::string out = fmt::format(R"(
talus = 1
[model]
gravity = [0, -{}]
[material.m]
density = {}
young = {}
poisson = 0
[joint.glue]
kind = "bonded"
[[grid]]
name = "column"
min = [0, 0]
max = [{}, {}]
cells = [1, {}]
material = "m"
joint = "glue"
[[support]]
name = "base"
edge = [[0, 0], [{}, 0]]
[[monitor]]
name = "top"
point = [0.5, {}]
[[monitor]]
name = "base"
support = "base"
)",
                                kG, kDensity, kYoung, kWidth, kHeight, n, kWidth, kHeight);
  for (int i = 1; i < n; ++i)
    out += fmt::format("[[monitor]]\nname = \"j{0}\"\ncontact = [\"column[0,{0}]\", \"column[0,{1}]\"]\n", i,
                       i - 1);
  return out + stage;
}

const double kStatic = -kDensity * kG * kHeight * kHeight / (2 * kYoung);  // u_top [m]

}  // namespace

TEST_CASE("A6a column at rest: settlement and joint forces") {
  for (const int n : {1, 5, 10}) {
    const CaseResult r = run_case(
        column_text(n, "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 60\nunbalanced = 1e-11\n"));
    CHECK(r.run.stages[0].at_rest);
    // what is left is the balance asked for, 1e-11 of the weight of a block
    check_close(fmt::format("A6a N={} settlement of the top", n), r.column("top.displacement_y").back(),
                kStatic, 1e-6, 1e-9);
    const double weight = kDensity * kG * kHeight * kWidth;
    check_close(fmt::format("A6a N={} reaction / weight", n), r.column("base.reaction_y").back() / weight, 1,
                1e-6, 1e-9);
    double worst = 0;
    for (int i = 1; i < n; ++i) {
      const double above = weight * (n - i) / n;
      worst = std::max(worst, std::abs(r.column(fmt::format("j{}.normal_force", i)).back() / above - 1));
    }
    if (n > 1)
      check_below(fmt::format("A6a N={} joint forces against the weight above", n), worst, 1e-6, 1e-9);
    check_below(fmt::format("A6a N={} energy left over / largest term", n), r.run.closure(), 1e-2, 1e-3);
  }
}

TEST_CASE("A6a sudden gravity: peak and period") {
  const double c = std::sqrt(kYoung / kDensity), transit = kHeight / c;
  struct Case {
    int n;
    double period;  // of the lowest mode, in 4 H / c
  };
  for (const Case k : {Case{1, 0.90690}, Case{5, 0.99590}, Case{10, 0.99897}}) {
    // steps far below the limit: the period of the blocks, not of the time scheme, is compared
    const CaseResult r = run_case(column_text(
        k.n,
        fmt::format("[[stage]]\nname = \"sudden\"\nkind = \"dynamic\"\nduration = {:.17g}\nsafety = 0.1\n",
                    80 * transit)));
    const auto &t = r.column("t [s]"), &u = r.column("top.displacement_y");
    double peak = 0;
    for (size_t i = 0; i < t.size() && t[i] < 4 * transit; ++i) peak = std::min(peak, u[i]);
    check_close(fmt::format("A6a N={} first peak / static settlement", k.n), peak / kStatic, 2, 5e-3, 1e-3);

    // lowest frequency: where the Fourier integral over a Hann window is largest
    const auto strength = [&](double omega) {
      std::complex<double> sum;
      for (size_t i = 0; i < t.size(); ++i) {
        const double hann = 1 - std::cos(2 * std::numbers::pi * t[i] / t.back());
        sum += hann * (u[i] - kStatic) * std::polar(1.0, -omega * t[i]);
      }
      return std::abs(sum);
    };
    const double expected = 2 * std::numbers::pi / (4 * transit * k.period);
    double low = 0.98 * expected, high = 1.02 * expected;
    while (high - low > 1e-6 * expected) {
      const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
      if (strength(a) > strength(b))
        high = b;
      else
        low = a;
    }
    const double period = 2 * std::numbers::pi / (0.5 * (low + high)) / (4 * transit);
    check_close(fmt::format("A6a N={} period / (4 H/c)", k.n), period, k.period, 5e-3, 1e-3);
    check_below(fmt::format("A6a N={} sudden, energy left over / largest term", k.n), r.run.closure(), 1e-2,
                1e-3);
  }
}

}  // namespace test_column
