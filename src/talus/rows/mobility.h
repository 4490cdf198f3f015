#pragma once
// How blocks answer to impulses: the inverse of the mass matrix of a step, elasticity included where that is
// implicit. All that solvers know of a block. Theory: docs/theory.md sections 1.4 and 4.9.

#include <vector>

#include "talus/rows/rows.h"

namespace talus {

/// With G = L G' R^T and Q = L Q' R^T (L, R rotations), the answer to a generalised impulse falls apart:
/// a = f / m, (G'xx, G'yy) = stretch (Q'xx, Q'yy), (G'xy, G'yx) = shear (Q'xy, Q'yx), both symmetric.
struct Mobility {
  double mass = 0;               // 1 / m [1/kg]; 0 for blocks whose motion is prescribed
  double stretch[3] = {};        // xx-xx, xx-yy, yy-yy [1/(kg m2)]
  double shear[3] = {};          // xy-xy, xy-yx, yx-yx [1/(kg m2)]
  Vec2 left{1, 0}, right{1, 0};  // (cos, sin) of the rotations L and R

  bool moves() const { return mass > 0; }
};

/// Whether impulses move block `block`; the ground (-1) they do not.
inline bool moves(const std::vector<Mobility>& mobility, int block) {
  return block >= 0 && mobility[block].moves();
}

/// Turned by the rotation of cosine and sine `r`, and back.
inline Vec2 turned(Vec2 r, Vec2 v) { return {r.x * v.x - r.y * v.y, r.y * v.x + r.x * v.y}; }
inline Vec2 turned_back(Vec2 r, Vec2 v) { return {r.x * v.x + r.y * v.y, r.x * v.y - r.y * v.x}; }
inline Mat2 rotation(Vec2 r) { return {r.x, -r.y, r.y, r.x}; }

/// @param share  factor on the inverse mass (mass-proportional damping)
Mobility mobility_of(const BlockSet& blocks, size_t i, double share);

/// The same with the block's own elasticity in the mass matrix: (M / share + time2 K)^-1, K the elastic
/// tangent in the frame turned with the block.
/// @param rotation  (cos, sin) of the rotation of F
/// @param time2     [s2]
Mobility mobility_implicit(const BlockSet& blocks, size_t i, Vec2 rotation, double share, double time2);

/// One per block, elasticity explicit.
std::vector<Mobility> mobilities(const BlockSet& blocks, double share);

/// Velocity change of the block per unit impulse: at acting arm `at`, by an impulse at acting arm `from`
/// [1/kg].
Mat2 influence(const Mobility& m, Vec2 at, Vec2 from);

/// Answer to a generalised impulse.
BlockRate accelerate(const Mobility& m, const BlockForce& impulse);

/// Lets the impulses of all rows act on the blocks.
/// @param rate  in: v*, rates without the rows; out: rates with them
void apply_impulses(const std::vector<Mobility>& mobility, const RowSet& rows, std::vector<BlockRate>& rate);

}  // namespace talus
