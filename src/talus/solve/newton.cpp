#include "talus/solve/newton.h"

#include <Eigen/Dense>
#include <Eigen/SparseLU>
#include <algorithm>
#include <deque>
#include <numeric>

#include "talus/base/index.h"
#include "talus/solve/contact_problem.h"
#include "talus/solve/symmetric_factor.h"

namespace talus {

namespace {

// Redundant ties (a ring of tied triangles around a corner, two edges at four points) make W singular though
// the equations stay consistent. A share of the diagonal makes the factor exist, and refinement against the
// true matrix takes its effect away from all that a motion feels. The share is not smaller because it alone
// holds back forces where a guess of what is closed makes the equations contradict each other: these grow to
// the contradiction over the share.
constexpr double kRegularisation = 1e-5;
constexpr int kRefinements = 12;

// Iterations that may pass without the residual halving. Of 345 islands of the tests that took more than six iterations 265
// were solved, two in three with at most five such iterations in a row, the slowest with thirty; the others cycle.
constexpr int kMostIdle = 30;

// Solves a x = rhs with the factor of a + diag(added); what no motion feels is left where refinement stalls
// (theory 5.2).
template <class Factor, class Matrix>
Eigen::VectorXd refined(const Factor& factor, const Matrix& a, const Eigen::VectorXd& rhs) {
  Eigen::VectorXd x = factor.solve(rhs);
  double left = rhs.lpNorm<Eigen::Infinity>();
  for (int n = 0; n < kRefinements; ++n) {
    const Eigen::VectorXd r = rhs - a * x;
    const double now = r.lpNorm<Eigen::Infinity>();
    if (!(now < 0.5 * left) || now == 0) break;
    left = now;
    x += factor.solve(r);
  }
  return x;
}

// Solves jacobian d = -h, using that most rows are either free, where the Jacobian is the symmetric W, or
// held.
class Direction {
 public:
  Direction(const ContactProblem& problem, SymmetricFactor& factor) : problem_(problem), factor_(factor) {}

  bool solve(const std::vector<RowState>& states, const Eigen::VectorXd& p, const Eigen::VectorXd& h,
             Eigen::VectorXd& d) const {
    if (problem_.smoothing.on) return solve_smoothed(p, h, d);
    const bool slides =
        std::any_of(states.begin(), states.end(), [](const RowState& s) { return s.slope != 0; });
    return slides ? solve_general(states, h, d) : solve_symmetric(states, h, d);
  }

 private:
  // Held rows know their change at once; the free ones are a symmetric system of W.
  bool solve_symmetric(const std::vector<RowState>& states, const Eigen::VectorXd& h,
                       Eigen::VectorXd& d) const {
    const SparseMatrix& w = problem_.influence;
    std::vector<int> free_index(states.size(), -1);
    int n_free = 0;
    d.resize(problem_.size());
    for (int r = 0; r < problem_.size(); ++r) {
      if (states[r].free)
        free_index[r] = n_free++;
      else
        d[r] = -h[r] / problem_.diagonal[r];
    }
    if (n_free == 0) return true;

    Eigen::VectorXd rhs(n_free);
    free_rows_.resize(n_free, n_free);
    free_rows_.reserve(w.nonZeros());
    for (int r = 0; r < problem_.size(); ++r) {
      const int row = free_index[r];
      if (row < 0) continue;
      rhs[row] = -h[r];
      free_rows_.startVec(row);
      for (SparseMatrix::InnerIterator it(w, r); it; ++it) {
        const int column = free_index[it.col()];
        if (column >= 0)
          free_rows_.insertBack(row, column) = it.value();
        else
          rhs[row] -= it.value() * d[it.col()];
      }
    }
    free_rows_.finalize();
    const ColumnMatrix a = free_rows_;
    ColumnMatrix held = a;
    for (int r = 0; r < problem_.size(); ++r)
      if (const int row = free_index[r]; row >= 0)
        held.coeffRef(row, row) += kRegularisation * problem_.diagonal[r];
    if (!factor_.factorize(held)) return false;
    const Eigen::VectorXd x = refined(factor_, a, rhs);
    if (!x.allFinite()) return false;
    for (int r = 0; r < problem_.size(); ++r) {
      const int row = free_index[r];
      if (row >= 0) d[r] = x[row];
    }
    return true;
  }

  // The bound of a sliding row follows its normal impulse: not symmetric.
  bool solve_general(const std::vector<RowState>& states, const Eigen::VectorXd& h,
                     Eigen::VectorXd& d) const {
    const Eigen::SparseMatrix<double> a = jacobian(problem_, states);
    Eigen::SparseMatrix<double> held = a;
    for (int r = 0; r < problem_.size(); ++r)
      if (states[r].free) held.coeffRef(r, r) += kRegularisation * problem_.diagonal[r];
    held.makeCompressed();
    Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(held);
    if (factor.info() != Eigen::Success) return false;
    d = refined(factor, a, -h);
    return d.allFinite();
  }

  bool solve_smoothed(const Eigen::VectorXd& p, const Eigen::VectorXd& h, Eigen::VectorXd& d) const {
    Eigen::SparseMatrix<double> a = jacobian_smoothed(problem_, p);
    for (int r = 0; r < problem_.size(); ++r) a.coeffRef(r, r) += kRegularisation * problem_.diagonal[r];
    a.makeCompressed();
    Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(a);
    if (factor.info() != Eigen::Success) return false;
    d = factor.solve(-h);
    return d.allFinite();
  }

  const ContactProblem& problem_;
  SymmetricFactor& factor_;
  mutable SparseMatrix free_rows_;  // of W
};

bool direction_by_differences(const ContactProblem& problem, const Eigen::VectorXd& p,
                              const Eigen::VectorXd& h, Eigen::VectorXd& d) {
  const double typical =
      std::max(p.lpNorm<Eigen::Infinity>(), (h.cwiseQuotient(problem.diagonal)).lpNorm<Eigen::Infinity>());
  const Eigen::MatrixXd j = jacobian_by_differences(problem, p, 1e-6 * typical);
  // rank-revealing: redundant rows get the smallest change
  d = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(j).solve(-h);
  return d.allFinite();
}

// Puts rows that are held at a bound exactly there: an open contact has no force, not a force of round-off,
// and what slides is on its cone.
void settle_on_bounds(const ContactProblem& problem, Eigen::VectorXd& p) {
  const std::vector<RowState> states = row_states(problem, p);
  for (Eigen::Index r = 0; r < p.size(); ++r) {
    if (states[r].free) continue;
    const auto k = static_cast<int>(r % 2);
    const Bounds b = bounds_of(problem.rows[r / 2], k, p[r - k]);
    p[r] = std::abs(p[r] - b.lower) < std::abs(p[r] - b.upper) ? b.lower : b.upper;
  }
}

// One island; returns the iterations used, negative when the residual stayed above the tolerance
// (theory 5.2).
int solve_island(const ContactProblem& problem, const SolverInput& options, double tolerance,
                 SymmetricFactor& factor, Eigen::VectorXd& p) {
  const Direction direction(problem, factor);
  Eigen::VectorXd h = residual(problem, p), d;
  Eigen::VectorXd best = p;
  double best_left = h.lpNorm<Eigen::Infinity>(), halved = best_left;
  int idle = 0;
  for (int iteration = 0; iteration <= options.max_iterations; ++iteration) {
    // at least one iteration: a first guess that happens to be good enough would make the accuracy of a step
    // depend on the scale of the problem
    const double left = h.lpNorm<Eigen::Infinity>();
    if ((iteration > 0 && left <= tolerance) || left == 0) return iteration;
    idle = left <= 0.5 * halved ? 0 : idle + 1;
    if (idle == 0) halved = left;
    if (idle > kMostIdle) {
      p = best;
      return -iteration - 1;
    }
    const bool solved = options.jacobian == JacobianKind::kDifference
                            ? direction_by_differences(problem, p, h, d)
                            : direction.solve(row_states(problem, p), p, h, d);
    if (!solved) {
      p = best;
      return -iteration - 1;
    }

    // line search: halve until the residual falls. At a kink no step may fall; the full step then moves on to
    // the next piece of the piecewise linear system, where the search starts afresh.
    const double merit = h.squaredNorm();
    Eigen::VectorXd full_p, full_h;
    double share = 1;
    for (int halvings = 0; halvings <= 8; ++halvings, share *= 0.5) {
      const Eigen::VectorXd trial = p + share * d;
      const Eigen::VectorXd h_trial = residual(problem, trial);
      if (halvings == 0) full_p = trial, full_h = h_trial;
      if (h_trial.squaredNorm() < (1 - 1e-4 * share) * merit) {
        full_p = trial, full_h = h_trial;
        break;
      }
    }
    p = full_p, h = full_h;
    if (const double now = h.lpNorm<Eigen::Infinity>(); now < best_left) best = p, best_left = now;
  }
  p = best;
  return -options.max_iterations - 1;
}

}  // namespace

// Theory 5.2.
std::vector<std::vector<int>> find_islands(const std::vector<Mobility>& mobility, const RowSet& set) {
  std::vector<int> parent(mobility.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int i) {
    while (parent[i] != i) {
      int& up = parent[i];
      up = parent[up];
      i = up;
    }
    return i;
  };
  const auto free_block = [&mobility](int i) { return i >= 0 && mobility[i].moves(); };
  for (const PointRows& p : set.points) {
    if (!free_block(p.block_a) || !free_block(p.block_b)) continue;
    const int a = root(p.block_a), b = root(p.block_b);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::vector<int>> islands;
  std::vector<int> island_of(mobility.size(), -1);
  for (int i = 0; i < count_of(set.points); ++i) {
    const PointRows& p = set.points[i];
    const int block = free_block(p.block_a) ? p.block_a : p.block_b;
    int& island = island_of[root(block)];
    if (island < 0) {
      island = count_of(islands);
      islands.emplace_back();
    }
    islands[island].push_back(i);
  }
  return islands;
}

namespace {

// `factors`: of the islands in their order.
SolveReport solve_islands(const std::vector<Mobility>& mobility, const std::vector<BlockRate>& rate,
                          const SolverInput& options, double tolerance, const Smoothing& smoothing,
                          std::deque<SymmetricFactor>& factors, RowSet& set) {
  SolveReport report;
  for (const std::vector<int>& points : find_islands(mobility, set)) {
    if (count_of(factors) <= report.islands) factors.emplace_back();
    SymmetricFactor& factor = factors[report.islands];
    ContactProblem problem = build_problem(mobility, set, points, rate);
    problem.smoothing = smoothing;
    Eigen::VectorXd p(problem.size());
    for (size_t i = 0; i < points.size(); ++i) {
      const Impulse& guess = set.impulse[points[i]];
      p[static_cast<Eigen::Index>(2 * i)] = guess[0], p[static_cast<Eigen::Index>(2 * i) + 1] = guess[1];
    }
    const int iterations = solve_island(problem, options, tolerance, factor, p);
    if (iterations >= 0 && !smoothing.on) settle_on_bounds(problem, p);
    if (iterations < 0) report.converged = false;
    for (size_t i = 0; i < points.size(); ++i) {
      const auto r = static_cast<Eigen::Index>(2 * i);
      set.impulse[points[i]] = {p[r], p[r + 1]};
    }
    report.iterations = std::max(report.iterations, iterations < 0 ? -iterations - 1 : iterations);
    report.largest_island = std::max(report.largest_island, count_of(points));
    ++report.islands;
  }
  return report;
}

}  // namespace

SolveReport solve_newton(const std::vector<Mobility>& mobility, const std::vector<BlockRate>& rate,
                         const SolverInput& options, double tolerance, RowSet& set,
                         const Smoothing& smoothing) {
  std::deque<SymmetricFactor> factors;
  return solve_islands(mobility, rate, options, tolerance, smoothing, factors, set);
}

struct Newton::Kept {
  std::deque<SymmetricFactor> factors;
};

Newton::Newton() : kept_(std::make_unique<Kept>()) {}
Newton::~Newton() = default;

SolveReport Newton::solve(const StepProblem& problem, const SolverGoal& goal, const SolverInput& limits,
                          const Workers&) {
  const InPart part(problem.profile, Profile::kNewton);
  const SolveReport report =
      solve_islands(problem.mobility, problem.rate_free, limits, goal.wanted / problem.dt, problem.smoothing,
                    kept_->factors, problem.rows);
  problem.rate = problem.rate_free;
  apply_impulses(problem.mobility, problem.rows, problem.rate);
  return report;
}

}  // namespace talus
