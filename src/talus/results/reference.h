#pragma once
// What the motion of a point is measured against: another point, the mean of points, of a support or of
// blocks, a free field at its height.

#include <string>
#include <vector>

#include "talus/output/vtk.h"
#include "talus/run/instant.h"

namespace talus {

struct PointMotion {
  Vec2 displacement, velocity;  // [m], [m/s]
};

/// Motion of the material point at `arm` of a block, displacements since they were last reset.
PointMotion motion_of(const Instant& instant, int block, Vec2 arm);

/// Supports and free fields as frames hold them.
std::vector<GroundMotion> ground_motions(const Instant& instant);

class Reference {
 public:
  Reference() = default;  // absolute
  /// @pre  the places that the monitor names have been checked
  /// @param height  at which a free field is looked at [m]
  Reference(const Scene& scene, const MonitorInput& monitor, double height);
  /// Its motion now; zero where the monitor is absolute. The velocity of a free field is half a step late.
  PointMotion at(const Instant& instant) const;

 private:
  struct Part {
    int block;
    Vec2 arm;
    double weight;
  };
  // A support, a free field, blocks of that name.
  void refer_to(const Scene& scene, const std::string& name);

  std::vector<Part> parts_;
  int column_ = -1;  // of the free field
  double height_ = 0;
};

}  // namespace talus
