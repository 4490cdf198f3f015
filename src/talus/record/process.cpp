#include "talus/record/process.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "talus/base/error.h"

namespace talus::record {

namespace {

constexpr double kMostPadded = 5e7;  // samples to transform, 400 MB of them

// Raised cosine from 0 to 1 in m samples.
double rise(size_t i, size_t m) {
  return 0.5 * (1 - std::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(m)));
}

size_t steps_in(double time, double dt) { return static_cast<size_t>(std::llround(time / dt)); }

[[noreturn]] void refuse(const std::string& source, const std::string& text, const std::string& hint) {
  throw InputError(fmt::format("{}: error: {}\n      = {}", source, text, hint));
}

}  // namespace

double remove_mean(std::vector<double>& a, double dt, double pre_event) {
  const size_t n = pre_event > 0 ? std::min(steps_in(pre_event, dt) + 1, a.size()) : a.size();
  double mean = 0;
  for (size_t i = 0; i < n; ++i) mean += a[i] / static_cast<double>(n);
  for (double& v : a) v -= mean;
  return mean;
}

void taper_ends(std::vector<double>& a, double share) {
  const auto m = static_cast<size_t>(share * static_cast<double>(a.size()));
  for (size_t i = 0; i < m; ++i) {
    a[i] *= rise(i, m);
    a[a.size() - 1 - i] *= rise(i, m);
  }
}

std::vector<double> remove_baseline(std::vector<double>& a, double dt, int degree) {
  const Motion m = integrate(a, dt);
  const double T = m.duration();
  const auto n = static_cast<Eigen::Index>(m.size());
  Eigen::MatrixXd powers(n, degree - 1);  // (t/T)^k: keeps the columns comparable
  for (Eigen::Index i = 0; i < n; ++i)
    for (int k = 2; k <= degree; ++k) powers(i, k - 2) = std::pow(static_cast<double>(i) * dt / T, k);
  const Eigen::VectorXd q =
      powers.householderQr().solve(Eigen::Map<const Eigen::VectorXd>(m.displacement.data(), n));
  for (size_t i = 0; i < a.size(); ++i) {
    const double s = static_cast<double>(i) * dt / T;
    for (int k = 2; k <= degree; ++k) a[i] -= q[k - 2] * k * (k - 1) * std::pow(s, k - 2) / (T * T);
  }
  std::vector<double> out;
  for (int k = 2; k <= degree; ++k) out.push_back(q[k - 2] / std::pow(T, k));
  return out;
}

std::vector<double> cut_window(const std::vector<double>& a, double dt, double begin, double duration,
                               double taper) {
  const size_t first = steps_in(begin, dt),
               last = duration > 0 ? first + steps_in(duration, dt) : a.size() - 1;
  std::vector<double> out(a.begin() + first, a.begin() + last + 1);
  const size_t m = std::min(steps_in(taper, dt), out.size());
  for (size_t i = 0; i < m; ++i) {
    out[out.size() - 1 - i] *= rise(i, m);
    if (begin > 0) out[i] *= rise(i, m);
  }
  return out;
}

std::pair<double, double> pin_end(std::vector<double>& a, double dt) {
  const double T = dt * static_cast<double>(a.size() - 1);
  std::vector<double> p(a.size()), q(a.size());
  for (size_t i = 0; i < a.size(); ++i) {
    const double t = static_cast<double>(i) * dt;
    p[i] = t * (T - t), q[i] = p[i] * (T - 2 * t);
  }
  const Motion mp = integrate(p, dt), mq = integrate(q, dt);
  Eigen::Matrix2d ends;  // v(T) and d(T) of either shape
  ends << mp.velocity.back(), mq.velocity.back(), mp.displacement.back(), mq.displacement.back();
  Eigen::Vector2d sum(0, 0);
  for (int pass = 0; pass < 2; ++pass) {  // the second takes off what rounding left
    const Motion m = integrate(a, dt);
    const Eigen::Vector2d c =
        ends.fullPivLu().solve(Eigen::Vector2d(-m.velocity.back(), -m.displacement.back()));
    for (size_t i = 0; i < a.size(); ++i) a[i] += c[0] * p[i] + c[1] * q[i];
    sum += c;
  }
  return {sum[0], sum[1]};
}

void check_processing(const Processing& how, size_t samples, double dt, const std::string& source) {
  const double nyquist = 0.5 / dt, T = dt * static_cast<double>(samples - 1);
  const Band& band = how.band;
  if (!(how.taper >= 0 && how.taper <= 0.5))
    refuse(source, fmt::format("a taper of {:g} of the record at each end", how.taper),
           "give a share from 0 to 0.5");
  if (!(band.high_pass >= 0 && band.low_pass >= 0 && band.order >= 1 && band.order <= 20))
    refuse(source, fmt::format("filter {:g} to {:g} Hz, order {}", band.high_pass, band.low_pass, band.order),
           "corners are 0 (none) or above, the order is from 1 to 20");
  for (const auto& [name, corner] : {std::pair{"high", band.high_pass}, std::pair{"low", band.low_pass}})
    if (corner >= nyquist)
      refuse(source,
             fmt::format("the {}-pass corner of {:g} Hz is not below half the sampling rate, {:g} Hz", name,
                         corner, nyquist),
             fmt::format("give --{}-pass below it, or 0 for none", name));
  if (band.low_pass > 0 && band.high_pass >= band.low_pass)
    refuse(source, fmt::format("the band from {:g} to {:g} Hz is empty", band.high_pass, band.low_pass),
           "the high-pass corner is the lower one");
  if (2 * padding_of(band) / dt + static_cast<double>(samples) > kMostPadded)
    refuse(source,
           fmt::format("a high-pass corner of {:g} Hz needs {:g} s of zeros on each side", band.high_pass,
                       padding_of(band)),
           "give a higher one, or 0 for none");
  if (how.baseline_degree != 0 && (how.baseline_degree < 2 || how.baseline_degree > 10))
    refuse(source, fmt::format("a baseline of degree {}", how.baseline_degree),
           "give 2 to 10, or 0 for none");
  if (!(how.pre_event >= 0 && how.pre_event < T))
    refuse(source, fmt::format("{:g} s before the event in a record of {:g} s", how.pre_event, T),
           "give less than the record, or 0 for the mean of all");
  const double room = 0.5 * dt;  // a window that ends between samples is rounded to one
  if (!(how.begin >= 0 && how.duration >= 0 && how.begin < T && how.begin + how.duration <= T + room))
    refuse(source,
           fmt::format("the window from {:g} s of {:g} s in a record of {:g} s", how.begin, how.duration, T),
           "give --begin and --duration inside the record");
  const double window = how.duration > 0 ? how.duration : T - how.begin;
  if (!(how.end_taper >= 0 && how.end_taper <= 0.5 * window))
    refuse(source, fmt::format("an end taper of {:g} s in a window of {:g} s", how.end_taper, window),
           "give at most half the window");
  if (window < 10 * dt)
    refuse(source, fmt::format("the window of {:g} s has fewer than ten steps", window), "widen it");
}

Processed process(std::vector<double> a, double dt, const Processing& how, const std::string& source) {
  check_processing(how, a.size(), dt, source);
  Processed out;
  const double mean = remove_mean(a, dt, how.pre_event);
  out.steps.push_back({"mean removed", {{"mean [m/s2]", mean}, {"pre-event [s]", how.pre_event}}});
  taper_ends(a, how.taper);
  out.steps.push_back({"cosine taper at both ends", {{"share of each end", how.taper}}});
  if (how.band.high_pass > 0 || how.band.low_pass > 0) {
    a = filter(a, dt, how.band);
    out.steps.push_back({"zero-phase Butterworth filter",
                         {{"high-pass corner [Hz]", how.band.high_pass},
                          {"low-pass corner [Hz]", how.band.low_pass},
                          {"order", how.band.order},
                          {"gain at the corners", how.band.corner == Corner::k3dB ? std::sqrt(0.5) : 0.5},
                          {"zeros on each side [s]", padding_of(how.band)}}});
  }
  if (how.baseline_degree > 0) {
    const std::vector<double> q = remove_baseline(a, dt, how.baseline_degree);
    Step step{"polynomial baseline of the displacement", {}};
    for (size_t i = 0; i < q.size(); ++i)
      step.numbers.emplace_back(fmt::format("t^{} [m/s{}]", i + 2, i + 2), q[i]);
    out.steps.push_back(step);
  }
  a = cut_window(a, dt, how.begin, how.duration, how.end_taper);
  out.steps.push_back({"window",
                       {{"begin [s]", how.begin},
                        {"duration [s]", dt * static_cast<double>(a.size() - 1)},
                        {"end taper [s]", how.end_taper}}});
  const auto [A, B] = pin_end(a, dt);
  out.steps.push_back(
      {"end brought to rest", {{"A of t (T - t) [m/s4]", A}, {"B of t (T - t)(T - 2 t) [m/s5]", B}}});
  out.motion = integrate(std::move(a), dt);
  return out;
}

}  // namespace talus::record
