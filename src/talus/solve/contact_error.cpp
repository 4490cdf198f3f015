#include "talus/solve/contact_error.h"

#include <algorithm>
#include <cmath>

namespace talus {

ContactError contact_error(const BlockSet& blocks, const RowSet& set, const std::vector<BlockRate>& rate,
                           double scale, double dt) {
  ContactError error;
  for (size_t i = 0; i < set.points.size(); ++i) {
    const PointRows& point = set.points[i];
    const auto u = relative_velocity(point, rate);
    for (int k = 0; k < 2; ++k) {
      const Vec2 d = k == 0 ? point.normal : turn_right(point.normal);
      double w = point.row[k].compliance;
      if (point.block_a >= 0)
        w += scale *
             dot(d, influence(blocks, static_cast<size_t>(point.block_a), point.arm_a, point.arm_a) * d);
      if (point.block_b >= 0)
        w += scale *
             dot(d, influence(blocks, static_cast<size_t>(point.block_b), point.arm_b, point.arm_b) * d);
      const double p = set.impulse[i][static_cast<size_t>(k)];
      double e = u[static_cast<size_t>(k)] + point.row[k].bias + point.row[k].compliance * p;
      if (point.partner >= 0)
        e += point.cross[k] * set.impulse[static_cast<size_t>(point.partner)][static_cast<size_t>(k)];
      const double lower = k == 1 && point.cone
                               ? -std::max(0.0, point.cohesion + point.friction * set.impulse[i][0])
                               : point.row[k].lower;
      const double upper = k == 1 && point.cone ? -lower : point.row[k].upper;
      const double here = std::abs(p - std::clamp(p - e / w, lower, upper)) * w * dt;
      if (!std::isfinite(here)) return {std::nan(""), static_cast<int>(i)};
      if (here > error.worst) error = {here, static_cast<int>(i)};
    }
  }
  return error;
}

}  // namespace talus
