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
  const auto n = static_cast<size_t>(c.elements);
  ColumnMass m{std::vector<double>(n + 1), std::vector<double>(n)};
  for (size_t e = 0; e < n; ++e) {
    const ColumnElement& element = field.elements[static_cast<size_t>(c.first_element) + e];
    const double all = element.density * element.height;
    const double own = lumped ? all / 2 : all / 3;
    m.diagonal[e] += own, m.diagonal[e + 1] += own;
    m.beside[e] = lumped ? 0 : all / 6;
  }
  return m;
}

// Solves a tridiagonal system by elimination from the first row; `diagonal` and `right` are used up.
void solve_tridiagonal(const std::vector<double>& lower, std::vector<double>& diagonal,
                       const std::vector<double>& upper, std::vector<double>& right) {
  const size_t n = diagonal.size();
  for (size_t i = 1; i < n; ++i) {
    const double f = lower[i - 1] / diagonal[i - 1];
    diagonal[i] -= f * upper[i - 1];
    right[i] -= f * right[i - 1];
  }
  for (size_t i = n; i-- > 0;) {
    if (i + 1 < n) right[i] -= upper[i] * right[i + 1];
    right[i] /= diagonal[i];
  }
}

// One column along one axis through a kick: (M (1 + b) + C dt/2) v+ = (M (1 - b) - C dt/2) v- + dt F, the
// dashpots C at base and top, b from mass-proportional damping.
class ColumnKick {
 public:
  ColumnKick(const FreeField& field, const GroundColumn& column, const std::vector<History>& histories,
             const StepClock& clock, double damping_mass, bool lumped)
      : c_(column),
        histories_(histories),
        t_(clock),
        damping_mass_(damping_mass),
        mass_(mass_of(field, column, lumped)) {}

  // @param v      in: rates before; out: after
  // @param force  of the stresses and body forces [Pa]
  void run(int axis, std::vector<double>& v, const std::vector<double>& force) const {
    const size_t n = v.size();
    const double b = 0.5 * damping_mass_ * t_.dt_kick;
    std::vector<double> diagonal(n), right(n), lower(n - 1), upper(n - 1);
    for (size_t i = 0; i < n; ++i) {
      diagonal[i] = (1 + b) * mass_.diagonal[i];
      double momentum = mass_.diagonal[i] * v[i];
      if (i > 0) momentum += mass_.beside[i - 1] * v[i - 1];
      if (i + 1 < n) momentum += mass_.beside[i] * v[i + 1];
      right[i] = (1 - b) * momentum + t_.dt_kick * force[i];
    }
    for (size_t i = 0; i + 1 < n; ++i) lower[i] = upper[i] = (1 + b) * mass_.beside[i];
    set_base(axis, v[0], diagonal[0], upper[0], right[0]);
    const double top = 0.5 * c_.top_impedance[axis] * t_.dt_kick;
    diagonal[n - 1] += top, right[n - 1] -= top * v[n - 1];
    solve_tridiagonal(lower, diagonal, upper, right);
    v = std::move(right);
  }

 private:
  void set_base(int axis, double before, double& diagonal, double& upper, double& right) const {
    const ColumnBase& base = c_.base;
    if (base.viscous) {
      const double half = 0.5 * base.impedance[axis] * t_.dt_kick;
      const int history = base.history[axis];
      const double bare =
          history < 0 ? 0
                      : base.incoming * histories_[static_cast<size_t>(history)].value_at(t_.history_time);
      diagonal += half;
      right += half * (2 * bare - before);
    } else if (base.motion[axis].kind != Motion::kFree) {
      const Motion& m = base.motion[axis];
      diagonal = 1, upper = 0;
      right =
          (m.displacement_at(t_.history_end(), histories_) - m.displacement_at(t_.history_time, histories_)) /
          t_.dt;
    }
  }

  const GroundColumn& c_;
  const std::vector<History>& histories_;
  const StepClock& t_;
  const double damping_mass_;
  const ColumnMass mass_;
};

// Index of the element of a column that holds a height; the ends go on outside.
size_t element_at(const FreeField& field, const GroundColumn& c, double height) {
  const auto begin = field.height.begin() + c.first_node, last = begin + c.elements;
  const auto above = std::upper_bound(begin, last, height) - begin;
  return static_cast<size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, c.elements - 1));
}

}  // namespace

// Theory 4.12.
ColumnStep stable_step(const FreeField& field, bool lumped) {
  ColumnStep least;
  for (const GroundColumn& column : field.columns) {
    for (int k = 0; k < column.elements; ++k) {
      const ColumnElement& e = field.elements[static_cast<size_t>(column.first_element + k)];
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
                  double damping_mass, bool lumped, const std::vector<Vec2>& acceleration, State& state) {
  TALUS_ASSERT(state.column_rate.size() == field.height.size());
  for (const GroundColumn& c : field.columns) {
    const auto n = static_cast<size_t>(c.elements) + 1, first = static_cast<size_t>(c.first_node);
    std::vector<double> force[2] = {std::vector<double>(n), std::vector<double>(n)},
                        v[2] = {force[0], force[0]};
    for (size_t e = 0; e + 1 < n; ++e) {
      const int index = c.first_element + static_cast<int>(e);
      const ColumnElement& element = field.elements[static_cast<size_t>(index)];
      const auto stress = column_stress(field, c, index, state.column_displacement);
      const double half = 0.5 * element.density * element.height;
      const Vec2 body = half * acceleration[static_cast<size_t>(element.block)];
      force[0][e] += stress[2] + body.x, force[0][e + 1] += body.x - stress[2];
      force[1][e] += stress[1] + body.y, force[1][e + 1] += body.y - stress[1];
    }
    for (size_t i = 0; i < n; ++i)
      v[0][i] = state.column_rate[first + i].x, v[1][i] = state.column_rate[first + i].y;
    const ColumnKick kick(field, c, histories, clock, damping_mass, lumped);
    for (int axis = 0; axis < 2; ++axis) kick.run(axis, v[axis], force[axis]);
    for (size_t i = 0; i < n; ++i) state.column_rate[first + i] = {v[0][i], v[1][i]};
  }
}

// Theory 4.12.
std::array<double, 3> column_stress(const FreeField& field, const GroundColumn& column, int element,
                                    const std::vector<Vec2>& displacement) {
  const ColumnElement& e = field.elements[static_cast<size_t>(element)];
  const auto node = static_cast<size_t>(column.first_node + element - column.first_element);
  const Vec2 strain = (displacement[node + 1] - displacement[node]) / e.height;
  std::array<double, 3> stress;
  for (size_t k = 0; k < 3; ++k) stress[k] = e.stiffness[k][1] * strain.y + e.stiffness[k][2] * strain.x;
  return stress;
}

Vec2 at_height(const FreeField& field, const GroundColumn& column, double height,
               const std::vector<Vec2>& node) {
  const size_t i = static_cast<size_t>(column.first_node) + element_at(field, column, height);
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
      const double s = (field.height[static_cast<size_t>(column.first_node + k)] - from.y) / rise;
      if (s > 0 && s < 1) cuts.push_back(s);
    }
  cuts.push_back(1);
  std::sort(cuts.begin(), cuts.end());
  for (size_t k = 1; k < cuts.size(); ++k)
    add(cuts[k - 1], cuts[k], element_at(field, column, from.y + 0.5 * (cuts[k - 1] + cuts[k]) * rise));
  return shares;
}

}  // namespace talus
