#include "talus/solve/contact_error.h"

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

// Adds n . w n and t . w t, w the influence of the arm on itself and t the tangent.
void add_diagonal(const Mobility& m, Vec2 arm, Vec2 normal, double w[2]) {
  if (!m.moves()) return;
  const Vec2 x = turned_back(m.right, arm), e = turned_back(m.left, normal);
  const double xx = x.x * x.x, xy = x.x * x.y, yy = x.y * x.y;
  const double wxx = m.mass + m.stretch[0] * xx + m.shear[0] * yy, wxy = (m.stretch[1] + m.shear[1]) * xy,
               wyy = m.mass + m.stretch[2] * yy + m.shear[2] * xx;
  const double cross = 2 * e.x * e.y * wxy;
  w[0] += e.x * e.x * wxx + cross + e.y * e.y * wyy;
  w[1] += e.y * e.y * wxx - cross + e.x * e.x * wyy;
}

}  // namespace

// Eq. 5.2.
double point_error(const std::vector<Mobility>& mobility, const RowSet& set, size_t i,
                   const std::array<double, 2>& u, double known) {
  const PointRows& point = set.points[i];
  const Impulse& impulse = set.impulse[i];
  double e[2], lower[2], upper[2];
  bool passed = true;
  for (int k = 0; k < 2; ++k) {
    e[k] = u[k] + point.row[k].bias + point.row[k].compliance * impulse[k];
    if (point.partner >= 0) e[k] += point.cross(k) * set.impulse[point.partner][k];
    const Bounds bounds = bounds_of(point, k, impulse[0]);
    lower[k] = bounds.lower, upper[k] = bounds.upper;
    // within its bounds an impulse is never further from its projection than e / Wii, and at a bound that e
    // pushes it against it is there
    const bool at_bound = (impulse[k] == lower[k] && e[k] >= 0) || (impulse[k] == upper[k] && e[k] <= 0);
    const bool within = impulse[k] >= lower[k] && impulse[k] <= upper[k];
    passed = passed && (at_bound || (within && std::abs(e[k]) <= known)) && std::isfinite(e[k]);
  }
  if (passed) return 0;

  double w[2] = {point.row[0].compliance, point.row[1].compliance};
  if (point.block_a >= 0) add_diagonal(mobility[point.block_a], point.arm_a, point.normal, w);
  if (point.block_b >= 0) add_diagonal(mobility[point.block_b], point.arm_b, point.normal, w);
  double worst = 0;
  for (size_t k = 0; k < 2; ++k) {
    const double p = impulse[k];
    const double here = std::abs(p - std::clamp(p - e[k] / w[k], lower[k], upper[k])) * w[k];
    if (!std::isfinite(here)) return std::nan("");
    worst = std::max(worst, here);
  }
  return worst;
}

ContactError contact_error(const std::vector<Mobility>& mobility, const RowSet& set,
                           const std::vector<BlockRate>& rate, double dt, const Workers& workers) {
  return workers.sum_chunks<ContactError>(
      set.points.size(), 1024, [&](size_t begin, size_t end, ContactError& worst) {
        for (size_t i = begin; i < end; ++i) {
          const auto u = relative_velocity(set.points[i], rate);
          worst += {dt * point_error(mobility, set, i, u, worst.worst / dt), static_cast<int>(i)};
        }
      });
}

}  // namespace talus
