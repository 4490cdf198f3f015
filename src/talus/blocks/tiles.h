#pragma once
// Blocks that lie together, for whoever works through the rows of a model part by part: what one part reads and
// writes stays in the nearest memory of a processor, and parts go to threads whole.

#include <vector>

#include "talus/base/vec2.h"

namespace talus {

/// The tile of each place: places in the order of Hilbert's curve through their common square, cut into lengths of
/// nearly equal number. Empty where there are too few to be parted. The same for the same places, whatever else.
std::vector<int> tiles_of(const std::vector<Vec2>& places);

}  // namespace talus
