#pragma once
// The path of Lemke's method: the solution of a neighbouring problem, followed from one set of open, sticking and
// sliding points to the next. Theory: docs/theory.md 5.10.

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <vector>

namespace talus::lemke {

using Eigen::Index;

// Most changes of a way by its rows, from rows that gave more.
inline constexpr double kSomeChanges = 1;

// Where an impulse is: between its bounds, at one of them, or (tangential) where both are one.
enum class At : char { kFree, kLower, kUpper, kNone };

// A point with its live rows, those that may reach a bound; -1: its row is no such.
struct Point {
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
  std::vector<Point> points;
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
  /// @param seed  of the small numbers by which residuals are moved
  Path(const Reduced& r, Eigen::VectorXd q, uint64_t seed);

  // From impulses near the solution: bounds as they leave them, and the residuals that are left as d.
  void start_from(Eigen::VectorXd p);

  // From all faces as far apart as their strength lets them: first the way of the tangential rows alone, then that of a d
  // that parts the faces. With rows that all give, this way has no other end than a solution (theory 5.10).
  bool start_apart(Eigen::VectorXd p);

  // Follows the way. False when it leads nowhere.
  bool follow(double share);

  // The matrix of the rows as they stand.
  Eigen::MatrixXd matrix() const;

  // What impulses p with the residuals e leave of them.
  Eigen::VectorXd left(const Eigen::VectorXd& p, const Eigen::VectorXd& e) const;

  // Impulses exactly at the bounds where they stand, and within them elsewhere.
  void settle(Eigen::VectorXd& p) const;

  Eigen::VectorXd impulses() const { return line_.col(0); }  // at t = 0
  int changes() const { return changes_; }

 private:
  void start_tangent(const Point& a, double p_n, double e_t, Eigen::VectorXd& p, Stands& s);

  void begin_at(const Eigen::VectorXd& p);

  // Row i of the equations A p = r0 + t r1 where the rows of its point stand.
  struct Equation {
    bool residual = false;  // e = 0
    int other = -1;         // else p_i + share p_other = value
    double share = 0, value = 0;
  };
  Equation normal_equation(size_t i) const;
  Equation tangent_equation(size_t i) const;
  template <class F>
  void for_equations(const F& f) const {
    for (size_t i = 0; i < stands_.size(); ++i) {
      if (r_.points[i].normal >= 0) f(r_.points[i].normal, normal_equation(i));
      if (r_.points[i].tangent >= 0) f(r_.points[i].tangent, tangent_equation(i));
    }
  }
  void set_right(Index row, const Equation& e);

  // The inverse, and all that hangs on it, from nothing but the states.
  void refresh();

  // The solution of a set is a line in t.
  void find_line();
  void find_residual();
  // What the inverse has lost in many changes.
  void correct_line();
  void measure_line();

  // Another equation in a row: the solution moves along the column of the inverse.
  void change(Index row, const Equation& e);

  double at(const Eigen::MatrixX2d& line, Index row, double t) const;

  // The slack that is the first to reach zero; of those that are about equal the fastest, which is the best known.
  Event first_event(double t, int sense) const;

  // Goes over into the next set of rows; returns by what the slack behind rises with t.
  double pass(const Event& event, double t);

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

}  // namespace talus::lemke
