#pragma once
// Joints that slipped or stand open, as lines for the picture of the blocks.

#include <string>

#include "talus/base/vec2.h"

namespace talus {

/// What two blocks share of a joint, end to end.
struct JointLine {
  std::string between;  // the two blocks, in words
  Vec2 from, to;        // as it lies now [m]
  double slip = 0;      // left of it, the larger of both ends [m]
  double opening = 0;   // the larger of both ends [m]; 0 where it does not stand open
};

}  // namespace talus
