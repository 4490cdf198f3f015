#pragma once
// Zero-phase Butterworth filter, applied as a real gain to the Fourier spectrum (theory 11.2).

#include <vector>

namespace talus::record {

/// Where the corner frequency lies on the gain of the whole filter.
enum class Corner {
  k3dB,  // one application of |H|: gain 1/sqrt(2) at the corner
  k6dB   // as a filter of half the order run forwards and backwards (filtfilt): gain 1/2 at the corner
};

/// Corners and order of the band that is kept.
struct Band {
  double high_pass = 0.1;  // f1 [Hz], what is slower is taken out; 0: nothing
  double low_pass = 15;    // f2 [Hz], what is faster is taken out; 0: nothing
  int order = 4;           // n, of the whole filter: slopes of n x 6 dB per octave
  Corner corner = Corner::k3dB;
};

/// Gain [-] of the filter at frequency f [Hz], real (no phase), the product over both corners of
///   1 / sqrt(1 + r^(2n)) with Corner::k3dB,   1 / (1 + r^n) with Corner::k6dB,   r = f1 / f or f / f2.
///   (theory 11.2)
/// Far from the corner both fall as r^-n.
double butterworth_gain(const Band& band, double f);

/// Zeros put on each side before filtering: 1.5 n / f1 [s], the length of the filter's own response; 0
/// without f1.
double padding_of(const Band& band);

/// Filters samples dt apart: pads both sides, multiplies the spectrum by butterworth_gain(), cuts the padding
/// off.
/// @pre 0 <= high_pass < low_pass (or low_pass 0) below 0.5 / dt, order >= 1
std::vector<double> filter(const std::vector<double>& samples, double dt, const Band& band);

}  // namespace talus::record
