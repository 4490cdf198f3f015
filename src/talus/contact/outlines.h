#pragma once
// What of blocks touches: each block as convex parts, with sides that are its own, cuts between its parts that
// are none, and sides that bonds tie. Made once for a run, in the reference shape. Theory: docs/theory.md 3.2.

#include <span>
#include <vector>

#include "talus/contact/bonds.h"

namespace talus {

/// A side of a convex part, from its corner k to the next.
struct PartSide {
  int edge = -1;  // of the block that it lies on; -1: a cut between two parts, no side
  int face = -1;  // of the bond set, that ties it; -1: none
};

struct Outlines {
  std::vector<int> part_begin;    // [count + 1] of each block
  std::vector<int> corner_begin;  // [n_parts + 1] of each part
  std::vector<Vec2> corner;       // [n_corners] reference arms, counter-clockwise [m]
  std::vector<PartSide> side;     // [n_corners]
  std::vector<char> plain;        // [n_parts] whether no side of the part is a cut or tied
  std::vector<std::pair<int, int>>
      closed;  // pairs of blocks between which the ground has closed a joint, sorted

  int parts_of(int block) const { return part_begin[block + 1] - part_begin[block]; }
  int corners_of(int part) const { return corner_begin[part + 1] - corner_begin[part]; }
};

/// A convex part, or an outline on its way there.
struct ConvexPart {
  std::vector<Vec2> corner;    // counter-clockwise
  std::vector<PartSide> side;  // [corners]
};

/// Cuts a simple polygon into convex parts: at each notch along the inward bisector of its two sides, the
/// shortest of all such cuts first, so that the order of corners has no say.
/// @param outline  counter-clockwise
std::vector<ConvexPart> convex_parts(const ConvexPart& outline);

/// Outlines of all blocks. Sides that lie along a face of the ground's joints are moved outwards by half of
/// what its stress has closed there (theory 3.4): the reference shape is that of the closed joint.
/// @param laws  of the model's joints, as the run begins
Outlines build_outlines(const Model& model, const Layout& layout, const BlockSet& blocks,
                        const BondSet& bonds, const std::vector<JointLaw>& laws);

}  // namespace talus
