// The ways out of two parts: sides with all of the other part before them, and the one along which the two meet.
// Theory: docs/theory.md 3.3.

#include <algorithm>
#include <cmath>

#include "talus/contact/overlap.h"

namespace talus {

namespace {

// One of two numbers without a branch: which one it is hangs on the last digits, and a wrong guess costs more than both.
size_t pick(bool first, size_t one, size_t two) { return two ^ ((one ^ two) & -static_cast<size_t>(first)); }

}  // namespace

// A side with how far the nearest corner of the other part is before it. No corner ends the loop: what a wrong guess of a
// branch costs is more than all of it.
PartsMeeting::Way PartsMeeting::side_before(bool of_b, size_t k) const {
  const Vec2 along = part(of_b).along[k];
  double furthest = -kAll;  // behind it, from the other part's origin
  for (const Vec2 x : part(!of_b).corner) furthest = std::max(furthest, cross(along, x));
  return {of_b, k, cross(along, part(of_b).corner[k] - shift_from(of_b)) - furthest};
}

PartsMeeting::Face PartsMeeting::face(bool of_b, size_t side) const {
  const PartNow& own = part(of_b);
  const bool last = side + 1 == own.size();
  const size_t first = last ? 0 : side, second = last ? side : side + 1;
  return {side, {first, second}, own.along[side], {own.corner[first], own.corner[second]}, {}};
}

// side_before() of a face and the ends of the other one.
PartsMeeting::Way PartsMeeting::face_before(bool of_b, const Face& own, Face& other) const {
  const Vec2 begin = own.place[own.corner[0] != own.side];
  const double from = cross(own.along, begin - shift_from(of_b));
  const double behind[2]{cross(own.along, other.place[0]), cross(own.along, other.place[1])};
  other.before[0] = from - behind[0], other.before[1] = from - behind[1];
  return {of_b, own.side, from - std::max(behind[0], behind[1])};
}

// find_ways() where all other ways are known to be behind these. Of one way of each part the ends of the two sides are the
// corners that may be nearest: before the far corner of the side beyond an end comes nearer than that end, the two turn by
// the angle of that corner, which makes a way of the side beyond it, and it is known to be none.
void PartsMeeting::find_near_ways(std::array<int, 2> near, double margin) {
  met_.kind = PartsMet::kFar;
  sides_.resize(near.size());
  const auto side_of = [](int way) { return static_cast<size_t>(std::abs(way)) - 1; };
  along_faces_ = near[0] > 0 && near[1] < 0;
  size_t count = near[1] == 0 ? 1 : 2;
  if (along_faces_) {
    Face a = face(false, side_of(near[1])), b = face(true, side_of(near[0]));
    sides_[0] = face_before(true, b, a), sides_[1] = face_before(false, a, b);
    faces_[0] = a, faces_[1] = b;
  } else {
    for (size_t i = 0; i < count; ++i) sides_[i] = side_before(near[i] > 0, side_of(near[i]));
  }
  const double widest = count == 1 ? sides_[0].gap : std::max(sides_[0].gap, sides_[1].gap);
  if (widest > margin) return;
  if (sides_[0].gap < widest - behind_) sides_[0] = sides_[1], count = 1;
  if (count > 1 && sides_[1].gap < widest - behind_) count = 1;
  ways_ = {sides_.data(), count};
  met_.kind = widest >= -rounding_ ? PartsMet::kApart : PartsMet::kOverlap;
}

// Convex parts overlap unless a side of one has all of the other before it. What is behind the widest way out by more than
// the step can change is no way.
void PartsMeeting::find_ways(double margin) {
  met_.kind = PartsMet::kFar, along_faces_ = false;
  sides_.resize(part_[0].size() + part_[1].size());
  Way* out = sides_.data();
  for (const bool of_b : {true, false})
    for (size_t k = 0; k < part(of_b).size(); ++k) *out++ = side_before(of_b, k);
  double widest_out = -kAll, widest_shut = -kAll;
  for (const Way& w : sides_)
    if (role_of(w) == SideRole::kOut)
      widest_out = std::max(widest_out, w.gap);
    else if (w.gap > 0 && !goes_on_free(w))
      widest_shut = w.gap;
  if (widest_out > margin || widest_shut > 0) return;
  const double least = widest_out - behind_;
  size_t count = 0;
  double rest = -kAll;
  near_ = {};
  for (const Way& w : sides_) {
    const SideRole role = role_of(w);
    const bool near = w.gap >= (role == SideRole::kOut ? least : std::min(0.0, least));
    rest = std::max(rest, near ? -kAll : w.gap);
    if (near && count < near_.size()) near_[count] = w.number();
    sides_[count] = w;
    count +=
        static_cast<size_t>(near && role != SideRole::kCut && (role == SideRole::kOut || !goes_on_free(w)));
  }
  ways_ = {sides_.data(), count};
  const bool all_out = part_[0].role.empty() && part_[1].role.empty();
  lead_ = all_out && count <= near_.size() ? widest_out - rest : 0;
  if (count > 0) met_.kind = widest_out >= -rounding_ ? PartsMet::kApart : PartsMet::kOverlap;
}

// Whether a side that a third block ties goes on in its line as a way out: where a tie ends within a side, what is before the
// one is before the other.
bool PartsMeeting::goes_on_free(const Way& w) const {
  if (role_of(w) != SideRole::kTied) return false;
  const PartNow& own = part(w.of_b);
  const size_t n = own.size();
  for (const size_t step : {size_t{1}, n - 1})
    for (size_t next = (w.side + step) % n; next != w.side; next = (next + step) % n) {
      const Vec2 one = own.along[w.side], two = own.along[next];
      if (std::abs(cross(one, two)) > kOneSide || dot(one, two) < 0) break;
      if (own.role_of(next) == SideRole::kOut) return true;
    }
  return false;
}

// Parts that are apart meet along the way along which they are furthest apart, or least in each other, at the end of
// the step. Where that is one that they are level along now and stay so, as corners of level blocks do that slide past
// each other, nothing keeps them apart; where they would be in each other by more, the way is one that still has a gap.
// What overlaps by no more than `before.by` touches, and keeps in the same way to the ways that it touches along.
void PartsMeeting::choose_way(const PartMotion& motion_a, const PartMotion& motion_b,
                              const WayBefore& before) {
  comes_ = {motion_a.way - motion_b.way + motion_b.turn * origin_[1], motion_a.turn - motion_b.turn};
  const Way* best = along_faces_ ? best_face(before) : nullptr;
  take_way(best ? *best : *best_way(before), before.by);
}

// Of two sides that lie on each other the longer one has the way: it is the better one as soon as they turn at all.
bool PartsMeeting::is_better(const Way& w, const Way& than) const {
  if (std::abs(w.then - than.then) > rounding_) return w.then > than.then;
  return side_length(w.of_b, w.side) > side_length(than.of_b, than.side);
}

// What best_way() finds of two faces in one line that both stand, or neither; nullptr: of these best_way() finds it.
const PartsMeeting::Way* PartsMeeting::best_face(const WayBefore& before) {
  if (ways_.size() != 2 || !in_line(ways_[0], ways_[1])) return nullptr;
  const bool apart = met_.kind == PartsMet::kApart;
  const double in = apart ? rounding_ : before.by;
  if ((ways_[0].gap >= -in) != (ways_[1].gap >= -in)) return nullptr;
  look_ahead_from_face(ways_[0]), look_ahead_from_face(ways_[1]);
  const Way& best = ways_[is_better(ways_[1], ways_[0])];
  for (const Way& w : ways_)
    if (!apart && w.number() == before.way && w.then >= best.then - before.by) return &w;
  return &best;
}

const PartsMeeting::Way* PartsMeeting::best_way(const WayBefore& before) {
  double widest = -kAll;
  for (const Way& w : ways_) widest = std::max(widest, w.gap);
  const Way *best = nullptr, *kept = nullptr;
  for (Way& w : ways_) {
    if (w.gap >= widest - behind_)
      look_ahead(w);
    else
      w.then = -kAll;
    if (!best || is_better(w, *best)) best = &w;
    if (w.number() == before.way) kept = &w;
  }
  const bool apart = met_.kind == PartsMet::kApart;
  const double in = apart ? rounding_ : before.by;
  const auto stands = [&](const Way& w) { return w.gap >= -in; };
  const auto best_that_stands = [&](const auto& may) {
    const Way* found = nullptr;
    for (Way& w : ways_) {
      if (!stands(w) || !may(w)) continue;
      look_ahead(w);
      if (!found || is_better(w, *found)) found = &w;
    }
    return found;
  };
  if (widest >= -in && !stands(*best)) {
    // the two sides of one interface are one way: a corner that hangs over may be behind the other's line
    const bool deep = best->then < -before.by;
    if (const Way* way = best_that_stands([&](const Way& w) { return deep || in_line(w, *best); }))
      best = way;
  }
  if (apart && !stands(*best)) met_.kind = PartsMet::kFar;
  // what is apart would be struck by a way that it has passed
  if (apart || !kept || kept->then < best->then - before.by || !(in_line(*kept, *best) || stands_at(*kept)))
    return best;
  const Way* other = nullptr;
  for (const Way& w : ways_)
    if (w.then >= best->then - before.by && !in_line(w, *kept) && stands_at(w) &&
        pushed_off(*kept, before.force) && (!other || is_better(w, *other)))
      other = &w;
  return other ? other : kept;
}

void PartsMeeting::take_way(const Way& best, double by) {
  met_.tied = part(best.of_b).role_of(best.side) != SideRole::kOut;
  const Vec2 out = turn_right(part(best.of_b).along[best.side]);
  met_.way = best.number();
  met_.normal = best.of_b ? out : -out;
  (best.of_b ? met_.side_b : met_.side_a) = static_cast<int>(best.side);
  (best.of_b ? met_.side_a : met_.side_b) = static_cast<int>(facing_side(best, out));
  met_.at_corner = false;
  if (met_.kind != PartsMet::kOverlap) return;
  for (const Way& w : ways_)
    if (&w != &best && w.then >= best.then - by)
      met_.at_corner = met_.at_corner || !faces_along(part(w.of_b).along[w.side], by);
}

double PartsMeeting::side_length(bool of_b, size_t side) const {
  const PartNow& own = part(of_b);
  return norm(own.corner[side + 1 == own.size() ? 0 : side + 1] - own.corner[side]);
}

// Where a place of the other part is going to be at the end of the step, seen from the origin of one.
Vec2 PartsMeeting::then_at(bool of_b, Vec2 place) const {
  const Vec2 x = place + origin_[!of_b], comes = comes_.way + comes_.turn * x;
  return place + shift_from(of_b) + (of_b ? comes : -comes);
}

// How far a place of the other part, from its origin, is before a side now, and how it comes nearer in the step. What
// then_at() adds to a distance is linear in the place.
PartsMeeting::Sight PartsMeeting::sight(bool of_b, size_t side) const {
  const PartNow& own = part(of_b);
  const Vec2 out = turn_right(own.along[side]), towards = of_b ? out : -out;
  const Vec2 per_place = transpose(comes_.turn) * towards;
  return {out, dot(out, shift_from(of_b) - own.corner[side]), per_place,
          dot(towards, comes_.way) + dot(per_place, origin_[!of_b])};
}

// How far the nearest corner of the other part is going to be before a side at the end of the step, one of those that
// are not further now than the two move; and which is nearest now.
void PartsMeeting::look_ahead(Way& w) const {
  const Sight sees = sight(w.of_b, w.side);
  const std::span<const Vec2> corners = part(!w.of_b).corner;
  double nearest = kAll;
  w.then = kAll;
  for (size_t k = 0; k < corners.size(); ++k) {
    const double now = sees.at_origin + dot(sees.out, corners[k]);
    w.then = std::min(w.then, now - w.gap > behind_ ? kAll : sees.then(now, corners[k]));
    w.nearest = pick(now < nearest, k, w.nearest), nearest = std::min(nearest, now);
  }
}

// The same of a face and the ends of the other one.
void PartsMeeting::look_ahead_from_face(Way& w) const {
  const Sight sees = sight(w.of_b, w.side);
  const Face& other = faces_[!w.of_b];
  double then[2];
  for (const size_t end : {0U, 1U}) {
    const double now = other.before[end];
    then[end] = now - w.gap > behind_ ? kAll : sees.then(now, other.place[end]);
  }
  w.then = std::min(then[0], then[1]);
  w.nearest = pick(other.before[1] < other.before[0], other.corner[1], other.corner[0]);
}

// Whether two ways are of sides in one line.
bool PartsMeeting::in_line(const Way& one, const Way& two) const {
  return std::abs(cross(part(one.of_b).along[one.side], part(two.of_b).along[two.side])) <= kOneSide;
}

// Whether the nearest corner of the other part is going to lie before the side of a way, or past an end of it by no more
// than it is in: so far contacts give.
bool PartsMeeting::stands_at(const Way& w) const {
  const Vec2 along = part(w.of_b).along[w.side], from = part(w.of_b).corner[w.side];
  const double past = std::max(0.0, -w.then) + rounding_;
  for (const Vec2 now : part(!w.of_b).corner) {
    const Vec2 x = then_at(w.of_b, now);
    const double s = dot(along, x - from);
    if (dot(turn_right(along), x - from) <= w.then + rounding_ && s >= -past &&
        s <= side_length(w.of_b, w.side) + past)
      return true;
  }
  return false;
}

// Whether the force on a, which holds the corner of a way back, holds it from leaving the side by an end that it is going to
// lie at.
bool PartsMeeting::pushed_off(const Way& w, Vec2 force) const {
  const Vec2 along = part(w.of_b).along[w.side], from = part(w.of_b).corner[w.side];
  const double towards = dot(along, w.of_b ? -force : force), length = side_length(w.of_b, w.side);
  const double past = std::max(0.0, -w.then) + rounding_;
  for (const Vec2 now : part(!w.of_b).corner) {
    const Vec2 x = then_at(w.of_b, now);
    const double s = dot(along, x - from);
    if (dot(turn_right(along), x - from) <= w.then + rounding_ &&
        ((towards > 0 && s >= length - past) || (towards < 0 && s <= past)))
      return true;
  }
  return false;
}

// Whether the two parts lie beside each other over more than `by` of a line. Where their sides that met do, they do.
bool PartsMeeting::faces_along(Vec2 tangent, double by) const {
  double low = -kAll, high = kAll;
  for (const bool of_b : {false, true}) {
    const int side = of_b ? met_.side_b : met_.side_a;
    const double s0 = dot(tangent, corner(of_b, side)),
                 s1 = dot(tangent, corner(of_b, after(side, part(of_b).size())));
    low = std::max(low, std::min(s0, s1)), high = std::min(high, std::max(s0, s1));
  }
  if (high - low > by) return true;
  low = -kAll, high = kAll;
  for (const bool of_b : {false, true}) {
    double from = kAll, to = -kAll;
    for (size_t k = 0; k < part(of_b).size(); ++k) {
      const double s = dot(tangent, corner(of_b, k));
      from = std::min(from, s), to = std::max(to, s);
    }
    low = std::max(low, from), high = std::min(high, to);
  }
  return high - low > by;
}

// Of the two sides at the corner of the other part that is nearest to a way, the one that faces it the most.
size_t PartsMeeting::facing_side(const Way& way, Vec2 direction) const {
  const PartNow& other = part(!way.of_b);
  const size_t before = ahead_of(way.nearest, other.size());
  return pick(
      dot(turn_right(other.along[before]), direction) < dot(turn_right(other.along[way.nearest]), direction),
      before, way.nearest);
}

}  // namespace talus
