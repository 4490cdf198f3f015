#pragma once
// Shares of a value, and the size of matrices.

#include <doctest/doctest.h>

#include <cmath>

#include "talus/base/vec2.h"

namespace talus::test {

/// Equal up to `share` of the value itself.
inline doctest::Approx relative(double value, double share) {
  return doctest::Approx(value).epsilon(share).scale(0);
}

inline double size_of(const Mat2& m) { return std::sqrt(contract(m, m)); }

}  // namespace talus::test
