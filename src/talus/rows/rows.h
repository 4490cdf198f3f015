#pragma once
// The plain rows that tie points of blocks together: all a solver sees. A row knows bounds, compliance and
// bias; it knows no joint, support or bolt. Theory: docs/theory.md section 4.

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "talus/blocks/state.h"

namespace talus {

/// Residual of a row: e = u + bias + compliance p (+ cross p of the partner), with u the relative velocity
/// along it at the end of the kick. Inside the bounds of p, e = 0; at the lower bound e >= 0; at the upper
/// bound e <= 0.
struct Row {
  double bias = 0;        // [m/s]
  double compliance = 0;  // [1/kg]
};

/// Two rows, normal and tangential, at one pair of material points. The impulse on block a is
/// p_n normal + p_t tangent, on block b the opposite; u = (velocity of a - velocity of b) along each.
struct PointRows {
  int block_a = -1, block_b = -1;  // -1: the ground, which stands still
  Vec2 arm_a, arm_b;               // acting arms (see acting_arm)
  Vec2 normal;                     // unit, from b into a; the tangent is the normal turned clockwise
  Row row[2];                      // normal, tangential
  double lower = -std::numeric_limits<double>::infinity();  // bounds of p_n [N s]
  double upper = std::numeric_limits<double>::infinity();
  double friction = 0;  // p_t lies within -+ max(0, cohesion + friction p_n); tan of the friction angle
  double cohesion = std::numeric_limits<double>::infinity();  // [N s]
  int partner = -1;  // index in the row set of the other end of the same compliant face, -1: none

  /// Compliance of row k with the partner's impulse, the same seen from both ends [1/kg]: of a linear closure
  /// of the face it is half the own one with the opposite sign (theory 4.6).
  double cross(int k) const { return partner < 0 ? 0 : -0.5 * row[k].compliance; }
};

using Impulse = std::array<double, 2>;  // normal, tangential [N s]

/// Resizes with a little to spare where the vector itself would double: rows and records are most of the
/// memory of a run.
template <class T>
void resize_sparingly(std::vector<T>& v, size_t n) {
  if (v.capacity() < n) v.reserve(n + n / 64);
  v.resize(n);
}

/// Whose rows they are, in the order in which they stand in a set. Who adds rows and reads them back asks for
/// it; solvers never do.
enum class RowFamily { kBonds, kContacts, kSupports, kBoundaries, kTies, kBolts };
inline constexpr size_t kRowFamilies = static_cast<size_t>(RowFamily::kBolts) + 1;

struct RowRange {
  size_t begin = 0, end = 0;
  size_t size() const { return end - begin; }
};

/// A row as one of its family.
struct RowPlace {
  RowFamily family = RowFamily::kBonds;
  size_t index = 0;  // within the family
};

/// Whether two faces of blocks meet there: an intact face or a contact.
inline bool is_joint(RowFamily family) {
  return family == RowFamily::kBonds || family == RowFamily::kContacts;
}

struct RowSet {
  std::vector<PointRows> points;
  std::vector<Impulse> impulse;  // in: first guess; out: solution

  void add(const PointRows& p, const Impulse& guess) {
    const size_t i = add_more(1);
    points[i] = p, impulse[i] = guess;
  }
  /// Room for `count` more points, to be written by the caller; returns the index of the first. Between
  /// restart() and finish() old points are written over, not made anew.
  size_t add_more(size_t count) {
    const size_t first = next_;
    next_ += count;
    range_[family_].end = next_;
    if (points.size() < next_) resize_sparingly(points, next_), resize_sparingly(impulse, next_);
    return first;
  }
  void restart() { next_ = 0, family_ = 0, range_ = {}; }
  /// What is added from here on is of this family. @pre  none of a later one is there
  void begin(RowFamily family) {
    family_ = static_cast<size_t>(family);
    range_[family_] = {next_, next_};
  }
  void finish() { points.resize(next_), impulse.resize(next_); }
  size_t size() const { return next_; }

  RowRange range(RowFamily family) const { return range_[static_cast<size_t>(family)]; }
  /// Bonds and contacts, which stand together: where faces of blocks meet.
  RowRange joints() const { return {range(RowFamily::kBonds).begin, range(RowFamily::kContacts).end}; }
  /// @pre  there is a row r
  RowPlace place(size_t r) const {
    size_t f = 0;
    while (r >= range_[f].end) ++f;
    return {static_cast<RowFamily>(f), r - range_[f].begin};
  }

 private:
  size_t next_ = 0, family_ = 0;
  std::array<RowRange, kRowFamilies> range_{};
};

/// Bounds of row k of a point when its normal impulse is p_n.
struct Bounds {
  double lower, upper;
};
inline Bounds bounds_of(const PointRows& p, int k, double p_n) {
  if (k == 0) return {p.lower, p.upper};
  const double limit = p.cohesion + p.friction * p_n;
  return limit > 0 ? Bounds{-limit, limit} : Bounds{0, 0};
}

/// Whether the tangential impulse sits on its cone. Solvers put it there to some digits only; a contact that
/// sticks so close to its limit may be taken for sliding, which changes nothing but the place of its anchor.
inline bool slides(const PointRows& p, const Impulse& impulse) {
  const double limit = bounds_of(p, 1, impulse[0]).upper;
  return std::abs(impulse[1]) >= limit * (1 - 1e-8);
}

/// M^-1 times a generalised force or impulse. Zero for blocks whose motion is prescribed.
BlockRate accelerate(const BlockSet& blocks, size_t i, const BlockForce& force);

/// M times a rate.
BlockForce momentum(const BlockSet& blocks, size_t i, const BlockRate& rate);

/// Relative velocity (normal, tangential) of a point pair when the blocks move at `rate`.
inline std::array<double, 2> relative_velocity(const PointRows& p, const std::vector<BlockRate>& rate) {
  Vec2 v;
  if (p.block_a >= 0) v += velocity_at(rate[static_cast<size_t>(p.block_a)], p.arm_a);
  if (p.block_b >= 0) v -= velocity_at(rate[static_cast<size_t>(p.block_b)], p.arm_b);
  return {dot(p.normal, v), dot(turn_right(p.normal), v)};
}

/// Impulse of a point as generalised impulse on block a (`sign` = 1) or block b (-1).
BlockForce impulse_on(const PointRows& p, const Impulse& impulse, double sign);

}  // namespace talus
