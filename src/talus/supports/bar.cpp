#include "talus/supports/bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/error.h"

namespace talus {

namespace {

// What is left of the stiffness of a spring at its limit, as share of the softest piece of bar: keeps the bar
// determined when all of it slips.
constexpr double kHardening = 1e-9;

constexpr int kMostIterations = 100;

// Force out of balance as share of the largest, at which the bar is taken to be in balance.
constexpr double kBalanced = 1e-9;

// Round-off of an elongation, as share of the slips that it is the difference of: across a closed joint the bar is so short
// that this is a force beyond the balance asked for.
constexpr double kRoundOff = 4 * std::numeric_limits<double>::epsilon();

// And what is too much to go on with.
constexpr double kMostLeft = 1e-3;

constexpr int kMostHalvings = 120;

// Whole steps from where the bar was a step ago: it hardly moves, and few springs begin or cease to yield.
constexpr int kMostFromBefore = 6;

// A spring that yields: force and tangent at elongation x from its place without force.
struct Law {
  double force, tangent;
};

// Eq. 4.9.
Law law(double stiffness, double soft, double limit, double x) {
  const double f = stiffness * x;
  if (std::abs(f) <= limit) return {f, stiffness};
  const double at = std::copysign(limit, f);
  return {at + soft * (x - at / stiffness), soft};
}

// The bar as a chain of unknown slips, with its residual and tridiagonal tangent.
class Chain {
 public:
  Chain(const std::vector<double>& rock, const Bolt& bolt) : rock_(rock), bolt_(bolt) {
    const size_t n = bolt.nodes.size();
    residual_.resize(n), held_.resize(n), linked_.resize(n);
    soft_ = bolt.segments[0].stiffness;
    for (const BoltSegment& s : bolt.segments) soft_ = std::min(soft_, s.stiffness);
    soft_ *= kHardening;
  }

  // Fills residual (force out of balance, the slope of the energy) and tangents.
  // @param yields  false: as if no spring had a limit
  void evaluate(const std::vector<double>& slip, bool yields) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    scale_ = round_off_ = 0;
    for (size_t i = 0; i < slip.size(); ++i) {
      const BoltNode& n = bolt_.nodes[i];
      const double limit = yields ? n.limit : kInfinity;
      const Law l = law(n.stiffness, soft_, limit, slip[i] - n.plastic);
      residual_[i] = l.force, held_[i] = l.tangent;
      scale_ = std::max(scale_, std::abs(l.force));
    }
    for (size_t j = 0; j < bolt_.segments.size(); ++j) {
      const BoltSegment& s = bolt_.segments[j];
      linked_[j] = 0;
      if (s.ruptured) continue;
      const double limit = yields ? s.yield : kInfinity;
      const Law l = law(s.stiffness, soft_, limit, slip[j + 1] - slip[j] + rock_[j] - s.plastic);
      residual_[j] -= l.force, residual_[j + 1] += l.force, linked_[j] = l.tangent;
      const double sizes =
          std::abs(slip[j]) + std::abs(slip[j + 1]) + std::abs(rock_[j]) + std::abs(s.plastic);
      round_off_ = std::max(round_off_, l.tangent * kRoundOff * sizes);
      scale_ = std::max(scale_, std::abs(l.force));
    }
  }

  double imbalance() const {
    double most = 0;
    for (const double r : residual_) most = std::max(most, std::abs(r));
    return most;
  }
  double scale() const { return scale_; }
  bool balanced() const {
    return imbalance() <= std::max(kBalanced * scale_, std::min(round_off_, kMostLeft * scale_));
  }

  // Slope of the energy along a step, at the last evaluation.
  double slope(const std::vector<double>& step) const {
    double sum = 0;
    for (size_t i = 0; i < step.size(); ++i) sum += residual_[i] * step[i];
    return sum;
  }

  // The Newton step from the last evaluation. The elimination adds up what holds each node, springs in series
  // and side by side: without a difference in it, very stiff springs beside soft ones lose no digits.
  std::vector<double> newton_step() const {
    const size_t n = residual_.size();
    std::vector<double> held = held_, x(n);
    for (size_t i = 0; i < n; ++i) x[i] = -residual_[i];
    for (size_t i = 0; i + 1 < n; ++i) {
      const double pass = linked_[i] / (held[i] + linked_[i]);
      held[i + 1] += pass * held[i], x[i + 1] += pass * x[i];
    }
    x[n - 1] /= held[n - 1];
    for (size_t i = n - 1; i-- > 0;) x[i] = (x[i] + linked_[i] * x[i + 1]) / (held[i] + linked_[i]);
    return x;
  }

 private:
  const std::vector<double>& rock_;
  const Bolt& bolt_;
  std::vector<double> residual_, held_, linked_;  // [n_nodes]; springs of nodes; segments, the last unused
  double scale_ = 0, soft_ = 0, round_off_ = 0;
};

std::vector<double> plus(const std::vector<double>& a, double part, const std::vector<double>& b) {
  std::vector<double> sum = a;
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += part * b[i];
  return sum;
}

// Where along a step the energy, which is convex, is least: a root of its slope, which rises. Leaves the
// chain evaluated there and moves `slip`.
void go_along(const std::vector<double>& step, Chain& chain, std::vector<double>& slip) {
  const std::vector<double> begin = slip;
  const auto slope_at = [&](double part) {
    slip = plus(begin, part, step);
    chain.evaluate(slip, true);
    return chain.slope(step);
  };
  if (slope_at(1) <= 0) return;
  // the root may lie many powers of ten below 1, where all of a bar slips
  double low = 0, high = 1;
  for (int k = 0; k < kMostHalvings; ++k) {
    const double middle = low > 0 ? 0.5 * (low + high) : 0.1 * high;
    if (middle <= low || middle >= high) break;
    (slope_at(middle) <= 0 ? low : high) = middle;
    if (high - low <= 1e-12 * high) break;
  }
  slope_at(low > 0 ? low : high);
}

// Minimises the energy of the chain: Newton's steps from where it was; where these do not end, from the elastic answer, as
// far as each leads down. The energy is convex: both find the same. Returns the force left out of balance, as
// share of the largest, 0 where it is no more than asked for (eq. 4.9).
double solve(const std::vector<double>& rock, const Bolt& bolt, std::vector<double>& slip) {
  Chain chain(rock, bolt);
  std::vector<double> before;
  for (const BoltNode& n : bolt.nodes) before.push_back(n.slip);
  slip = before;
  chain.evaluate(slip, true);
  for (int k = 1; k <= kMostFromBefore; ++k) {
    slip = plus(slip, 1, chain.newton_step());
    chain.evaluate(slip, true);
    // the second refines what round-off left of the first
    if (k >= 2 && chain.balanced()) return 0;
  }
  slip = before;
  for (int refine = 0; refine < 2; ++refine) {
    chain.evaluate(slip, false);
    slip = plus(slip, 1, chain.newton_step());
  }
  chain.evaluate(slip, true);
  std::vector<double> best = slip;
  double least = chain.imbalance();
  for (int k = 0; k < kMostIterations && !chain.balanced(); ++k) {
    go_along(chain.newton_step(), chain, slip);
    if (chain.imbalance() < least) best = slip, least = chain.imbalance();
  }
  slip = best;
  chain.evaluate(slip, true);
  return chain.balanced() ? 0 : least / chain.scale();
}

// Takes over the slips; ruptures the segment that is stretched most beyond its limit: the others may unload
// (theory 4.21).
bool keep(const std::vector<double>& rock, const std::vector<double>& slip, Bolt& bolt) {
  BoltSegment* worst = nullptr;
  double most = bolt.rupture_strain;
  for (size_t i = 0; i < slip.size(); ++i) bolt.nodes[i].slip = slip[i];
  for (size_t j = 0; j < bolt.segments.size(); ++j) {
    BoltSegment& s = bolt.segments[j];
    s.stretch = slip[j + 1] - slip[j] + rock[j];
    const double strain = (s.stretch - s.start) / s.gauge;
    if (!s.ruptured && strain > most) most = strain, worst = &s;
  }
  if (worst) worst->ruptured = true, worst->force = 0;
  return worst != nullptr;
}

// A bar held at its ends alone: one spring, which carries no compression (its force may come out negative:
// that far it is from being taut) (theory 4.21).
int stretch_anchored(double rock, Bolt& bolt) {
  BoltSegment& s = bolt.segments[0];
  s.stretch = rock;
  if (s.ruptured) return 0;
  if (rock - s.start > bolt.rupture_strain * s.gauge) {
    s.ruptured = true, s.force = 0;
    return 1;
  }
  if (s.stiffness * (rock - s.plastic) > s.yield) s.plastic = rock - s.yield / s.stiffness, s.yielded = true;
  s.force = s.stiffness * (rock - s.plastic);
  return 0;
}

}  // namespace

int balance_bar(const std::vector<double>& rock, Bolt& bolt) {
  if (bolt.anchored) return stretch_anchored(rock[0], bolt);
  int ruptured = 0;
  std::vector<double> slip;
  double left = solve(rock, bolt, slip);
  for (; keep(rock, slip, bolt); ++ruptured) left = solve(rock, bolt, slip);
  if (!(left <= kMostLeft))
    throw NumericalError(fmt::format(
        "the statics of a grouted bolt were not solved: {:.2g} of its largest force is out of balance",
        left));
  for (BoltNode& n : bolt.nodes) {
    const double x = n.slip - n.plastic;
    if (n.stiffness * std::abs(x) > n.limit) n.plastic += x - std::copysign(n.limit / n.stiffness, x);
  }
  for (BoltSegment& s : bolt.segments) {
    if (s.ruptured) continue;
    const double x = s.stretch - s.plastic;
    s.force = std::clamp(s.stiffness * x, -s.yield, s.yield);
    if (s.stiffness * std::abs(x) <= s.yield) continue;
    s.plastic += x - std::copysign(s.yield / s.stiffness, x);
    s.yielded = true;
  }
  return ruptured;
}

// Theory 4.21.
std::vector<double> elastic_stiffness(const Bolt& bolt, const std::vector<int>& of) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Bolt elastic = bolt;
  elastic.rupture_strain = kInfinity;
  std::vector<double> sum(of.size(), 0);
  for (const int at : of) {
    for (BoltNode& n : elastic.nodes) n.limit = kInfinity, n.plastic = n.slip = 0;
    for (BoltSegment& s : elastic.segments) s.yield = kInfinity, s.plastic = s.start = 0;
    std::vector<double> rock(elastic.segments.size(), 0);
    rock[at] = 1;
    balance_bar(rock, elastic);
    for (size_t k = 0; k < of.size(); ++k) sum[k] += std::abs(elastic.segments[of[k]].force);
  }
  return sum;
}

double stored_energy(const Bolt& bolt) {
  double sum = 0;
  for (const BoltNode& n : bolt.nodes) sum += 0.5 * n.stiffness * (n.slip - n.plastic) * (n.slip - n.plastic);
  for (const BoltSegment& s : bolt.segments) {
    const double f = bolt.anchored ? std::max(s.force, 0.0) : s.force;
    if (!s.ruptured) sum += 0.5 * f * f / s.stiffness;
  }
  for (const BoltCrossing& c : bolt.crossings) {
    const double f = c.shear_stiffness * (c.shear - c.shear_plastic);
    if (c.shear_stiffness > 0 && !bolt.segments[c.segment].ruptured)
      sum += 0.5 * f * (c.shear - c.shear_plastic);
  }
  return sum;
}

}  // namespace talus
