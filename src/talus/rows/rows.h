#pragma once
// The plain rows that tie points of blocks together: all a solver sees. A row knows bounds, compliance and
// bias; it knows no joint, support or bolt. Theory: docs/theory.md section 4.

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/parallel.h"
#include "talus/blocks/state.h"
#include "talus/rows/owner.h"

namespace talus {

/// Residual of a row: e = u + bias + compliance p (+ cross p of the partner), with u the relative velocity
/// along it at the end of the kick. Inside the bounds of p, e = 0; at the lower bound e >= 0; at the upper
/// bound e <= 0 (eq. 4.1).
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
  int partner = -1;             // index in the row set of the other end of the same compliant face, -1: none
  std::array<bool, 2> gives{};  // rows whose compliance is the give of a hard contact, not that of a joint

  /// Whether row k is one of a joint with stiffness.
  bool is_soft(int k) const { return row[k].compliance > 0 && !gives[k]; }
  bool is_soft() const { return is_soft(0) || is_soft(1); }

  /// Compliance of row k with the partner's impulse, the same seen from both ends [1/kg]: of a linear closure
  /// of the face it is half the own one with the opposite sign (theory 4.6).
  double cross(int k) const { return partner < 0 ? 0 : -0.5 * row[k].compliance; }
};

/// What rows begin as where many are written. Of memory: to clear a row takes longer than to copy one.
inline constexpr PointRows kFreshRows{};

using Impulse = std::array<double, 2>;  // normal, tangential [N s]

/// Resizes with a little to spare where the vector itself would double: rows and records are most of the
/// memory of a run.
template <class T>
void resize_sparingly(std::vector<T>& v, size_t n) {
  if (v.capacity() < n) v.reserve(n + n / 64);
  v.resize(n);
}

struct RowRange {
  size_t begin = 0, end = 0;
  size_t size() const { return end - begin; }
};

struct RowSet {
  std::vector<PointRows> points;
  std::vector<Impulse> impulse;  // in: first guess; out: solution
  std::vector<RowOwner> owner;

  void add(const PointRows& p, const Impulse& guess, RowOwner whose = {}) {
    const size_t i = add_more(whose.family, 1);
    points[i] = p, impulse[i] = guess, owner[i] = whose;
  }
  /// Room for `count` more points of a family, to be written by the caller; returns the index of the first.
  /// Between restart() and finish() old points are written over, not made anew.
  /// @pre  none of a later family is there
  size_t add_more(Family family, size_t count) {
    const size_t first = next_;
    TALUS_ASSERT(end_.back() == end_[place_of(family)]);
    next_ += count;
    for (size_t f = place_of(family); f < end_.size(); ++f) end_[f] = next_;
    if (points.size() < next_)
      resize_sparingly(points, next_), resize_sparingly(impulse, next_), resize_sparingly(owner, next_);
    return first;
  }
  void restart() { next_ = 0, end_ = {}; }
  void finish() { points.resize(next_), impulse.resize(next_), owner.resize(next_); }
  size_t size() const { return next_; }

  /// Those of a family, which stand together.
  RowRange range(Family family) const {
    const int f = place_of(family);
    return {f == 0 ? 0 : end_[f - 1], end_[f]};
  }

 private:
  size_t next_ = 0;
  std::array<size_t, kAllFamilies.size()> end_{};
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

/// Points of faces that are tied without any give: what `auto` chooses a solver by.
size_t hard_ties(const RowSet& rows, const Workers& workers);

/// M^-1 times a generalised force or impulse. Zero for blocks whose motion is prescribed.
inline BlockRate accelerate(const BlockSet& blocks, size_t i, const BlockForce& force) {  // eq. 1.2
  switch (blocks.kind[i]) {
    case BlockKind::kDeformable:
      return {force.f / blocks.mass[i], force.Q * blocks.inertia_inverse[i]};
    case BlockKind::kRigid:
      return {force.f / blocks.mass[i], spin_matrix((force.Q.yx - force.Q.xy) / blocks.polar_inertia[i])};
    default:
      return {};
  }
}

/// M times a rate.
inline BlockForce momentum(const BlockSet& blocks, size_t i, const BlockRate& rate) {
  switch (blocks.kind[i]) {
    case BlockKind::kDeformable:
      return {blocks.mass[i] * rate.a, rate.G * blocks.inertia[i]};
    case BlockKind::kRigid:
      return {blocks.mass[i] * rate.a, (0.5 * blocks.polar_inertia[i]) * rate.G};
    default:
      return {};
  }
}

/// Relative velocity (normal, tangential) of a point pair when the blocks move at `rate`.
inline std::array<double, 2> relative_velocity(const PointRows& p, const std::vector<BlockRate>& rate) {
  Vec2 v;
  if (p.block_a >= 0) v += velocity_at(rate[p.block_a], p.arm_a);
  if (p.block_b >= 0) v -= velocity_at(rate[p.block_b], p.arm_b);
  return {dot(p.normal, v), dot(turn_right(p.normal), v)};
}

/// Impulse of a point as generalised impulse on block a (`sign` = 1) or block b (-1).
BlockForce impulse_on(const PointRows& p, const Impulse& impulse, double sign);

}  // namespace talus
