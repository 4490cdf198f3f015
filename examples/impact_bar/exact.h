#pragma once
// Exact force between a rigid mass and a fixed-free elastic bar that it strikes (one-dimensional wave
// theory). tau = c t / L, alpha = mass of the bar / mass of the striker, forces in F0 = A sqrt(E rho) v0. The
// wave that leaves the struck end in period n, tau = 2 n + x with 0 <= x < 2, has the stress s_n(x) =
// exp(-alpha x) p_n(x) with a polynomial p_n; it returns after 2 L/c unchanged in sign. The force is s_n +
// s_(n-1), the striker's velocity s_n - s_(n-1), and Newton's law for the striker gives p_n.

#include <algorithm>
#include <cmath>
#include <vector>

namespace talus::example {

class BarImpact {
 public:
  explicit BarImpact(double alpha, int periods = 6) : alpha_(alpha) {
    for (int n = 0; n < periods; ++n) p_.push_back(next_polynomial());
    separation_ = find_separation();
  }

  /// Force of the striker on the bar; 0 before the impact and after separation.
  double force(double tau) const { return tau < 0 || tau >= separation_ ? 0 : force_unseparated(tau); }
  /// Velocity of the striker in units of v0.
  double velocity(double tau) const {
    if (tau < 0) return 1;
    const Place at(std::min(tau, separation_));
    return wave(at.n, at.x) - wave(at.n - 1, at.x);
  }
  /// Impulse so far in units of M1 v0.
  double impulse(double tau) const { return 1 - velocity(tau); }
  /// Mean force over a window of this width centred on tau.
  double mean_force(double tau, double width) const {
    return (impulse(tau + width / 2) - impulse(tau - width / 2)) / (alpha_ * width);
  }
  double separation() const { return separation_; }
  double rebound() const { return -velocity(separation_); }
  double second_peak() const { return force_unseparated(2); }

 private:
  struct Place {
    explicit Place(double tau) : n(static_cast<int>(tau / 2)), x(tau - 2 * n) {}
    int n;
    double x;
  };
  using Coefficients = std::vector<double>;

  static double evaluate(const Coefficients& p, double x) {
    double v = 0;
    for (size_t i = p.size(); i-- > 0;) v = v * x + p[i];
    return v;
  }
  double wave(int n, double x) const {
    return n < 0 ? 0 : std::exp(-alpha_ * x) * evaluate(p_[static_cast<size_t>(n)], x);
  }
  double force_unseparated(double tau) const {
    const Place at(tau);
    return wave(at.n, at.x) + wave(at.n - 1, at.x);
  }

  // p_n' = p_(n-1)' - 2 alpha p_(n-1), with the striker's velocity continuous from period to period
  Coefficients next_polynomial() const {
    if (p_.empty()) return {1};
    const Coefficients& last = p_.back();
    Coefficients p(last.size() + 1, 0);
    for (size_t k = 1; k < last.size(); ++k) p[k] += last[k];
    for (size_t k = 0; k < last.size(); ++k) p[k + 1] -= 2 * alpha_ * last[k] / static_cast<double>(k + 1);
    const double before = p_.size() > 1 ? evaluate(p_[p_.size() - 2], 2) : 0;
    p[0] = last[0] + std::exp(-2 * alpha_) * (evaluate(last, 2) - before);
    return p;
  }

  // First time at which the force would turn into a pull.
  double find_separation() const {
    const double end = 2 * static_cast<double>(p_.size()) - 1e-9;
    double high = 0;
    while (high < end && force_unseparated(high) > 0) high += 1e-3;
    double low = high - 1e-3;
    for (int i = 0; i < 80; ++i) {
      const double middle = 0.5 * (low + high);
      (force_unseparated(middle) > 0 ? low : high) = middle;
    }
    return low;
  }

  double alpha_, separation_ = 0;
  std::vector<Coefficients> p_;
};

}  // namespace talus::example
