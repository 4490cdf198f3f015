#pragma once
// Which corners touch which edges: candidates from a box grid with a skin, then corner-edge pairs of simple
// polygons. Geometry only. Theory: docs/theory.md section 3, with sketches.

#include <vector>

#include "talus/blocks/state.h"

namespace talus {

/// One contact point: a corner of block a on, near or slightly inside an edge of block b.
struct ContactPoint {
  ContactKey key;
  Vec2 normal;        // outward normal of b's edge now: from b into a
  Vec2 arm_a, arm_b;  // reference arms of the corner and of its foot on the edge
  double gap = 0;     // [m] > 0 apart
  double slip = 0;    // [m] position of the foot along the tangent (the normal turned clockwise)
  double length = 0;  // [m] tributary length: half the face it ends, 0 for a corner alone
  int face_edge_a = -1, face_edge_b = -1;  // edges of a and b beside the middle of that face; -1: none
  ContactKey partner;                      // the other end of that face; block_a = -1 when there is none
};

/// Gap and foot of a corner over an edge; digits are kept however far both are from the origin.
struct CornerEdge {
  double gap = 0;     // [m]
  double along = 0;   // foot as share of the edge, 0 at its first corner
  double length = 0;  // of the edge now [m]
  Vec2 normal;        // outward
};

CornerEdge corner_over_edge(const BlockSet& blocks, const State& state, int block_a, int vertex, int block_b,
                            int edge);

/// Appends the contact points of two blocks that are closer than `margin` [m], in the order of their keys.
///  - a corner acts on an edge only above the edge itself (never its extension), and only where its own two
///  edges
///    do not lie behind the edge (entrance condition);
///  - a flat corner (turning by less than 1e-4) enters nothing: the edges beside it are one straight side;
///  - a corner near a convex corner of the other block obeys one edge: the one with the larger gap;
///  - two corners at one place make one contact: again the larger gap; gaps that are equal by what they come
///  to
///    within `look_ahead` [s] at the rates of the state (a block that slides over a flush joint must not be
///    caught by the side of the next block), then by the lower key.
void touch_blocks(const BlockSet& blocks, const State& state, int block_a, int block_b, double margin,
                  std::vector<ContactPoint>& out, double look_ahead = 0);

/// Keeps the list of close pairs between calls and renews it when some block has moved half the skin.
class CandidateFinder {
 public:
  /// Pairs (a < b) of blocks, at least one freely moving, that may be closer than `margin`.
  const std::vector<std::pair<int, int>>& pairs(const BlockSet& blocks, const State& state, double margin);
  int rebuilds() const { return rebuilds_; }

 private:
  bool still_valid(const BlockSet& blocks, const State& state, double margin) const;

  std::vector<std::pair<int, int>> pairs_;
  std::vector<Vec2> displacement_;  // at the last build
  std::vector<Mat2> strain_part_;
  std::vector<double> radius_;  // farthest corner of each block
  double skin_ = 0, margin_ = -1;
  int rebuilds_ = 0;
};

}  // namespace talus
