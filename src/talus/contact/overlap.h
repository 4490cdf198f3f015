#pragma once
// Two convex parts as they lie: what they have in common, the energy of that and its gradient, or how far they
// are apart. Geometry only: no stiffness, no memory. Theory: docs/theory.md 3.2, 3.3.

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "talus/base/vec2.h"
#include "talus/contact/moments.h"

namespace talus {

/// Neighbouring sides of a part that turn by less than this are one [rad]: of what turns by more, the next side is
/// reached by a turn that shows.
inline constexpr double kOneSide = 1e-4;

/// What a side of a part is to the other one.
enum class SideRole : char {
  kOut,      // a way out
  kCut,      // between two parts of a block: no side
  kTied,     // to a third block: no way out
  kTiedHere  // tied to the other part's block: what is nearest to it is left to the tie
};

/// The place after k, and the one before it, of n that go round.
inline size_t after(size_t k, size_t n) { return k + 1 == n ? 0 : k + 1; }
inline size_t ahead_of(size_t k, size_t n) { return k == 0 ? n - 1 : k - 1; }

/// A convex part as it lies now, in any frame.
struct PartNow {
  std::span<const Vec2> corner;    // counter-clockwise [m]
  std::span<const Vec2> along;     // unit vector of the side from each corner to the next
  std::span<const SideRole> role;  // empty: all sides are ways out
  SideRole role_of(size_t side) const { return role.empty() ? SideRole::kOut : role[side]; }
  size_t size() const { return corner.size(); }
};

/// How a part is going to move in a step: a place x by way + turn x, seen from the origin of the part.
struct PartMotion {
  Vec2 way;   // [m]
  Mat2 turn;  // [-]
};

/// Of two parts that met before: PartsMet::way then, and how far apart or in each other two parts that are level may
/// be [m]: by more another way out of an overlap must be better to be taken.
struct WayBefore {
  int way = 0;
  double by = 0;
  Vec2 force = {};  // on a, of any measure
};

/// Where to look for two parts, which makes no difference to what is found: the way of the step before first, and
/// whether it was that of a strip that was measured; by how much a way must be behind another one to be behind it at the
/// end of the step too, and by more than WayBefore::by [m]; the ways that all others are known to be that far behind, as
/// PartsMeeting::near_ways() tells them; 0: not known.
struct LookFirst {
  int way = 0;
  bool strip = false;
  double behind = std::numeric_limits<double>::infinity();
  std::array<int, 2> near{};
};

/// The part of an overlap that is nearest to one side of a block.
struct SideCell {
  int side = -1;     // of the part
  double area = 0;   // [m2]
  Vec2 first;        // integral of the place [m3]
  double depth = 0;  // integral of the distance to the line of the side [m3]
};

/// How two parts lie to each other. Places are seen from the origin of the first.
struct PartsMet {
  enum Kind : char { kFar, kApart, kOverlap } kind = kFar;
  double area = 0;      // of the overlap that bears [m2]
  double force = 0;     // resultant over stiffness and thickness [m2] (eq. 3.3)
  double energy = 0;    // over the same [m3] (eq. 3.2)
  Vec2 normal;          // direction of the force on a, apart: of the widest gap; unit, from b to a
  Vec2 begin, end;      // of the chord, along the tangent: the normal turned clockwise; of face ends on a [m]
  double across[2]{};   // how far b's surface lies from there, against the normal: of face ends [m]
  double closure[2]{};  // at begin and end, linear between, of this force and moment [m]; < 0: a gap
  // the side whose normal that is: of b 1, 2 and so on, of a -1, -2; of a strip that was measured its face on b, of another
  // measured overlap 0
  int way = 0;
  bool at_corner = false;   // two corners in each other: along another way, as good, nothing of the two faces
  bool beside_tie = false;  // a piece of an overlap that ties leave
  bool tied = false;        // the nearest way out of an overlap is one that a tie closes
  bool beyond = false;      // the force acts beyond an end of the chord, and is put there
  int side_a = -1, side_b = -1;            // the sides that have most of it
  std::vector<SideCell> cells_a, cells_b;  // of an overlap
  /// Along the tangent: the surface of either part may be slanted to it.
  double length() const { return dot(turn_right(normal), end - begin); }
};

/// A side of either part at a place where a corner of one touches a corner of the other.
struct CornerSide {
  bool of_b = false;
  size_t side = 0;
  std::array<Vec2, 2> behind;  // places behind it, at the corner and farther on, seen from the origin of a
  bool filled = false;         // told from outside: third blocks are at both
};

/// Sees how two convex parts lie to each other; keeps its memory from pair to pair.
class PartsMeeting {
 public:
  /// Tells whether two parts are far from each other, apart or in overlap; the other functions say the rest.
  /// @param b         seen from its own origin
  /// @param shift     of b's origin, seen from a's [m]
  /// @param margin    gaps up to this are told [m]
  /// @param rounding  overlaps up to this have no shape: the parts are apart, by less than nothing [m]
  /// @param first     makes no difference to what is found. choose_way() wants no strip.
  const PartsMet& look(const PartNow& a, const PartNow& b, Vec2 shift, double margin, double rounding,
                       const LookFirst& first = {});

  /// The ways that were not behind by LookFirst::behind, if they are one or two: numbers as PartsMet::way, 0: none.
  /// @pre  look() found the two apart or in overlap
  std::array<int, 2> near_ways() const { return near_; }

  /// By how much all other ways are behind the first of those at least [m]; 0: there are more, or sides are tied or cuts.
  /// @pre  look() without LookFirst::near found them apart or in overlap
  double lead() const { return lead_; }

  /// Normal and sides by the way along which the two are furthest apart, or least in each other, at the end of the
  /// step. What is apart and not along that way is kFar from now on.
  /// @param motion_a  in the step to come: parts that are apart meet along the way that is left last
  /// @param before    the way of the step before, and by how much another one must be better to be taken [m]
  /// @pre  look() found them apart or in overlap
  void choose_way(const PartMotion& motion_a, const PartMotion& motion_b, const WayBefore& before = {});

  /// The sides at the corner where the two meet by the way that was chosen, if a corner of one is on a corner of the other
  /// and no two of them lie on each other or in one line.
  /// @param level  so far off each other corners may be [m]
  /// @pre  choose_way()
  std::span<CornerSide> sides_at_corner(double level);

  /// Leaves out ways that third blocks fill. True: other ways are left, of which choose_way() has to choose. Where none
  /// is left the two are kFar.
  /// @pre  sides_at_corner(), and for each is told whether it is filled
  bool leave_out_filled();

  /// Energy, force, chord and closures of an overlap (eqs. 3.2 to 3.4), and its normal and sides by these: of all of it,
  /// or of the first connected piece where ties leave several. False: it has no way out but those that ties close, or
  /// pushes both ways alike.
  /// @pre  look() found one
  bool measure_overlap();

  /// The same of the next piece that ties leave. False: there is none.
  /// @pre  measure_overlap()
  bool measure_next_piece();

  /// Chord and closures by the gaps along the normal: from where it is smallest to the end of the flatter side
  /// there, or to where it is larger by `reach`. Of a face its two ends, of a corner alone the corner and a
  /// place that bears nothing. False: nothing faces each other.
  /// @pre  choose_way()
  bool face_ends(double reach);

  const PartsMet& met() const { return met_; }

 private:
  using Polygon = std::vector<Vec2>;
  static constexpr double kAll = std::numeric_limits<double>::infinity();
  // How much of the other part a side has before it.
  struct Way {
    bool of_b;
    size_t side;
    double gap;          // of its nearest corner, < 0: behind it
    double then = 0;     // the same at the end of the step
    size_t nearest = 0;  // that corner

    int number() const { return of_b ? static_cast<int>(side) + 1 : -static_cast<int>(side) - 1; }
  };

  // What a side sees of a place of the other part.
  struct Sight {
    Vec2 out;          // along which distances are
    double at_origin;  // of the other part's origin, now [m]
    Vec2 per_place;    // by which a place comes, on top of
    double comes;      // what the origin does in the step [m]
    double then(double now, Vec2 place) const { return now + comes + dot(per_place, place); }
  };

  struct Gap {
    double s, g, a;  // along the tangent, how wide, where a's face is along the normal [m]
  };
  struct Seen {
    double s, n;  // along the tangent and the normal [m]
  };

  void find_near_ways(std::array<int, 2> near, double margin);
  void find_ways(double margin);
  Way side_before(bool of_b, size_t k) const;
  struct Face;
  Face face(bool of_b, size_t side) const;
  Way face_before(bool of_b, const Face& own, Face& other) const;
  void look_ahead_from_face(Way& w) const;
  Sight sight(bool of_b, size_t side) const;
  void clip();
  bool take_nearest(bool of_b, std::vector<int>& sides, size_t& main) const;
  double depth_of(bool of_b, size_t side, Vec2 x) const {
    return cross(part(of_b).along[side], x - corner(of_b, side));
  }
  void keep_nearest(bool of_b, const std::vector<int>& sides, size_t which, const Polygon& from,
                    Polygon& out) const;
  SideCell cell(bool of_b, int side, double area, Vec2 first) const;
  void cells_by_rest(bool of_b, size_t main, std::vector<SideCell>& out);
  bool left_to_bonds(bool of_b) const;
  bool any_tied() const;
  bool goes_on_free(const Way& w) const;
  void nested_cells();
  bool measure_cells();
  size_t facing(bool of_b, size_t side) const;
  bool measure_strip(bool of_b, size_t side);
  bool take_end(bool high);
  bool strip_is_all(bool of_b) const;
  double take_triangle(bool of_b, bool high, Moments& triangle) const;
  bool strip_cells(bool of_b, const Moments& all, std::vector<SideCell>& out) const;
  void put_with_neighbours(size_t cell);
  bool share_a_place(size_t cell, size_t other) const;
  bool sum_up();
  const Way* best_way(const WayBefore& before);
  const Way* best_face(const WayBefore& before);
  bool is_better(const Way& w, const Way& than) const;
  void take_way(const Way& best, double by);
  Vec2 then_at(bool of_b, Vec2 place) const;
  void look_ahead(Way& w) const;
  double side_length(bool of_b, size_t side) const;
  bool in_line(const Way& one, const Way& two) const;
  bool stands_at(const Way& w) const;
  bool pushed_off(const Way& w, Vec2 force) const;
  bool faces_along(Vec2 tangent, double by) const;
  void add_corner_sides(bool of_b, size_t at, double level);
  Vec2 along(const CornerSide& c) const { return part(c.of_b).along[c.side]; }
  size_t facing_side(const Way& way, Vec2 direction) const;
  void see_face(bool of_b);
  bool see_gaps();
  bool ends_of_sides(Gap& low, Gap& high) const;
  bool ends_along_faces(Gap& low, Gap& high);
  // which of the two it is goes into addresses: no branch on it could be foretold
  const PartNow& part(bool of_b) const { return part_[of_b]; }
  SideRole role_of(const Way& w) const { return part(w.of_b).role_of(w.side); }
  Vec2 corner(bool of_b, size_t k) const { return part_[of_b].corner[k] + origin_[of_b]; }
  /// Of the other part's origin, seen from that of one.
  Vec2 shift_from(bool of_b) const { return origin_[!of_b] - origin_[of_b]; }

  PartNow part_[2];         // a and b
  Vec2 origin_[2];          // of their places, seen from that of a
  std::vector<Way> sides_;  // of b, of a; then what of them are ways
  // Where the two meet along two faces: each with its ends, from the origin of the part, first the one that comes first in
  // the part, and how far before the other face these are.
  struct Face {
    size_t side, corner[2];
    Vec2 along, place[2];
    double before[2];
  };
  Face faces_[2];  // of a and b
  bool along_faces_ = false;
  std::array<int, 2> near_{};
  double lead_ = 0;
  std::span<Way> ways_;       // those that are not too far behind
  Polygon region_, bearing_;  // the overlap; the corners of what of it bears
  mutable Polygon work_;
  Polygon cell_, cell_of_cell_;
  std::vector<int> near_a_, near_b_;  // sides that are the nearest somewhere in the overlap
  // Beside ties: what is nearest to one side of either part, and the piece that it is of.
  struct NestedCell {
    SideCell a, b;
    size_t begin, end;  // its corners in corners_
    size_t piece;
  };
  std::vector<NestedCell> nested_;
  Polygon corners_;
  size_t next_piece_ = 0;
  mutable std::vector<double> low_, high_, middle_;
  std::vector<Gap> gaps_;
  std::vector<Seen> seen_, face_[2];  // all corners of a part; those of a and b that face the other
  PartMotion comes_;                  // of a in the step to come, seen from b; places from the origin of a
  std::vector<CornerSide> corner_sides_;
  // Where a strip ends along the side of b, below or above: the next sides of a and b there, the corners between those
  // and the faces, which part it is that ends, and where its end meets the two faces.
  struct StripEnd {
    bool of_b = false;
    size_t side[2]{};
    Vec2 corner[2], on[2];  // of a and b
  };
  struct {
    size_t side[2]{};  // of a and b: the faces
    StripEnd end[2];
  } strip_;
  bool is_strip_ = false;
  double rounding_ = 0, behind_ = 0;
  PartsMet met_;
};

}  // namespace talus
