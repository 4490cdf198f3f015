#pragma once
// The blocks that a straight line passes, as they lie now.

#include <string>
#include <vector>

#include "talus/blocks/state.h"

namespace talus {

/// Piece of the line in one block, by distances from the line's beginning [m].
struct PathPiece {
  int block = -1;
  double from = 0, to = 0;
};

struct BoltPath {
  std::vector<PathPiece> pieces;  // in order, without overlaps
  std::string trouble;            // "" when there is none: the line runs along a joint, or meets no block
};

/// Pieces of the segment from-to in blocks that are there, those shorter than `least` [m] left out.
BoltPath path_through(const BlockSet& blocks, const State& state, Vec2 from, Vec2 to, double least);

}  // namespace talus
