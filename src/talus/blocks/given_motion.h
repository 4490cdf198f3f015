#pragma once
// How fast the model says that its blocks move.

#include "talus/blocks/block_set.h"

namespace talus {

/// Fastest motion that the model gives: of blocks at the start, and of what is driven [m/s].
double fastest_given(const Model& model, const Layout& layout, const BlockSet& blocks);

}  // namespace talus
