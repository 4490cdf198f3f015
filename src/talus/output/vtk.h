#pragma once
// Frames for ParaView: polygons of the blocks (.vtu), contact points (.vtp).

#include <string>
#include <vector>

#include "talus/blocks/state.h"

namespace talus {

/// One force between two blocks, or on a block by a support, as drawn in a frame.
struct ContactFrame {
  Vec2 point;  // [m]
  Vec2 force;  // on the first block [N]
  double normal_force = 0, shear_force = 0, gap = 0;
  int kind = 0;                    // 0 contact, 1 bond, 2 support, 3 boundary, 4 bolt
  double slip = 0, opening = 0;    // of joints [m]
  int state = -1;                  // of joints: 0 intact, 1 slipped, 2 open, 3 never in touch; -1: no joint
  int block_a = -1, block_b = -1;  // -1: the ground
  // of a contact the corner of block_a and the edge of block_b; else the index of the point and 0: the same
  // point has the same numbers in every frame
  int corner = 0, edge = 0;
  int partner = -1;  // index in the frame of the other end of what the two blocks share, -1: none
};

/// The deformed blocks: displacement and velocity at corners; stress (sxx, syy, sxy), block id, kind,
/// material, group.
/// @param rate  velocities at this instant
std::string blocks_vtu(const BlockSet& blocks, const State& state, const std::vector<BlockRate>& rate);

std::string contacts_vtp(const std::vector<ContactFrame>& contacts, double time);

}  // namespace talus
