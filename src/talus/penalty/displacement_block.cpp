#include "talus/penalty/displacement_block.h"

#include <cmath>

namespace talus {

Tile mass_tile(double mass, const Mat2& second) {
  const double xx = second.xx, yy = second.yy, xy = second.xy;
  Tile m{};
  const auto set = [&m](size_t i, size_t j, double v) { m[6 * i + j] = m[6 * j + i] = v; };
  set(0, 0, mass), set(1, 1, mass);
  set(2, 2, xx + yy), set(2, 3, -xy), set(2, 4, xy), set(2, 5, 0.5 * (xx - yy));
  set(3, 3, xx), set(4, 4, yy), set(3, 5, 0.5 * xy), set(4, 5, 0.5 * xy), set(5, 5, 0.25 * (xx + yy));
  return m;
}

Tile elastic_tile(const PlaneModuli& c, double volume) {
  Tile k{};
  k[6 * 3 + 3] = k[6 * 4 + 4] = volume * c.c11;
  k[6 * 3 + 4] = k[6 * 4 + 3] = volume * c.c12;
  k[6 * 5 + 5] = volume * c.c33;
  return k;
}

Six stress_force(const Mat2& stress, double volume) {
  return {0, 0, 0, -volume * stress.xx, -volume * stress.yy, -volume * 0.5 * (stress.xy + stress.yx)};
}

Six six_of(const BlockForce& force, const Mat2& F) {
  const Mat2 q = force.Q * transpose(F);
  return {force.f.x, force.f.y, q.yx - q.xy, q.xx, q.yy, 0.5 * (q.xy + q.yx)};
}

Six operator*(const Tile& m, const Six& d) {
  Six out{};
  for (size_t i = 0; i < 6; ++i)
    for (size_t j = 0; j < 6; ++j) out[i] += m[6 * i + j] * d[j];
  return out;
}

void add(Tile& m, const Six& row, const Six& column, double factor) {
  for (size_t i = 0; i < 6; ++i)
    for (size_t j = 0; j < 6; ++j) m[6 * i + j] += factor * row[i] * column[j];
}

Mat2 stress_by(const PlaneModuli& c, const Six& d) {
  const double shear = c.c33 * d[5];
  return {c.c11 * d[3] + c.c12 * d[4], shear, shear, c.c12 * d[3] + c.c11 * d[4]};
}

Mat2 deformed(const Mat2& F, const Six& d, bool exact_rotation) {
  if (!exact_rotation) return F + gradient_of(d) * F;
  const Mat2 strain{d[3], 0.5 * d[5], 0.5 * d[5], d[4]};
  return F + (rotation_minus_identity(d[2]) + strain) * F;
}

}  // namespace talus
