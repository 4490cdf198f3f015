#include "talus/solve/lemke_path.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "talus/base/random.h"

namespace talus::lemke {

namespace {

// The free residuals are moved by this share of the largest one, each by another number: no two rows then reach a
// bound at once. The last set of rows is solved without.
constexpr double kMoved = 1e-12;

// What is this share of the scale is no way off a bound, of residuals and of how fast they change.
constexpr double kZero = 1e-12, kFlat = 1e-13;

// Changes of rows after which the inverse is made anew.
constexpr int kFresh = 200, kSoonest = 20;

// Residuals of rows that are to have none are corrected beyond this share of the scale.
constexpr double kDrift = 1e-9;

}  // namespace

Path::Path(const Reduced& r, Eigen::VectorXd q, uint64_t seed)
    : r_(r), size_(q.size()), stands_(r.points.size()), q_(std::move(q)) {
  Random random(seed);
  scale_ = std::max(q_.lpNorm<Eigen::Infinity>(), 1e-300);
  for (Index i = 0; i < size_; ++i) q_[i] += kMoved * scale_ * (1 + random.uniform());
  apart_.resize(size_);
  for (double& x : apart_) x = 0.5 + random.uniform();
}

void Path::start_from(Eigen::VectorXd p) {
  const Eigen::VectorXd e = r_.C * p + q_;
  for (size_t i = 0; i < stands_.size(); ++i) {
    const Point& a = r_.points[i];
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

bool Path::start_apart(Eigen::VectorXd p) {
  for (size_t i = 0; i < stands_.size(); ++i) {
    const Point& a = r_.points[i];
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
    const Point& a = r_.points[i];
    if (a.normal < 0 || stands_[i].normal != At::kLower) continue;
    const double e_t = a.tangent < 0 ? 0 : std::abs(residual_(a.tangent, 0)), e = residual_(a.normal, 0);
    d_[a.normal] = (1 + apart_[a.normal]) * (scale_ + std::abs(e) + a.friction * e_t);
  }
  return true;
}

bool Path::follow(double share) {
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

Eigen::MatrixXd Path::matrix() const {
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

Eigen::VectorXd Path::left(const Eigen::VectorXd& p, const Eigen::VectorXd& e) const {
  Eigen::VectorXd x(size_);
  for_equations([&](Index row, const Equation& q) {
    x[row] = q.residual ? e[row] : p[row] + (q.other < 0 ? 0 : q.share * p[q.other]) - q.value;
  });
  return x;
}

void Path::settle(Eigen::VectorXd& p) const {
  for (size_t i = 0; i < stands_.size(); ++i) {
    const Point& a = r_.points[i];
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

void Path::start_tangent(const Point& a, double p_n, double e_t, Eigen::VectorXd& p, Stands& s) {
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

void Path::begin_at(const Eigen::VectorXd& p) {
  const Eigen::VectorXd e = r_.C * p + q_;
  d_ = Eigen::VectorXd::Zero(size_);
  // e >= 0 asked of a row: what is missing, and a little more
  const auto lift = [&](Index i, double sign) {
    const double over = sign * e[i], more = 1e-9 * scale_ * apart_[i];
    if (over < more) d_[i] = sign * (more - over + 0.1 * apart_[i] * std::abs(over));
  };
  for (size_t i = 0; i < stands_.size(); ++i) {
    const Point& a = r_.points[i];
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

Path::Equation Path::normal_equation(size_t i) const {
  const Point& a = r_.points[i];
  if (stands_[i].normal == At::kFree) return {.residual = true};
  return {.value = stands_[i].normal == At::kLower ? a.lower : a.upper};
}

Path::Equation Path::tangent_equation(size_t i) const {
  const Point& a = r_.points[i];
  if (stands_[i].tangent == At::kFree) return {.residual = true};
  if (stands_[i].tangent == At::kNone) return {};
  const double sign = stands_[i].tangent == At::kUpper ? 1 : -1;
  return {.other = a.normal, .share = -sign * a.friction, .value = sign * a.cohesion};
}

void Path::set_right(Index row, const Equation& e) {
  right_(row, 0) = e.residual ? -q_[row] : e.value;
  right_(row, 1) = e.residual ? -d_[row] : 0;
}

void Path::refresh() {
  right_.resize(size_, 2);
  for_equations([&](Index row, const Equation& e) { set_right(row, e); });
  inverse_ = Eigen::PartialPivLU<Eigen::MatrixXd>(matrix()).inverse();
  fresh_ = 0;
  find_line();
}

void Path::find_line() {
  line_.resize(size_, 2), residual_.resize(size_, 2);
  for (int k = 0; k < 2; ++k) line_.col(k).noalias() = inverse_ * right_.col(k);
  find_residual();
  correct_line();
}

void Path::find_residual() {
  for (int k = 0; k < 2; ++k) {
    residual_.col(k) = k == 0 ? q_ : d_;
    residual_.col(k).noalias() += r_.C * line_.col(k);
  }
  measure_line();
}

void Path::correct_line() {
  Eigen::MatrixX2d left(size_, 2);
  for_equations([&](Index row, const Equation& e) {
    left.row(row) = residual_.row(row);
    if (!e.residual) left.row(row) = line_.row(row) - right_.row(row);
    if (!e.residual && e.other >= 0) left.row(row) += e.share * line_.row(e.other);
  });
  for (int k = 0; k < 2; ++k) line_.col(k).noalias() -= inverse_ * left.col(k);
  find_residual();
}

void Path::measure_line() {
  drift_ = 0;
  for_equations([&](Index row, const Equation& e) {
    if (e.residual) drift_ = std::max({drift_, std::abs(residual_(row, 0)), std::abs(residual_(row, 1))});
  });
  fall_ = std::max(line_.col(1).lpNorm<Eigen::Infinity>(), residual_.col(1).lpNorm<Eigen::Infinity>());
}

void Path::change(Index row, const Equation& e) {
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

double Path::at(const Eigen::MatrixX2d& line, Index row, double t) const {
  return line(row, 0) + t * line(row, 1);
}

Event Path::first_event(double t, int sense) const {
  std::vector<Event> all;
  const auto add = [&](size_t i, Event::Kind kind, double slack, double rate) {
    if (sense * rate < -kFlat * fall_)
      all.push_back({static_cast<int>(i), kind, std::max(slack, 0.0), sense * rate});
  };
  for (size_t i = 0; i < stands_.size(); ++i) {
    const Point& a = r_.points[i];
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

double Path::pass(const Event& event, double t) {
  const int i = event.point;
  const Point& a = r_.points[i];
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

}  // namespace talus::lemke
