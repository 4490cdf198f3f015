#pragma once
// What every engine of rigid bodies needs of a block and gives back: mass and corners about the centroid, and
// the polygon that a pose turns them into, in double precision whatever the engine keeps itself.

#include <cmath>
#include <vector>

#include "scenes.h"
#include "talus/geometry/polygon.h"

namespace talus::bench {

struct RigidShape {
  bool fixed = false;
  Vec2 centroid;              // [m] at the start
  double mass = 0;            // [kg] per metre
  double inertia = 0;         // [kg m^2] per metre, about the centroid
  std::vector<Vec2> corners;  // [m] about the centroid
};

inline std::vector<RigidShape> rigid_shapes(const BenchScene& scene) {
  std::vector<RigidShape> shapes;
  for (const BenchBlock& block : scene.blocks) {
    const PolygonMoments moments = polygon_moments(block.corners);
    RigidShape shape{block.fixed, moments.centroid, scene.density * moments.area,
                     scene.density * trace(moments.second), block.corners};
    for (Vec2& corner : shape.corners) corner -= moments.centroid;
    shapes.push_back(shape);
  }
  return shapes;
}

inline BenchBlock posed(const RigidShape& shape, Vec2 centroid, double angle) {
  const Mat2 turn{std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle)};
  BenchBlock block{shape.fixed, {}};
  for (const Vec2 corner : shape.corners) block.corners.push_back(centroid + turn * corner);
  return block;
}

struct RigidVelocity {
  Vec2 centroid, velocity;  // [m], [m/s]
  double spin = 0;          // [rad/s]

  Vec2 at(Vec2 point) const { return velocity + spin * turn_left(point - centroid); }
};

}  // namespace talus::bench
