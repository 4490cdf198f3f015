#pragma once
// Numbers that describe a ground motion (theory 11.4).

#include <string>

#include "talus/record/motion.h"

namespace talus::record {

/// Share of the integral of |V(f)|^2 that lies below the highest frequency that matters.
inline constexpr double kVelocityShare = 0.999;

struct Measures {
  double pga = 0, pga_time = 0;     // largest |a| of the samples [m/s2] and when [s]
  double pgv = 0, pgd = 0;          // largest |v| [m/s], |d| [m] of the samples
  double arias = 0;                 // pi / (2 g) x integral of a^2 [m/s], g = 9.80665 m/s2
  double significant_duration = 0;  // D5-95 [s]: from 5 % to 95 % of the Arias integral
  double end_velocity = 0;          // v(T) [m/s]
  double end_displacement = 0;      // d(T) [m]
  double highest_frequency = 0;     // [Hz] below it lies kVelocityShare of the integral of |V(f)|^2
};

Measures measure(const Motion& motion);

/// Throws InputError, naming the motion and the first time, when a value or a measure is not finite: numbers so
/// large that sums of them are none.
void check_finite(const std::string& name, const Motion& motion, const Measures& measures);

/// Frequency [Hz] below which `share` of the integral of |V(f)|^2 lies. A motion that does not end at rest
/// jumps at its end, which adds high frequencies: process it first. Resolution: 1 / duration.
double highest_frequency(const Motion& motion, double share = kVelocityShare);

/// A table of the measures of one or two motions, a line each.
/// @param titles  one per motion
std::string measures_table(const std::vector<std::pair<std::string, Measures>>& columns);

}  // namespace talus::record
