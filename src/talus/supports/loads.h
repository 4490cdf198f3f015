#pragma once
// Body forces on blocks over time, as accelerations beside gravity.

#include <vector>

#include "talus/blocks/state.h"

namespace talus {

/// Blocks of each load of the model, in its order.
std::vector<std::vector<int>> loaded_blocks(const Model& model, const Layout& layout);

/// Acceleration by all loads on each block at `time` on the clock of the histories [count] [m/s2].
std::vector<Vec2> load_acceleration(const Model& model, const std::vector<std::vector<int>>& loaded,
                                    int block_count, double time);

}  // namespace talus
