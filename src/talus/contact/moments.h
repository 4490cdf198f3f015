#pragma once
// Area and first moment of a polygon.

#include <vector>

#include "talus/base/vec2.h"

namespace talus {

struct Moments {
  double area = 0;  // [m2], > 0 counter-clockwise
  Vec2 first;       // integral of the place [m3]
};

inline Moments moments(const std::vector<Vec2>& p) {
  Moments m;
  if (p.size() < 3) return m;
  for (size_t i = 1; i + 1 < p.size(); ++i) {
    const Vec2 u = p[i] - p[0], v = p[i + 1] - p[0];
    const double half = 0.5 * cross(u, v);
    m.area += half, m.first += (half / 3) * (u + v);
  }
  m.first += m.area * p[0];
  return m;
}

}  // namespace talus
