#pragma once
// A picture of the blocks as they lie, as SVG: for a first look without any other program.

#include <string>

#include "talus/blocks/state.h"

namespace talus {

/// All blocks in true proportion, coloured by kind, with the title, the time and a scale bar.
std::string blocks_svg(const BlockSet& blocks, const State& state, const std::string& title);

}  // namespace talus
