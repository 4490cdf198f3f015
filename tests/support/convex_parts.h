#pragma once
// Convex parts for tests of how two of them lie to each other.

#include <cmath>
#include <vector>

#include "support/box_polygon.h"
#include "talus/contact/contact_give.h"
#include "talus/contact/overlap.h"
#include "talus/geometry/polygon.h"

namespace talus::test {

// A part in its own frame, and where that lies.
struct Body {
  Polygon corner;  // counter-clockwise, from the origin of the part [m]
  Vec2 origin;     // [m]
  std::vector<SideRole> role = {};

  Vec2 at(size_t k) const { return origin + corner[k % corner.size()]; }
  SideRole role_of(size_t k) const { return role.empty() ? SideRole::kOut : role[k]; }
};

inline Vec2 turned(Vec2 x, double angle) {
  return {std::cos(angle) * x.x - std::sin(angle) * x.y, std::sin(angle) * x.x + std::cos(angle) * x.y};
}

// Moved by `way` and turned about the origin of all, frame and all.
inline Body moved(Body body, Vec2 way, double angle = 0) {
  for (Vec2& c : body.corner) c = turned(c, angle);
  body.origin = turned(body.origin, angle) + way;
  return body;
}

// Keeps what a part is seen by, for as long as it is looked at.
class Seen {
 public:
  explicit Seen(const Body& body) : body_(body) {
    const size_t n = body_.corner.size();
    for (size_t k = 0; k < n; ++k) {
      const Vec2 side = body_.corner[(k + 1) % n] - body_.corner[k];
      along_.push_back(side / norm(side));
    }
  }
  PartNow now() const { return {body_.corner, along_, body_.role}; }

 private:
  Body body_;
  std::vector<Vec2> along_;
};

inline constexpr double kMargin = 0.05;     // [m]
inline constexpr double kRounding = 1e-14;  // [m]

inline PartsMet meet(const Body& a, const Body& b, const PartMotion& motion_b = {}) {
  PartsMeeting meeting;
  const Seen one(a), two(b);
  PartsMet met = meeting.look(one.now(), two.now(), b.origin - a.origin, kMargin, kRounding);
  if (met.kind != PartsMet::kFar) meeting.choose_way({}, motion_b, {0, kLevel});  // of 1 m
  met = meeting.met();
  if (met.kind != PartsMet::kOverlap) return met;
  const bool any = meeting.measure_overlap();
  met = meeting.met();
  if (!any) met.kind = PartsMet::kFar;
  return met;
}

inline Body floor_body() { return {box_polygon(-2, -1, 2, 0), {}}; }

/// A block on it, a little to the right [m].
inline Body block_over(double length, double depth) {
  return {box_polygon(-0.5 * length, 0, 0.5 * length, 1), {0.1, -depth}};
}

}  // namespace talus::test
