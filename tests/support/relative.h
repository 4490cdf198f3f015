#pragma once
// Shares of a value, and the size of matrices.

#include <doctest/doctest.h>

#include <cmath>

#include "talus/base/vec2.h"

namespace talus::test {

/// Equal up to its epsilon of the value itself: doctest's own adds 1 to that, which no number of millimetres could miss.
/// Zero is zero.
inline doctest::Approx approx(double value) { return doctest::Approx(value).scale(1e-200); }

/// Equal up to `share` of the value itself.
inline doctest::Approx relative(double value, double share) { return approx(value).epsilon(share); }

inline double size_of(const Mat2& m) { return std::sqrt(contract(m, m)); }

}  // namespace talus::test
