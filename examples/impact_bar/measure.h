#pragma once
// What is compared between a run of impact_bar.toml and the exact solution. Shared by the example and its
// tests.

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "exact.h"
#include "talus/output/csv.h"

namespace talus::example {

/// One case of the example; lengths and densities are those of impact_bar.toml.
struct BarCase {
  double young = 1e7;      // [Pa]
  double velocity = 1.25;  // [m/s]

  static constexpr double kLength = 0.5, kArea = 0.05 * 0.05, kDensity = 2700;
  static constexpr double kAlpha = (0.5 * 0.05 * 2700) / (0.075 * 0.075 * 8000);  // 1.5
  static constexpr double kWindow = 0.2;                                          // of the mean, in L/c

  double time_unit() const { return kLength / std::sqrt(young / kDensity); }              // L/c [s]
  double force_unit() const { return kArea * std::sqrt(young * kDensity) * velocity; }    // F0 [N]
  double impulse_unit() const { return kLength * kArea * kDensity / kAlpha * velocity; }  // M1 v0 [N s]
};

/// Dimensionless results: times in L/c, forces in F0, impulses in M1 v0, velocities in v0.
struct BarMeasures {
  double second_peak = 0, exact_second_peak = 0;  // of the mean over 0.2 L/c, 1.9 < tau < 2.6
  double impulse = 0, exact_impulse = 0;
  double impulse_error = 0;  // largest of the impulse so far, as share of the total
  double separation = 0, exact_separation = 0;
  double rebound = 0, exact_rebound = 0;
  double raw_first = 0, raw_peak = 0;  // largest force of a single step: the first; after tau = 0.3
};

/// @param run  histories of a run, every step
inline BarMeasures measure(const BarCase& bar, const CsvTable& run) {
  const BarImpact exact(BarCase::kAlpha);
  const auto &t = run.column("t [s]"), &force = run.column("impact.normal_force [N]"),
             &impulse = run.column("impact.normal_impulse [N s]");
  const auto& v = run.column("striker.velocity_x [m/s]");
  BarMeasures m;
  const double half = 0.5 * BarCase::kWindow;
  // impulse at any time, linear between the steps
  size_t at = 0;
  const auto impulse_at = [&](double tau) {
    const double time = tau * bar.time_unit();
    while (at + 1 < t.size() && t[at + 1] < time) ++at;
    while (at > 0 && t[at] > time) --at;
    if (at + 1 >= t.size()) return impulse.back() / bar.impulse_unit();
    const double s = std::min(std::max((time - t[at]) / (t[at + 1] - t[at]), 0.0), 1.0);
    return (impulse[at] + s * (impulse[at + 1] - impulse[at])) / bar.impulse_unit();
  };
  for (double tau = 0; tau <= 3.2; tau += 2e-4) {
    m.impulse_error = std::max(m.impulse_error, std::abs(impulse_at(tau) - exact.impulse(tau)));
    if (tau < 1.9 || tau > 2.6) continue;
    const double mean =
        (impulse_at(tau + half) - impulse_at(tau - half)) / (BarCase::kAlpha * BarCase::kWindow);
    m.second_peak = std::max(m.second_peak, mean);
    m.exact_second_peak = std::max(m.exact_second_peak, exact.mean_force(tau, BarCase::kWindow));
  }
  size_t last = 0;
  for (size_t i = 0; i < t.size(); ++i) {
    if (force[i] > 1e-6 * bar.force_unit()) last = i;  // a parting contact may touch once more by round-off
    if (t[i] > 0.3 * bar.time_unit()) m.raw_peak = std::max(m.raw_peak, force[i] / bar.force_unit());
  }
  m.raw_first = force[0] / bar.force_unit();
  m.separation = t[std::min(last + 1, t.size() - 1)] / bar.time_unit();
  m.exact_separation = exact.separation();
  m.impulse = impulse.back() / bar.impulse_unit();
  m.exact_impulse = exact.impulse(exact.separation());
  m.impulse_error /= m.exact_impulse;
  m.rebound = -v.back() / bar.velocity;
  m.exact_rebound = exact.rebound();
  return m;
}

/// Exact curves with the column titles of a run: the force, and its mean over the window.
inline std::string exact_csv(const BarCase& bar) {
  const BarImpact exact(BarCase::kAlpha);
  std::string out = "t [s],impact.normal_force [N],impact.mean_normal_force [N]\n";
  const auto row = [&](double tau, double force) {
    out += fmt::format("{:.9g},{:.9g},{:.9g}\n", tau * bar.time_unit(), force * bar.force_unit(),
                       exact.mean_force(tau, BarCase::kWindow) * bar.force_unit());
  };
  for (int i = 0; i <= 2000; ++i) row(i * 3.2 / 2000, exact.force(i * 3.2 / 2000));
  return out;
}

}  // namespace talus::example
