#include "talus/record/filter.h"

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/record/fourier.h"

namespace talus::record {

// Eq. 11.2.
double butterworth_gain(const Band& band, double f) {
  const auto one = [&band](double ratio) {
    return band.corner == Corner::k3dB ? 1 / std::sqrt(1 + std::pow(ratio, 2 * band.order))
                                       : 1 / (1 + std::pow(ratio, band.order));
  };
  double gain = 1;
  if (band.high_pass > 0) gain *= f > 0 ? one(band.high_pass / f) : 0;
  if (band.low_pass > 0) gain *= one(f / band.low_pass);
  return gain;
}

double padding_of(const Band& band) { return band.high_pass > 0 ? 1.5 * band.order / band.high_pass : 0; }

std::vector<double> filter(const std::vector<double>& samples, double dt, const Band& band) {
  TALUS_ASSERT(dt > 0 && band.order >= 1);
  TALUS_ASSERT(band.high_pass >= 0 && (band.low_pass == 0 || band.high_pass < band.low_pass));
  const auto pad = static_cast<size_t>(std::ceil(padding_of(band) / dt));
  std::vector<double> padded(fast_length(samples.size() + 2 * pad));
  const auto begin = static_cast<std::ptrdiff_t>(pad);
  std::copy(samples.begin(), samples.end(), padded.begin() + begin);
  auto spectrum = transform(padded);
  for (size_t k = 0; k < spectrum.size(); ++k)
    spectrum[k] *= butterworth_gain(band, static_cast<double>(k) / (static_cast<double>(padded.size()) * dt));
  const std::vector<double> out = transform_back(spectrum);
  return {out.begin() + begin, out.begin() + begin + samples.size()};
}

}  // namespace talus::record
