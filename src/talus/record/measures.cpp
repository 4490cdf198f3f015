#include "talus/record/measures.h"

#include <fmt/format.h>

#include "talus/base/error.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "talus/record/fourier.h"

namespace talus::record {

namespace {

double largest(const std::vector<double>& values) {
  double out = 0;
  for (const double v : values) out = std::max(out, std::abs(v));
  return out;
}

// Integral of a^2 from the start to each sample [m2/s3], a linear between samples.
std::vector<double> squares_so_far(const Motion& m) {
  const std::vector<double>& a = m.acceleration;
  std::vector<double> sum(a.size(), 0);
  for (size_t i = 0; i + 1 < a.size(); ++i)
    sum[i + 1] = sum[i] + m.dt * (a[i] * a[i] + a[i] * a[i + 1] + a[i + 1] * a[i + 1]) / 3;
  return sum;
}

// When a sum that never falls passes `level`, linear between samples [s].
double time_of(const std::vector<double>& sum, double level, double dt) {
  const auto after = std::lower_bound(sum.begin(), sum.end(), level);
  const size_t i = after - sum.begin();
  if (i == 0) return 0;
  return dt * (static_cast<double>(i) - (sum[i] - level) / (sum[i] - sum[i - 1]));
}

}  // namespace

Measures measure(const Motion& motion) {
  Measures m;
  m.pga = largest(motion.acceleration);
  for (size_t i = 0; i < motion.size(); ++i)
    if (std::abs(motion.acceleration[i]) == m.pga) {
      m.pga_time = static_cast<double>(i) * motion.dt;
      break;
    }
  m.pgv = largest(motion.velocity);
  m.pgd = largest(motion.displacement);
  const std::vector<double> squares = squares_so_far(motion);
  m.arias = std::numbers::pi / (2 * kStandardGravity) * squares.back();
  if (squares.back() > 0)
    m.significant_duration = time_of(squares, 0.95 * squares.back(), motion.dt) -
                             time_of(squares, 0.05 * squares.back(), motion.dt);
  m.end_velocity = motion.velocity.back();
  m.end_displacement = motion.displacement.back();
  m.highest_frequency = highest_frequency(motion);
  return m;
}

double highest_frequency(const Motion& motion, double share) {
  std::vector<double> v = motion.velocity;
  v.resize(fast_length(v.size()), 0);
  const auto spectrum = transform(v);
  std::vector<double> sum;
  for (size_t k = 0; k < spectrum.size(); ++k) {
    const bool once = k == 0 || k + 1 == spectrum.size();  // all others stand for two frequencies, +f and -f
    sum.push_back((sum.empty() ? 0 : sum.back()) + (once ? 1 : 2) * std::norm(spectrum[k]));
  }
  const auto at = std::lower_bound(sum.begin(), sum.end(), share * sum.back());
  return static_cast<double>(at - sum.begin()) / (static_cast<double>(v.size()) * motion.dt);
}

void check_finite(const std::string& name, const Motion& motion, const Measures& m) {
  const auto refuse = [&name](const std::string& what) {
    throw InputError(fmt::format(
        "{}: {} is not finite: the numbers are too large to be filtered or integrated, so nothing was "
        "written. Is the unit right?",
        name, what));
  };
  for (size_t i = 0; i < motion.size(); ++i) {
    const double t = static_cast<double>(i) * motion.dt;
    if (!std::isfinite(motion.acceleration[i])) refuse(fmt::format("its acceleration at t = {:g} s", t));
    if (!std::isfinite(motion.velocity[i])) refuse(fmt::format("its velocity at t = {:g} s", t));
    if (!std::isfinite(motion.displacement[i])) refuse(fmt::format("its displacement at t = {:g} s", t));
  }
  for (const double v : {m.pga, m.pga_time, m.pgv, m.pgd, m.arias, m.significant_duration, m.end_velocity,
                         m.end_displacement, m.highest_frequency})
    if (!std::isfinite(v)) refuse("one of its measures");
}

std::string measures_table(const std::vector<std::pair<std::string, Measures>>& columns) {
  struct Line {
    const char* name;
    double Measures::*value;
  };
  const Line lines[] = {{"PGA [m/s2]", &Measures::pga},
                        {"  at [s]", &Measures::pga_time},
                        {"PGV [m/s]", &Measures::pgv},
                        {"PGD [m]", &Measures::pgd},
                        {"Arias intensity [m/s]", &Measures::arias},
                        {"duration D5-95 [s]", &Measures::significant_duration},
                        {"v at the end [m/s]", &Measures::end_velocity},
                        {"d at the end [m]", &Measures::end_displacement},
                        {"99.9 % of |V(f)|^2 below [Hz]", &Measures::highest_frequency}};
  static_assert(kVelocityShare == 0.999, "the table names the share");
  std::string out = fmt::format("{:<32}", "");
  for (const auto& [title, m] : columns) out += fmt::format("{:>14}", title);
  for (const Line& line : lines) {
    out += fmt::format("\n{:<32}", line.name);
    for (const auto& [title, m] : columns) out += fmt::format("{:>14.5g}", m.*line.value);
  }
  return out + "\n";
}

}  // namespace talus::record
