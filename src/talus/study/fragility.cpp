#include "talus/study/fragility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/study/normal.h"

namespace talus::study {

namespace {

constexpr int kMostRounds = 200;
constexpr double kConverged = 1e-9;

// P = Phi(eta); the score and the expected information of a point, without underflow far out.
struct Term {
  double score, weight;
};
Term term_of(double eta, double runs, double damaged) {
  const double p = normal_share(eta), q = normal_share(-eta), density = normal_density(eta);
  if (p < 1e-300 || q < 1e-300) return {0, 0};
  return {density * (damaged * q - (runs - damaged) * p) / (p * q), runs * density * density / (p * q)};
}

double log_likelihood(const std::vector<FragilityPoint>& points, double a, double b) {
  double sum = 0;
  for (const FragilityPoint& p : points) {
    const double eta = a + b * std::log(p.intensity);
    if (p.damaged > 0) sum += p.damaged * std::log(std::max(normal_share(eta), 1e-300));
    if (p.runs > p.damaged) sum += (p.runs - p.damaged) * std::log(std::max(normal_share(-eta), 1e-300));
  }
  return sum;
}

// Why the likelihood has no greatest value inside.
std::string separated(const std::vector<FragilityPoint>& points) {
  int damaged = 0, whole = 0;
  double highest_damaged = 0, lowest_whole = std::numeric_limits<double>::infinity();
  for (const FragilityPoint& p : points) {
    if (p.damaged > 0) highest_damaged = std::max(highest_damaged, p.intensity);
    if (p.runs > p.damaged) lowest_whole = std::min(lowest_whole, p.intensity);
  }
  double highest_whole = 0, lowest_damaged = std::numeric_limits<double>::infinity(), lowest = lowest_damaged,
         highest = 0;
  for (const FragilityPoint& p : points) {
    damaged += p.damaged, whole += p.runs - p.damaged;
    if (p.damaged > 0) lowest_damaged = std::min(lowest_damaged, p.intensity);
    if (p.runs > p.damaged) highest_whole = std::max(highest_whole, p.intensity);
    if (p.runs > 0) lowest = std::min(lowest, p.intensity), highest = std::max(highest, p.intensity);
  }
  if (damaged + whole == 0) return "no run counts";
  if (damaged == 0) return "no run is in this state: go to where it is";
  if (whole == 0) return "every run is in this state: go to where it is not";
  if (lowest == highest) return "all runs have one intensity";
  if (highest_damaged <= lowest_whole) return "damage does not grow with intensity";
  if (highest_whole == lowest_damaged)
    return fmt::format(
        "only at {:g} some runs are in this state and some are not: give levels just below and above it",
        lowest_damaged);
  if (highest_whole < lowest_damaged)
    return fmt::format("all runs from {:g} on are in this state and none up to {:g}: give levels between",
                       lowest_damaged, highest_whole);
  return "";
}

}  // namespace

double Fragility::probability(double x) const { return normal_share(std::log(x / median) / beta); }

double Fragility::band(double x, double z) const {
  const double l = std::log(x), eta = std::log(x / median) / beta;
  const double variance = covariance[0] + 2 * l * covariance[1] + l * l * covariance[2];
  return normal_share(eta + z * std::sqrt(std::max(variance, 0.0)));
}

Fragility fit_fragility(const std::vector<FragilityPoint>& points) {
  Fragility fit;
  fit.trouble = separated(points);
  if (!fit.found()) return fit;
  // from the mean of ln x and its spread
  double sum = 0, mean = 0, squares = 0;
  for (const FragilityPoint& p : points) sum += p.runs, mean += p.runs * std::log(p.intensity);
  mean /= sum;
  for (const FragilityPoint& p : points) squares += p.runs * std::pow(std::log(p.intensity) - mean, 2);
  double b = 1 / std::sqrt(squares / sum), a = -b * mean, before = log_likelihood(points, a, b);
  double aa = 0, ab = 0, bb = 0;
  bool converged = false;
  for (int round = 0; round < kMostRounds && !converged; ++round) {
    double ga = 0, gb = 0;
    aa = ab = bb = 0;
    for (const FragilityPoint& p : points) {
      const double l = std::log(p.intensity);
      const Term t = term_of(a + b * l, p.runs, p.damaged);
      ga += t.score, gb += t.score * l;
      aa += t.weight, ab += t.weight * l, bb += t.weight * l * l;
    }
    const double det = aa * bb - ab * ab;
    if (!(det > 0)) break;
    double da = (bb * ga - ab * gb) / det, db = (aa * gb - ab * ga) / det, share = 1;
    while (share > 1e-6 && log_likelihood(points, a + share * da, b + share * db) < before) share *= 0.5;
    a += share * da, b += share * db;
    before = log_likelihood(points, a, b);
    converged = std::abs(da) + std::abs(db) <= kConverged * (1 + std::abs(a) + std::abs(b));
  }
  const double det = aa * bb - ab * ab;
  if (!converged || !(det > 0)) {
    fit.trouble = "the likelihood has no greatest value that could be found";
    return fit;
  }
  if (b <= 0) {
    fit.trouble = "damage does not grow with intensity";
    return fit;
  }
  fit.median = std::exp(-a / b), fit.beta = 1 / b;
  fit.covariance[0] = bb / det, fit.covariance[1] = -ab / det, fit.covariance[2] = aa / det;
  // ln(median) = -a / b
  const double da = -1 / b, db = a / (b * b);
  fit.median_error =
      std::sqrt(da * da * fit.covariance[0] + 2 * da * db * fit.covariance[1] + db * db * fit.covariance[2]);
  fit.beta_error = std::sqrt(fit.covariance[2]) / (b * b);
  return fit;
}

}  // namespace talus::study
