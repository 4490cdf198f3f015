#pragma once
// Quantities that scatter.

#include <cstdint>
#include <limits>

namespace talus {

/// A quantity drawn anew for each joint: its mean and how it scatters.
struct Scattered {
  enum Kind {
    kConstant,
    kNormal,       // spread: standard deviation
    kUniform,      // spread: half width
    kExponential,  // the mean alone
  };
  Kind kind = kConstant;
  double mean = 0, spread = 0;
};

/// A quantity, or how it scatters by a stream of numbers of its own.
struct Strewn {
  enum Kind { kNone, kNormal, kLognormal };
  Kind kind = kNone;
  double mean = 0, deviation = 0;
  double least = 0, most = std::numeric_limits<double>::infinity();  // what the key allows
  int64_t seed = 0;
};

}  // namespace talus
