#include <algorithm>
#include <cmath>
#include <numbers>

#include "talus/study/normal.h"
#include "talus/study/study.h"

namespace talus::study {

double normal_share(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi); }

// By halving: normal_share() is exact to its last digits, and this has them too.
double normal_quantile(double u) {
  double low = -40, high = 40;
  for (int i = 0; i < 200 && high - low > 1e-15 * std::max(1.0, std::abs(low)); ++i) {
    const double middle = 0.5 * (low + high);
    (normal_share(middle) < u ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double Distribution::quantile(double u) const {
  if (kind == kUniform) {
    const double from = std::max(least, mean - deviation), to = std::min(most, mean + deviation);
    return from + u * (to - from);
  }
  const bool logs = kind == kLognormal;
  const double variance = logs ? std::log1p(deviation * deviation / (mean * mean)) : deviation * deviation;
  const double middle = logs ? std::log(mean) - 0.5 * variance : mean, width = std::sqrt(variance);
  const auto share = [&](double x) {
    if (logs && x <= 0) return 0.0;
    return normal_share(((logs ? std::log(x) : x) - middle) / width);
  };
  // cut off: the rest is as likely as before, in proportion
  const double below = share(least), above = share(most);
  const double x = middle + width * normal_quantile(below + u * (above - below));
  return logs ? std::exp(x) : x;
}

}  // namespace talus::study
