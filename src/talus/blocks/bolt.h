#pragma once
// Rock bolts as they lie in the blocks, and what they keep from step to step. All forces and stiffnesses are
// those of the model's thickness (of one bolt times thickness / spacing). Theory: docs/theory.md 4.21.

#include <array>
#include <vector>

#include "talus/base/vec2.h"

namespace talus {

/// A point of the bar and the spring that holds it in its block, along the bar.
struct BoltNode {
  int block = -1;
  Vec2 arm;              // reference arm [m]
  double stiffness = 0;  // of the spring [N/m]
  double limit = 0;      // of its force [N]; infinite where the bar is fixed to the block
  double plastic = 0;    // slip that stays [m]
  double slip = 0;       // of the bar against the block, along the bar [m]
};

/// The bar between two nodes; node j and j + 1 belong to segment j.
struct BoltSegment {
  double length = 0;     // at installation [m]; 0 across a closed joint
  double stiffness = 0;  // [N/m]
  double gauge = 0;      // length over which the elongation at rupture counts [m]
  double yield = 0;      // [N], infinite: none
  double start = 0;      // plastic elongation at installation: minus what the pretension stretches [m]
  double plastic = 0;    // elongation at which it has no force [m]
  double stretch = 0;    // elongation since installation [m]
  double force = 0;      // > 0: tension, by the statics of the bar [N]
  int crossing = -1;     // of the bolt, where its ends lie in different blocks
  bool yielded = false, ruptured = false;
};

/// A joint that the bar crosses: two rows between the blocks, along the bar and across it.
struct BoltCrossing {
  int segment = 0;
  std::array<Vec2, 2> direction{};  // of the bar in the reference shape of its two blocks, unit
  Vec2 apart;                       // from the node before to the node after, less their displacements [m]
  double row_stiffness = 0;         // of the row along the bar [N/m], at least what the bar has
  double most = 0;                  // force that the bar can pass on at all [N]
  double shear_stiffness = 0;       // dowel [N/m], 0: none
  double shear_yield = 0;           // [N]
  double shear_plastic = 0;         // [m]
  double shear = 0;                 // displacement across the bar since installation [m]
  std::array<double, 2> row{};  // impulse of the two rows over the length of the kick, on the first block [N]
};

struct Bolt {
  int input = -1;         // of the model
  bool anchored = false;  // the bar is held at its ends alone and takes no compression
  double share = 1;       // thickness / spacing
  double rupture_strain = 0;
  std::vector<BoltNode> nodes;
  std::vector<BoltSegment> segments;
  std::vector<BoltCrossing> crossings;
};

}  // namespace talus
