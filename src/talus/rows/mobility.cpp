#include "talus/rows/mobility.h"

#include "talus/base/error.h"

namespace talus {

namespace {

// Inverse of the symmetric matrix [[a, b], [b, c]].
void invert(double a, double b, double c, double out[3]) {
  const double d = a * c - b * b;
  out[0] = c / d, out[1] = -b / d, out[2] = a / d;
}

}  // namespace

// Eq. 1.2.
Mobility mobility_of(const BlockSet& blocks, size_t i, double share) {
  Mobility m;
  if (!blocks.moves_freely(i)) return m;
  m.mass = share / blocks.mass[i];
  if (blocks.kind[i] == BlockKind::kRigid) {
    const double j = share / blocks.polar_inertia[i];
    m.shear[0] = m.shear[2] = j, m.shear[1] = -j;
    return m;
  }
  m.right = blocks.axis[i];
  const Vec2 s = blocks.principal[i];
  m.stretch[0] = m.shear[2] = share / s.x;
  m.stretch[2] = m.shear[0] = share / s.y;
  return m;
}

// Eq. 4.2.
Mobility mobility_implicit(const BlockSet& blocks, size_t i, Vec2 rotation, double share, double time2) {
  Mobility m = mobility_of(blocks, i, share);
  if (blocks.kind[i] != BlockKind::kDeformable) return m;
  m.left = turned(rotation, blocks.axis[i]);
  const Vec2 s = blocks.principal[i] / share;
  const PlaneModuli& c = blocks.moduli[i];
  const double f = time2 * blocks.volume[i];
  invert(s.x + f * c.c11, f * c.c12, s.y + f * c.c11, m.stretch);
  invert(s.y + f * c.c33, f * c.c33, s.x + f * c.c33, m.shear);
  return m;
}

std::vector<Mobility> mobilities(const BlockSet& blocks, double share) {
  std::vector<Mobility> all;
  for (int i = 0; i < blocks.count; ++i) all.push_back(mobility_of(blocks, i, share));
  return all;
}

// Eq. 1.3.
Mat2 influence(const Mobility& m, Vec2 at, Vec2 from) {
  // columns: answers to unit impulses along the left axes
  const Vec2 x = turned_back(m.right, from), y = turned_back(m.right, at);
  const Mat2 w{m.mass + m.stretch[0] * x.x * y.x + m.shear[0] * x.y * y.y,
               m.stretch[1] * x.y * y.x + m.shear[1] * x.x * y.y,
               m.stretch[1] * x.x * y.y + m.shear[1] * x.y * y.x,
               m.mass + m.stretch[2] * x.y * y.y + m.shear[2] * x.x * y.x};
  const Mat2 l = rotation(m.left);
  return l * w * transpose(l);
}

BlockRate accelerate(const Mobility& m, const BlockForce& impulse) {
  const Mat2 l = rotation(m.left), r = rotation(m.right);
  const Mat2 q = transpose(l) * impulse.Q * r;
  const Mat2 g{m.stretch[0] * q.xx + m.stretch[1] * q.yy, m.shear[0] * q.xy + m.shear[1] * q.yx,
               m.shear[1] * q.xy + m.shear[2] * q.yx, m.stretch[1] * q.xx + m.stretch[2] * q.yy};
  return {m.mass * impulse.f, l * g * transpose(r)};
}

void apply_impulses(const std::vector<Mobility>& mobility, const RowSet& rows, std::vector<BlockRate>& rate) {
  TALUS_ASSERT(mobility.size() == rate.size() && rows.impulse.size() == rows.points.size());
  std::vector<BlockForce> sum(rate.size());
  for (size_t r = 0; r < rows.points.size(); ++r) {
    const PointRows& p = rows.points[r];
    if (p.block_a >= 0) sum[p.block_a] += impulse_on(p, rows.impulse[r], 1);
    if (p.block_b >= 0) sum[p.block_b] += impulse_on(p, rows.impulse[r], -1);
  }
  for (size_t i = 0; i < rate.size(); ++i) {
    const BlockRate change = accelerate(mobility[i], sum[i]);
    rate[i].a += change.a;
    rate[i].G += change.G;
  }
}

}  // namespace talus
