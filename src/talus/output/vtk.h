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

/// Kinds of blocks as frames number them.
inline constexpr std::array<const char*, 4> kBlockKinds{"deformable", "rigid", "fixed", "driven"};

/// What displacements in a picture may be told against, beside blocks: a support, level ground at each height.
struct GroundMotion {
  std::string name;
  std::vector<double> height;                // upwards [m]; none: the same at any
  std::vector<Vec2> displacement, velocity;  // one, or one for each height [m], [m/s]
};
/// Array of one: height, displacement x, y, velocity x, y.
inline constexpr const char* kMotionArray = "motion of ";

/// The deformed blocks: displacement and velocity at corners; of the blocks stress, displacement of the centroid
/// and its gradient (F - I, against the state from which displacements count), velocity of the centroid and its
/// gradient (against places now); block id, kind, material, group.
/// @param rate  velocities at this instant
std::string blocks_vtu(const BlockSet& blocks, const State& state, const std::vector<BlockRate>& rate,
                       const std::vector<GroundMotion>& grounds = {});

}  // namespace talus
