#include "talus/rows/rows.h"

namespace talus {

// Eq. 1.2.
BlockRate accelerate(const BlockSet& blocks, size_t i, const BlockForce& force) {
  switch (blocks.kind[i]) {
    case BlockKind::kDeformable:
      return {force.f / blocks.mass[i], force.Q * blocks.inertia_inverse[i]};
    case BlockKind::kRigid:
      return {force.f / blocks.mass[i], spin_matrix((force.Q.yx - force.Q.xy) / blocks.polar_inertia[i])};
    default:
      return {};
  }
}

BlockForce momentum(const BlockSet& blocks, size_t i, const BlockRate& rate) {
  switch (blocks.kind[i]) {
    case BlockKind::kDeformable:
      return {blocks.mass[i] * rate.a, rate.G * blocks.inertia[i]};
    case BlockKind::kRigid:
      return {blocks.mass[i] * rate.a, (0.5 * blocks.polar_inertia[i]) * rate.G};
    default:
      return {};
  }
}

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
