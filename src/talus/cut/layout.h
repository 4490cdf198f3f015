#pragma once
// From the model's blocks and grids to the list of block polygons, and the checks that need them all:
// simple, apart from each other, monitors and supports on a block.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "talus/model/model.h"

namespace talus {

struct BlockShape {
  std::string name;
  int group = 0;    // index of the block or grid it comes from
  Polygon polygon;  // counter-clockwise
  int material = 0;
  BlockKind kind = BlockKind::kDeformable;
  Vec2 velocity;
  double spin = 0;
  Motion motion_x, motion_y, motion_rotation;
};

struct Layout {
  std::vector<BlockShape> blocks;
  std::vector<std::string> groups;                // names of blocks and grids
  std::map<std::pair<int, int>, int> pair_joint;  // (smaller group, larger group) -> joint
  int default_joint = -1;

  /// Joint between two blocks of these groups; -1: hard and frictionless.
  int joint_between(int group_a, int group_b) const;
  /// Index of the group called `name`, -1 when there is none.
  int find_group(const std::string& name) const;
  /// Indices of the blocks of the group, or of the single block, called `name`.
  std::vector<int> blocks_called(const std::string& name) const;
};

/// Expands grids, turns polygons counter-clockwise, and checks. Everything wrong goes to `findings`.
/// @pre  read_model found no error
Layout make_layout(const Model& model, Findings& findings);

/// Blocks whose polygon holds `point` (boundary included, within `tolerance` [m]).
std::vector<int> blocks_at(const Layout& layout, Vec2 point, double tolerance);

/// The block that a point monitor follows: the first that holds `point`; -1 when none does.
int block_of_point(const Layout& layout, Vec2 point);

/// Corner `vertex` of block `block`, held by a support.
struct SupportedCorner {
  int block = 0;
  int vertex = -1;  // -1: `point` inside the block
  Vec2 point;       // [m]
};

/// The material points that `support` holds; empty when it touches no block.
std::vector<SupportedCorner> corners_of_support(const Layout& layout, const SupportInput& support);

}  // namespace talus
