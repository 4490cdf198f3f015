#pragma once
// The normal distribution.

namespace talus::study {

/// Share of a standard normal quantity below z.
double normal_share(double z);
double normal_density(double z);
/// z below which the share u lies. @pre 0 < u < 1
double normal_quantile(double u);

}  // namespace talus::study
