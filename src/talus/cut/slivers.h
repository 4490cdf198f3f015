#pragma once
// Blocks too small or too thin to compute with: found, merged, deleted or kept, and listed.

#include "talus/cut/cut.h"

namespace talus {

/// Applies the policy to cut.blocks and fills cut.slivers. A sliver is merged only within its region and
/// opening, into the neighbour with the longest shared edge with which it makes a simple polygon; across a
/// fault only when no other neighbour can take it.
/// @param removed  openings whose blocks are taken out later: not judged
void treat_slivers(const CutInput& input, const std::vector<bool>& removed, Cut& cut);

}  // namespace talus
