#pragma once
// What the user asked for of rock bolts: plain data in SI units, of one bolt.

#include <limits>
#include <string>

#include "talus/base/vec2.h"
#include "talus/schema/findings.h"

namespace talus {

enum class BoltKind { kAnchored, kGrouted, kSuperposed };

struct BoltType {
  std::string name;
  BoltKind kind = BoltKind::kGrouted;
  double diameter = 0.025;                                          // [m]
  double young = 200e9;                                             // [Pa]
  double yield_force = std::numeric_limits<double>::infinity();     // [N]
  double rupture_strain = std::numeric_limits<double>::infinity();  // elongation at rupture / length
  double spacing = 1;                                               // out of the plane [m]
  double pretension = 0;                                            // [N]
  double grout_stiffness = 1e9;                                     // [N/m per m]
  double bond_strength = 200e3;                                     // [N/m]
  double dowel_stiffness = 0;                                       // [N/m]
  double dowel_yield = 0;                                           // [N]
  double segment_length = 0.25;                                     // [m]
  bool plate = false;                                               // the end `from` is fixed to its block
  Where where;

  double area() const { return 0.25 * 3.14159265358979323846 * diameter * diameter; }
  double axial_stiffness() const { return young * area(); }  // EA [N]
};

struct BoltInput {
  std::string name;
  Vec2 from, to;  // [m] where they are when it is installed
  int type = -1;
  int stage = 0;
  Where where;

  /// Whether it is called so, or belongs to the pattern of that name.
  bool belongs_to(const std::string& other) const {
    return name == other || (!other.empty() && name.rfind(other + "[", 0) == 0);
  }
};

}  // namespace talus
