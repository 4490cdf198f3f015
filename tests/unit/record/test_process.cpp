// Each step of the processing against what it must do exactly.

#include "talus/record/process.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/relative.h"
#include "support/tolerance.h"
#include "talus/base/error.h"
#include "talus/base/random.h"
#include "talus/record/fourier.h"

namespace test_process {

using namespace talus;
using namespace talus::record;
using namespace talus::test;

namespace {

constexpr double kPi = std::numbers::pi;

std::vector<double> noise(size_t n) {
  Random random(3);
  std::vector<double> a(n);
  for (double& v : a) v = random.normal();
  return a;
}

double largest(const std::vector<double>& a) {
  double out = 0;
  for (const double v : a) out = std::max(out, std::abs(v));
  return out;
}

}  // namespace

TEST_CASE("motion: integrals of a linear acceleration are exact at any step") {
  // a = 3 - 2 t: v = 3 t - t^2, d = 3 t^2 / 2 - t^3 / 3
  for (const double dt : {0.5, 0.013}) {
    std::vector<double> a;
    for (int i = 0; i <= 40; ++i) a.push_back(3 - 2 * dt * i);
    const Motion m = integrate(a, dt);
    for (size_t i = 0; i < a.size(); ++i) {
      const double t = dt * static_cast<double>(i);
      CHECK(m.velocity[i] == approx(3 * t - t * t).epsilon(1e-12).scale(1));
      CHECK(m.displacement[i] == approx(1.5 * t * t - t * t * t / 3).epsilon(1e-12).scale(1));
    }
  }
}

TEST_CASE("fourier: transform against its sum, and back") {
  const std::vector<double> x = noise(60);
  const auto X = transform(x);
  REQUIRE(X.size() == 31);
  for (const size_t k : {0UL, 1UL, 7UL, 29UL, 30UL}) {
    std::complex<double> sum = 0;
    for (size_t j = 0; j < x.size(); ++j)
      sum += x[j] * std::polar(1.0, -2 * kPi * static_cast<double>(j * k) / static_cast<double>(x.size()));
    CHECK(std::abs(X[k] - sum) < 1e-12);  // 60 numbers of size 1
  }
  const std::vector<double> back = transform_back(X);
  REQUIRE(back.size() == x.size());
  for (size_t j = 0; j < x.size(); ++j) CHECK(std::abs(back[j] - x[j]) < 1e-13);
  CHECK(fast_length(7) == 8);
  CHECK(fast_length(60) == 60);
  CHECK(fast_length(2567) == 2592);  // 2^5 3^4
  CHECK(fast_length(121) == 128);    // even, though 125 = 5^3 is near
}

TEST_CASE("filter: gain at corners, an octave off and far off") {
  const Band band{0.5, 10, 4, Corner::k3dB};
  for (const double f : {0.1, 0.25, 0.5, 1.0, 3.0, 10.0, 20.0}) {
    const double high = 1 / std::sqrt(1 + std::pow(0.5 / f, 8)), low = 1 / std::sqrt(1 + std::pow(f / 10, 8));
    CHECK(butterworth_gain(band, f) == approx(high * low).epsilon(1e-14));
  }
  CHECK(butterworth_gain({0.5, 0, 4, Corner::k3dB}, 0.5) == approx(std::sqrt(0.5)).epsilon(1e-14));
  CHECK(butterworth_gain({0.5, 0, 4, Corner::k6dB}, 0.5) == approx(0.5).epsilon(1e-14));
  CHECK(butterworth_gain({0.5, 0, 4, Corner::k6dB}, 0.25) == approx(1 / 17.0).epsilon(1e-14));
  // order n: n x 6.02 dB per octave far from the corner, with either convention
  for (const Corner corner : {Corner::k3dB, Corner::k6dB}) {
    const Band low{0, 1, 6, corner};
    CHECK(butterworth_gain(low, 200) / butterworth_gain(low, 100) == approx(std::pow(0.5, 6)).epsilon(1e-9));
  }
  CHECK(butterworth_gain(band, 0) == 0);
  CHECK(butterworth_gain({0, 0, 4, Corner::k3dB}, 0) == 1);
}

TEST_CASE("filter: a harmonic comes out with the gain and in phase") {
  // in the middle, 25 s from where the harmonic begins at once: the slowest pole of order 4 decays as
  // exp(-2 pi f1 sin(pi / 8) t), f1 = 0.5 Hz, to 1e-13
  const double dt = 0.01, T = 50;
  const int n = (T / dt) + 1;
  for (const double f : {0.5, 1.0, 4.0, 10.0, 14.0}) {
    for (const Corner corner : {Corner::k3dB, Corner::k6dB}) {
      const Band band{0.5, 10, 4, corner};
      std::vector<double> a(n);
      for (size_t i = 0; i < n; ++i) a[i] = std::sin(2 * kPi * f * dt * static_cast<double>(i));
      const std::vector<double> out = filter(a, dt, band);
      REQUIRE(out.size() == n);
      double worst = 0;
      for (size_t i = n / 2 - 100; i < n / 2 + 100; ++i)
        worst = std::max(worst, std::abs(out[i] - butterworth_gain(band, f) * a[i]));
      check_below(fmt::format("filtered harmonic of {:g} Hz, corner {}", f, corner == Corner::k3dB ? 3 : 6),
                  worst, 1e-10, 1e-11);
    }
  }
}

TEST_CASE("process: mean of all, and of the time before the event") {
  std::vector<double> a{1, 2, 3, 4, 10};
  CHECK(remove_mean(a, 1, 0) == 4);
  CHECK(a == std::vector<double>{-3, -2, -1, 0, 6});
  a = {1, 2, 3, 4, 10};
  CHECK(remove_mean(a, 1, 2) == 2);  // of t = 0, 1, 2 s
  CHECK(a == std::vector<double>{-1, 0, 1, 2, 8});
}

TEST_CASE("process: tapers rise as a cosine and leave the middle alone") {
  std::vector<double> a(100, 1);
  taper_ends(a, 0.1);
  for (size_t i = 0; i < 10; ++i) {
    CHECK(a[i] == approx(std::pow(std::sin(kPi * static_cast<double>(i) / 20), 2)).scale(1));
    CHECK(a[99 - i] == a[i]);
  }
  for (size_t i = 10; i < 90; ++i) CHECK(a[i] == 1);
}

TEST_CASE("process: a polynomial drift is found and taken off") {
  // d = sum of q_k t^k at dt small: a = its second derivative. What is left is the error of linear
  // interpolation between samples, dt^2 / 12 of the fourth derivative
  const double dt = 0.01;
  const std::vector<double> q{0.3, -0.02, 4e-3, -2e-4, 3e-6};
  std::vector<double> a;
  for (int i = 0; i <= 1000; ++i) {
    double v = 0;
    for (int k = 2; k <= 6; ++k) v += q[k - 2] * k * (k - 1) * std::pow(dt * i, k - 2);
    a.push_back(v);
  }
  const double scale = largest(a);
  const std::vector<double> found = remove_baseline(a, dt, 6);
  for (size_t k = 0; k < q.size(); ++k)
    check_close(fmt::format("baseline coefficient of t^{}", k + 2), found[k], q[k], 1e-4, 1e-6);
  check_below("baseline: acceleration left / before", largest(a) / scale, 1e-5, 1e-6);
}

TEST_CASE("process: the window ends in zero and keeps the rest") {
  std::vector<double> a(101, 2);
  const auto whole = cut_window(a, 0.1, 0, 0, 1);
  CHECK(whole.size() == 101);
  CHECK(whole.front() == 2);
  CHECK(whole.back() == 0);
  CHECK(whole[90] == approx(2 * 0.5 * (1 + std::cos(kPi * 0.0))));
  CHECK(whole[95] == approx(2 * 0.5 * (1 + std::cos(kPi * 0.5))));
  const auto part = cut_window(a, 0.1, 2, 5, 1);
  CHECK(part.size() == 51);
  CHECK(part.front() == 0);
  CHECK(part[25] == 2);
  CHECK(part.back() == 0);
}

TEST_CASE("process: the end is at rest, and both ends of the acceleration stay") {
  std::vector<double> a = noise(2001);
  const double first = a.front(), last = a.back();
  pin_end(a, 0.01);
  const Motion m = integrate(a, 0.01);
  // sums of 2000 numbers of size 1: 1e-16 x 2000 x 0.01 s at v, x 20 s at d
  check_below("v(T) of noise brought to rest [m/s]", std::abs(m.velocity.back()), 1e-13, 1e-14);
  check_below("d(T) of noise brought to rest [m]", std::abs(m.displacement.back()), 1e-12, 1e-14);
  CHECK(a.front() == first);
  CHECK(a.back() == approx(last).epsilon(1e-12));

  // a pure combination of the two shapes is found again
  std::vector<double> shape;
  const double dt = 0.005, T = 10;
  for (int i = 0; i <= 2000; ++i) {
    const double t = dt * i;
    shape.push_back(3e-3 * t * (T - t) - 2e-4 * t * (T - t) * (T - 2 * t));
  }
  const auto [A, B] = pin_end(shape, dt);
  CHECK(A == approx(-3e-3).epsilon(1e-9));
  CHECK(B == approx(2e-4).epsilon(1e-9));
  CHECK(largest(shape) < 1e-12);
}

TEST_CASE("process: says what it did, in its order") {
  const Processed p = process(noise(4001), 0.01, {}, "noise");
  std::vector<std::string> names;
  for (const Step& s : p.steps) names.push_back(s.name);
  CHECK(names ==
        std::vector<std::string>{"mean removed", "cosine taper at both ends", "zero-phase Butterworth filter",
                                 "polynomial baseline of the displacement", "window", "end brought to rest"});
  CHECK(std::abs(p.motion.displacement.back()) < 1e-12);
  CHECK(p.motion.size() == 4001);
}

TEST_CASE("process: options that do not fit the record are refused") {
  const auto message = [](const auto& change) {
    Processing how;
    change(how);
    try {
      check_processing(how, 2001, 0.02, "r");  // 40 s, 25 Hz
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("(accepted)");
  };
  CHECK(message([](Processing&) {}) == "(accepted)");
  CHECK(message([](Processing& h) { h.taper = 0.6; }) ==
        "r: error: a taper of 0.6 of the record at each end\n      = give a share from 0 to 0.5");
  CHECK(message([](Processing& h) { h.band.low_pass = 25; }) ==
        "r: error: the low-pass corner of 25 Hz is not below half the sampling rate, 25 Hz\n      = give "
        "--low-pass below it, or 0 for none");
  CHECK(message([](Processing& h) { h.band.high_pass = 20; }) ==
        "r: error: the band from 20 to 15 Hz is empty\n      = the high-pass corner is the lower one");
  CHECK(message([](Processing& h) { h.band.high_pass = 1e-6; }) ==
        "r: error: a high-pass corner of 1e-06 Hz needs 6e+06 s of zeros on each side\n      = give a higher "
        "one, or 0 for none");
  CHECK(message([](Processing& h) { h.band.order = 0; }) ==
        "r: error: filter 0.1 to 15 Hz, order 0\n      = corners are 0 (none) or above, the order is from 1 "
        "to 20");
  CHECK(message([](Processing& h) { h.baseline_degree = 1; }) ==
        "r: error: a baseline of degree 1\n      = give 2 to 10, or 0 for none");
  CHECK(message([](Processing& h) { h.pre_event = 50; }) ==
        "r: error: 50 s before the event in a record of 40 s\n      = give less than the record, or 0 for "
        "the mean of all");
  CHECK(message([](Processing& h) { h.begin = 30, h.duration = 11; }) ==
        "r: error: the window from 30 s of 11 s in a record of 40 s\n      = give --begin and --duration "
        "inside the record");
  CHECK(message([](Processing& h) { h.duration = 1.5; }) ==
        "r: error: an end taper of 1 s in a window of 1.5 s\n      = give at most half the window");
  CHECK(message([](Processing& h) { h.duration = 0.1, h.end_taper = 0; }) ==
        "r: error: the window of 0.1 s has fewer than ten steps\n      = widen it");
}

}  // namespace test_process
