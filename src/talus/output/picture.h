#pragma once
// A picture of the blocks as they lie, as SVG: for a first look without any other program.

#include <string>

#include "talus/blocks/state.h"
#include "talus/output/bolt_lines.h"
#include "talus/output/joint_lines.h"

namespace talus {

/// All blocks in true proportion, coloured by kind, with the title, the time and a scale bar; over them the
/// joints that slipped (the wider the line, the more slip is left) or stand open (dashed), those of less than
/// 2 % of the largest slip or opening left out, and the bolts, coloured by their tension as share of the
/// largest.
std::string blocks_svg(const BlockSet& blocks, const State& state, const std::string& title,
                       const std::vector<BoltLine>& bolts = {}, const std::vector<JointLine>& joints = {});

}  // namespace talus
