#pragma once
// A block of conventional DDA: six displacements of a step, u0, v0, r0, ex, ey, gxy, and what mass, elasticity, stress
// and springs make of them (Shi 1988, chapter 2). Theory: docs/theory.md section 13.

#include <array>

#include "talus/blocks/state.h"
#include "talus/solve/block_factor.h"

namespace talus {

/// Displacements of a step: of the centroid [m], rotation [rad], strains [-]; or forces conjugate to them.
using Six = std::array<double, 6>;

inline Six& operator+=(Six& a, const Six& b) {
  for (size_t k = 0; k < 6; ++k) a[k] += b[k];
  return a;
}
inline Six operator*(double s, Six a) {
  for (double& v : a) v *= s;
  return a;
}
inline double dot(const Six& a, const Six& b) {
  double sum = 0;
  for (size_t k = 0; k < 6; ++k) sum += a[k] * b[k];
  return sum;
}

/// Row n^T T(x) of the displacement along `n` at `arm` from the centroid as the block lies now (eq. 13.1).
inline Six along(Vec2 n, Vec2 arm) {
  return {n.x, n.y, n.y * arm.x - n.x * arm.y, n.x * arm.x, n.y * arm.y, 0.5 * (n.x * arm.y + n.y * arm.x)};
}
/// Gradient of the displacement, in the shape of now.
inline Mat2 gradient_of(const Six& d) { return {d[3], 0.5 * d[5] - d[2], 0.5 * d[5] + d[2], d[4]}; }
/// The six of a velocity a and its gradient L in the shape of now.
inline Six six_of(Vec2 a, const Mat2& L) { return {a.x, a.y, 0.5 * (L.yx - L.xy), L.xx, L.yy, L.xy + L.yx}; }

/// Mass matrix (eq. 13.2). @param second  density times the integral of x x^T over the block as it lies now [kg m2]
Tile mass_tile(double mass, const Mat2& second);
/// Stiffness against its strains (eq. 13.3). @param volume  [m3]
Tile elastic_tile(const PlaneModuli& c, double volume);
/// Force of its stress (eq. 13.4).
Six stress_force(const Mat2& stress, double volume);
/// A generalised force on the reference arms, conjugate to BlockRate, as one of the six.
Six six_of(const BlockForce& force, const Mat2& F);

Six operator*(const Tile& m, const Six& d);
void add(Tile& m, const Six& row, const Six& column, double factor);

/// Cauchy stress that strains of a step add [Pa].
Mat2 stress_by(const PlaneModuli& c, const Six& d);

/// F after a step: (I + H) F, which lets a turning block grow, or with its rotation exact, (R + E) F (eq. 13.5).
Mat2 deformed(const Mat2& F, const Six& d, bool exact_rotation);

}  // namespace talus
