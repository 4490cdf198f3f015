#include "talus/solve/pivoting.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/solve/contact_error.h"
#include "talus/solve/contact_problem.h"
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

// The free residuals are moved by this share of the largest one, each by another number: no two rows then reach a
// bound at once. The last set of rows is solved without.
constexpr double kMoved = 1e-12;

// What is this share of the scale is no way off a bound, of residuals and of how fast they change.
constexpr double kZero = 1e-12, kFlat = 1e-13;

// Changes of rows after which the inverse is made anew.
constexpr int kFresh = 200, kSoonest = 20;

// Residuals of rows that are to have none are corrected beyond this share of the scale.
constexpr double kDrift = 1e-9;

// Most changes of a way, by its rows: from the impulses known, from rows that gave more, from all faces apart.
constexpr double kFewChanges = 0.25, kSomeChanges = 1, kMostChanges = 2;

// Numbers between 0 and 1 that are the same in every run.
class Numbers {
 public:
  explicit Numbers(uint64_t seed) : state_(seed) {}
  double next() {  // splitmix64
    uint64_t z = (state_ += 0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  uint64_t state_;
};

// Where an impulse is: between its bounds, at one of them, or (tangential) where both are one.
enum class At : char { kFree, kLower, kUpper, kNone };

// A point with its live rows, those that may reach a bound; -1: its row is no such.
struct LivePoint {
  int normal = -1, tangent = -1;
  double lower = 0, upper = 0;        // of the normal impulse
  double friction = 0, cohesion = 0;  // p_t within -+ max(0, cohesion + friction p_n)
  double bound(double p_n) const { return cohesion + friction * p_n; }
};

struct Stands {
  At normal = At::kFree, tangent = At::kFree;
};

// Eq. 5.4: e = C p + q of the live rows, the others eliminated; rows and impulses are scaled so that their own influence is 1.
struct Reduced {
  std::vector<LivePoint> points;
  Eigen::MatrixXd C;
  Eigen::VectorXd q;
};

// One row leaves a bound, or comes to one: `slack` falls to zero.
struct Event {
  int point = -1;
  enum Kind {
    kLower,  // p_n at its lower bound
    kUpper,  // at its upper
    kLeave,  // e_n zero: p_n leaves its bound
    kPlus,   // p_t at its bounds
    kMinus,
    kStick,   // e_t zero: sliding ends
    kVanish,  // bounds of p_t go to zero, and come from there
    kAppear
  } kind = kLower;
  double slack = 0, rate = 0;
};

// The way t from 1 to 0 of e = C p + q + t d, from a p that solves it at t = 1.
class Path {
 public:
  Path(const Reduced& r, Eigen::VectorXd q, uint64_t seed)
      : r_(r), size_(q.size()), stands_(r.points.size()), q_(std::move(q)) {
    Numbers numbers(seed);
    scale_ = std::max(q_.lpNorm<Eigen::Infinity>(), 1e-300);
    for (Index i = 0; i < size_; ++i) q_[i] += kMoved * scale_ * (1 + numbers.next());
    apart_.resize(size_);
    for (double& x : apart_) x = 0.5 + numbers.next();
  }

  // From impulses near the solution: bounds as they leave them, and the residuals that are left as d.
  void start_from(Eigen::VectorXd p) {
    const Eigen::VectorXd e = r_.C * p + q_;
    for (size_t i = 0; i < stands_.size(); ++i) {
      const LivePoint& a = r_.points[i];
      Stands& s = stands_[i];
      double p_n = 0;
      if (a.normal >= 0) {
        const double trial = p[a.normal] - e[a.normal];
        s.normal = trial <= a.lower ? At::kLower : trial >= a.upper ? At::kUpper : At::kFree;
        p_n = p[a.normal];
        if (s.normal == At::kLower) p_n = a.lower;
        if (s.normal == At::kUpper) p_n = a.upper;
        if (s.normal == At::kFree && p_n <= a.lower)
          p_n = a.lower + 0.01 * (std::min(trial, a.upper) - a.lower);
        if (s.normal == At::kFree && p_n >= a.upper)
          p_n = a.upper - 0.01 * (a.upper - std::max(trial, a.lower));
        p[a.normal] = p_n;
      }
      start_tangent(a, p_n, a.tangent < 0 ? 0 : e[a.tangent], p, s);
    }
    begin_at(p);
  }

  // From all faces as far apart as their strength lets them: first the way of the tangential rows alone, then that of a d
  // that parts the faces. With rows that all give, this way has no other end than a solution (theory 5.10).
  bool start_apart(Eigen::VectorXd p) {
    for (size_t i = 0; i < stands_.size(); ++i) {
      const LivePoint& a = r_.points[i];
      Stands& s = stands_[i];
      double p_n = 0;
      if (a.normal >= 0) {
        p_n = std::isfinite(a.lower) ? a.lower : std::min(p[a.normal], a.upper);
        s.normal = p_n == a.lower ? At::kLower : p_n == a.upper ? At::kUpper : At::kFree;
        p[a.normal] = p_n;
      }
      if (a.tangent >= 0) p[a.tangent] = 0;
      start_tangent(a, p_n, 0, p, s);
    }
    begin_at(p);
    held_ = true;
    if (!follow(kSomeChanges)) return false;
    held_ = false;
    d_.setZero();
    for (size_t i = 0; i < stands_.size(); ++i) {
      const LivePoint& a = r_.points[i];
      if (a.normal < 0 || stands_[i].normal != At::kLower) continue;
      const double e_t = a.tangent < 0 ? 0 : std::abs(residual_(a.tangent, 0)), e = residual_(a.normal, 0);
      d_[a.normal] = (1 + apart_[a.normal]) * (scale_ + std::abs(e) + a.friction * e_t);
    }
    return true;
  }

  // Follows the way. False when it leads nowhere.
  bool follow(double share) {
    double t = 1;
    int sense = -1;
    refresh();
    for (const int most = changes_ + 100 + static_cast<int>(share * static_cast<double>(size_));
         changes_ < most;) {
      const Event next = first_event(t, sense);
      const double step =
          next.point < 0 ? std::numeric_limits<double>::infinity() : std::max(0.0, next.slack / -next.rate);
      if (sense < 0 && step >= t) {
        return line_.allFinite();
      }
      if (next.point < 0) return false;
      t += sense * step;
      if (!(t < 1e6)) return false;
      const double rise = pass(next, t);
      if (!(std::abs(rise) > 0)) return false;
      sense = rise > 0 ? 1 : -1;
    }
    return false;
  }

  // The matrix of the rows as they stand.
  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size_, size_);
    for_equations([&](Index row, const Equation& e) {
      if (e.residual) {
        A.row(row) = r_.C.row(row);
      } else {
        A(row, row) = 1;
        if (e.other >= 0) A(row, e.other) = e.share;
      }
    });
    return A;
  }

  // What impulses p with the residuals e leave of them.
  Eigen::VectorXd left(const Eigen::VectorXd& p, const Eigen::VectorXd& e) const {
    Eigen::VectorXd x(size_);
    for_equations([&](Index row, const Equation& q) {
      x[row] = q.residual ? e[row] : p[row] + (q.other < 0 ? 0 : q.share * p[q.other]) - q.value;
    });
    return x;
  }

  // Impulses exactly at the bounds where they stand, and within them elsewhere.
  void settle(Eigen::VectorXd& p) const {
    for (size_t i = 0; i < stands_.size(); ++i) {
      const LivePoint& a = r_.points[i];
      double p_n = 0;
      if (a.normal >= 0) {
        double& n = p[a.normal];
        n = stands_[i].normal == At::kLower   ? a.lower
            : stands_[i].normal == At::kUpper ? a.upper
                                              : std::clamp(n, a.lower, a.upper);
        p_n = n;
      }
      if (a.tangent < 0) continue;
      const double b = std::max(0.0, a.bound(p_n));
      double& p_t = p[a.tangent];
      p_t = stands_[i].tangent == At::kLower   ? -b
            : stands_[i].tangent == At::kUpper ? b
            : stands_[i].tangent == At::kNone  ? 0
                                               : std::clamp(p_t, -b, b);
    }
  }

  Eigen::VectorXd impulses() const { return line_.col(0); }  // at t = 0
  int changes() const { return changes_; }

 private:
  void start_tangent(const LivePoint& a, double p_n, double e_t, Eigen::VectorXd& p, Stands& s) {
    if (a.tangent < 0) return;
    const double b = a.bound(p_n);
    double& p_t = p[a.tangent];
    const double trial = p_t - e_t;
    if (b <= 0) {
      s.tangent = At::kNone, p_t = 0;
    } else if (trial >= b || trial <= -b) {
      s.tangent = trial > 0 ? At::kUpper : At::kLower, p_t = trial > 0 ? b : -b;
    } else {
      s.tangent = At::kFree, p_t = std::clamp(p_t, -0.99 * b, 0.99 * b);
    }
  }

  void begin_at(const Eigen::VectorXd& p) {
    const Eigen::VectorXd e = r_.C * p + q_;
    d_ = Eigen::VectorXd::Zero(size_);
    // e >= 0 asked of a row: what is missing, and a little more
    const auto lift = [&](Index i, double sign) {
      const double over = sign * e[i], more = 1e-9 * scale_ * apart_[i];
      if (over < more) d_[i] = sign * (more - over + 0.1 * apart_[i] * std::abs(over));
    };
    for (size_t i = 0; i < stands_.size(); ++i) {
      const LivePoint& a = r_.points[i];
      if (a.normal >= 0) {
        if (stands_[i].normal == At::kFree) d_[a.normal] = -e[a.normal];
        if (stands_[i].normal == At::kLower) lift(a.normal, 1);
        if (stands_[i].normal == At::kUpper) lift(a.normal, -1);
      }
      if (a.tangent >= 0) {
        if (stands_[i].tangent == At::kFree) d_[a.tangent] = -e[a.tangent];
        if (stands_[i].tangent == At::kLower) lift(a.tangent, 1);
        if (stands_[i].tangent == At::kUpper) lift(a.tangent, -1);
      }
    }
  }

  // Row i of the equations A p = r0 + t r1 where the rows of its point stand.
  struct Equation {
    bool residual = false;  // e = 0
    int other = -1;         // else p_i + share p_other = value
    double share = 0, value = 0;
  };
  Equation normal_equation(size_t i) const {
    const LivePoint& a = r_.points[i];
    if (stands_[i].normal == At::kFree) return {.residual = true};
    return {.value = stands_[i].normal == At::kLower ? a.lower : a.upper};
  }
  Equation tangent_equation(size_t i) const {
    const LivePoint& a = r_.points[i];
    if (stands_[i].tangent == At::kFree) return {.residual = true};
    if (stands_[i].tangent == At::kNone) return {};
    const double sign = stands_[i].tangent == At::kUpper ? 1 : -1;
    return {.other = a.normal, .share = -sign * a.friction, .value = sign * a.cohesion};
  }
  template <class F>
  void for_equations(const F& f) const {
    for (size_t i = 0; i < stands_.size(); ++i) {
      if (r_.points[i].normal >= 0) f(r_.points[i].normal, normal_equation(i));
      if (r_.points[i].tangent >= 0) f(r_.points[i].tangent, tangent_equation(i));
    }
  }
  void set_right(Index row, const Equation& e) {
    right_(row, 0) = e.residual ? -q_[row] : e.value;
    right_(row, 1) = e.residual ? -d_[row] : 0;
  }

  // The inverse, and all that hangs on it, from nothing but the states.
  void refresh() {
    right_.resize(size_, 2);
    for_equations([&](Index row, const Equation& e) { set_right(row, e); });
    inverse_ = Eigen::PartialPivLU<Eigen::MatrixXd>(matrix()).inverse();
    fresh_ = 0;
    find_line();
  }

  // The solution of a set is a line in t.
  void find_line() {
    line_.resize(size_, 2), residual_.resize(size_, 2);
    for (int k = 0; k < 2; ++k) line_.col(k).noalias() = inverse_ * right_.col(k);
    find_residual();
    correct_line();
  }
  void find_residual() {
    for (int k = 0; k < 2; ++k) {
      residual_.col(k) = k == 0 ? q_ : d_;
      residual_.col(k).noalias() += r_.C * line_.col(k);
    }
    measure_line();
  }
  // What the inverse has lost in many changes.
  void correct_line() {
    Eigen::MatrixX2d left(size_, 2);
    for_equations([&](Index row, const Equation& e) {
      left.row(row) = residual_.row(row);
      if (!e.residual) left.row(row) = line_.row(row) - right_.row(row);
      if (!e.residual && e.other >= 0) left.row(row) += e.share * line_.row(e.other);
    });
    for (int k = 0; k < 2; ++k) line_.col(k).noalias() -= inverse_ * left.col(k);
    find_residual();
  }
  void measure_line() {
    drift_ = 0;
    for_equations([&](Index row, const Equation& e) {
      if (e.residual) drift_ = std::max({drift_, std::abs(residual_(row, 0)), std::abs(residual_(row, 1))});
    });
    fall_ = std::max(line_.col(1).lpNorm<Eigen::Infinity>(), residual_.col(1).lpNorm<Eigen::Infinity>());
  }

  // Another equation in a row: the solution moves along the column of the inverse.
  void change(Index row, const Equation& e) {
    const Eigen::VectorXd column = inverse_.col(row), pushed = r_.C * column;
    Eigen::RowVectorXd w;
    double rate = 0;
    Eigen::RowVector2d left;
    if (e.residual) {
      w.noalias() = r_.C.col(row).transpose() * inverse_;
      rate = pushed[row], left = -residual_.row(row);
    } else {
      w = inverse_.row(row), rate = column[row], left = -line_.row(row);
      left[0] += e.value;
      if (e.other >= 0) {
        w += e.share * inverse_.row(e.other), rate += e.share * column[e.other];
        left -= e.share * line_.row(e.other);
      }
    }
    w[row] -= 1;
    set_right(row, e);
    for (int k = 0; k < 2; ++k) {
      line_.col(k) += left[k] / rate * column;
      residual_.col(k) += left[k] / rate * pushed;
    }
    w /= rate;
    inverse_.noalias() -= column * w;
    ++fresh_, ++changes_;
  }

  double at(const Eigen::MatrixX2d& line, Index row, double t) const {
    return line(row, 0) + t * line(row, 1);
  }

  // The slack that is the first to reach zero; of those that are about equal the fastest, which is the best known.
  Event first_event(double t, int sense) const {
    std::vector<Event> all;
    const auto add = [&](size_t i, Event::Kind kind, double slack, double rate) {
      if (sense * rate < -kFlat * fall_)
        all.push_back({static_cast<int>(i), kind, std::max(slack, 0.0), sense * rate});
    };
    for (size_t i = 0; i < stands_.size(); ++i) {
      const LivePoint& a = r_.points[i];
      const Stands& s = stands_[i];
      double p_n = 0, dp_n = 0;
      if (a.normal >= 0) {
        p_n = at(line_, a.normal, t), dp_n = line_(a.normal, 1);
        const double e = at(residual_, a.normal, t), de = residual_(a.normal, 1);
        if (s.normal == At::kLower && !held_) add(i, Event::kLeave, e, de);
        if (s.normal == At::kUpper && !held_) add(i, Event::kLeave, -e, -de);
        if (s.normal == At::kFree && std::isfinite(a.lower)) add(i, Event::kLower, p_n - a.lower, dp_n);
        if (s.normal == At::kFree && std::isfinite(a.upper)) add(i, Event::kUpper, a.upper - p_n, -dp_n);
      }
      if (a.tangent < 0) continue;
      const double b = a.bound(p_n), db = a.friction * dp_n;
      const double p_t = at(line_, a.tangent, t), dp_t = line_(a.tangent, 1);
      const double e = at(residual_, a.tangent, t), de = residual_(a.tangent, 1);
      const bool moving = s.normal == At::kFree && a.normal >= 0 && a.friction > 0;
      // a contact without cohesion loses its bounds as it opens
      const bool apex = moving && !(a.bound(a.lower) >= 0);
      if (s.tangent == At::kFree)
        add(i, Event::kPlus, b - p_t, db - dp_t), add(i, Event::kMinus, b + p_t, db + dp_t);
      if (s.tangent == At::kUpper) add(i, Event::kStick, -e, -de);
      if (s.tangent == At::kLower) add(i, Event::kStick, e, de);
      if (apex && s.tangent != At::kNone && s.tangent != At::kFree) add(i, Event::kVanish, b, db);
      if (moving && s.tangent == At::kNone) add(i, Event::kAppear, -b, -db);
    }
    double last = std::numeric_limits<double>::infinity();
    for (const Event& e : all) last = std::min(last, (e.slack + kZero * scale_) / -e.rate);
    Event best;
    for (const Event& e : all)
      if (e.slack / -e.rate <= last && (best.point < 0 || e.rate < best.rate)) best = e;
    return best;
  }

  // Goes over into the next set of rows; returns by what the slack behind rises with t.
  double pass(const Event& event, double t) {
    const auto i = static_cast<size_t>(event.point);
    const LivePoint& a = r_.points[i];
    Stands& s = stands_[i];
    const Stands before = s;
    const double e_t = a.tangent < 0 ? 0 : at(residual_, a.tangent, t);
    switch (event.kind) {
      case Event::kLower:
      case Event::kUpper:
        s.normal = event.kind == Event::kLower ? At::kLower : At::kUpper;
        if (a.tangent >= 0 && a.bound(event.kind == Event::kLower ? a.lower : a.upper) <= 0)
          s.tangent = At::kNone;
        break;
      case Event::kLeave:
        s.normal = At::kFree;
        if (a.tangent >= 0 && s.tangent == At::kNone && a.friction > 0 &&
            a.bound(before.normal == At::kLower ? a.lower : a.upper) >= 0)
          s.tangent = e_t > 0 ? At::kLower : At::kUpper;
        break;
      case Event::kPlus:
        s.tangent = At::kUpper;
        break;
      case Event::kMinus:
        s.tangent = At::kLower;
        break;
      case Event::kStick:
        s.tangent = At::kFree;
        break;
      case Event::kVanish:
        s.tangent = At::kNone;
        break;
      case Event::kAppear:
        s.tangent = e_t > 0 ? At::kLower : At::kUpper;
        break;
    }
    if (s.normal != before.normal) change(a.normal, normal_equation(i));
    if (s.tangent != before.tangent) change(a.tangent, tangent_equation(i));
    measure_line();
    if (!(drift_ < kDrift * scale_)) correct_line();
    if (fresh_ > kFresh || (fresh_ > kSoonest && !(drift_ < kDrift * scale_))) refresh();
    const auto slope = [&](const Eigen::MatrixX2d& line, int row) { return line(row, 1); };
    switch (event.kind) {
      case Event::kLower:
        return slope(residual_, a.normal);
      case Event::kUpper:
        return -slope(residual_, a.normal);
      case Event::kLeave:
        return before.normal == At::kLower ? slope(line_, a.normal) : -slope(line_, a.normal);
      case Event::kPlus:
        return -slope(residual_, a.tangent);
      case Event::kMinus:
        return slope(residual_, a.tangent);
      case Event::kStick: {
        const double db = a.normal < 0 ? 0 : a.friction * slope(line_, a.normal);
        return before.tangent == At::kUpper ? db - slope(line_, a.tangent) : db + slope(line_, a.tangent);
      }
      case Event::kVanish:
        return -slope(line_, a.normal);
      case Event::kAppear:
        return slope(line_, a.normal);
    }
    return 0;
  }

  const Reduced& r_;
  Index size_;
  std::vector<Stands> stands_;
  Eigen::VectorXd q_, d_;
  Eigen::VectorXd apart_;
  double scale_ = 1, fall_ = 0, drift_ = 0;
  Eigen::MatrixXd inverse_;
  Eigen::MatrixX2d right_, line_, residual_;  // [of t^0, of t^1]
  bool held_ = false;
  int fresh_ = 0, changes_ = 0;
};

// The rows of an island: those that only tie are eliminated, those that may reach a bound stay.
class Island {
 public:
  explicit Island(const ContactProblem& problem)
      : problem_(problem), place_(static_cast<size_t>(problem.size()), -1) {
    for (int i = 0; i < static_cast<int>(problem.rows.size()); ++i) sort_point(i);
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
                                : by_path(kKnown, kSomeChanges, give, centre, &trial, changes);
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
    Path path(reduced_, reduced_.q - give.cwiseProduct(centre), start);
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
    for (const LivePoint& a : reduced_.points) give = std::max(give, a.friction);
    while (give > kGive && by_path(kKnown, kSomeChanges, give_.cwiseMax(give), by_steps, nullptr, changes))
      give *= kLess;
    if (give <= kGive && by_path(kKnown, kSomeChanges, give_, by_steps, &p, changes)) {
      centre = by_steps;
      return true;
    }
    return by_path(kApart, kMostChanges, give_, centre, &p, changes);
  }

  int add(int row, std::vector<int>& rows) {
    place_[static_cast<size_t>(row)] = static_cast<int>(rows.size());
    rows.push_back(row);
    return place_[static_cast<size_t>(row)];
  }

  void sort_point(int i) {
    const PointRows& rows = problem_.rows[static_cast<size_t>(i)];
    const bool stuck[2] = {!(problem_.diagonal[2 * i] > 0), !(problem_.diagonal[2 * i + 1] > 0)};
    const bool bounded = rows.cohesion < std::numeric_limits<double>::infinity();
    const bool coupled = bounded && rows.friction > 0 && !stuck[1];
    LivePoint a{
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
    for (const int row : live_) is_live_[static_cast<size_t>(row)] = 1;
    std::vector<char> is_tie(place_.size(), 0);
    for (const int row : ties_) is_tie[static_cast<size_t>(row)] = 1;
    share_.resize(n);
    for (Index i = 0; i < n; ++i) share_[i] = 1 / std::sqrt(problem_.diagonal[live_[static_cast<size_t>(i)]]);

    std::vector<Eigen::Triplet<double>> tied, between;
    reduced_.C = Eigen::MatrixXd::Zero(n, n);
    give_ = Eigen::VectorXd::Zero(n);
    for (Index i = 0; i < n; ++i) {
      const int row = live_[static_cast<size_t>(i)];
      for (SparseMatrix::InnerIterator it(problem_.influence, row); it; ++it) {
        const auto col = static_cast<size_t>(it.col());
        if (is_live_[col])
          reduced_.C(i, place_[col]) = share_[i] * it.value() * share_[place_[col]];
        else if (is_tie[col])
          between.emplace_back(place_[col], static_cast<int>(i), it.value() * share_[i]);
      }
      const PointRows& point = problem_.rows[static_cast<size_t>(row / 2)];
      if (point.row[row % 2].compliance == 0) give_[i] = kGive;
    }
    for (Index i = 0; i < ties; ++i) {
      const int row = ties_[static_cast<size_t>(i)];
      for (SparseMatrix::InnerIterator it(problem_.influence, row); it; ++it)
        if (const auto col = static_cast<size_t>(it.col()); is_tie[col])
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
    for (LivePoint& a : reduced_.points) {
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
  void finish(const Path& path, Eigen::VectorXd& p) const {
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
  Reduced reduced_;
};

// The worst point of an island.
double worst_of(const StepProblem& problem, const std::vector<int>& points) {
  double worst = 0;
  for (const int point : points) {
    const auto i = static_cast<size_t>(point);
    const auto u = relative_velocity(problem.rows.points[i], problem.rate);
    const double here = problem.dt * point_error(problem.mobility, problem.rows, i, u, worst / problem.dt);
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
    report.largest_island = std::max(report.largest_island, static_cast<int>(points.size()));
    const double before = worst_of(problem, points);
    if (before <= goal.enough) continue;
    const ContactProblem equations = build_problem(problem.mobility, problem.rows, points, problem.rate_free);
    Island island(equations);
    bool better = false;
    if (island.live() <= kMostPivotRows) {
      std::vector<Impulse> kept;
      Eigen::VectorXd p(equations.size());
      for (size_t i = 0; i < points.size(); ++i) {
        kept.push_back(problem.rows.impulse[static_cast<size_t>(points[i])]);
        p[static_cast<Index>(2 * i)] = kept.back()[0], p[static_cast<Index>(2 * i) + 1] = kept.back()[1];
      }
      if (island.solve(p, goal.enough / problem.dt, report.iterations)) {
        for (size_t i = 0; i < points.size(); ++i)
          problem.rows.impulse[static_cast<size_t>(points[i])] = {p[static_cast<Index>(2 * i)],
                                                                  p[static_cast<Index>(2 * i) + 1]};
        let_act(problem);
        better = std::isnan(before) || worst_of(problem, points) < before;
        if (!better) {
          for (size_t i = 0; i < points.size(); ++i)
            problem.rows.impulse[static_cast<size_t>(points[i])] = kept[i];
          let_act(problem);
        }
      }
    }
    report.converged = report.converged && better;
  }
  return report;
}

}  // namespace talus
