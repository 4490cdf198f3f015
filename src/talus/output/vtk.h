#pragma once
// Frames of the blocks for ParaView: their polygons (.vtu).

#include <array>
#include <string>
#include <vector>

#include "talus/blocks/state.h"

namespace talus {

/// Arrays of whole blocks.
inline constexpr std::array<const char*, 3> kStressArrays{"stress xx [Pa]", "stress yy [Pa]",
                                                          "stress xy [Pa]"};
inline constexpr const char *kCentroidArray = "centroid displacement [m]",
                            *kGradientArray = "displacement gradient",  // xx, xy, yx, yy
                                *kVelocityArray = "centroid velocity [m s-1]",
                            *kRateArray = "velocity gradient [s-1]";

/// The deformed blocks: displacement and velocity at corners; of the blocks stress, displacement of the centroid
/// and its gradient (F - I, against the state from which displacements count), velocity of the centroid and its
/// gradient (against places now); block id, kind, material, group.
/// @param rate  velocities at this instant
std::string blocks_vtu(const BlockSet& blocks, const State& state, const std::vector<BlockRate>& rate);

}  // namespace talus
