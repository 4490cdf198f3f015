#include "talus/solve/pivoting.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/solve/contact_error.h"
#include "talus/solve/contact_problem.h"
#include "talus/solve/lemke_path.h"
#include "talus/solve/newton.h"
#include "talus/solve/symmetric_factor.h"

namespace talus {

namespace {

using Eigen::Index;

// Ties that do not give at all get this share of their influence: redundant ones have no factor without. Refinement
// takes away what it leaves.
constexpr double kTieGive = 1e-11;

// So do the other rows, about a centre that goes to the impulses found, until both are the same: with it any way has an
// end, and the rows of a set are well conditioned.
constexpr double kGive = 1e-6, kLeastGive = 1e-10;

// Where the impulses known are too far off, all rows give as much as friction can turn, and then this share of it from
// one way to the next.
constexpr double kLess = 0.01;

constexpr int kMostCentres = 12, kMostRefined = 8;

// Most changes of a way by its rows: from the impulses known, from all faces apart.
constexpr double kFewChanges = 0.25, kMostChanges = 2;

// The rows of an island: those that only tie are eliminated, those that may reach a bound stay.
class Island {
 public:
  explicit Island(const ContactProblem& problem) : problem_(problem), place_(problem.size(), -1) {
    for (int i = 0; i < count_of(problem.rows); ++i) sort_point(i);
  }
  size_t live() const { return live_.size(); }

  // False when no way leads to a solution. `p`: all impulses, those known in, the best found out; `enough`: of their
  // residual [m/s].
  bool solve(Eigen::VectorXd& p, double enough, int& changes) {
    if (!reduce(p)) return false;
    Eigen::VectorXd centre(static_cast<Index>(live_.size()));
    for (size_t i = 0; i < live_.size(); ++i)
      centre[static_cast<Index>(i)] = p[live_[i]] / share_[static_cast<Index>(i)];
    Eigen::VectorXd best = p;
    double least = residual(problem_, p).lpNorm<Eigen::Infinity>();
    const auto keep_better = [&](const Eigen::VectorXd& trial) {
      const double now = residual(problem_, trial).lpNorm<Eigen::Infinity>();
      if (now < least) least = now, best = trial;
    };
    bool found = false;
    // what rows do not agree on goes with the centres, the slower the more they give: so they give less each time
    Eigen::VectorXd give = give_;
    for (int n = 0; n < kMostCentres && !(least <= enough); ++n) {
      Eigen::VectorXd trial = p;
      const bool there = n == 0 ? begin(centre, trial, changes)
                                : by_path(kKnown, lemke::kSomeChanges, give, centre, &trial, changes);
      if (!there) break;
      found = true;
      Eigen::VectorXd plain = p;
      put(centre, plain), untie(plain);
      keep_better(plain), keep_better(trial);
      give = (0.1 * give).cwiseMax(kLeastGive / kGive * give_);
    }
    p = best;
    return found;
  }

 private:
  enum Start { kKnown, kApart };

  // The way from `start` to the rows that give `give` more about the centre, which goes to the impulses found. False when
  // it leads nowhere. `p`: gets the impulses of the last set of rows as they are; null: not wanted.
  bool by_path(Start start, double share, const Eigen::VectorXd& give, Eigen::VectorXd& centre,
               Eigen::VectorXd* p, int& changes) {
    reduced_.C.diagonal() = own_ + give;
    lemke::Path path(reduced_, reduced_.q - give.cwiseProduct(centre), start);
    if (start == kKnown) path.start_from(centre);
    const bool there = (start == kKnown || path.start_apart(centre)) && path.follow(share);
    changes += path.changes();
    if (!there) return false;
    centre = path.impulses();
    if (p) finish(path, *p);
    return true;
  }

  // From the impulses known; by rows that give much, then less and less; from all faces apart.
  bool begin(Eigen::VectorXd& centre, Eigen::VectorXd& p, int& changes) {
    if (by_path(kKnown, kFewChanges, give_, centre, &p, changes)) return true;
    Eigen::VectorXd by_steps = centre;
    double give = 1;
    for (const lemke::Point& a : reduced_.points) give = std::max(give, a.friction);
    while (give > kGive &&
           by_path(kKnown, lemke::kSomeChanges, give_.cwiseMax(give), by_steps, nullptr, changes))
      give *= kLess;
    if (give <= kGive && by_path(kKnown, lemke::kSomeChanges, give_, by_steps, &p, changes)) {
      centre = by_steps;
      return true;
    }
    return by_path(kApart, kMostChanges, give_, centre, &p, changes);
  }

  int add(int row, std::vector<int>& rows) {
    place_[row] = count_of(rows);
    rows.push_back(row);
    return place_[row];
  }

  void sort_point(int i) {
    const PointRows& rows = problem_.rows[i];
    const bool stuck[2] = {!(problem_.diagonal[2 * i] > 0), !(problem_.diagonal[2 * i + 1] > 0)};
    const bool bounded = rows.cohesion < std::numeric_limits<double>::infinity();
    const bool coupled = bounded && rows.friction > 0 && !stuck[1];
    lemke::Point a{
        .lower = rows.lower, .upper = rows.upper, .friction = rows.friction, .cohesion = rows.cohesion};
    if (stuck[0] || rows.lower == rows.upper) {
      if (!stuck[0]) fixed_.emplace_back(2 * i, rows.lower);
    } else if (std::isinf(rows.lower) && std::isinf(rows.upper) && !coupled) {
      add(2 * i, ties_);
    } else {
      a.normal = add(2 * i, live_);
    }
    if (a.normal < 0)
      a.cohesion += a.friction * (stuck[0] ? 0 : rows.lower == rows.upper ? rows.lower : 0), a.friction = 0;
    if (!stuck[1] && !bounded) {
      add(2 * i + 1, ties_);
    } else if (!stuck[1] && a.normal < 0 && a.cohesion <= 0) {
      fixed_.emplace_back(2 * i + 1, 0);
    } else if (!stuck[1]) {
      a.tangent = add(2 * i + 1, live_);
    }
    if (a.normal >= 0 || a.tangent >= 0) reduced_.points.push_back(a);
  }

  // C = W_cc - W_cb W_bb^-1 W_bc, b the ties.
  bool reduce(Eigen::VectorXd& p) {
    const auto n = static_cast<Index>(live_.size()), ties = static_cast<Index>(ties_.size());
    for (const auto& [row, value] : fixed_) p[row] = value;
    is_live_.assign(place_.size(), 0);
    for (const int row : live_) is_live_[row] = 1;
    std::vector<char> is_tie(place_.size(), 0);
    for (const int row : ties_) is_tie[row] = 1;
    share_.resize(n);
    for (Index i = 0; i < n; ++i) share_[i] = 1 / std::sqrt(problem_.diagonal[live_[i]]);

    std::vector<Eigen::Triplet<double>> tied, between;
    reduced_.C = Eigen::MatrixXd::Zero(n, n);
    give_ = Eigen::VectorXd::Zero(n);
    for (Index i = 0; i < n; ++i) {
      const int row = live_[i];
      for (SparseMatrix::InnerIterator it(problem_.influence, row); it; ++it) {
        const Eigen::Index col = it.col();
        if (is_live_[col])
          reduced_.C(i, place_[col]) = share_[i] * it.value() * share_[place_[col]];
        else if (is_tie[col])
          between.emplace_back(place_[col], static_cast<int>(i), it.value() * share_[i]);
      }
      const PointRows& point = problem_.rows[row / 2];
      if (point.row[row % 2].compliance == 0) give_[i] = kGive;
    }
    for (Index i = 0; i < ties; ++i) {
      const int row = ties_[i];
      for (SparseMatrix::InnerIterator it(problem_.influence, row); it; ++it)
        if (const Eigen::Index col = it.col(); is_tie[col])
          tied.emplace_back(static_cast<int>(i), place_[col],
                            it.value() * (it.col() == row ? 1 + kTieGive : 1));
    }
    between_.resize(ties, n);
    between_.setFromTriplets(between.begin(), between.end());
    if (ties > 0) {
      ColumnMatrix of_ties(ties, ties);
      of_ties.setFromTriplets(tied.begin(), tied.end());
      if (!factor_.factorize(of_ties)) return false;
      for (Index i = 0; i < n; ++i) {
        const Eigen::VectorXd column = between_.col(i);
        if (column.isZero(0)) continue;
        reduced_.C.col(i).noalias() -= between_.transpose() * factor_.solve(column);
      }
      reduced_.C = (0.5 * (reduced_.C + reduced_.C.transpose())).eval();
    }
    own_ = reduced_.C.diagonal();
    // q: of no live impulse, the ties as they then are
    Eigen::VectorXd none = p;
    for (const int row : live_) none[row] = 0;
    const Eigen::VectorXd e = problem_.influence * none + problem_.velocity_free;
    reduced_.q = reduced_residual(e);
    scale_points();
    return reduced_.C.allFinite() && reduced_.q.allFinite();
  }

  // Residuals of the live rows once the ties have gone to where theirs vanish.
  Eigen::VectorXd reduced_residual(const Eigen::VectorXd& e) const {
    Eigen::VectorXd q(static_cast<Index>(live_.size()));
    for (size_t i = 0; i < live_.size(); ++i)
      q[static_cast<Index>(i)] = share_[static_cast<Index>(i)] * e[live_[i]];
    if (!ties_.empty()) q -= between_.transpose() * factor_.solve(of_ties(e));
    return q;
  }
  Eigen::VectorXd of_ties(const Eigen::VectorXd& e) const {
    Eigen::VectorXd x(static_cast<Index>(ties_.size()));
    for (size_t i = 0; i < ties_.size(); ++i) x[static_cast<Index>(i)] = e[ties_[i]];
    return x;
  }

  void scale_points() {
    for (lemke::Point& a : reduced_.points) {
      const double n = a.normal < 0 ? 1 : share_[a.normal], t = a.tangent < 0 ? 1 : share_[a.tangent];
      a.lower /= n, a.upper /= n, a.friction *= n / t, a.cohesion /= t;
    }
  }

  void put(const Eigen::VectorXd& live, Eigen::VectorXd& p) const {
    for (size_t i = 0; i < live_.size(); ++i)
      p[live_[i]] = share_[static_cast<Index>(i)] * live[static_cast<Index>(i)];
  }
  // The ties follow the live rows.
  void untie(Eigen::VectorXd& p) const {
    if (ties_.empty()) return;
    for (int n = 0; n < 3; ++n) {
      const Eigen::VectorXd x = factor_.solve(of_ties(problem_.influence * p + problem_.velocity_free));
      for (size_t i = 0; i < ties_.size(); ++i) p[ties_[i]] -= x[static_cast<Index>(i)];
    }
  }

  // The impulses of the last set of rows, of the rows as they are.
  void finish(const lemke::Path& path, Eigen::VectorXd& p) const {
    const Eigen::PartialPivLU<Eigen::MatrixXd> factor(path.matrix());
    Eigen::VectorXd live = path.impulses(), best;
    double least = std::numeric_limits<double>::infinity();
    for (int n = 0; n <= kMostRefined; ++n) {
      path.settle(live);
      put(live, p);
      const Eigen::VectorXd e = problem_.influence * p + problem_.velocity_free;
      Eigen::VectorXd e_live(live.size());
      for (size_t i = 0; i < live_.size(); ++i)
        e_live[static_cast<Index>(i)] = share_[static_cast<Index>(i)] * e[live_[i]];
      const double now =
          std::max(path.left(live, e_live).lpNorm<Eigen::Infinity>(), of_ties(e).lpNorm<Eigen::Infinity>());
      if (n > 0 && !(now < least)) break;
      const bool enough = n > 1 && now > 0.5 * least;
      least = now, best = p;
      if (enough || now == 0) break;
      const Eigen::VectorXd change = factor.solve(-path.left(live, reduced_residual(e)));
      live += change;
      if (!ties_.empty()) {
        const Eigen::VectorXd tied = factor_.solve(of_ties(e) + between_ * change);
        for (size_t i = 0; i < ties_.size(); ++i) p[ties_[i]] -= tied[static_cast<Index>(i)];
      }
    }
    p = best;
  }

  const ContactProblem& problem_;
  std::vector<int> live_, ties_;  // rows
  std::vector<std::pair<int, double>> fixed_;
  std::vector<int> place_;  // of a row among its kind
  std::vector<char> is_live_;
  Eigen::VectorXd own_,
      give_;  // of the live rows: the diagonal of C, and what it has more of rows that do not give
  Eigen::VectorXd share_;  // of the live rows: 1 / sqrt(Wii)
  ColumnMatrix between_;   // ties by live rows, scaled
  SymmetricFactor factor_;
  lemke::Reduced reduced_;
};

// The worst point of an island.
double worst_of(const StepProblem& problem, const std::vector<int>& points) {
  double worst = 0;
  for (const int point : points) {
    const auto u = relative_velocity(problem.rows.points[point], problem.rate);
    const double here =
        problem.dt * point_error(problem.mobility, problem.rows, point, u, worst / problem.dt);
    if (std::isnan(here)) return here;
    worst = std::max(worst, here);
  }
  return worst;
}

void let_act(const StepProblem& problem) {
  problem.rate = problem.rate_free;
  apply_impulses(problem.mobility, problem.rows, problem.rate);
}

}  // namespace

// Theory 5.10.
SolveReport Pivoting::solve(const StepProblem& problem, const SolverGoal& goal, const SolverInput&,
                            const Workers&) {
  const InPart part(problem.profile, Profile::kNewton);
  TALUS_ASSERT(!problem.smoothing.on);
  SolveReport report;
  for (Impulse& p : problem.rows.impulse)
    for (double& x : p)
      if (!std::isfinite(x)) x = 0;
  let_act(problem);
  for (const std::vector<int>& points : find_islands(problem.mobility, problem.rows)) {
    ++report.islands;
    report.largest_island = std::max(report.largest_island, count_of(points));
    const double before = worst_of(problem, points);
    if (before <= goal.enough) continue;
    const ContactProblem equations = build_problem(problem.mobility, problem.rows, points, problem.rate_free);
    Island island(equations);
    bool better = false;
    const bool may_stay = before <= goal.limit;
    if (island.live() <= (may_stay ? kMostPivotRowsLoose : kMostPivotRows)) {
      std::vector<Impulse> kept;
      Eigen::VectorXd p(equations.size());
      for (size_t i = 0; i < points.size(); ++i) {
        kept.push_back(problem.rows.impulse[points[i]]);
        p[static_cast<Index>(2 * i)] = kept.back()[0], p[static_cast<Index>(2 * i) + 1] = kept.back()[1];
      }
      if (island.solve(p, goal.enough / problem.dt, report.iterations)) {
        for (size_t i = 0; i < points.size(); ++i)
          problem.rows.impulse[points[i]] = {p[static_cast<Index>(2 * i)], p[static_cast<Index>(2 * i) + 1]};
        let_act(problem);
        better = std::isnan(before) || worst_of(problem, points) < before;
        if (!better) {
          for (size_t i = 0; i < points.size(); ++i) problem.rows.impulse[points[i]] = kept[i];
          let_act(problem);
        }
      }
    }
    report.converged = report.converged && better;
  }
  return report;
}

}  // namespace talus
