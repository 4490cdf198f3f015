#pragma once
// Which corners of two simple polygons touch which edges. Geometry only. Theory: docs/theory.md section 3,
// with sketches.

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

/// Looks for contact points; keeps its memory from pair to pair.
class ContactSearch {
 public:
  /// The contact points of two blocks that are closer than `margin` [m], in the order of their keys.
  ///  - a corner acts on an edge only above the edge itself (never its extension), and only where its own two
  ///    edges do not lie behind the edge (entrance condition);
  ///  - a flat corner (turning by less than 1e-4) enters nothing: the edges beside it are one straight side;
  ///  - a corner near a convex corner of the other block obeys one edge: the one with the larger gap;
  ///  - two corners at one place make one contact: again the larger gap; gaps that are equal by what they
  ///  come
  ///    to within `look_ahead` [s] at the rates of the state (a block that slides over a flush joint must not
  ///    be caught by the side of the next block), then by the lower key.
  /// @param clearance  the least distance, along an edge or between gaps, to another outcome [m]; -1 when
  ///                   velocities had a say: it holds for this step only
  const std::vector<ContactPoint>& touch(const BlockSet& blocks, const State& state, int block_a, int block_b,
                                         double margin, double look_ahead, double& clearance);

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
    int side_of(int edge) const;
    int edge_beside(int first, Vec2 place) const;
    bool may_enter(int corner, Vec2 normal) const;
    bool on_convex_chain(int edge_1, int edge_2) const;
  };
  struct Hit {
    ContactPoint point;
    int at_corner = -1;   // corner of b at the foot, -1 inside the edge
    double expected = 0;  // gap after the look-ahead
    bool apart = false;   // by the side of b, over which a slides flush
    bool coming = false;  // beside the edge still; over it after the look-ahead
  };
  struct Span {
    int side_lo, side_hi;  // straight sides of the lower and the higher block id
    bool operator==(const Span&) const = default;
  };

  bool is_flush(const BlockSet& blocks, const State& state, const Outline& a, int corner, const Outline& b,
                int edge, int end) const;
  bool is_elsewhere(const Outline& a, int corner, Vec2 place, const Outline& b, const Hit& hit);
  bool is_better(const Hit& x, const Hit& y);
  void corners_over_edges(const BlockSet& blocks, const State& state, const Outline& a, const Outline& b,
                          Vec2 shift);
  void merge_corner_pairs(const Outline& a, const Outline& b);
  void share_faces(const Outline& a, const Outline& b, Vec2 shift);
  void spans_of(const Outline& a, const Outline& b, const Hit& h, std::vector<Span>& list) const;

  double margin_ = 0, look_ahead_ = 0, same_ = 0, clearance_ = 0;
  bool by_velocity_ = false;
  Outline first_, second_;
  std::vector<Hit> hits_;
  std::vector<std::vector<Span>> spans_;
  std::vector<ContactPoint> found_;
};

/// The same for one pair, appended to `out`.
void touch_blocks(const BlockSet& blocks, const State& state, int block_a, int block_b, double margin,
                  std::vector<ContactPoint>& out, double look_ahead = 0);

/// Two corners closer than this share of the smaller block are one place.
inline constexpr double kSamePlace = 1e-5;

}  // namespace talus
