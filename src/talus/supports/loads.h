#pragma once
// What pushes blocks over time: body forces as accelerations beside gravity, pressures and tractions on
// edges, forces at points.

#include <vector>

#include "talus/blocks/state.h"

namespace talus {

/// Where a pressure, traction or force acts: the middle of an edge, or a point.
struct LoadedPoint {
  int load = -1;  // of the model
  int block = -1;
  Vec2 arm;            // reference arm [m]
  Vec2 normal;         // of the edge, outward, in the reference shape
  double area = 0;     // of the edge [m2]; of a point: its share of the force [-]
  bool active = true;  // in this stage
};

struct LoadSet {
  std::vector<std::vector<int>> blocks;  // of each load of the model that is a body force
  std::vector<LoadedPoint> points;       // of all others, in the order of the model
  std::vector<char> active;              // [loads] whether a body force acts in this stage; empty: all
};

/// @pre  the places of the loads have been checked
LoadSet build_loads(const Model& model, const Layout& layout, const BlockSet& blocks);

/// Acceleration by all body forces on each block at `time` on the clock of the histories [count] [m/s2].
std::vector<Vec2> load_acceleration(const Model& model, const LoadSet& loads, int block_count, double time);

/// Adds the forces of pressures, tractions and point loads. A pressure turns with the block, on its reference
/// area; tractions and forces keep their direction.
void add_edge_and_point_loads(const BlockSet& blocks, const Model& model, const LoadSet& loads,
                              const State& state, double time, std::vector<BlockForce>& force);

}  // namespace talus
