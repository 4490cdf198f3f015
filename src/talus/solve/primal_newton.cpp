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

// Friction's bounds held in turn: the first time with contacts softer by kSoftest, then by kHarder of that, and so on. Each time
// velocities are found to the share kShare of the error before. Newton's method on the law as it is follows where faces stand
// as the turn before, or the error has come down to kNearer of what it was when that was tried last.
constexpr double kSoftest = 1e4, kHarder = 0.1, kShare = 0.03, kNearer = 0.3;
constexpr int kMostTurns = 60, kMostDown = 100, kMostNear = 8;

// Slope along a step that is none, as share of what it begins with; shares of it.
constexpr double kLevel = 0.1, kFarthest = 64;
constexpr int kMostTries = 40;

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

// Adds the share of the step at which the slope along it has all but gone. With friction's bounds held F is the gradient of
// a convex function: there always is one. False when the step does not lead down. Eq. 5.3a.
bool go_down(VelocityEquations& equations, const std::vector<double>& step, std::vector<double>& v) {
  const std::vector<double> from = v;
  const auto slope = [&](double share) {
    for (size_t i = 0; i < v.size(); ++i) v[i] = from[i] + share * step[i];
    return equations.product(equations.residual(v, nullptr), step);
  };
  double low = 0, high = 1, at_low = slope(0), at_high = slope(1);
  const double level = kLevel * -at_low;
  if (!(level > 0)) return false;
  if (std::abs(at_high) <= level) return true;
  while (at_high < 0 && high < kFarthest) low = high, at_low = at_high, at_high = slope(high *= 2);
  for (int k = 0; k < kMostTries; ++k) {
    const double share =
        k % 3 == 2 ? 0.5 * (low + high) : (low * at_high - high * at_low) / (at_high - at_low);
    const double now = slope(share);
    if (std::abs(now) <= level) break;
    (now < 0 ? low : high) = share, (now < 0 ? at_low : at_high) = now;
  }
  return true;
}

// One step's search for its velocities; the best impulses so far stay.
class Search {
 public:
  Search(const StepProblem& problem, const SolverGoal& goal, const Workers& workers, BlockFactor& factor,
         SolveReport& report)
      : problem_(problem),
        goal_(goal),
        workers_(workers),
        factor_(factor),
        report_(report),
        equations_(problem, workers),
        best_impulse_(problem.rows.impulse),
        first_guess_(problem.rows.impulse) {
    factor.analyse(equations_.pairs(), equations_.places());
    best_.worst = std::numeric_limits<double>::infinity();
    if (report.judged) best_ = *report.judged;
  }

  void by_newton(int most);
  void by_turns();
  bool solved() const { return best_.worst <= goal_.solved; }

  ~Search() {
    problem_.rows.impulse = std::move(best_impulse_);
    report_.judged = judge();
  }
  Search(const Search&) = delete;
  Search& operator=(const Search&) = delete;

 private:
  ContactError judge() const {
    problem_.rate = problem_.rate_free;
    apply_impulses(problem_.mobility, problem_.rows, problem_.rate);
    return contact_error(problem_.mobility, problem_.rows, problem_.rate, problem_.dt, workers_);
  }
  // Of the impulses that are in the rows now.
  double judged() {
    const ContactError error = judge();
    if (error.worst < best_.worst) best_ = error, best_impulse_ = problem_.rows.impulse;
    report_.converged = best_.worst <= goal_.enough;
    return error.worst;
  }
  bool factorize() {
    equations_.tiles(tangent_, diagonal_, beside_);
    of_factor_ = tangent_;
    return factored_ = factor_.factorize(diagonal_, beside_, workers_);
  }
  std::vector<double> newton_step(const std::vector<double>& F, double residual) const;
  bool least(std::vector<double>& v, double reach);
  bool from_near(std::vector<double> v);

  const StepProblem& problem_;
  const SolverGoal& goal_;
  const Workers& workers_;
  BlockFactor& factor_;
  SolveReport& report_;
  VelocityEquations equations_;
  std::vector<FaceTangent> tangent_, of_factor_;
  std::vector<Tile> diagonal_, beside_;
  bool factored_ = false;
  ContactError best_;
  std::vector<Impulse> best_impulse_, first_guess_;
};

std::vector<double> Search::newton_step(const std::vector<double>& F, double residual) const {
  std::vector<double> down(F), step;
  for (double& x : down) x = -x;
  const auto jacobian = [&](const std::vector<double>& x) { return equations_.jacobian_times(tangent_, x); };
  const auto near = [&](std::vector<double>& x) { factor_.solve(x, workers_); };
  minimal_residual(equations_, jacobian, near, down, residual, step);
  return step;
}

// The law as it is.
void Search::by_newton(int most) {
  std::vector<double> v = equations_.start();
  double before = std::numeric_limits<double>::infinity();
  int idle = 0;
  for (;; ++report_.iterations) {
    // the first time as if what sweeps have opened, closed and brought to slip were so: their velocities say nothing yet
    // of impulses, as joints give little
    const bool first = report_.iterations == 0 && !problem_.from_rest;
    std::vector<double> F = equations_.residual(v, &tangent_, first);
    if (!first) {
      const double known = best_.worst, error = judged();
      if (std::isnan(error) || best_.worst <= goal_.wanted) break;
      if (report_.iterations == 1 && !problem_.from_rest && !(error <= known)) {
        std::fill(v.begin(), v.end(), 0.0);  // sweeps have not come far enough
        F = equations_.residual(v, &tangent_);
      }
      if (equations_.reach(F) <= kInner * error && equations_.centre()) F = equations_.residual(v, &tangent_);
    }
    if (report_.iterations >= most) break;
    if ((!factored_ || differing(tangent_, of_factor_) > kMostChanged) && !factorize()) break;
    const std::vector<double> step = newton_step(F, first ? kResidual : kRoughResidual);
    if (first) {
      for (size_t i = 0; i < v.size(); ++i) v[i] += step[i];
      continue;
    }
    const double square = equations_.square(F);
    idle = square <= 0.25 * before ? 0 : idle + 1;
    if (idle == 0) before = square;
    if (idle > kPatience) break;
    go(equations_, square, step, v);
  }
}

// The velocities at which F is nothing while friction's bounds are held, to this reach [m].
bool Search::least(std::vector<double>& v, double reach) {
  for (int k = 0; k < kMostDown; ++k) {
    std::vector<double> F = equations_.residual(v, &tangent_);
    if (equations_.reach(F) <= reach) {
      if (!equations_.centre()) return true;
      F = equations_.residual(v, &tangent_);
      if (equations_.reach(F) <= reach) return true;
    }
    if (!factorize()) return false;
    ++report_.iterations;
    std::vector<double> step(F);
    for (double& x : step) x = -x;
    factor_.solve(step, workers_);
    if (!go_down(equations_, step, v)) return true;
  }
  return true;
}

// Newton's method on the law as it is, from where its faces are expected to stand as they do at the solution. Whether it is
// found.
bool Search::from_near(std::vector<double> v) {
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kMostNear; ++k, ++report_.iterations) {
    std::vector<double> F = equations_.residual(v, &tangent_);
    const double error = judged();
    if (report_.converged || !(error < before)) break;
    if (k > 0) before = error;
    if (equations_.reach(F) <= kInner * error && equations_.centre()) F = equations_.residual(v, &tangent_);
    if (!factorize()) break;
    go(equations_, equations_.square(F), newton_step(F, kResidual), v);
  }
  return best_.worst <= goal_.solved;
}

// Friction's bounds are held, which leaves a convex problem; then they are half way to those of the impulses found, and so on.
void Search::by_turns() {
  std::vector<double> v = equations_.start(), pressed(problem_.rows.size());
  bool known = false;  // something of the step before
  for (size_t i = 0; i < pressed.size(); ++i)
    pressed[i] = first_guess_[i][0], known = known || pressed[i] > 0;
  std::vector<FaceTangent> stands, stood;
  double tried = std::numeric_limits<double>::infinity(), error = best_.worst;
  double soft = known ? 1 : kSoftest;
  const int most = report_.iterations + goal_.turns;
  for (int turn = 0; turn < kMostTurns && report_.iterations < most;
       ++turn, soft = std::max(1.0, kHarder * soft)) {
    equations_.hold(pressed, soft);
    if (!least(v, std::max(kInner * goal_.enough, kShare * error))) break;
    error = judged();
    if (best_.worst <= goal_.solved || std::isnan(error)) break;
    std::vector<double> found(pressed.size());
    for (size_t i = 0; i < found.size(); ++i) found[i] = problem_.rows.impulse[i][0];
    equations_.let_go();
    if (soft == 1) {
      equations_.residual(v, &stands);
      if ((!stood.empty() && differing(stands, stood) == 0) || error < kNearer * tried) {
        tried = error;
        if (from_near(v)) break;
      }
      stood = std::move(stands);
    }
    for (size_t i = 0; i < found.size(); ++i) pressed[i] += (turn == 0 ? 1.0 : 0.5) * (found[i] - pressed[i]);
  }
  equations_.let_go();
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
  {
    Search search(problem, goal, workers, kept_->factor, report);
    search.by_newton(limits.max_iterations);
    if (goal.turns > 0 && !search.solved()) search.by_turns();
  }

  return report;
}

}  // namespace talus
