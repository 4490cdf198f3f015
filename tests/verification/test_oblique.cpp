// A4d: what a viscous edge reflects of waves that come in at an angle. The ground is cut into triangles and
// its sides are tied, so that waves repeat themselves sideways; forces that run along the foot send up
// pressure and shear waves of one trace, and the steady motion is taken apart into the four plane waves that
// there can be.

#include <Eigen/Dense>
#include <complex>
#include <numbers>

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_oblique {

using namespace talus;
using namespace talus::test;

namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;
constexpr double kDensity = 2500, kShear = 2000;                       // [kg/m3], cs [m/s]; poisson 0.25
const double kPressure = std::sqrt(3.0) * kShear;                      // cp
constexpr int kAcross = 24, kUp = 16;                                  // cells; 12 to a shear wave
constexpr double kWidth = 24, kHeight = 16;                            // [m]
const double kTrace = 2 * kPi / kWidth, kOmega = 2 * kTrace * kShear;  // S at 30 degrees, P at 60
const double kPeriod = 2 * kPi / kOmega;

std::string model(char axis) {
  std::string out = fmt::format(R"toml(
talus = 1
[material.a]
density = 2500
young = "25 GPa"
poisson = 0.25
[joint.glue]
kind = "bonded"
[[grid]]
name = "a"
min = [0, 0]
max = [{0}, {1}]
cells = [{2}, {3}]
pattern = "crossed_triangles"
material = "a"
joint = "glue"
[[boundary]]
name = "top"
kind = "viscous"
edge = [[0, {1}], [{0}, {1}]]
[[boundary]]
name = "foot"
kind = "viscous"
edge = [[0, 0], [{0}, 0]]
[[boundary]]
name = "sides"
kind = "tied"
edge = [[0, 0], [0, {1}]]
to_edge = [[{0}, 0], [{0}, {1}]]
[[stage]]
name = "waves"
kind = "dynamic"
duration = {4:.17g}
time_step = {5:.17g}
)toml",
                                kWidth, kHeight, kAcross, kUp, 8 * kPeriod, kPeriod / 120);
  for (int i = 0; i < kAcross; ++i)
    out += fmt::format(
        "[history.f{0}]\nexpression = \"(t < {1:.17g} ? 0.5*(1-cos(_pi*t/{1:.17g})) : "
        "1)*1e4*sin({2:.17g}*t-{3:.17g})\"\n"
        "duration = {4:.17g}\n"
        "[[load]]\nname = \"f{0}\"\nedge = [[{0}, 0], [{5}, 0]]\ntraction_{6} = \"f{0}\"\n",
        i, 2 * kPeriod, kOmega, kTrace * (i + 0.5), 8 * kPeriod, i + 1, axis);
  return out;
}

// Plane wave with displacement d exp(i(w t - k x - kz z)).
struct Wave {
  double kz;
  Vec2 d;
};

// P up, S up, P down, S down, of speeds off by the factors of P and S.
std::array<Wave, 4> waves(double p = 1, double s = 1) {
  const double kp = kOmega / (p * kPressure), ks = kOmega / (s * kShear);
  const double zp = std::sqrt(kp * kp - kTrace * kTrace), zs = std::sqrt(ks * ks - kTrace * kTrace);
  return {{{zp, {kTrace / kp, zp / kp}},
           {zs, {zs / ks, -kTrace / ks}},
           {-zp, {kTrace / kp, -zp / kp}},
           {-zs, {zs / ks, kTrace / ks}}}};
}

// Stress on the edge plus rho c v has to vanish: the waves down for each wave up.
Eigen::Matrix2cd exact() {
  Eigen::Matrix<double, 2, 4> q;
  const double mu = kDensity * kShear * kShear, c11 = kDensity * kPressure * kPressure;
  const auto all = waves();
  for (int i = 0; i < 4; ++i) {
    const auto [kz, d] = all[i];
    q(0, i) = mu * (kTrace * d.y + kz * d.x) - kDensity * kShear * kOmega * d.x;
    q(1, i) = (c11 - 2 * mu) * kTrace * d.x + c11 * kz * d.y - kDensity * kPressure * kOmega * d.y;
  }
  return (-q.rightCols<2>().inverse() * q.leftCols<2>()).cast<Complex>();
}

// Amplitudes of the four waves at the top edge.
Eigen::Vector4cd taken_apart(const std::vector<Vec2>& place,
                             const std::vector<std::array<Complex, 2>>& motion) {
  Eigen::Vector4cd best;
  double least = 1e300;
  const auto rows = static_cast<Eigen::Index>(2 * place.size());
  Eigen::MatrixXcd a(rows, 4);
  Eigen::VectorXcd b(rows);
  // waves in triangles run up to some per cent too fast: the speeds that fit best
  for (double p = 0.98; p < 1.05; p += 0.005)
    for (double s = 0.98; s < 1.05; s += 0.005) {
      const auto all = waves(p, s);
      for (size_t i = 0; i < place.size(); ++i)
        for (Eigen::Index c = 0; c < 2; ++c) {
          const auto row = static_cast<Eigen::Index>(2 * i) + c;
          for (Eigen::Index w = 0; w < 4; ++w) {
            const Wave& wave = all[w];
            a(row, w) = (c == 0 ? wave.d.x : wave.d.y) *
                        std::polar(1.0, -kTrace * place[i].x - wave.kz * (place[i].y - kHeight));
          }
          b(row) = motion[i][c];
        }
      const Eigen::Vector4cd x = (a.adjoint() * a).ldlt().solve(a.adjoint() * b);
      const double off = (a * x - b).norm() / b.norm();
      if (off < least) least = off, best = x;
    }
  check_below("A4d motion that is none of the four waves", least, 5e-2, 2e-2);
  return best;
}

}  // namespace

TEST_CASE("A4d viscous edge: pressure waves at 60 degrees, shear waves at 30" *
          doctest::test_suite("optimised")) {
  const Eigen::Matrix2cd law = exact();
  for (int i = 0; i < 4; ++i) CHECK(std::abs(std::abs(law(i / 2, i % 2)) - 0.134) < 5e-4);  // published

  Eigen::Matrix2cd up, down;
  for (const int k : {0, 1}) {
    std::vector<Vec2> place;
    std::vector<std::array<Complex, 2>> motion;
    std::vector<size_t> block;
    const CaseResult r = run_case(model(k == 0 ? 'x' : 'y'), {}, [&](const Instant& i) {
      if (place.empty())
        for (size_t b = 0; b < i.scene.blocks.centroid.size(); ++b) {
          const Vec2 c = i.scene.blocks.centroid[b];
          if (c.y > 3 && c.y < kHeight - 1) place.push_back(c), block.push_back(b);
        }
      motion.resize(place.size());
      if (i.state.time < 6 * kPeriod * (1 - 1e-9) || i.last) return;  // two whole periods
      for (size_t j = 0; j < place.size(); ++j) {
        const Vec2 v = rate_now(i.work, i.state, block[j]).a;
        motion[j][0] += v.x * std::polar(1.0, -kOmega * i.state.time);
        motion[j][1] += v.y * std::polar(1.0, -kOmega * i.state.time);
      }
    });
    const Eigen::Vector4cd w = taken_apart(place, motion);
    up.col(k) = w.head<2>(), down.col(k) = w.tail<2>();
    check_below("A4d energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
  }
  const Eigen::Matrix2cd found = down * up.inverse();
  const char* name[2][2] = {{"P from P at 60 deg", "P from S at 30 deg"},
                            {"S from P at 60 deg", "S from S at 30 deg"}};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      check_close(fmt::format("A4d {}", name[i][j]), std::abs(found(i, j)), std::abs(law(i, j)), 3e-2, 1e-2,
                  1);
}

}  // namespace test_oblique
