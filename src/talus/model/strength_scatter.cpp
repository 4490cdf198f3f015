#include "talus/model/strength_scatter.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "talus/base/random.h"

namespace talus {

double StrengthScatter::at(double z) const {
  if (kind == kNormal) return mean + z * deviation;
  // a lognormal quantity of this mean and standard deviation
  const double variance = std::log1p((deviation / mean) * (deviation / mean));
  return mean * std::exp(z * std::sqrt(variance) - 0.5 * variance);
}

double StrengthScatter::draw(int a, int b) const {
  const auto low = static_cast<int64_t>(std::min(a, b)), high = static_cast<int64_t>(std::max(a, b));
  Random random(stream_seed(seed, "", (low << 32) | high));
  for (;;) {
    const double z = random.normal(), value = at(z);
    if (std::abs(z) <= kWidest && value >= least && value <= most) return value;
  }
}

double StrengthScatter::largest() const { return std::min(most, at(kWidest)); }

uint64_t strength_seed(int64_t seed, std::string_view name, std::string_view key) {
  return stream_seed(static_cast<uint64_t>(seed), std::string(name) + "." + std::string(key));
}

}  // namespace talus
