#pragma once
// From the model's blocks, grids, meshes and cut regions to the list of block polygons: simple, apart from
// each other.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "talus/cut/partition.h"
#include "talus/model/model.h"

namespace talus {

/// A corner of a block, and an edge, from its corner `edge` to the next; -1: none.
struct BlockCorner {
  int block = -1, corner = -1;
};
struct BlockEdge {
  int block = -1, edge = -1;
};

struct BlockShape {
  // made and taken apart in one file: here every file of the program would hold that code
  BlockShape();
  BlockShape(const BlockShape&);
  BlockShape(BlockShape&&) noexcept;
  BlockShape& operator=(const BlockShape&);
  BlockShape& operator=(BlockShape&&) noexcept;
  ~BlockShape();

  std::string name;
  int id = 0;       // number that stays when other blocks are merged or taken out
  int group = 0;    // index of the block, grid, mesh surface, region or opening it belongs to
  Polygon polygon;  // counter-clockwise
  int material = 0;
  BlockKind kind = BlockKind::kDeformable;
  Vec2 velocity;
  double spin = 0;
  Motion motion_x, motion_y, motion_rotation;
  std::vector<int> edge_origin;  // [edges] of cut blocks and meshes: index into Layout::origins; else empty
  std::vector<int> edge_joint;   // [edges] of the same: joint along each edge, -1 hard and frictionless
};

struct Layout {
  // made and taken apart in one file: here every file of the program would hold that code
  Layout();
  Layout(const Layout&);
  Layout(Layout&&) noexcept;
  Layout& operator=(const Layout&);
  Layout& operator=(Layout&&) noexcept;
  ~Layout();

  std::vector<BlockShape> blocks;
  std::vector<std::string> groups;   // blocks, grids, meshes and their surfaces, regions, kept openings
  std::vector<Where> group_where;    // [groups]
  std::map<int, int> mesh_of;        // group of a physical surface -> that of its mesh
  int first_mesh_group = 0;          // groups from here to the next are those of meshes
  int first_cut_group = 0;           // groups from here on were cut together
  std::vector<std::string> origins;  // what edges of cut blocks and meshes come from
  double touching = 0;               // [m] edges of cut blocks lie this near to each other where they touch
  std::map<std::pair<int, int>, int> pair_joint;  // (smaller group, larger group) -> joint
  int default_joint = -1;
  int needles_merged = 0, slivers_merged = 0, slivers_deleted = 0, slivers_kept = 0;  // of the cut
  bool sound = true;        // false: a polygon is none, and nothing that needs them all can be said
  std::vector<char> glued;  // [joints] bonded: no law for blocks that meet at a corner; empty: none

  /// Whether a block was cut out of a region, together with others.
  bool was_cut(const BlockShape& block) const { return block.group >= first_cut_group; }
  /// Joint where two edges meet (edge -1: a corner of the block); -1: hard and frictionless. A joint
  /// given for the pair goes first; then that of the edge, where two differ that of the lower block; then
  /// the default.
  int joint_at(BlockEdge a, BlockEdge b) const;

  /// The same of blocks that have no joint as a pair of groups.
  int joint_by_edges(BlockEdge a, BlockEdge b) const;
  /// Joint of a corner that touches an edge of another block but ends no face: that of the edge; where
  /// the edge is glued, to a third block, that of the joint that ends at the corner, or the default.
  int joint_at_corner(BlockCorner a, BlockEdge b) const;
  /// Joint given for two groups, or kNoPair.
  static constexpr int kNoPair = -2;
  int joint_of_pair(int group_a, int group_b) const;
  /// Index of the group called `name`, -1 when there is none.
  int find_group(const std::string& name) const;
  /// The group called `name`, and those of its surfaces when it is a mesh; empty when there is none.
  std::vector<int> groups_called(const std::string& name) const;
  /// Indices of the blocks of the group, or of the single block, called `name`.
  std::vector<int> blocks_called(const std::string& name) const;
};

/// Told when no block is called `name`.
void unknown_block(const Layout& layout, const std::string& name, const Where& where, const std::string& path,
                   Findings& findings);

/// Cuts the regions of the model, or reads the blocks file that `cut.blocks` names. Everything wrong goes to
/// `findings`, and then the cut is empty.
Cut cut_or_read(const Model& model, Findings& findings);

/// Polygons of blocks of a cut, flat corners (to a cell of the grid) left out: they are no corners. Groups
/// count from the first region.
std::vector<BlockShape> shapes_of(const Model& model, const Cut& cut, const std::vector<CutBlock>& blocks);

/// Blocks, expanded grids and cut blocks as polygons, counter-clockwise, all checked (places that sections
/// name are not: check_places.h). Everything wrong goes to `findings`.
/// @pre  read_model found no error
Layout make_layout(const Model& model, const Cut& cut, Findings& findings);

/// The same, cutting first.
Layout make_layout(const Model& model, Findings& findings);

/// Lengths below this are round-off of coordinates [m]. @pre  the layout has a block
double point_tolerance(const Layout& layout);

/// Blocks whose polygon holds `point` (boundary included, within `tolerance` [m]).
std::vector<int> blocks_at(const Layout& layout, Vec2 point, double tolerance);

/// The block that a point monitor follows: the first that holds `point`; -1 when none does.
int block_of_point(const Layout& layout, Vec2 point);

}  // namespace talus
