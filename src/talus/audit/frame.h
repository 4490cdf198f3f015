#pragma once
// What the audit looks at: blocks as polygons and the points between them, as plain data. It does not say how
// the points were found. Theory: docs/theory.md section 12.

#include <limits>
#include <string>
#include <vector>

#include "talus/geometry/polygon.h"

namespace talus::audit {

enum class Hold : char { kFree, kPrescribed, kRemoved };  // prescribed: fixed or driven

struct Block {
  Hold hold = Hold::kFree;
  Polygon polygon;              // as it lies now, counter-clockwise [m]
  std::vector<Vec2> velocity;   // of the corners [m/s]; empty: at rest
  std::vector<Vec2> next = {};  // the same of the step that follows; empty: not known
};

/// What a joint can carry, the larger of peak and residual values.
struct Law {
  double friction = 0;               // tan of the friction angle
  double cohesion = 0, tension = 0;  // [Pa]
  double normal_stiffness = 0;       // [Pa/m], 0: hard
  bool bonded = false;               // carries anything
  bool dilates = false;              // rises as it slips
};

inline constexpr int kNoJoint = -1, kUnknownJoint = -2;

/// An end of a patch, or of an intact face of bonds, at `place`; or a corner of block a over an edge of block b, of
/// formulations that go by corners.
struct Point {
  int block_a = -1, block_b = -1;
  int corner = -1, edge = -1;  // of a and of b; edge -1: the end of a bond, less: of a patch
  Vec2 place;                  // of an end [m]
  Vec2 normal;                 // of a patch, from b into a; 0: not known
  double gap = 0;              // of positions [m]; of bonds not used
  double normal_force = 0;     // > 0 pressing [N]
  double shear_force = 0;      // [N]
  double rise = 0;             // of the joint over its roughness [m]
  double in_situ = 0;          // closure by the stress of the ground, left out of the gap [m]
  double closing = kNotKnown;  // of a patch: how much further it closes to where its force belongs [m]
  int partner = -1;            // other end of the face: its place in the list, -1: a corner alone
  int joint = kUnknownJoint;   // index into Rules::laws
  static constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

  bool bond() const { return edge == -1; }
  bool patch() const { return edge < -1; }
};

/// What holds for a whole run.
struct Rules {
  std::vector<std::string> names;  // of the blocks
  std::vector<Law> laws;           // of the joints
  bool joints_everywhere = false;  // the model gives a joint for pairs that have none of their own
  bool in_situ = false;            // the run began in ground under stress
  bool changes = false;            // stages change what the model began with
  double slop = 0;                 // overlap that hard contacts may keep, share of the smaller block's size
  double give = 0;                 // of a hard contact point under a force [m/N]
  double tolerance = 0;            // contact error that steps may have left so far [m]
  double thickness = 1;            // [m]
};

struct Frame {
  double time = 0, step = 0;  // [s], length of the time step [s]
  std::vector<Block> blocks;
  std::vector<Point> points;
};

}  // namespace talus::audit
