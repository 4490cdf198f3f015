#include "talus/record/synthetic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "talus/base/error.h"
#include "talus/base/random.h"
#include "talus/record/fourier.h"
#include "talus/record/measures.h"
#include "talus/record/response_spectrum.h"

namespace talus::record {

namespace {

constexpr int kMatched = 80;
constexpr double kShortestMatched = 0.05, kLongestMatched = 4;  // [s]
constexpr double kEndTaper = 1;                                 // [s]
constexpr double kDecayedTo = 0.05;  // share of the envelope at the end of its decay
constexpr double kCaution =
    0.8;  // power of the correction of a turn: 1 overshoots where periods share a harmonic

double highest_used(const SyntheticInput& in) { return std::min(in.highest, 0.4 / in.dt); }

void check(const SyntheticInput& in) {
  const auto refuse = [](const std::string& text, const std::string& hint) {
    throw InputError(fmt::format("synthetic motion: error: {}\n      = {}", text, hint));
  };
  if (!(in.dt > 0 && in.duration >= 20 * in.dt && in.duration / in.dt < 1e7))
    refuse(fmt::format("{:g} s in steps of {:g} s", in.duration, in.dt), "give 20 to ten million steps");
  if (in.duration < 4 * kEndTaper)
    refuse(fmt::format("a duration of {:g} s", in.duration), "give at least 4 s");
  const Envelope& e = in.envelope;
  if (!(e.rise >= 0 && e.strong >= 0 && e.decay > 0 && e.rise + e.strong < in.duration))
    refuse(fmt::format("an envelope of {:g} s rise, {:g} s strong motion, {:g} s decay in {:g} s", e.rise,
                       e.strong, e.decay, in.duration),
           "rise and strong motion are 0 or more and end before the motion does; the decay is above 0 s");
  if (in.pga && !(*in.pga > 0))
    refuse(fmt::format("a peak acceleration of {:g} m/s2", *in.pga), "give one above 0");
  if (!(in.lowest > 0 && in.lowest < highest_used(in)))
    refuse(fmt::format("a band from {:g} to {:g} Hz", in.lowest, highest_used(in)),
           "the lower end goes first");
  if (in.target.period.empty())
    refuse("there is no target spectrum", "give --pga for the built-in one, or --target");
  if (matched_periods(in).size() < 3)
    refuse("target and band of the motion share fewer than three periods from 0.05 to 4 s",
           "widen the target, or take a smaller dt");
}

// Motion of the amplitudes: harmonics times envelope, brought to rest at its end.
std::vector<double> motion_of(const SyntheticInput& in, const std::vector<std::complex<double>>& spectrum,
                              size_t n) {
  std::vector<double> a = transform_back(spectrum);
  a.resize(n);
  for (size_t i = 0; i < n; ++i) a[i] *= in.envelope.at(static_cast<double>(i) * in.dt);
  a = cut_window(a, in.dt, 0, 0, kEndTaper);
  pin_end(a, in.dt);
  return a;
}

double rms_of(const std::vector<double>& logs) {
  double sum = 0;
  for (const double x : logs) sum += x * x;
  return std::sqrt(sum / static_cast<double>(logs.size()));
}

// ln(target / Sa) at the periods.
std::vector<double> misfit(const SyntheticInput& in, const std::vector<double>& a,
                           const std::vector<double>& periods) {
  std::vector<double> out = response_spectrum(a, in.dt, periods);
  for (size_t i = 0; i < periods.size(); ++i) out[i] = std::log(in.target.at(periods[i]) / out[i]);
  return out;
}

// Linear in ln(period), held outside.
double between(const std::vector<double>& periods, const std::vector<double>& values, double period) {
  const auto after = std::upper_bound(periods.begin(), periods.end(), period);
  if (after == periods.begin()) return values.front();
  if (after == periods.end()) return values.back();
  const size_t i = after - periods.begin() - 1;
  const double s = std::log(period / periods[i]) / std::log(periods[i + 1] / periods[i]);
  return values[i] + s * (values[i + 1] - values[i]);
}

// Random phases; amplitudes that would give the target if every harmonic acted for long.
std::vector<std::complex<double>> first_spectrum(const SyntheticInput& in, size_t length) {
  std::vector<std::complex<double>> spectrum(length / 2 + 1);
  Random random(stream_seed(in.seed, "phases of a ground motion"));
  const Band band{in.lowest, 0, 8, Corner::k3dB};
  for (size_t k = 1; k + 1 < spectrum.size(); ++k) {
    const double phase = 2 * std::numbers::pi * random.uniform();
    const double f = static_cast<double>(k) / (static_cast<double>(length) * in.dt);
    if (f < 0.5 * in.lowest || f > highest_used(in)) continue;
    spectrum[k] = std::polar(in.target.at(1 / f) / std::sqrt(f) * butterworth_gain(band, f), phase);
  }
  return spectrum;
}

}  // namespace

double TargetSpectrum::at(double T) const {
  std::vector<double> logs(value.size());
  for (size_t i = 0; i < value.size(); ++i) logs[i] = std::log(value[i]);
  return std::exp(between(period, logs, T));
}

TargetSpectrum code_spectrum(double pga) {
  constexpr double TB = 0.15, TC = 0.5, TD = 2, kPlateau = 2.5;
  TargetSpectrum target;
  target.period = spectrum_periods(0.01, 10, 301);
  for (const double T : target.period)
    target.value.push_back(pga * (T < TB   ? 1 + (kPlateau - 1) * T / TB
                                  : T < TC ? kPlateau
                                  : T < TD ? kPlateau * TC / T
                                           : kPlateau * TC * TD / (T * T)));
  return target;
}

double Envelope::at(double t) const {
  if (t < rise) return (t / rise) * (t / rise);
  const double past = t - rise - strong;
  return past <= 0 ? 1 : std::pow(kDecayedTo, past / decay);
}

std::vector<double> matched_periods(const SyntheticInput& in) {
  std::vector<double> out;
  for (const double T : spectrum_periods(kShortestMatched, kLongestMatched, kMatched))
    if (T >= in.target.period.front() && T <= in.target.period.back() && 1 / T >= in.lowest &&
        1 / T <= highest_used(in))
      out.push_back(T);
  return out;
}

Synthetic make_synthetic(const SyntheticInput& in) {
  check(in);
  const auto n = static_cast<size_t>(std::llround(in.duration / in.dt)) + 1;
  const size_t length = fast_length(n);
  const std::vector<double> periods = matched_periods(in);
  auto spectrum = first_spectrum(in, length);

  Synthetic best;
  std::vector<double> best_a;
  for (int turn = 0; turn <= in.iterations; ++turn) {
    std::vector<double> a = motion_of(in, spectrum, n);
    std::vector<double> logs = misfit(in, a, periods);
    if (in.pga) {  // judged as it will be delivered
      const double peak = measure(integrate(a, in.dt)).pga, factor = *in.pga / peak;
      for (double& v : a) v *= factor;
      std::vector<double> scaled = logs;
      for (double& x : scaled) x -= std::log(factor);
      if (best_a.empty() || rms_of(scaled) < best.rms_misfit)
        best_a = a, best.rms_misfit = rms_of(scaled), best.iterations = turn, best.scaled_by = factor;
    } else if (best_a.empty() || rms_of(logs) < best.rms_misfit) {
      best_a = a, best.rms_misfit = rms_of(logs), best.iterations = turn;
    }
    for (size_t k = 1; k + 1 < spectrum.size(); ++k) {
      const double T = static_cast<double>(length) * in.dt / static_cast<double>(k);
      spectrum[k] *= std::exp(kCaution * between(periods, logs, T));
    }
  }
  pin_end(best_a, in.dt);  // once more after scaling: what is left is rounding
  best.motion = integrate(std::move(best_a), in.dt);
  best.steps.push_back({"harmonics with random phases",
                        {{"seed", static_cast<double>(in.seed)},
                         {"lowest [Hz]", in.lowest},
                         {"highest [Hz]", highest_used(in)}}});
  best.steps.push_back({"envelope",
                        {{"rise [s]", in.envelope.rise},
                         {"strong [s]", in.envelope.strong},
                         {"decay [s]", in.envelope.decay}}});
  best.steps.push_back({"matched to the target spectrum",
                        {{"periods", static_cast<double>(periods.size())},
                         {"turns", best.iterations},
                         {"rms of ln(Sa / target)", best.rms_misfit}}});
  best.steps.push_back({"end brought to rest", {{"end taper [s]", kEndTaper}}});
  if (in.pga) best.steps.push_back({"scaled to PGA", {{"PGA [m/s2]", *in.pga}, {"factor", best.scaled_by}}});
  return best;
}

}  // namespace talus::record
