#pragma once
// A ground motion: acceleration at equal steps, linear between them, and its exact integrals from rest.

#include <vector>

#include "talus/record/read_record.h"

namespace talus::record {

struct Motion {
  double dt = 0;                     // [s]
  std::vector<double> acceleration;  // [n] [m/s2] at i dt, linear between
  std::vector<double> velocity;      // [n] [m/s], 0 at the start
  std::vector<double> displacement;  // [n] [m], 0 at the start

  size_t size() const { return acceleration.size(); }
  double duration() const { return dt * static_cast<double>(size() - 1); }  // [s]
};

/// Integrates acceleration [m/s2] that is linear between its samples, from v = d = 0, without error but
/// rounding: v(i+1) = v(i) + dt (a(i) + a(i+1)) / 2,  d(i+1) = d(i) + dt v(i) + dt^2 (2 a(i) + a(i+1)) / 6.
/// (theory 11.1)
Motion integrate(std::vector<double> acceleration, double dt);

/// Derivative of samples at equal steps: central differences, one-sided at the two ends; error of order dt^2
/// inside.
/// @pre at least two samples
std::vector<double> differentiate(const std::vector<double>& value, double dt);

/// Acceleration [m/s2] of a record: as it is, or differentiated once (velocity) or twice (displacement).
std::vector<double> acceleration_of(const Record& record);

}  // namespace talus::record
