#include "talus/contact/overlap.h"

#include <algorithm>
#include <cmath>

#include "talus/base/index.h"
#include "talus/contact/moments.h"
#include "talus/geometry/polygon.h"

namespace talus {

namespace {

// What of a convex polygon has value(corner) >= 0, the value being linear.
template <class F>
void keep(const std::vector<Vec2>& in, F value, std::vector<Vec2>& out) {
  out.clear();
  if (in.empty()) return;
  double here = value(in[0]);
  const double first = here;
  for (size_t i = 0; i < in.size(); ++i) {
    const size_t next = i + 1 == in.size() ? 0 : i + 1;
    const double there = next == 0 ? first : value(in[next]);
    if (here >= 0) out.push_back(in[i]);
    if ((here >= 0) != (there >= 0)) out.push_back(in[i] + (here / (here - there)) * (in[next] - in[i]));
    here = there;
  }
  if (out.size() < 3) out.clear();
}

}  // namespace

void PartsMeeting::clip() {
  region_.assign(part_[0].corner.begin(), part_[0].corner.end());
  for (size_t j = 0; j < part_[1].size() && !region_.empty(); ++j) {
    const auto below = [&](Vec2 x) { return depth_of(true, j, x) < 0; };
    if (std::none_of(part_[0].corner.begin(), part_[0].corner.end(), below)) continue;
    keep(
        region_, [&](Vec2 x) { return depth_of(true, j, x); }, work_);
    region_.swap(work_);
  }
}

// The sides that are the nearest way out somewhere in the overlap, and the one that is it for most of it.
bool PartsMeeting::take_nearest(bool of_b, std::vector<int>& sides, size_t& main) const {
  const PartNow& own = part(of_b);
  sides.clear(), low_.assign(own.size(), kAll), middle_.assign(own.size(), kAll);
  double best = kAll;
  double tied = kAll;  // depth of all of the overlap below a side that a third block ties
  for (size_t k = 0; k < own.size(); ++k) {
    if (own.role_of(k) == SideRole::kCut) continue;
    double high = -kAll, sum = 0;
    for (const Vec2 x : region_) {
      const double depth = depth_of(of_b, k, x);
      low_[k] = std::min(low_[k], depth), high = std::max(high, depth), sum += depth;
    }
    if (own.role_of(k) == SideRole::kTied) {
      tied = std::min(tied, high), low_[k] = kAll;
      continue;
    }
    middle_[k] = sum, best = std::min(best, high);
  }
  // all of it lies at a glued crossing, with no way out but the far sides: left to the bonds around it
  if (*std::min_element(low_.begin(), low_.end()) > tied) return false;
  main = 0;
  for (int k = 0; k < count_of(own); ++k) {
    if (!(low_[k] < best)) continue;
    if (!sides.empty() && middle_[k] < middle_[sides[main]]) main = sides.size();
    sides.push_back(k);
  }
  return !sides.empty();
}

// What of a polygon is nearest to one of the sides (theory 3.2). Between neighbours the bisector goes through
// their common corner, which is exact where they are nearly in line too.
void PartsMeeting::keep_nearest(bool of_b, const std::vector<int>& sides, size_t which, const Polygon& from,
                                Polygon& out) const {
  const PartNow& own = part(of_b);
  const int n = count_of(own), j = sides[which];
  out = from;
  for (size_t i = 0; i < sides.size() && !out.empty(); ++i) {
    if (i == which) continue;
    const int k = sides[i];
    const bool next = k == (j + 1) % n, before = j == (k + 1) % n;
    if (next || before) {
      const Vec2 at = corner(of_b, next ? k : j), way = own.along[j] + own.along[k];
      const double sign = next ? -1 : 1;
      keep(
          out, [&](Vec2 x) { return sign * dot(way, x - at); }, work_);
    } else {
      // of sides in line those between them tell which is nearer
      if (dot(own.along[j], own.along[k]) > 0 && std::abs(cross(own.along[j], own.along[k])) <= kOneSide)
        continue;
      keep(
          out, [&](Vec2 x) { return depth_of(of_b, k, x) - depth_of(of_b, j, x); }, work_);
    }
    out.swap(work_);
  }
}

SideCell PartsMeeting::cell(bool of_b, int side, double area, Vec2 first) const {
  return {side, area, first, cross(part(of_b).along[side], first - area * corner(of_b, side))};
}

// Cells of all sides, the largest as what the others leave.
void PartsMeeting::cells_by_rest(bool of_b, size_t main, std::vector<SideCell>& out) {
  const std::vector<int>& sides = of_b ? near_b_ : near_a_;
  out.clear();
  const Moments all = moments(region_);
  double area = all.area;
  Vec2 first = all.first;
  for (size_t i = 0; i < sides.size(); ++i) {
    if (i == main) continue;
    keep_nearest(of_b, sides, i, region_, cell_);
    const Moments m = moments(cell_);
    if (!(m.area > 0)) continue;
    area -= m.area, first -= m.first;
    out.push_back(cell(of_b, sides[i], m.area, m.first));
  }
  if (area > 0) out.push_back(cell(of_b, sides[main], area, first));
  bearing_ = region_;
  met_.area = all.area;
}

bool PartsMeeting::any_tied() const {
  const auto tied = [](const PartNow& p, const std::vector<int>& sides) {
    return std::any_of(sides.begin(), sides.end(),
                       [&](int k) { return p.role_of(k) == SideRole::kTiedHere; });
  };
  return tied(part_[0], near_a_) || tied(part_[1], near_b_);
}

// Cells of both, each cut by those of the other: what is nearest to a tie of the two bears nothing.
void PartsMeeting::nested_cells() {
  corners_.clear();
  for (size_t i = 0; i < near_a_.size(); ++i) {
    if (part_[0].role_of(near_a_[i]) == SideRole::kTiedHere) continue;
    keep_nearest(false, near_a_, i, region_, cell_);
    for (size_t j = 0; j < near_b_.size() && !cell_.empty(); ++j) {
      if (part_[1].role_of(near_b_[j]) == SideRole::kTiedHere) continue;
      keep_nearest(true, near_b_, j, cell_, cell_of_cell_);
      const Moments m = moments(cell_of_cell_);
      if (!(m.area > 0)) continue;
      const size_t begin = corners_.size(), which = nested_.size();
      corners_.insert(corners_.end(), cell_of_cell_.begin(), cell_of_cell_.end());
      nested_.push_back({cell(false, near_a_[i], m.area, m.first), cell(true, near_b_[j], m.area, m.first),
                         begin, corners_.size(), which});
      put_with_neighbours(which);
    }
  }
}

// A piece is what hangs together, cells that have a place in common, and is called by the first of them. Force, moment and
// energy are sums over cells, whatever pieces these make: they go on without a jump where two pieces come to touch. What
// jumps there is bounded: the stiffness by as much as the two chords are not in line (in line k b and k b^3/12 of the whole
// are those of its pieces), friction by as much as the two forces are not.
void PartsMeeting::put_with_neighbours(size_t cell) {
  for (size_t other = 0; other < cell; ++other) {
    const auto [first, second] = std::minmax(nested_[cell].piece, nested_[other].piece);
    if (first == second || !share_a_place(cell, other)) continue;
    for (NestedCell& c : nested_)
      if (c.piece == second) c.piece = first;
  }
}

// Two convex cells beside each other do so where a corner of one lies on the other.
bool PartsMeeting::share_a_place(size_t cell, size_t other) const {
  const auto on = [this](const NestedCell& c, const NestedCell& o) {
    for (size_t i = c.begin; i < c.end; ++i)
      for (size_t k = o.begin; k < o.end; ++k)
        if (distance_to_segment(corners_[i], corners_[k], corners_[k + 1 == o.end ? o.begin : k + 1]) <=
            rounding_)
          return true;
    return false;
  };
  return on(nested_[cell], nested_[other]) || on(nested_[other], nested_[cell]);
}

// Resultant, moment and energy of the cells; chord and closures (eqs. 3.2 to 3.4).
bool PartsMeeting::sum_up() {
  if (!(met_.area > 0)) return false;
  Vec2 centre;
  for (const SideCell& c : met_.cells_b) centre += c.first;
  centre = centre / met_.area;
  Vec2 force;
  double moment = 0;
  met_.energy = 0;
  const auto add = [&](bool of_b, const std::vector<SideCell>& cells, int& side) {
    double most = 0;
    side = -1;
    for (const SideCell& c : cells) {
      const Vec2 out = (of_b ? 0.5 : -0.5) * turn_right(part(of_b).along[c.side]);
      force += c.area * out, moment += cross(c.first - c.area * centre, out);
      met_.energy += 0.5 * c.depth;
      if (c.area > most) most = c.area, side = c.side;
    }
  };
  add(true, met_.cells_b, met_.side_b), add(false, met_.cells_a, met_.side_a);
  met_.force = norm(force);
  // an overlap that its sides push both ways alike has no direction
  if (!(met_.force > 0)) return false;
  met_.normal = force / met_.force;
  const Vec2 t = turn_right(met_.normal);
  double low = kAll, high = -kAll;
  for (const Vec2 x : bearing_)
    low = std::min(low, dot(t, x - centre)), high = std::max(high, dot(t, x - centre));
  const double b = high - low, at = moment / met_.force - low, m = std::clamp(at, 0.0, b);
  // what is left beside ties may be a sliver of rounding, which would be stiffer than all else
  if (!(b > rounding_)) return false;
  met_.beyond = at != m;
  met_.across[0] = met_.across[1] = 0;
  met_.begin = centre + low * t, met_.end = centre + high * t;
  const double per = 2 * met_.force / (b * b);
  met_.closure[0] = per * (2 * b - 3 * m), met_.closure[1] = per * (3 * m - b);
  return true;
}

const PartsMet& PartsMeeting::look(const PartNow& a, const PartNow& b, Vec2 shift, double margin,
                                   double rounding, const LookFirst& first) {
  part_[0] = a, part_[1] = b, origin_[1] = shift, rounding_ = rounding, behind_ = first.behind;
  is_strip_ = first.strip && first.way > 0 && first.way <= count_of(b) && measure_strip(true, first.way - 1);
  if (is_strip_)
    met_.kind = PartsMet::kOverlap;
  else if (first.near[0] != 0)
    find_near_ways(first.near, margin);
  else
    find_ways(margin);
  return met_;
}

bool PartsMeeting::measure_overlap() {
  nested_.clear(), next_piece_ = 0;
  met_.beside_tie = false;
  if (!is_strip_) {
    const Way* best = &ways_.front();
    for (const Way& w : ways_)
      if (w.gap > best->gap) best = &w;
    is_strip_ = measure_strip(best->of_b, best->side);
  }
  met_.way = is_strip_ ? static_cast<int>(strip_.side[1]) + 1 : 0;
  return is_strip_ ? sum_up() : measure_cells();
}

// Whether all that the two may have in common is nearer to a side that a third block ties than to any way out, as
// take_nearest() finds of most overlaps at glued crossings: told by the other part's corners, without the overlap.
bool PartsMeeting::left_to_bonds(bool of_b) const {
  const PartNow& own = part(of_b);
  double tied = kAll, out = kAll;
  for (size_t k = 0; k < own.role.size(); ++k) {
    if (own.role[k] == SideRole::kCut) continue;
    double least = kAll, most = -kAll;
    for (size_t i = 0; i < part(!of_b).size(); ++i) {
      const double depth = depth_of(of_b, k, corner(!of_b, i));
      least = std::min(least, depth), most = std::max(most, depth);
    }
    if (own.role[k] == SideRole::kTied)
      tied = std::min(tied, most);
    else
      out = std::min(out, least);
  }
  return out > tied;
}

bool PartsMeeting::measure_cells() {
  if (left_to_bonds(false) || left_to_bonds(true)) return false;
  clip();
  size_t main_a = 0, main_b = 0;
  if (region_.empty() || !take_nearest(false, near_a_, main_a) || !take_nearest(true, near_b_, main_b))
    return false;
  if (any_tied()) {
    nested_cells();
    met_.beside_tie = true;
    return measure_next_piece();
  }
  cells_by_rest(false, main_a, met_.cells_a);
  cells_by_rest(true, main_b, met_.cells_b);
  return sum_up();
}

bool PartsMeeting::measure_next_piece() {
  for (; next_piece_ < nested_.size(); ++next_piece_) {
    met_.cells_a.clear(), met_.cells_b.clear(), bearing_.clear(), met_.area = 0;
    for (const NestedCell& c : nested_) {
      if (c.piece != next_piece_) continue;
      met_.cells_a.push_back(c.a), met_.cells_b.push_back(c.b), met_.area += c.a.area;
      for (size_t k = c.begin; k < c.end; ++k) bearing_.push_back(corners_[k]);
    }
    if (sum_up()) return ++next_piece_, true;
  }
  return false;
}

// The corners of a part that face the other, from the first along the tangent to the last.
void PartsMeeting::see_face(bool of_b) {
  const PartNow& own = part(of_b);
  const Vec2 n = met_.normal, t = turn_right(n);
  const size_t count = own.size();
  seen_.resize(count);
  size_t first = 0, last = 0;
  // of corners as far along, the one nearer to the other part: along the tangent a's face goes on counter-clockwise,
  // b's comes back
  const double towards = of_b ? -1 : 1;
  const auto nearer = [&](const Seen& x, const Seen& y) { return towards * x.n < towards * y.n; };
  Seen low{kAll, 0}, high{-kAll, 0};
  for (size_t k = 0; k < count; ++k) {
    const Vec2 place = corner(of_b, k);
    const Seen x{dot(t, place), dot(n, place)};
    if (x.s < low.s || (x.s == low.s && nearer(x, low))) low = x, first = k;
    if (x.s > high.s || (x.s == high.s && nearer(x, high))) high = x, last = k;
    seen_[k] = x;
  }
  std::vector<Seen>& face = face_[of_b];
  face.clear();
  for (size_t k = first;; k = of_b ? (k == 0 ? count : k) - 1 : (k + 1 == count ? 0 : k + 1)) {
    if (face.empty() || seen_[k].s > face.back().s) face.push_back(seen_[k]);
    if (k == last) break;
  }
  // a side along the normal is reached where it comes nearest
  if (face.size() > 2 && face[1].s - face[0].s <= rounding_) face.erase(face.begin());
  if (face.size() > 2 && face.back().s - face[face.size() - 2].s <= rounding_) face.pop_back();
}

// Gaps along the tangent wherever a corner of either face is, in order. False: the faces have no length in common.
bool PartsMeeting::see_gaps() {
  see_face(false), see_face(true);
  const double low = std::max(face_[0].front().s, face_[1].front().s),
               high = std::min(face_[0].back().s, face_[1].back().s);
  if (!(low < high)) return false;
  size_t next[2]{};  // the first corner of each face beyond the last gap
  gaps_.clear();
  const auto put = [&](double s) {
    double at[2];
    for (const size_t of_b : {0U, 1U}) {
      const std::vector<Seen>& face = face_[of_b];
      while (next[of_b] + 1 < face.size() && face[next[of_b]].s <= s) ++next[of_b];
      const Seen q = face[next[of_b]], p = next[of_b] == 0 ? q : face[next[of_b] - 1];
      at[of_b] = q.s > p.s ? p.n + std::clamp((s - p.s) / (q.s - p.s), 0.0, 1.0) * (q.n - p.n) : p.n;
    }
    const Gap gap{s, at[0] - at[1], at[0]};
    // of places that are one it is where the two are nearest that counts: a side along the normal leads away from it
    if (gaps_.empty() || s - gaps_.back().s > rounding_)
      gaps_.push_back(gap);
    else if (gap.g < gaps_.back().g)
      gaps_.back() = gap;
  };
  for (double s = low; s < high;) {
    put(s);
    const double from = s;
    s = high;
    for (const size_t of_b : {0U, 1U})
      for (size_t k = next[of_b]; k < face_[of_b].size() && face_[of_b][k].s < s; ++k)
        if (face_[of_b][k].s > from) s = face_[of_b][k].s;
  }
  put(high);
  return true;
}

// The two ends where the faces are one side each over all that they have in common, and the gap widens beyond either end
// by more than along these: closed form of what ends_along_faces() finds.
bool PartsMeeting::ends_of_sides(Gap& low, Gap& high) const {
  const Vec2 n = met_.normal, t = turn_right(n);
  const size_t side[2]{static_cast<size_t>(met_.side_a), static_cast<size_t>(met_.side_b)};
  const auto seen = [&](bool of_b, size_t k) {
    const Vec2 place = corner(of_b, k);
    return Seen{dot(t, place), dot(n, place)};
  };
  // along the tangent a's face goes on counter-clockwise, b's comes back
  const size_t next[2]{after(side[0], part_[0].size()), after(side[1], part_[1].size())};
  const Seen from[2]{seen(false, side[0]), seen(true, next[1])},
      to[2]{seen(false, next[0]), seen(true, side[1])};
  const double length[2]{to[0].s - from[0].s, to[1].s - from[1].s};
  low.s = std::max(from[0].s, from[1].s), high.s = std::min(to[0].s, to[1].s);
  const double common = high.s - low.s;
  if (!(std::min({length[0], length[1], common}) > rounding_)) return false;
  const double slope[2]{(to[0].n - from[0].n) / length[0], (to[1].n - from[1].n) / length[1]};
  for (Gap* end : {&low, &high}) {
    end->a = from[0].n + (end->s - from[0].s) * slope[0];
    end->g = end->a - (from[1].n + (end->s - from[1].s) * slope[1]);
  }
  const double least = std::abs(high.g - low.g) / common + kOneSide;
  const auto widens = [&](bool up) {
    const bool of_b = up ? to[1].s < to[0].s : from[1].s > from[0].s;  // whose side ends there
    const bool forward = of_b != up;
    const PartNow& own = part(of_b);
    const Vec2 beyond = forward ? own.along[next[of_b]] : -own.along[ahead_of(side[of_b], own.size())];
    const double on = (up ? 1 : -1) * dot(t, beyond);
    const double wider = (of_b ? -1 : 1) * (dot(n, beyond) - (up ? on : -on) * slope[!of_b]);
    return on <= 0 || wider > least * on;
  };
  return widens(false) && widens(true);
}

bool PartsMeeting::ends_along_faces(Gap& low, Gap& high) {
  if (!see_gaps()) return false;
  // the gap is convex along the tangent: on from the smallest along the flatter side
  size_t at = 0;
  for (size_t k = 1; k < gaps_.size(); ++k)
    if (gaps_[k].g < gaps_[at].g) at = k;
  const auto slope = [&](size_t from, size_t to) {
    const double more = gaps_[to].g - gaps_[from].g;
    return more > rounding_ ? more / std::abs(gaps_[to].s - gaps_[from].s) : 0;
  };
  const auto last = gaps_.size() - 1;
  const double back = at > 0 ? slope(at, at - 1) : kAll, on = at < last ? slope(at, at + 1) : kAll;
  const bool up = on <= back;
  const auto go_on = [&](size_t from, bool forward, double slope_of_all) {
    while (forward ? from < last : from > 0) {
      const size_t next = forward ? from + 1 : from - 1;
      if (slope(from, next) > slope_of_all + kOneSide) break;
      from = next;
    }
    return from;
  };
  const double flat = std::max(0.0, std::min(on, back));
  const size_t far = go_on(at, up, flat);
  // where the side is level the corner of the smallest gap may be any on it
  low = gaps_[flat <= kOneSide ? go_on(at, !up, 0) : at], high = gaps_[far];
  if (low.s > high.s) std::swap(low, high);
  return low.s < high.s;
}

bool PartsMeeting::face_ends(double reach) {
  Gap low, high;
  if (!ends_of_sides(low, high) && !ends_along_faces(low, high)) return false;
  if (const double more = high.g - low.g; std::abs(more) > reach) {
    const Gap& one = more > 0 ? low : high;
    Gap& two = more > 0 ? high : low;
    const double share = reach / std::abs(more);
    two = {one.s + share * (two.s - one.s), one.g + reach, one.a + share * (two.a - one.a)};
    if (!(low.s < high.s)) return false;
  }
  const Vec2 n = met_.normal, t = turn_right(n);
  met_.begin = low.s * t + low.a * n, met_.end = high.s * t + high.a * n;
  met_.closure[0] = -low.g, met_.closure[1] = -high.g;
  met_.across[0] = low.g, met_.across[1] = high.g;
  return true;
}

}  // namespace talus
