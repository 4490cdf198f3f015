#pragma once
// Random numbers that are the same with every compiler and library: own generator, own distributions.

#include <cstdint>
#include <string_view>

namespace talus {

/// A stream of random numbers (splitmix64). Two streams of different seeds do not follow each other.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}

  uint64_t next();
  /// Uniform in [0, 1), multiples of 2^-53.
  double uniform();
  /// Standard normal: mean 0, standard deviation 1 (Box and Muller, the cosine of each pair).
  double normal();
  /// Exponential of mean 1.
  double exponential();

 private:
  uint64_t state_;
};

/// Seed of the stream for the thing called `name`, and of its part `number`, under one seed of the model:
/// adding one stream does not disturb another.
uint64_t stream_seed(uint64_t seed, std::string_view name, int64_t number = 0);

}  // namespace talus
