// Oscillator response and measures against closed forms.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/relative.h"
#include "support/tolerance.h"
#include "talus/record/measures.h"
#include "talus/record/response_spectrum.h"

namespace test_spectrum {

using namespace talus::record;
using namespace talus::test;

namespace {

constexpr double kPi = std::numbers::pi;

// u'' + 2 z w u' + w^2 u = -A sin(p t) from rest, at t.
double harmonic_response(double A, double p, double w, double z, double t) {
  const double r = w * w - p * p, c = 2 * z * w * p, D = r * r + c * c;
  const double S = -A * r / D, C = A * c / D;  // steady state S sin + C cos
  const double wd = w * std::sqrt(1 - z * z), b = -C, a = (-S * p - C * z * w) / wd;
  return S * std::sin(p * t) + C * std::cos(p * t) +
         std::exp(-z * w * t) * (a * std::sin(wd * t) + b * std::cos(wd * t));
}

std::vector<double> harmonic(double A, double p, double dt, size_t n) {
  std::vector<double> a(n);
  for (size_t i = 0; i < n; ++i) a[i] = A * std::sin(p * dt * static_cast<double>(i));
  return a;
}

}  // namespace

TEST_CASE("oscillator: the step is exact for an acceleration that rises linearly, at any step") {
  // from rest under a = s t: u = -(s / w^3) (w t - 2 z + exp(-z w t) (2 z cos wd t - (1 - 2 z^2) w / wd sin
  // wd t))
  const double s = 3, period = 0.7, z = 0.05, w = 2 * kPi / period, wd = w * std::sqrt(1 - z * z);
  for (const double dt : {0.01, 0.3, 2.0}) {
    std::vector<double> a;
    for (int i = 0; i <= 20; ++i) a.push_back(s * dt * i);
    const std::vector<double> u = oscillator_response(a, dt, period, z);
    for (size_t i = 0; i < u.size(); ++i) {
      const double t = dt * static_cast<double>(i);
      const double exact =
          -s / (w * w * w) *
          (w * t - 2 * z +
           std::exp(-z * w * t) * (2 * z * std::cos(wd * t) - (1 - 2 * z * z) * w / wd * std::sin(wd * t)));
      CHECK(std::abs(u[i] - exact) < 1e-13 * (1 + std::abs(exact)));
    }
  }
}

TEST_CASE("oscillator: response to a harmonic, second order in the step") {
  // straight lines between samples of a sine of pulsation p follow it to (p dt)^2 / 12 in the mean; p = 2 pi
  // 2 Hz, dt = 0.005 s: 3e-4 of the response
  const double p = 4 * kPi, A = 2;
  for (const double period : {0.2, 0.5, 1.3}) {
    const double w = 2 * kPi / period;
    double error[2];
    for (const int k : {0, 1}) {
      const double dt = k == 0 ? 0.005 : 0.0025;
      const auto n = static_cast<size_t>(10 / dt) + 1;
      const std::vector<double> u = oscillator_response(harmonic(A, p, dt, n), dt, period, 0.05);
      double worst = 0, size = 0;
      for (size_t i = 0; i < n; ++i) {
        const double exact = harmonic_response(A, p, w, 0.05, dt * static_cast<double>(i));
        worst = std::max(worst, std::abs(u[i] - exact)), size = std::max(size, std::abs(exact));
      }
      error[k] = worst / size;
    }
    check_below(fmt::format("response of {:g} s to a harmonic of 0.5 s", period), error[0], 5e-4, 3.5e-4);
    CHECK(error[0] / error[1] == approx(4).epsilon(0.02));
  }
}

TEST_CASE("spectrum: peak response to a harmonic of whole periods") {
  // the motion is 8 s of a sine of 0.5 s (whole periods: it ends in zero), then the oscillator swings freely;
  // a sampled peak is at most 0.3 % low (40 steps a period), and the exact peak is sought as finely as can be
  const double p = 4 * kPi, A = 2, T = 8, z = 0.05;
  const std::vector<double> periods{0.1, 0.2, 0.4, 0.5, 0.6, 1.0, 2.0};
  const std::vector<double> sa = response_spectrum(harmonic(A, p, 0.002, 4001), 0.002, periods);
  for (size_t k = 0; k < periods.size(); ++k) {
    const double w = 2 * kPi / periods[k], wd = w * std::sqrt(1 - z * z), h = 1e-4;
    double exact = 0;
    for (double t = 0; t <= T; t += h) exact = std::max(exact, std::abs(harmonic_response(A, p, w, z, t)));
    const double u = harmonic_response(A, p, w, z, T);
    const double v =
        (harmonic_response(A, p, w, z, T + 1e-6) - harmonic_response(A, p, w, z, T - 1e-6)) / 2e-6;
    for (double t = 0; t <= periods[k]; t += h)
      exact = std::max(exact, std::abs(std::exp(-z * w * t) *
                                       (u * std::cos(wd * t) + (v + z * w * u) / wd * std::sin(wd * t))));
    check_close(fmt::format("Sa({:g} s) of a harmonic of 0.5 s [m/s2]", periods[k]), sa[k], w * w * exact,
                3.1e-3, 1e-3);
  }
  // the limits: stiff, the ground itself; in resonance 1 / (2 zeta) after long
  CHECK(response_spectrum(harmonic(A, p, 0.002, 4001), 0.002, {0.01})[0] == approx(A).epsilon(1e-3));
  CHECK(response_spectrum(harmonic(A, p, 0.002, 20001), 0.002, {0.5})[0] == approx(A * 10).epsilon(3e-3));
}

TEST_CASE("spectrum: the peak may come after the motion") {
  // a kick of 0.1 s makes an oscillator of 2 s swing farthest half a second later; zeros behind it change
  // nothing but the places of the samples: 0.3 % at most
  const std::vector<double> kick = harmonic(3, 10 * kPi, 0.01, 11);
  std::vector<double> quiet = kick;
  quiet.resize(1000, 0.0);
  const double alone = response_spectrum(kick, 0.01, {2.0})[0],
               padded = response_spectrum(quiet, 0.01, {2.0})[0];
  CHECK(alone == approx(padded).epsilon(3e-3));
  // impulse v0 over w, of the sine by its eleven samples (0.8 % less than 3 x 0.2 / pi), damped until its peak:
  // w v0 exp(-zeta atan(1/zeta)); the kick is no point in time, (w 0.1 s)^2 / 42
  const double w = kPi, v0 = 3 * 0.01 / std::tan(kPi / 20), z = kSpectrumDamping;
  CHECK(alone == approx(w * v0 * std::exp(-z * std::atan(std::sqrt(1 - z * z) / z))).epsilon(4e-3));
}

TEST_CASE("measures: of half a sine of velocity") {
  // a = A sin(2 pi t / T) for one period: v = A T / (2 pi) (1 - cos), PGV = A T / pi, d(T) = A T^2 / (2 pi),
  // Arias = pi / (2 g) A^2 T / 2; second order in the step: (2 pi dt / T)^2 / 12 = 8e-7
  const double A = 4, T = 2, dt = 0.001;
  const Motion m = integrate(harmonic(A, 2 * kPi / T, dt, 2001), dt);
  const Measures x = measure(m);
  check_close("PGA of a sine [m/s2]", x.pga, A, 1e-12, 1e-15);
  CHECK(x.pga_time == approx(0.5));
  check_close("PGV of a sine [m/s]", x.pgv, A * T / kPi, 2e-6, 1e-6);
  check_close("PGD of a sine [m]", x.pgd, A * T * T / (2 * kPi), 2e-6, 1e-6);
  check_close("Arias intensity of a sine [m/s]", x.arias, kPi / (2 * 9.80665) * A * A * T / 2, 4e-6, 2e-6);
  check_below("v(T) of a sine [m/s]", std::abs(x.end_velocity), 1e-12, 1e-14);
  check_close("d(T) of a sine [m]", x.end_displacement, A * T * T / (2 * kPi), 2e-6, 1e-6);
  // constant |a|: 5 % to 95 % is nine tenths of the time
  CHECK(measure(integrate(std::vector<double>(101, 1.0), 0.1)).significant_duration == approx(9));
}

TEST_CASE("measures: the highest frequency that matters is where the shares say") {
  // v = cos at 1 Hz and 0.1 of it at 8 Hz, over 20 s: the second holds 1 % of the integral of |V|^2
  const double dt = 0.01;
  Motion m;
  m.dt = dt;
  for (int i = 0; i < 2000; ++i)
    m.velocity.push_back(std::cos(2 * kPi * dt * i) + 0.1 * std::cos(16 * kPi * dt * i));
  CHECK(highest_frequency(m, 0.98) == approx(1));
  CHECK(highest_frequency(m, 0.995) == approx(8));
  CHECK(highest_frequency(m) == approx(8));
  // a mean of v counts once, what swings for +f and -f: 1 and 0.02
  for (int i = 0; i < 2000; ++i) m.velocity[i] = 1 + 0.2 * std::cos(16 * kPi * dt * i);
  CHECK(highest_frequency(m, 0.975) == 0);
  CHECK(highest_frequency(m, 0.985) == approx(8));
}

TEST_CASE("measures: the table has a line for each") {
  const Motion m = integrate({0, 1, 0, -1, 0}, 1);
  const std::string table = measures_table({{"as read", measure(m)}, {"processed", measure(m)}});
  for (const char* word : {"as read", "processed", "PGA [m/s2]", "PGV", "PGD", "Arias", "D5-95",
                           "v at the end", "d at the end", "99.9 %"})
    CHECK(table.find(word) != std::string::npos);
}

}  // namespace test_spectrum
