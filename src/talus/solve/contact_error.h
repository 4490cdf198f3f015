#pragma once
// How far a set of impulses is from the contact law: one measure, the same for every solver, computed from
// the blocks' velocities after the fact and sharing no code with any solver. Theory: docs/theory.md (5.3).

#include "talus/rows/rows.h"

namespace talus {

struct ContactError {
  double worst =
      0;  // [m] largest |p - Proj(p - e / Wii)| Wii dt over all rows; NaN when something is not finite
  int point = -1;  // where
};

/// @param rate   rates after the impulses have acted
/// @param scale  factor on M^-1
/// @param dt     time over which the velocities act [s]
ContactError contact_error(const BlockSet& blocks, const RowSet& set, const std::vector<BlockRate>& rate,
                           double scale, double dt);

}  // namespace talus
