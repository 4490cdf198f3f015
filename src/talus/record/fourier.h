#pragma once
// The discrete Fourier transform of real samples.

#include <complex>
#include <cstddef>
#include <vector>

namespace talus::record {

/// Smallest even number not below `n` with no prime factor above 5: lengths that transform fast.
size_t fast_length(size_t n);

/// X(k) = sum over j of x(j) exp(-2 pi i j k / n), k = 0 .. n/2.
/// @param x  [n] real samples, n even
/// @return   [n/2 + 1]; with samples dt apart, entry k stands at the frequency k / (n dt) [Hz]
std::vector<std::complex<double>> transform(const std::vector<double>& x);

/// The samples whose transform is `spectrum` ([n/2 + 1]); inverse of transform(). @return [n]
std::vector<double> transform_back(const std::vector<std::complex<double>>& spectrum);

}  // namespace talus::record
