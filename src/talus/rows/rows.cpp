#include "talus/rows/rows.h"

namespace talus {

size_t hard_ties(const RowSet& rows, const Workers& workers) {
  constexpr size_t kChunk = 1024;
  const RowRange faces = rows.range(Family::kFace);
  return workers.sum_chunks<size_t>(faces.size(), kChunk, [&](size_t begin, size_t end, size_t& count) {
    for (size_t r = faces.begin + begin; r < faces.begin + end; ++r)
      count += rows.points[r].row[0].compliance == 0;
  });
}

BlockForce impulse_on(const PointRows& p, const Impulse& impulse, double sign) {
  const Vec2 f = sign * (impulse[0] * p.normal + impulse[1] * turn_right(p.normal));
  return {f, outer(f, sign > 0 ? p.arm_a : p.arm_b)};
}

}  // namespace talus
