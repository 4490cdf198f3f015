#pragma once
// Response of a damped oscillator to ground acceleration that is linear between its samples, and the response
// spectrum. The step is exact (Nigam and Jennings 1969): theory 11.3.

#include <vector>

namespace talus::record {

/// Damping ratio of response spectra here.
inline constexpr double kSpectrumDamping = 0.05;

/// One exact step of u'' + 2 zeta w u' + w^2 u = -a(t), a linear over the step:
/// (u, u')(t + dt) = A (u, u')(t) + B (a(t), a(t + dt)).
struct OscillatorStep {
  double A[2][2], B[2][2];
};
/// @param period   2 pi / w [s], > 0
/// @param damping  zeta, 0 <= zeta < 1
/// @param dt       [s], > 0
OscillatorStep oscillator_step(double period, double damping, double dt);

/// Displacement u [m] relative to the ground at the samples, from rest.
std::vector<double> oscillator_response(const std::vector<double>& acceleration, double dt, double period,
                                        double damping);

/// Pseudo-acceleration Sa = w^2 max |u| [m/s2] at each period [s], u followed during the motion and for one
/// period after it. Steps are divided so that a period has at least 40 of them: a peak between two is missed
/// by at most 0.3 %.
std::vector<double> response_spectrum(const std::vector<double>& acceleration, double dt,
                                      const std::vector<double>& periods, double damping = kSpectrumDamping);

/// `count` periods from `shortest` to `longest` [s], equal in logarithm.
std::vector<double> spectrum_periods(double shortest, double longest, int count);

}  // namespace talus::record
