#include "talus/rows/rows.h"

namespace talus {

size_t hard_ties(const RowSet& rows) {
  size_t count = 0;
  const RowRange faces = rows.range(Family::kFace);
  for (size_t r = faces.begin; r < faces.end; ++r) count += rows.points[r].row[0].compliance == 0;
  return count;
}

BlockForce impulse_on(const PointRows& p, const Impulse& impulse, double sign) {
  const Vec2 f = sign * (impulse[0] * p.normal + impulse[1] * turn_right(p.normal));
  return {f, outer(f, sign > 0 ? p.arm_a : p.arm_b)};
}

}  // namespace talus
