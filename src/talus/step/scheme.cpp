#include "talus/step/scheme.h"

namespace talus {

// Theory 4.9.
Mat2 Scheme::tangent_force(size_t i, const Mat2& G) const {
  const Mat2 r = rotation(elastic[i].rotation), e = transpose(r) * G;
  const PlaneModuli& c = blocks.moduli[i];
  const double shear = c.c33 * (e.xy + e.yx);
  return blocks.volume[i] *
         (r * Mat2{c.c11 * e.xx + c.c12 * e.yy, shear, shear, c.c12 * e.xx + c.c11 * e.yy});
}

// Theory 4.5.
BlockForce Scheme::stiffness_damping(size_t i, const BlockRate& before, const BlockRate& after) const {
  return {{}, (-damping_time2()) * tangent_force(i, before.G + after.G)};
}

BlockForce Scheme::impulse_for(size_t i, const BlockRate& change) const {
  BlockForce impulse = (1 + damping()) * momentum(blocks, i, change);
  if (implicit(i))
    impulse += BlockForce{{}, (tangent_time2() + damping_time2()) * tangent_force(i, change.G)};
  return impulse;
}

}  // namespace talus
