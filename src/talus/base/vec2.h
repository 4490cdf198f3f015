#pragma once
// Vectors and 2x2 matrices of the plane. Plain data, no invariants; everything inline.

#include <cmath>

namespace talus {

struct Vec2 {
  double x = 0, y = 0;

  Vec2& operator+=(Vec2 o) {
    x += o.x, y += o.y;
    return *this;
  }  // clang-format off
  Vec2& operator-=(Vec2 o) { x -= o.x, y -= o.y; return *this; }
  Vec2& operator*=(double s) { x *= s, y *= s; return *this; }  // clang-format on
};

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
inline Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.y}; }
inline Vec2 operator*(Vec2 a, double s) { return s * a; }
inline Vec2 operator/(Vec2 a, double s) { return {a.x / s, a.y / s}; }
inline bool operator==(Vec2 a, Vec2 b) { return a.x == b.x && a.y == b.y; }

inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
/// z component of a x b; > 0 when b lies counter-clockwise of a.
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
inline double norm(Vec2 a) { return std::sqrt(a.x * a.x + a.y * a.y); }
/// `a` turned 90 degrees counter-clockwise.
inline Vec2 turn_left(Vec2 a) { return {-a.y, a.x}; }
/// `a` turned 90 degrees clockwise: the tangent tau that belongs to a normal n.
inline Vec2 turn_right(Vec2 a) { return {a.y, -a.x}; }
inline bool is_finite(Vec2 a) { return std::isfinite(a.x) && std::isfinite(a.y); }

struct Mat2 {
  double xx = 0, xy = 0, yx = 0, yy = 0;

  Mat2& operator+=(const Mat2& o) {
    xx += o.xx, xy += o.xy, yx += o.yx, yy += o.yy;
    return *this;
  }
};

inline constexpr Mat2 kIdentity{1, 0, 0, 1};

inline Mat2 operator+(Mat2 a, const Mat2& b) { return a += b; }
inline Mat2 operator*(double s, const Mat2& a) { return {s * a.xx, s * a.xy, s * a.yx, s * a.yy}; }
inline Mat2 operator-(const Mat2& a, const Mat2& b) { return a + (-1.0) * b; }
inline Vec2 operator*(const Mat2& a, Vec2 v) { return {a.xx * v.x + a.xy * v.y, a.yx * v.x + a.yy * v.y}; }
inline Mat2 operator*(const Mat2& a, const Mat2& b) {
  return {a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, a.yx * b.xx + a.yy * b.yx,
          a.yx * b.xy + a.yy * b.yy};
}
inline Mat2 transpose(const Mat2& a) { return {a.xx, a.yx, a.xy, a.yy}; }
inline double trace(const Mat2& a) { return a.xx + a.yy; }
inline double det(const Mat2& a) { return a.xx * a.yy - a.xy * a.yx; }
/// Sum of the products of all entries, A : B.
inline double contract(const Mat2& a, const Mat2& b) {
  return a.xx * b.xx + a.xy * b.xy + a.yx * b.yx + a.yy * b.yy;
}
/// Of all entries (Frobenius): no vector becomes longer than by this factor.
inline double norm(const Mat2& a) { return std::sqrt(contract(a, a)); }
/// a b^T
inline Mat2 outer(Vec2 a, Vec2 b) { return {a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y}; }
/// @pre det(a) != 0
inline Mat2 inverse(const Mat2& a) {
  const double d = det(a);
  return {a.yy / d, -a.xy / d, -a.yx / d, a.xx / d};
}
/// Spin matrix: spin_matrix(w) * x is the velocity at arm x of a body turning at w [rad/s].
inline Mat2 spin_matrix(double w) { return {0, -w, w, 0}; }
inline bool is_finite(const Mat2& a) {
  return std::isfinite(a.xx) && std::isfinite(a.xy) && std::isfinite(a.yx) && std::isfinite(a.yy);
}

}  // namespace talus
