#include "talus/geometry/shapes.h"

#include <cmath>
#include <numbers>

#include "talus/base/error.h"

namespace talus {

namespace {

constexpr double kPi = std::numbers::pi;

Vec2 on_circle(Vec2 center, double radius, double angle) {
  return center + radius * Vec2{std::cos(angle), std::sin(angle)};
}

}  // namespace

Polygon circle_polygon(Vec2 center, double diameter, int segments) {
  TALUS_ASSERT(diameter > 0 && segments >= 3);
  // n triangles of area R^2 sin(2 pi / n) / 2
  const double angle = 2 * kPi / segments;
  const double radius = 0.5 * diameter * std::sqrt(angle / std::sin(angle));
  Polygon polygon;
  for (int i = 0; i < segments; ++i) polygon.push_back(on_circle(center, radius, angle * i));
  return polygon;
}

double sagitta(double radius, double angle) { return radius * (1 - std::cos(0.5 * angle)); }

Polygon horseshoe_polygon(Vec2 center, double width, double height, int segments) {
  TALUS_ASSERT(height >= 0.5 * width && segments >= 1);
  const double r = 0.5 * width, floor = center.y - (height - r);
  // inner corners at radius R, the two ends at r: sin(a)/2 (2 r R + (n - 2) R^2) = pi r^2 / 2
  const double angle = kPi / segments, n = segments;
  const double c = kPi * r * r / std::sin(angle);
  const double radius = n > 2 ? (-r + std::sqrt(r * r + (n - 2) * c)) / (n - 2) : c / (2 * r);
  Polygon polygon;
  if (height > r) polygon = {{center.x - r, floor}, {center.x + r, floor}};
  polygon.push_back({center.x + r, center.y});
  for (int i = 1; i < segments; ++i) polygon.push_back(on_circle(center, radius, angle * i));
  polygon.push_back({center.x - r, center.y});
  return polygon;
}

}  // namespace talus
