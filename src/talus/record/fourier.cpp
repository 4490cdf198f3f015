#include "talus/record/fourier.h"

#include <unsupported/Eigen/FFT>

namespace talus::record {

size_t fast_length(size_t n) {
  for (size_t length = n + n % 2;; length += 2) {
    size_t rest = length;
    for (const size_t p : {size_t{2}, size_t{3}, size_t{5}})
      while (rest % p == 0) rest /= p;
    if (rest == 1) return length;
  }
}

std::vector<std::complex<double>> transform(const std::vector<double>& x) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> out;
  fft.fwd(out, x);
  return out;
}

std::vector<double> transform_back(const std::vector<std::complex<double>>& spectrum) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> out;
  fft.inv(out, spectrum, static_cast<Eigen::Index>(2 * (spectrum.size() - 1)));
  return out;
}

}  // namespace talus::record
