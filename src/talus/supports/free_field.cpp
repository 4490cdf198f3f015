#include "talus/supports/free_field.h"

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"

namespace talus {

namespace {

// The mass matrix of a column along one axis, tridiagonal and symmetric, per area of its section [kg/m2].
struct ColumnMass {
  std::vector<double> diagonal, beside;
};

ColumnMass mass_of(const FreeField& field, const GroundColumn& c, bool lumped) {
  const int n = c.elements;
  ColumnMass m{std::vector<double>(n + 1), std::vector<double>(n)};
  for (int e = 0; e < n; ++e) {
    const ColumnElement& element = field.elements[c.first_element + e];
    const double all = element.density * element.height;
    const double own = lumped ? all / 2 : all / 3;
    m.diagonal[e] += own, m.diagonal[e + 1] += own;
    m.beside[e] = lumped ? 0 : all / 6;
  }
  return m;
}

// One equation per node, in both axes at once, coupled with the nodes above and below.
struct ColumnEquations {
  explicit ColumnEquations(size_t nodes)
      : diagonal(nodes, Mat2{}), above(nodes - 1, Mat2{}), below(nodes - 1, Mat2{}), right(nodes) {}

  std::vector<Mat2> diagonal, above, below;
  std::vector<Vec2> right;

  // Elimination from the foot upwards; the equations are used up.
  std::vector<Vec2> solve() {
    const size_t n = right.size();
    for (size_t i = 1; i < n; ++i) {
      const Mat2 f = below[i - 1] * inverse(diagonal[i - 1]);
      diagonal[i] = diagonal[i] - f * above[i - 1];
      right[i] -= f * right[i - 1];
    }
    for (size_t i = n; i-- > 0;) {
      if (i + 1 < n) right[i] -= above[i] * right[i + 1];
      right[i] = inverse(diagonal[i]) * right[i];
    }
    return std::move(right);
  }
};

double& on_axis(Vec2& v, int axis) { return axis == 0 ? v.x : v.y; }
double& on_axis(Mat2& m, int axis) { return axis == 0 ? m.xx : m.yy; }

// Stress xy, yy per strain of shear and of height: what an element pulls its upper node back with [Pa].
Mat2 modulus(const Stiffness& c) { return {c[2][2], c[2][1], c[1][2], c[1][1]}; }

// One column through a kick (eq. 4.4): (M (1 + b) + C dt/2 + s K) v+ = (M (1 - b) - C dt/2 + r^2 s K) v- + dt F,
// the dashpots C at base and top, b from mass-proportional damping, s K and r of elasticity where it is implicit.
class ColumnKick {
 public:
  ColumnKick(const FreeField& field, const GroundColumn& column, const std::vector<History>& histories,
             const StepClock& clock, double damping_mass, bool lumped,
             const std::optional<StepClock::ElasticWeights>& elastic)
      : field_(field),
        c_(column),
        histories_(histories),
        t_(clock),
        damping_(0.5 * damping_mass * clock.dt_kick),
        stiff_time2_(elastic ? clock.dt * clock.dt_kick / elastic->position : 0),
        old_(elastic ? elastic->old : 0),
        mass_(mass_of(field, column, lumped)) {}

  // @param v      rates before
  // @param force  of the stresses and body forces on each node [Pa]
  std::vector<Vec2> rates_after(const std::vector<Vec2>& v, const std::vector<Vec2>& force) const {
    const size_t n = v.size();
    ColumnEquations e(n);
    for (size_t i = 0; i < n; ++i) {
      Vec2 momentum = mass_.diagonal[i] * v[i];
      if (i > 0) momentum += mass_.beside[i - 1] * v[i - 1];
      if (i + 1 < n) momentum += mass_.beside[i] * v[i + 1];
      e.diagonal[i] = (1 + damping_) * mass_.diagonal[i] * kIdentity;
      e.right[i] = (1 - damping_) * momentum + t_.dt_kick * force[i];
    }
    for (size_t k = 0; k + 1 < n; ++k) {
      const ColumnElement& element = field_.elements[c_.first_element + k];
      const Mat2 stiff = stiff_time2_ / element.height * modulus(element.stiffness);
      const Vec2 kept = old_ * (stiff * (v[k + 1] - v[k]));
      e.above[k] = e.below[k] = (1 + damping_) * mass_.beside[k] * kIdentity - stiff;
      e.diagonal[k] += stiff, e.diagonal[k + 1] += stiff;
      e.right[k] -= kept, e.right[k + 1] += kept;
    }
    for (int axis = 0; axis < 2; ++axis) {
      set_base(axis, v[0], e);
      const double top = 0.5 * c_.top_impedance[axis] * t_.dt_kick;
      Vec2 last = v[n - 1];
      on_axis(e.diagonal[n - 1], axis) += top, on_axis(e.right[n - 1], axis) -= top * on_axis(last, axis);
    }
    return e.solve();
  }

 private:
  void set_base(int axis, Vec2 before, ColumnEquations& e) const {
    const ColumnBase& base = c_.base;
    double& right = on_axis(e.right[0], axis);
    if (base.viscous) {
      const double half = 0.5 * base.impedance[axis] * t_.dt_kick;
      const int history = base.history[axis];
      const double bare = history < 0 ? 0 : base.incoming * histories_[history].value_at(t_.history_time);
      on_axis(e.diagonal[0], axis) += half;
      right += half * (2 * bare - on_axis(before, axis));
    } else if (base.motion[axis].kind != Motion::kFree) {
      const Motion& m = base.motion[axis];
      Mat2& own = e.diagonal[0];
      (axis == 0 ? own.xy : own.yx) = 0;
      on_axis(own, axis) = 1;
      if (!e.above.empty()) e.above[0] = (axis == 0 ? Mat2{0, 0, 0, 1} : Mat2{1, 0, 0, 0}) * e.above[0];
      right =
          (m.displacement_at(t_.history_end(), histories_) - m.displacement_at(t_.history_time, histories_)) /
          t_.dt;
    }
  }

  const FreeField& field_;
  const GroundColumn& c_;
  const std::vector<History>& histories_;
  const StepClock& t_;
  const double damping_, stiff_time2_, old_;
  const ColumnMass mass_;
};

// Index of the element of a column that holds a height; the ends go on outside.
size_t element_at(const FreeField& field, const GroundColumn& c, double height) {
  const auto begin = field.height.begin() + c.first_node, last = begin + c.elements;
  const auto above = std::upper_bound(begin, last, height) - begin;
  return std::clamp<std::ptrdiff_t>(above - 1, 0, c.elements - 1);
}

}  // namespace

// Theory 4.12.
ColumnStep stable_step(const FreeField& field, bool lumped) {
  ColumnStep least;
  for (const GroundColumn& column : field.columns) {
    for (int k = 0; k < column.elements; ++k) {
      const ColumnElement& e = field.elements[column.first_element + k];
      // fastest motion of a free element: w^2 = 12 q / (rho h^2), lumped 4 q / (rho h^2), q the larger
      // modulus
      const Stiffness& c = e.stiffness;
      const double mean = 0.5 * (c[1][1] + c[2][2]);
      const double q = mean + std::hypot(0.5 * (c[1][1] - c[2][2]), c[1][2]);
      const double dt = 2 * e.height * std::sqrt(e.density / ((lumped ? 4 : 12) * q));
      if (dt < least.dt) least = {dt, column.boundary};
    }
  }
  return least;
}

// Eq. 4.4.
void kick_columns(const FreeField& field, const std::vector<History>& histories, const StepClock& clock,
                  double damping_mass, bool lumped, const std::optional<StepClock::ElasticWeights>& elastic,
                  const std::vector<Vec2>& acceleration, State& state, ColumnMotion& motion) {
  TALUS_ASSERT(state.column_rate.size() == field.height.size());
  const std::vector<Vec2> before = state.column_rate;
  for (const GroundColumn& c : field.columns) {
    const int n = c.elements + 1;
    std::vector<Vec2> force(n);
    for (int e = 0; e + 1 < n; ++e) {
      const int index = c.first_element + e;
      const ColumnElement& element = field.elements[index];
      const auto stress = column_stress(field, c, index, state.column_displacement);
      const Vec2 pull{stress[2], stress[1]};
      const double half = 0.5 * element.density * element.height;
      const Vec2 body = half * acceleration[element.block];
      force[e] += body + pull, force[e + 1] += body - pull;
    }
    const auto node = before.begin() + c.first_node;
    const ColumnKick kick(field, c, histories, clock, damping_mass, lumped, elastic);
    const std::vector<Vec2> after = kick.rates_after({node, node + n}, force);
    std::copy(after.begin(), after.end(), state.column_rate.begin() + c.first_node);
  }
  motion.velocity = state.column_rate;
  motion.displacement = state.column_displacement;
  const bool starts = state.dt_before == 0;
  for (size_t i = 0; i < before.size(); ++i) {
    // at the start: the velocity of the start
    motion.velocity[i] = starts ? before[i] : 0.5 * (before[i] + state.column_rate[i]);
    if (elastic)
      motion.displacement[i] +=
          clock.dt / elastic->position * (state.column_rate[i] - elastic->old * before[i]);
  }
}

// Theory 4.12.
std::array<double, 3> column_stress(const FreeField& field, const GroundColumn& column, int element,
                                    const std::vector<Vec2>& displacement) {
  const ColumnElement& e = field.elements[element];
  const int node = column.first_node + element - column.first_element;
  const Vec2 strain = (displacement[node + 1] - displacement[node]) / e.height;
  std::array<double, 3> stress;
  for (size_t k = 0; k < 3; ++k) stress[k] = e.stiffness[k][1] * strain.y + e.stiffness[k][2] * strain.x;
  return stress;
}

Vec2 at_height(const FreeField& field, const GroundColumn& column, double height,
               const std::vector<Vec2>& node) {
  const size_t i = column.first_node + element_at(field, column, height);
  const double s = std::clamp((height - field.height[i]) / (field.height[i + 1] - field.height[i]), 0.0, 1.0);
  return (1 - s) * node[i] + s * node[i + 1];
}

std::vector<std::pair<int, double>> shares_of_segment(const FreeField& field, const GroundColumn& column,
                                                      Vec2 from, Vec2 to) {
  const double length = norm(to - from), rise = to.y - from.y;
  std::vector<std::pair<int, double>> shares;
  const auto add = [&](double s0, double s1, size_t element) {
    // integral of the weight 1 - s
    shares.emplace_back(column.first_element + static_cast<int>(element),
                        length * (s1 - s0) * (1 - 0.5 * (s0 + s1)));
  };
  // the places along the segment where it passes a node
  std::vector<double> cuts{0};
  if (rise != 0)
    for (int k = 1; k < column.elements; ++k) {
      const double s = (field.height[column.first_node + k] - from.y) / rise;
      if (s > 0 && s < 1) cuts.push_back(s);
    }
  cuts.push_back(1);
  std::sort(cuts.begin(), cuts.end());
  for (size_t k = 1; k < cuts.size(); ++k)
    add(cuts[k - 1], cuts[k], element_at(field, column, from.y + 0.5 * (cuts[k - 1] + cuts[k]) * rise));
  return shares;
}

}  // namespace talus
