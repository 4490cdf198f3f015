// Overlaps that are strips: two sides that lie on each other and at each end the side of one of the two parts. Their
// cells are triangles at the ends and what those leave: closed form, without clipping. Theory: docs/theory.md 3.2.

#include <algorithm>
#include <cmath>

#include "talus/contact/overlap.h"

namespace talus {

// The side of a part that faces a side of the other the most.
size_t PartsMeeting::facing(bool of_b, size_t side) const {
  const PartNow& own = part(of_b);
  const Vec2 along = part(!of_b).along[side];
  size_t best = 0;
  double least = 2;
  for (size_t k = 0; k < own.size(); ++k)
    if (const double turn = dot(along, own.along[k]); turn < least) least = turn, best = k;
  return best;
}

// The end of a strip along the side of b (`high`) or before it: the part that ends there, and the two corners of the
// overlap. False: its next side does not cross the other's face.
bool PartsMeeting::take_end(bool high) {
  const size_t i = strip_.side[0], j = strip_.side[1], na = part_[0].size(), nb = part_[1].size();
  const Vec2 u = part_[1].along[j];
  StripEnd& end = strip_.end[high];
  // along an outline a's face runs against b's
  end.side[0] = high ? ahead_of(i, na) : after(i, na), end.side[1] = high ? after(j, nb) : ahead_of(j, nb);
  end.corner[0] = corner(false, high ? i : after(i, na)),
  end.corner[1] = corner(true, high ? after(j, nb) : j);
  end.of_b = (dot(u, end.corner[0] - end.corner[1]) > 0) == high;
  const bool onwards = end.of_b == high;
  const size_t side = end.side[end.of_b], face = strip_.side[!end.of_b];
  const Vec2 from = end.corner[end.of_b],
             to = corner(end.of_b, onwards ? after(side, part(end.of_b).size()) : side);
  const double in = depth_of(!end.of_b, face, from), out = depth_of(!end.of_b, face, to);
  if (!(in > rounding_ && out < 0)) return false;
  end.on[end.of_b] = from, end.on[!end.of_b] = from + (in / (in - out)) * (to - from);
  return true;
}

// Whether the sides of a part bound the strip where they end it and nowhere else, and none is nearer to any of it than its face
// and the next ones are.
bool PartsMeeting::strip_is_all(bool of_b) const {
  const PartNow& own = part(of_b);
  const StripEnd &low = strip_.end[0], &high = strip_.end[1];
  const Vec2 at[4]{low.on[0], low.on[1], high.on[0], high.on[1]};
  double deepest = 0;
  for (const Vec2 x : at) deepest = std::max(deepest, depth_of(of_b, strip_.side[of_b], x));
  for (size_t k = 0; k < own.size(); ++k) {
    if (k == strip_.side[of_b]) continue;
    const bool next = low.side[of_b] == k || high.side[of_b] == k;
    const double least = next || own.role_of(k) == SideRole::kCut ? 0 : deepest;
    for (size_t i = 0; i < 4; ++i) {
      const StripEnd& end = strip_.end[i / 2];
      if (end.of_b == of_b && end.side[of_b] == k) continue;  // its own two places
      if (!(depth_of(of_b, k, at[i]) >= least)) return false;
    }
  }
  return true;
}

// The triangle at an end that is nearer to a part's side there than to its face: beyond the bisector of the two.
// Returns how far it reaches along the other face, as share of that; not in [0, 1): no strip.
double PartsMeeting::take_triangle(bool of_b, bool high, Moments& triangle) const {
  const StripEnd& end = strip_.end[high];
  const PartNow& own = part(of_b);
  triangle = {};
  if (own.role_of(end.side[of_b]) == SideRole::kCut) return 0;
  if (own.role_of(end.side[of_b]) != SideRole::kOut) return 1;
  const Vec2 way = own.along[strip_.side[of_b]] + own.along[end.side[of_b]];
  // the bisector is square to the sum of two sides' ways; on which side of it the face lies goes by their order
  const double sign = of_b == high ? -1 : 1;
  const auto beside = [&](Vec2 x) { return sign * dot(way, x - end.corner[of_b]); };
  const double here = end.of_b == of_b ? 0 : beside(end.on[of_b]), beyond = beside(end.on[!of_b]);
  const double far = beside(strip_.end[!high].on[!of_b]);
  if (beyond >= 0 && far >= 0) return 0;
  if (!(beyond < 0 && here >= 0 && far > 0)) return 1;
  const Vec2 tip = end.on[!of_b], u = (beyond / (beyond - here)) * (end.on[of_b] - tip),
             v = (beyond / (beyond - far)) * (strip_.end[!high].on[!of_b] - tip);
  const double area = 0.5 * std::abs(cross(u, v));
  triangle = {area, area * (tip + (u + v) / 3)};
  return beyond / (beyond - far);
}

// The cells of a part: the triangles at the ends and what they leave.
bool PartsMeeting::strip_cells(bool of_b, const Moments& all, std::vector<SideCell>& out) const {
  out.clear();
  Moments rest = all, triangle;
  double shares = 0;
  for (const bool high : {false, true}) {
    shares += take_triangle(of_b, high, triangle);
    if (!(triangle.area > 0)) continue;
    rest.area -= triangle.area, rest.first -= triangle.first;
    out.push_back(cell(of_b, static_cast<int>(strip_.end[high].side[of_b]), triangle.area, triangle.first));
  }
  out.push_back(cell(of_b, static_cast<int>(strip_.side[of_b]), rest.area, rest.first));
  return shares < 1;
}

bool PartsMeeting::measure_strip(bool of_b, size_t side) {
  strip_.side[of_b] = side, strip_.side[!of_b] = facing(!of_b, side);
  for (const bool one : {false, true})
    if (part(one).role_of(strip_.side[one]) != SideRole::kOut) return false;
  if (!take_end(false) || !take_end(true) || !strip_is_all(false) || !strip_is_all(true)) return false;
  const StripEnd &low = strip_.end[0], &high = strip_.end[1];
  bearing_.assign({low.on[1], high.on[1], high.on[0], low.on[0]});
  const Moments all = moments(bearing_);
  met_.area = all.area;
  return all.area > 0 && strip_cells(false, all, met_.cells_a) && strip_cells(true, all, met_.cells_b);
}

}  // namespace talus
