#pragma once
// Which corners of two simple polygons touch which edges. Geometry only. Theory: docs/theory.md 13.6,
// with sketches.

#include <limits>
#include <span>
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
  int partner = -1;  // the other end of that face: its place in the list; each is the other's; -1: none
  FaceEnd face;      // which end of which interface, where it has a partner
};

/// Gap and foot of a corner over an edge; digits are kept however far both are from the origin.
struct CornerEdge {
  double gap = 0;     // [m]
  double along = 0;   // foot as share of the edge, 0 at its first corner
  double length = 0;  // of the edge now [m]
  Vec2 normal;        // outward
};

inline CornerEdge corner_over_edge(const BlockSet& blocks, const State& state, BlockCorner corner,
                                   BlockEdge on) {  // theory 13.6
  const int ia = corner.block, ib = on.block;
  const Vec2 Xa = blocks.corner(corner), Xb = blocks.corner({on.block, on.edge}),
             E = blocks.corner(blocks.end_of(on)) - Xb;
  // the difference of reference places first, then the difference of displacements: both small
  const Vec2 reference = (blocks.centroid[ia] - blocks.centroid[ib]) + (Xa - Xb);
  const Vec2 r = reference + (displacement_at(state, ia, Xa) - displacement_at(state, ib, Xb));
  const Vec2 e = E + state.strain_part[ib] * E;
  const double length = norm(e);
  const Vec2 n = turn_right(e) / length;
  return {dot(n, r), dot(r, e) / (length * length), length, n};
}

/// How far, how deep and in whose company the points of a pair are sought.
struct SearchRange {
  double margin = 0;      // gaps up to this are seen [m]
  double depth = 0;       // overlaps up to this are seen [m]
  double look_ahead = 0;  // [s] what comes together within this time is seen before it does
  const std::vector<BlockRate>* before = nullptr;  // actual rates, none: those of the state
  const Neighbours* neighbours = nullptr;          // none: the two are alone
  std::span<const Contact> known;                  // contact points of the pair before
};

/// What a search found, and what could change it.
struct Found {
  std::vector<ContactPoint> points;  // in the order of their keys
  double clearance = 0;         // the least distance, along an edge or between gaps, to another outcome [m]
  bool this_step_only = false;  // velocities or neighbours had a say: the outcome holds for this step only
  bool plain = false;           // no corner of the two lies on a straight side
  std::vector<Cover> cover;     // sides covered here: were a block to leave one, there were more points
};

/// Whether the place beside the side of one of the two still lies in the third block (theory 13.6 ii).
bool covers(const BlockSet& blocks, const State& state, int a, int b, const Cover& cover);

/// Looks for contact points; keeps its memory from pair to pair.
class ContactSearch {
 public:
  /// The contact points of two blocks (theory 13.6).
  ///  - A corner acts on an edge only above the edge itself (never its extension), and only where its own two
  ///    edges do not lie behind the edge (entrance condition).
  ///  - A flat corner (turning by less than 1e-4) enters nothing: the edges beside it are one straight side.
  ///  - A side that a third block covers is no way out: neither a corner alone nor a stretch of two sides
  ///    that is not much longer than the overlap bears there.
  ///  - What was in touch before stays on its side until it opens or passes the end.
  ///  - Else a corner near a convex corner of the other block obeys one edge: the one with the larger gap;
  ///    equal gaps by what they come to within `look_ahead`, then by the lower key.
  ///  - Two corners at one place make one contact, by the same rule.
  const Found& touch(const BlockSet& blocks, const State& state, int block_a, int block_b,
                     const SearchRange& range);

 private:
  // A block as it lies now, seen from its reference centroid.
  struct Outline {
    int block = 0, count = 0;
    std::vector<Vec2> corner, edge;  // edge k from corner k to corner k + 1
    std::vector<double> length;
    std::vector<char> flat, convex;  // convex: or flat

    void take(const BlockSet& blocks, const State& state, int i);
    int before(int k) const { return k == 0 ? count - 1 : k - 1; }
    int after(int k) const { return k + 1 == count ? 0 : k + 1; }
    double leans(int v, int side, double depth) const;
    int side_of(int edge) const;
    int last_of(int edge) const;
    int edge_beside(int first, Vec2 place) const;
    bool may_enter(int corner, Vec2 normal, double dip) const;
    bool runs_against(int edge, const Outline& other, int edge_of_other, double sine) const;
    bool holds(Vec2 place, double tolerance) const;
    bool on_convex_chain(int edge_1, int edge_2) const;
  };
  struct Hit {
    ContactPoint point;
    int at_corner = -1;    // corner of b at the foot, -1 inside the edge
    double expected = 0;   // gap after the look-ahead, at the predicted rates
    double as_before = 0;  // the same at the actual ones
    double blunt = 0;      // cosine of the angle by which the corner turns
    bool lone = false;     // none of its sides is antiparallel to the edge
    bool apart = false;    // by the side of b, over which a slides flush
    bool coming = false;   // beside the edge still; over it after the look-ahead
    bool held = false;     // in touch on this side before
    bool covered = false;  // by a third block, now
  };
  // The length over which two antiparallel sides lie beside each other, along an edge of the second block.
  struct Stretch {
    double length = 0, middle = 0;  // [m] the middle from the first corner of that edge
    int edge_a = -1;                // of the first block; -1: none is antiparallel
  };
  struct Span {
    int side_lo, side_hi;  // straight sides of the lower and the higher block id
    bool operator==(const Span&) const = default;
  };

  bool is_flush(const BlockSet& blocks, const State& state, const Outline& a, int corner, const Outline& b,
                int edge, int end) const;
  bool is_elsewhere(const Outline& a, int corner, Vec2 place, const Outline& b, const Hit& hit, size_t first);
  bool is_better(const Hit& x, const Hit& y);
  void corners_over_edges(const BlockSet& blocks, const State& state, const Outline& a, const Outline& b,
                          Vec2 shift);
  bool was_in_touch(const Outline& a, int corner, const Outline& b, int edge) const;
  Stretch stretch_of(const Outline& a, int corner, const Outline& b, int edge, Vec2 shift) const;
  bool is_covered(const BlockSet& blocks, const State& state, const Outline& a, const Outline& b, Vec2 shift,
                  const Hit& hit, double reach);
  bool lies_in_third(const BlockSet& blocks, const State& state, int block, int other, Vec2 place, Vec2 back,
                     Vec2 direction);
  void merge_corner_pairs(const Outline& a, const Outline& b, Vec2 shift);
  void share_faces(const Outline& a, const Outline& b, Vec2 shift);
  void spans_of(const Outline& a, const Outline& b, const Hit& h, std::vector<Span>& list) const;

  SearchRange range_;
  double same_ = 0;
  double most_reach_ = 0;  // most overlap across which neighbours are looked for [m]
  double dip_ = 0;         // how far a corner's own edges may dip below the plane it rests on (sine)
  Outline first_, second_;
  std::vector<Hit> hits_;
  std::vector<std::vector<Span>> spans_;
  std::vector<Vec2> outline_;  // of a third block
  std::vector<char> out_;      // hits of a corner that hold nothing
  Found found_;
};

/// The same for one pair that is alone, appended to `out`.
void touch_blocks(const BlockSet& blocks, const State& state, int block_a, int block_b, double margin,
                  std::vector<ContactPoint>& out, double look_ahead = 0);

/// Two corners closer than this share of the smaller block are one place.
inline constexpr double kSamePlace = 1e-5;

}  // namespace talus
