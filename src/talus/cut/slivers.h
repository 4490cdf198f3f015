#pragma once
// Blocks too small or too thin to compute with: found, merged, deleted or kept, and listed. What may be
// merged is what hides no mechanism. Theory: docs/theory.md section 10.3.

#include "talus/cut/partition.h"

namespace talus {

/// Applies the policy to cut.blocks and fills cut.slivers. The smallest goes first, into the neighbour of its
/// region and opening with the longest shared edge with which it makes a simple polygon. Needles first,
/// whatever the policy: hairs, which the grid hardly resolves, across the longer of the two joints along them
/// that are one; and across cuts that open holes, glued cells and, where they lie within the height of a
/// curve over its facets, the outline of an opening. Then, when merging is asked for, slivers inside the rock
/// across edges of joint sets. Blocks of openings that are taken out later are not judged.
/// @pre  cut.blocks are all blocks
void treat_slivers(const Model& model, Cut& cut);

}  // namespace talus
