#pragma once
// Geometry that scatters from joint to joint.

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

}  // namespace talus
