#include "talus/record/response_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus::record {

namespace {

constexpr double kStepsPerPeriod = 40;

}  // namespace

// Within a step a = a0 + s t with s = (a1 - a0) / dt. A particular solution is u = c0 + c1 t with
// c1 = -s / w^2 and c0 = -(a0 + 2 zeta w c1) / w^2 ... from  2 zeta w c1 + w^2 (c0 + c1 t) = -a0 - s t;
// the rest decays freely: u = exp(-zeta w t) (C cos wd t + S sin wd t).
OscillatorStep oscillator_step(double period, double damping, double dt) {
  const double w = 2 * std::numbers::pi / period, z = damping, wd = w * std::sqrt(1 - z * z);
  const double decay = std::exp(-z * w * dt), c = std::cos(wd * dt), s = std::sin(wd * dt);
  const auto advance = [&](double u0, double v0, double a0, double a1, double& u, double& v) {
    const double c1 = -(a1 - a0) / (dt * w * w), c0 = -(a0 + 2 * z * w * c1) / (w * w);
    const double C = u0 - c0, S = (v0 - c1 + z * w * C) / wd;
    u = decay * (C * c + S * s) + c0 + c1 * dt;
    v = decay * ((S * wd - z * w * C) * c - (C * wd + z * w * S) * s) + c1;
  };
  OscillatorStep step{};
  advance(1, 0, 0, 0, step.A[0][0], step.A[1][0]);
  advance(0, 1, 0, 0, step.A[0][1], step.A[1][1]);
  advance(0, 0, 1, 0, step.B[0][0], step.B[1][0]);
  advance(0, 0, 0, 1, step.B[0][1], step.B[1][1]);
  return step;
}

std::vector<double> oscillator_response(const std::vector<double>& a, double dt, double period,
                                        double damping) {
  const auto [A, B] = oscillator_step(period, damping, dt);
  std::vector<double> out(a.size(), 0);
  double u = 0, v = 0;
  for (size_t i = 0; i + 1 < a.size(); ++i) {
    const double next = A[0][0] * u + A[0][1] * v + B[0][0] * a[i] + B[0][1] * a[i + 1];
    v = A[1][0] * u + A[1][1] * v + B[1][0] * a[i] + B[1][1] * a[i + 1];
    out[i + 1] = u = next;
  }
  return out;
}

std::vector<double> response_spectrum(const std::vector<double>& acceleration, double dt,
                                      const std::vector<double>& periods, double damping) {
  std::vector<double> out;
  for (const double period : periods) {
    const auto parts = static_cast<size_t>(std::max(1.0, std::ceil(kStepsPerPeriod * dt / period)));
    const double h = dt / static_cast<double>(parts);
    std::vector<double> fine;
    fine.reserve(acceleration.size() * parts + static_cast<size_t>(period / h) + 2);
    for (size_t i = 0; i + 1 < acceleration.size(); ++i)
      for (size_t k = 0; k < parts; ++k)
        fine.push_back(acceleration[i] + (acceleration[i + 1] - acceleration[i]) * static_cast<double>(k) /
                                             static_cast<double>(parts));
    fine.push_back(acceleration.back());
    fine.resize(fine.size() + static_cast<size_t>(std::ceil(period / h)), 0.0);
    double largest = 0;
    for (const double u : oscillator_response(fine, h, period, damping))
      largest = std::max(largest, std::abs(u));
    const double w = 2 * std::numbers::pi / period;
    out.push_back(w * w * largest);
  }
  return out;
}

std::vector<double> spectrum_periods(double shortest, double longest, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i)
    out.push_back(shortest * std::pow(longest / shortest, static_cast<double>(i) / (count - 1)));
  return out;
}

}  // namespace talus::record
