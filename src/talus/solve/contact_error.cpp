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

double point_error(const std::vector<Mobility>& mobility, const RowSet& set, size_t i,
                   const std::array<double, 2>& u) {
  const PointRows& point = set.points[i];
  double w[2] = {point.row[0].compliance, point.row[1].compliance};
  if (point.block_a >= 0)
    add_diagonal(mobility[static_cast<size_t>(point.block_a)], point.arm_a, point.normal, w);
  if (point.block_b >= 0)
    add_diagonal(mobility[static_cast<size_t>(point.block_b)], point.arm_b, point.normal, w);
  double worst = 0;
  for (size_t k = 0; k < 2; ++k) {
    const double p = set.impulse[i][k];
    double e = u[k] + point.row[k].bias + point.row[k].compliance * p;
    if (point.partner >= 0) e += point.cross[k] * set.impulse[static_cast<size_t>(point.partner)][k];
    const double lower = k == 1 && point.cone
                             ? -std::max(0.0, point.cohesion + point.friction * set.impulse[i][0])
                             : point.row[k].lower;
    const double upper = k == 1 && point.cone ? -lower : point.row[k].upper;
    const double here = std::abs(p - std::clamp(p - e / w[k], lower, upper)) * w[k];
    if (!std::isfinite(here)) return std::nan("");
    worst = std::max(worst, here);
  }
  return worst;
}

ContactError contact_error(const std::vector<Mobility>& mobility, const RowSet& set,
                           const std::vector<BlockRate>& rate, double dt, const Workers& workers) {
  return workers.sum_chunks<ContactError>(
      set.points.size(), 1024, [&](size_t begin, size_t end, ContactError& worst) {
        for (size_t i = begin; i < end; ++i)
          worst += {dt * point_error(mobility, set, i, relative_velocity(set.points[i], rate)),
                    static_cast<int>(i)};
      });
}

}  // namespace talus
