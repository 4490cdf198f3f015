#include "talus/solve/primal_newton.h"

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/solve/block_factor.h"
#include "talus/solve/gauss_seidel.h"
#include "talus/solve/velocity_equations.h"

namespace talus {

namespace {

// The centre is moved once velocities are found to this share of the error.
constexpr double kInner = 0.1;

// Iterations on the exact Jacobian: to this residual where the faces that stand are expected to stay so, to the other
// where some are not, by so many at most.
constexpr double kResidual = 1e-4, kRoughResidual = 1e-2;
constexpr int kMostInner = 30;

// A new factor costs about as much as five such iterations, and each face that opens, closes, slips or sticks since
// the factor was made may ask for one more.
constexpr size_t kMostChanged = 4;

// Sweeps before: from far off, where free velocities say nothing about which points are closed, Newton's method
// finds no way.
constexpr int kSweepsFirst = 40;

// Iterations that may pass without the residual halving, and how often a step is halved for it.
constexpr int kPatience = 6, kMostHalved = 8;

// Solves J x = b by generalised minimal residuals, `near` being close to J^-1.
template <class J, class P>
void minimal_residual(const VelocityEquations& with, J times, P near, const std::vector<double>& b,
                      double residual, std::vector<double>& x) {
  const double size = std::sqrt(with.product(b, b));
  x.assign(b.size(), 0);
  if (!(size > 0)) return;
  std::vector<std::vector<double>> basis{b}, turned;
  for (double& v : basis[0]) v /= size;
  std::vector<std::vector<double>> column;  // of the triangle
  std::vector<double> cosine, sine, right{size};
  size_t k = 0;
  for (; k < kMostInner; ++k) {
    turned.push_back(basis[k]);
    near(turned[k]);
    std::vector<double> w = times(turned[k]);
    std::vector<double> h(k + 2);
    for (size_t i = 0; i <= k; ++i) {
      h[i] = with.product(w, basis[i]);
      for (size_t j = 0; j < w.size(); ++j) w[j] -= h[i] * basis[i][j];
    }
    h[k + 1] = std::sqrt(with.product(w, w));
    const double last = h[k + 1];
    for (size_t i = 0; i < k; ++i) {
      const double t = cosine[i] * h[i] + sine[i] * h[i + 1];
      h[i + 1] = cosine[i] * h[i + 1] - sine[i] * h[i];
      h[i] = t;
    }
    const double r = std::hypot(h[k], h[k + 1]);
    cosine.push_back(h[k] / r), sine.push_back(h[k + 1] / r);
    h[k] = r;
    column.push_back(std::move(h));
    right.push_back(-sine[k] * right[k]), right[k] *= cosine[k];
    if (!(std::abs(right[k + 1]) > residual * size) || !(last > 0)) {
      ++k;
      break;
    }
    for (double& v : w) v /= last;
    basis.push_back(std::move(w));
  }
  std::vector<double> y(k);
  for (size_t i = k; i-- > 0;) {
    double t = right[i];
    for (size_t j = i + 1; j < k; ++j) t -= column[j][i] * y[j];
    y[i] = t / column[i][i];
  }
  for (size_t i = 0; i < k; ++i)
    for (size_t j = 0; j < x.size(); ++j) x[j] += y[i] * turned[i][j];
}

// Adds the longest of the halved steps that brings the square of the residual down, or the one that leaves the least.
void go(VelocityEquations& equations, double square, const std::vector<double>& step,
        std::vector<double>& v) {
  const std::vector<double> from = v;
  const auto take = [&](double share) {
    for (size_t i = 0; i < v.size(); ++i) v[i] = from[i] + share * step[i];
  };
  double best = 1, least = std::numeric_limits<double>::infinity(), share = 1;
  for (int halved = 0; halved < kMostHalved; ++halved, share *= 0.5) {
    take(share);
    const double now = equations.square(equations.residual(v, nullptr));
    if (now < least) least = now, best = share;
    if (now < (1 - 1e-4 * share) * square) break;
  }
  take(best);
}

}  // namespace

struct PrimalNewton::Kept {
  GaussSeidel sweeps;
  BlockFactor factor;
};

PrimalNewton::PrimalNewton() : kept_(std::make_unique<Kept>()) {}
PrimalNewton::~PrimalNewton() = default;

SolveReport PrimalNewton::solve(const StepProblem& problem, const SolverGoal& goal, const SolverInput& limits,
                                const Workers& workers) {
  SolveReport report;
  if (!problem.from_rest) {
    SolverInput few = limits;
    few.max_sweeps = std::min(limits.max_sweeps, kSweepsFirst);
    report = kept_->sweeps.solve(problem, goal, few, workers);
    if (report.converged) return report;
    report.iterations = 0;
  }
  const InPart part(problem.profile, Profile::kNewton);
  VelocityEquations equations(problem, workers);
  BlockFactor& factor = kept_->factor;
  factor.analyse(equations.pairs(), equations.places());
  std::vector<Tile> diagonal, beside;
  bool factored = false;

  std::vector<double> v = equations.start();
  std::vector<FaceTangent> tangent, of_factor;
  ContactError best;
  best.worst = std::numeric_limits<double>::infinity();
  if (report.judged) best = *report.judged;
  std::vector<Impulse> best_impulse = problem.rows.impulse;
  double before = std::numeric_limits<double>::infinity();
  int idle = 0;
  const auto judge = [&] {
    problem.rate = problem.rate_free;
    apply_impulses(problem.mobility, problem.rows, problem.rate);
    return contact_error(problem.mobility, problem.rows, problem.rate, problem.dt, workers);
  };
  for (;; ++report.iterations) {
    // the first time as if what sweeps have opened, closed and brought to slip were so: their velocities say nothing yet
    // of impulses, as joints give little
    const bool first = report.iterations == 0 && !problem.from_rest;
    std::vector<double> F = equations.residual(v, &tangent, first);
    if (!first) {
      const ContactError error = judge();
      if (std::isnan(error.worst)) break;
      if (error.worst < best.worst) best = error, best_impulse = problem.rows.impulse;
      report.converged = best.worst <= goal.enough;
      if (best.worst <= goal.wanted) break;
      if (report.iterations == 1 && !problem.from_rest && !(error.worst <= best.worst)) {
        std::fill(v.begin(), v.end(), 0.0);  // sweeps have not come far enough
        F = equations.residual(v, &tangent);
      }
      if (equations.reach(F) <= kInner * error.worst && equations.centre())
        F = equations.residual(v, &tangent);
    }
    if (report.iterations >= limits.max_iterations) break;

    std::vector<double> down(F), step;
    for (double& x : down) x = -x;
    const auto jacobian = [&](const std::vector<double>& x) { return equations.jacobian_times(tangent, x); };
    const auto near = [&](std::vector<double>& x) { factor.solve(x, workers); };
    if (!factored || differing(tangent, of_factor) > kMostChanged) {
      equations.tiles(tangent, diagonal, beside);
      factored = factor.factorize(diagonal, beside, workers);
      if (!factored) break;
      of_factor = tangent;
    }
    minimal_residual(equations, jacobian, near, down, first ? kResidual : kRoughResidual, step);
    if (first) {
      for (size_t i = 0; i < v.size(); ++i) v[i] += step[i];
      continue;
    }
    const double square = equations.square(F);
    idle = square <= 0.25 * before ? 0 : idle + 1;
    if (idle == 0) before = square;
    if (idle > kPatience) break;
    go(equations, square, step, v);
  }
  problem.rows.impulse = std::move(best_impulse);
  report.judged = judge();
  return report;
}

}  // namespace talus
