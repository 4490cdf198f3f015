#pragma once
// Probability of a state of damage over an intensity: a lognormal curve by maximum likelihood, with its band.

#include <string>
#include <vector>

namespace talus::study {

struct FragilityPoint {
  double intensity = 0;  // > 0
  int runs = 0, damaged = 0;
};

/// P(damage | x) = Phi(ln(x / median) / beta).
struct Fragility {
  double median = 0, beta = 0;              // in the unit of the intensity; of the logarithm
  double median_error = 0, beta_error = 0;  // standard errors: of ln(median), of beta
  double covariance[3] = {0, 0, 0};         // of a, b in P = Phi(a + b ln x): aa, ab, bb
  std::string trouble;                      // why there is no curve; "" when there is

  bool found() const { return trouble.empty(); }
  double probability(double intensity) const;
  /// Ends of the confidence band: `z` standard errors of a + b ln x below (z < 0) or above.
  double band(double intensity, double z) const;
};

/// Fits by Fisher's scoring. Points of one intensity may be several.
Fragility fit_fragility(const std::vector<FragilityPoint>& points);

}  // namespace talus::study
