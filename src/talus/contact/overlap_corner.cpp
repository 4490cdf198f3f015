// A corner on a corner of hard parts: which ways out there a third block fills. Theory: docs/theory.md 3.3.

#include <algorithm>
#include <array>
#include <cmath>

#include "talus/contact/overlap.h"

namespace talus {

namespace {

// Sides that are slanted to each other by less, as a tangent, lie on each other where they meet.
constexpr double kSlanted = 0.1;

}  // namespace

std::span<CornerSide> PartsMeeting::sides_at_corner(double level) {
  corner_sides_.clear();
  const std::array<size_t, 2> side{static_cast<size_t>(met_.side_a), static_cast<size_t>(met_.side_b)};
  if (std::abs(cross(part_[0].along[side[0]], part_[1].along[side[1]])) <= kSlanted) return {};  // as most
  for (const size_t k : {side[0], after(side[0], part_[0].size())})
    for (const size_t m : {side[1], after(side[1], part_[1].size())})
      if (corner_sides_.empty() && norm(corner(false, k) - corner(true, m)) <= level)
        add_corner_sides(false, k, level), add_corner_sides(true, m, level);
  // faces that lie on each other or in one line, as where a block slides from one onto the next: as if there was no third
  for (const CornerSide& c : corner_sides_)
    for (const CornerSide& d : corner_sides_)
      if (c.of_b != d.of_b && dot(along(c), along(d)) < 0 && std::abs(cross(along(c), along(d))) <= kSlanted)
        return {};
  return corner_sides_;
}

// A side that begins or ends at the corner is filled where a third block is nearer than what is level, at the corner and on.
void PartsMeeting::add_corner_sides(bool of_b, size_t at, double level) {
  const PartNow& own = part(of_b);
  for (const size_t side : {ahead_of(at, own.size()), at}) {
    if (own.role_of(side) != SideRole::kOut) continue;
    const Vec2 into = side == at ? own.along[side] : -own.along[side],
               out = corner(of_b, at) + level * turn_right(own.along[side]);
    corner_sides_.push_back({of_b, side, {out + level * into, out + (level / kSlanted) * into}});
  }
}

// Filled sides are no ways, nor are sides against such ones of the other part along whose normal they move against what
// fills by more than they have to. What has no side left is behind a corner of others, which bear.
bool PartsMeeting::leave_out_filled() {
  std::array<bool, 2> filled{}, open{};  // of a and b
  for (const CornerSide& c : corner_sides_) (c.filled ? filled : open)[c.of_b] = true;
  if (!filled[0] && !filled[1]) return false;
  if (!open[0] || !open[1]) return met_.kind = PartsMet::kFar, false;
  const auto against = [&](const CornerSide& c) {
    double most = 0;
    for (const CornerSide& f : corner_sides_)
      if (f.filled) most = std::max(most, std::abs(dot(along(c), along(f))));
    return most;
  };
  double least = 1;
  for (const CornerSide& c : corner_sides_)
    if (!c.filled) least = std::min(least, against(c));
  const auto is_out = [&](const CornerSide& c) {
    return c.filled || (filled[!c.of_b] && against(c) > least + kOneSide);
  };
  size_t count = 0;
  bool apart = false;
  for (const Way& w : ways_) {
    const auto c = std::find_if(corner_sides_.begin(), corner_sides_.end(),
                                [&](const CornerSide& s) { return s.of_b == w.of_b && s.side == w.side; });
    if (c != corner_sides_.end() && is_out(*c)) continue;
    ways_[count++] = w;
    apart = apart || (role_of(w) == SideRole::kOut && w.gap >= -rounding_);
  }
  ways_ = ways_.first(count);
  met_.kind = count == 0 ? PartsMet::kFar : apart ? PartsMet::kApart : PartsMet::kOverlap;
  return count > 0;
}

}  // namespace talus
