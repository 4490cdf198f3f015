#include "talus/solve/contact_error.h"

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

// Diagonal of W along the normal and the tangent of a point, without compliance.
void add_diagonal(const Mobility& m, Vec2 arm, Vec2 normal, double w[2]) {
  if (!m.moves()) return;
  const Mat2 here = influence(m, arm, arm);
  const Vec2 tangent = turn_right(normal);
  w[0] += dot(normal, here * normal);
  w[1] += dot(tangent, here * tangent);
}

double point_error(const std::vector<Mobility>& mobility, const RowSet& set,
                   const std::vector<BlockRate>& rate, double dt, size_t i) {
  const PointRows& point = set.points[i];
  const auto u = relative_velocity(point, rate);
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
    const double here = std::abs(p - std::clamp(p - e / w[k], lower, upper)) * w[k] * dt;
    if (!std::isfinite(here)) return std::nan("");
    worst = std::max(worst, here);
  }
  return worst;
}

// The worst of chunks in order: the first of equals, a NaN before all else.
struct Worst {
  ContactError error;
  Worst& operator+=(const Worst& o) {
    if (!std::isnan(error.worst) && (std::isnan(o.error.worst) || o.error.worst > error.worst))
      error = o.error;
    return *this;
  }
};

}  // namespace

ContactError contact_error(const std::vector<Mobility>& mobility, const RowSet& set,
                           const std::vector<BlockRate>& rate, double dt, const Workers& workers) {
  return workers
      .sum_chunks<Worst>(set.points.size(), 2048,
                         [&](size_t begin, size_t end, Worst& worst) {
                           for (size_t i = begin; i < end; ++i)
                             worst += {{point_error(mobility, set, rate, dt, i), static_cast<int>(i)}};
                         })
      .error;
}

}  // namespace talus
