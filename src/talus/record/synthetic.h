#pragma once
// Ground motions made from a seed, matched to a target response spectrum (theory 11.5).

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "talus/record/motion.h"
#include "talus/record/process.h"

namespace talus::record {

/// A 5 % response spectrum, linear between its points in the logarithms of both, held outside.
struct TargetSpectrum {
  std::vector<double> period;  // [s] > 0, rising
  std::vector<double> value;   // Sa [m/s2] > 0

  double at(double period) const;
};

/// The built-in target for a peak ground acceleration `pga`: Sa = pga times
///   1 + 1.5 T / TB for T < TB,   2.5 to TC,   2.5 TC / T to TD,   2.5 TC TD / T^2 beyond, (eq. 11.6)
/// TB = 0.15 s, TC = 0.5 s, TD = 2 s: the usual shape of code spectra.
TargetSpectrum code_spectrum(double pga);

/// Reads a CSV with a column of periods ("period [s]") and one of Sa with its unit. Throws InputError,
/// FileError.
TargetSpectrum read_target(const std::filesystem::path& path);

/// Share of the full strength over time: (t / rise)^2, then 1, then down to 5 % over `decay` as an
/// exponential.
struct Envelope {
  double rise = 3, strong = 7, decay = 8;  // [s]

  double at(double t) const;
};

struct SyntheticInput {
  uint64_t seed = 1;
  double dt = 0.01;      // [s]
  double duration = 20;  // [s]
  Envelope envelope;
  TargetSpectrum target;
  std::optional<double> pga;  // [m/s2] scales the result to it
  double lowest = 0.1;        // [Hz] no slower motion, down to half of it
  double highest = 25;        // [Hz] no faster motion; at most 0.4 / dt is used
  int iterations = 30;
};

struct Synthetic {
  Motion motion;            // begins and ends at rest, v(T) = d(T) = 0
  double rms_misfit = 0;    // root mean square of ln(Sa / target) over the periods, after scaling to pga
  double scaled_by = 1;     // by the wish for a pga
  int iterations = 0;       // after which the best match was found
  std::vector<Step> steps;  // as of process()
};

/// Periods [s] at which target and motion are compared: 80, equal in logarithm, from 0.05 to 4 s, as far as
/// the band of the motion and the target go.
std::vector<double> matched_periods(const SyntheticInput& input);

/// Sum of harmonics with random phases (the stream of the seed) times the envelope; the amplitudes are
/// corrected by the ratio of target and response spectrum again and again, the best of all turns is kept. The
/// same seed gives the same motion everywhere, up to the rounding of sin, cos and exp. Throws InputError for
/// input out of range.
Synthetic make_synthetic(const SyntheticInput& input);

}  // namespace talus::record
