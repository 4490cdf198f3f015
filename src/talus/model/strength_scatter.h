#pragma once
// Strength of a joint that differs from face to face.

#include <cstdint>
#include <limits>
#include <string_view>

namespace talus {

/// How one strength scatters. Drawn by the two blocks that meet, so that a face keeps its own for good.
struct StrengthScatter {
  enum Kind { kNone, kNormal, kLognormal };  // as Strewn::Kind
  Kind kind = kNone;
  double mean = 0, deviation = 0;                                    // of the strength itself [SI]
  double least = 0, most = std::numeric_limits<double>::infinity();  // what a draw has to lie in [SI]
  uint64_t seed = 0;                                                 // stream of this strength of this joint

  /// Standard deviations within which draws lie; what lies outside, or outside of least and most, is drawn anew.
  static constexpr double kWidest = 4;

  bool given() const { return kind != kNone; }
  /// Strength between blocks `a` and `b`, in either order.
  double draw(int a, int b) const;
  /// The largest that can be drawn.
  double largest() const;
  /// Value at `z` standard deviations (of its logarithm, where it is lognormal) from the mean (the median).
  double at(double z) const;
};

/// Seed of the stream of strength `key` of joint `name`.
uint64_t strength_seed(int64_t seed, std::string_view name, std::string_view key);

}  // namespace talus
