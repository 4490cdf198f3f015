#pragma once
// The blocks of a stage: everything about them that a step does not change, in flat arrays.
// A block is an affine body in reference form, x = c + F X. Theory: docs/theory.md section 1.

#include <algorithm>
#include <string>
#include <vector>

#include "talus/base/error.h"
#include "talus/base/vec2.h"
#include "talus/cut/layout.h"

namespace talus {

/// Plane elastic moduli [Pa] of a deformable block: normal stress = c11 e_xx + c12 e_yy, shear = c33 g_xy.
struct PlaneModuli {
  double c11 = 0, c12 = 0, c33 = 0;
};

PlaneModuli plane_moduli(double young, double poisson, Plane plane);

struct BlockSet {
  // made and taken apart in one file: here every file of the program would hold that code
  BlockSet();
  BlockSet(const BlockSet&);
  BlockSet(BlockSet&&) noexcept;
  BlockSet& operator=(const BlockSet&);
  BlockSet& operator=(BlockSet&&) noexcept;
  ~BlockSet();

  int count = 0;
  double thickness = 1;  // [m]

  std::vector<std::string> name;  // [count]
  std::vector<int> group;         // [count]
  std::vector<BlockKind> kind;    // [count]
  std::vector<int> material;      // [count]
  std::vector<Vec2> centroid;     // [count] reference centroid c0 [m]
  std::vector<double> volume;     // [count] area x thickness [m3]
  std::vector<double> mass;       // [count] [kg]
  std::vector<Mat2> inertia;  // [count] S0 = density x integral X X^T dV [kg m2], as used (lumped, clamped)
  std::vector<Mat2> inertia_inverse;  // [count] deformable: S0^-1; otherwise unused
  std::vector<Vec2> axis;             // [count] (cos, sin) of the principal axes of S0
  std::vector<Vec2> principal;        // [count] principal moments of S0 along them [kg m2]
  std::vector<double> polar_inertia;  // [count] trace of S0: moment of inertia of a rigid block [kg m2]
  std::vector<PlaneModuli> moduli;    // [count]
  std::vector<double> size;           // [count] square root of the area [m]
  std::vector<double> thinness;  // [count] mean thickness across the longest extent: area / (2 radius) [m]
  std::vector<double> radius;    // [count] distance of the farthest corner from the centroid [m]
  std::vector<int> tile;         // [count] blocks that lie together (tiles_of); empty: too few to be parted

  std::vector<int> vertex_begin;  // [count + 1]
  std::vector<Vec2> arm;          // [n_vertices] reference arms X from the centroid, counter-clockwise [m]

  int clamped = 0;           // blocks whose inertia was raised (moment clamp)
  double largest_clamp = 1;  // largest factor by which an eigenvalue of S0 was raised

  bool moves_freely(size_t i) const {
    return kind[i] == BlockKind::kDeformable || kind[i] == BlockKind::kRigid;
  }
  bool removed(int i) const { return kind[i] == BlockKind::kRemoved; }
  /// Whether forces between two blocks can move one of them.
  bool interact(int i, int j) const {
    return (moves_freely(i) || moves_freely(j)) && !removed(i) && !removed(j);
  }
  int vertex_count(int i) const { return vertex_begin[i + 1] - vertex_begin[i]; }
  /// The corner at which an edge ends.
  BlockCorner end_of(BlockEdge e) const {
    return {e.block, e.edge + 1 == vertex_count(e.block) ? 0 : e.edge + 1};
  }
  /// Reference arm of a corner.
  Vec2 corner(BlockCorner c) const {
    TALUS_ASSERT(c.corner >= 0 && c.corner < vertex_count(c.block));
    return arm[vertex_begin[c.block] + c.corner];
  }
  /// From the start of an edge to its end, of the reference shape.
  Vec2 side(BlockEdge e) const { return corner(end_of(e)) - corner({e.block, e.edge}); }
  /// Size of the smaller of two blocks [m].
  double smaller_size(int i, int j) const { return std::min(size[i], size[j]); }
};

/// Blocks of a layout, with exact mass properties.
BlockSet build_blocks(const Model& model, const Layout& layout);

/// Size of the smallest block [m]; 0 without blocks.
double smallest_size(const BlockSet& blocks);

/// What the solver's tolerance is a share of [m]: the size of the smallest block, and at least a tenth of
/// that of the median block, lest slivers set it; 0 without blocks.
double tolerance_size(const BlockSet& blocks);

/// Largest stable step [s] of central differences for block i on its own (theory 2.4); infinite for blocks
/// that do not deform. Ties and contacts between blocks never lower it.
double stable_step_of(const BlockSet& blocks, int i);

struct StableStep {
  double dt = 0;   // [s] smallest over all blocks; infinite when no block deforms
  int block = -1;  // the block that sets it
};

StableStep stable_step(const BlockSet& blocks);

/// Raises the smaller eigenvalue of S0 of every block whose stable step lies below `dt` until it allows `dt`.
/// Mass is untouched; the inertia of the thin direction (and of rotation) grows. Counts in `clamped`.
void clamp_moments(BlockSet& blocks, double dt);

}  // namespace talus
