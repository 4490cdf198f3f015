#include "talus/corners/find.h"

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/geometry/polygon.h"

namespace talus {

namespace {

// Edges within this angle of parallel (sine) form a face.
constexpr double kParallel = 0.02;

// How far below the tangent plane the corner's own edges may dip (sine): parallel faces must pass the
// entrance condition in spite of round-off and of the strain of a step.
constexpr double kEntrance = 0.02;

// The same for sides that a corner is nearer to than to the one it lies deep behind: it came in with its own
// sides ahead of it, through one that it does not rest on.
constexpr double kDeepDip = 0.5, kDeep = 2000;  // 2 % of the smaller block

// A corner that turns by less than this (sine) lies on a straight side: a joint ends there on the other side,
// or the side belongs to two sources. It enters nothing; the corner across does.
constexpr double kFlat = 1e-4;

// Stretches of two sides longer than this many times the size of one place (5 % of the smaller block), and
// this many times the overlap, are interfaces whatever lies beside them.
constexpr double kLongStretch = 5000, kLongerThanDeep = 20;

// Height at which a neighbour is looked for beside a side, against the distance from its end: wedges of 14
// degrees.
constexpr double kWedge = 0.25;

// A short stretch keeps this share of its length, so that it has a stiffness.
constexpr double kLeastStretch = 1e-3;

// An edge that goes down from a side by less than this (sine) does not end it.
constexpr double kSteep = 0.1;

// Sides within this angle (sine) all but lie along each other.
constexpr double kNearly = 0.3;

// A block leans over a side when one of its own leaves it within this angle (sine).
constexpr double kLeaning = 0.7;

// Corners are equally sharp when the cosines of their angles differ by less.
constexpr double kBlunter = 0.05;

// Two corners that have gone into each other and are nearer than this many overlaps are one place.
constexpr double kBothIn = 5;

// Sides within this angle (sine) leave no room between them for a corner.
constexpr double kBeside = 0.5;

// Gaps beside a side up to the depth of the overlap are none, but never wider than this share of the smaller
// block.
constexpr double kMostReach = 0.05;

// Joints open by less than this share of the smaller block are closed to a corner that is not deeper in them.
constexpr double kHairGap = 2e-4;

// Whether the way from a place in a polygon to another leads out through a side that all but runs against
// `direction` (unit).
bool leaves_against(std::span<const Vec2> polygon, Vec2 from, Vec2 to, Vec2 direction) {
  const Vec2 way = to - from;
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 p = polygon[k], side = polygon[k + 1 < polygon.size() ? k + 1 : 0] - p;
    if (dot(side, direction) >= 0 || std::abs(cross(side, direction)) > kBeside * norm(side)) continue;
    const double begin = cross(way, p - from), end = cross(way, p + side - from);
    if (begin * end > 0) continue;
    if (cross(side, from - p) * cross(side, to - p) <= 0) return true;
  }
  return false;
}

// Whether a place, seen from where the centroid of a block is now, lies in the block: in the reference frame,
// in which its corners are known.
bool lies_in(const BlockSet& blocks, const State& s, int block, Vec2 at) {
  const Mat2& h = s.strain_part[block];
  const double reach = blocks.radius[block] * (1 + std::sqrt(contract(h, h)));
  if (dot(at, at) > reach * reach) return false;
  const Vec2 X = inverse(kIdentity + h) * at;
  bool inside = false;
  Vec2 p = blocks.corner({block, blocks.vertex_count(block) - 1});
  for (int v = 0; v < blocks.vertex_count(block); ++v) {
    const Vec2 q = blocks.corner({block, v});
    // X lies to the left of the edge where that crosses its height
    if ((p.y > X.y) != (q.y > X.y) && (cross(q - p, X - p) > 0) == (q.y > p.y)) inside = !inside;
    p = q;
  }
  return inside;
}

}  // namespace

void ContactSearch::Outline::take(const BlockSet& blocks, const State& state, int i) {
  block = i, count = blocks.vertex_count(i);
  corner.resize(count), edge.resize(count), length.resize(count), flat.resize(count), convex.resize(count);
  for (int v = 0; v < count; ++v) {
    const Vec2 X = blocks.corner({i, v});
    const Vec2 E = blocks.corner({i, after(v)}) - X;
    corner[v] = offset_now(state, i, X);
    edge[v] = E + state.strain_part[i] * E;
    length[v] = norm(edge[v]);
  }
  for (int v = 0; v < count; ++v) {
    const int b = before(v);
    const double turn = cross(edge[b], edge[v]);
    flat[v] = dot(edge[b], edge[v]) > 0 && std::abs(turn) <= kFlat * length[b] * length[v];
    convex[v] = turn > 0 || flat[v];
  }
}

// The first edge of the straight side that an edge belongs to.
int ContactSearch::Outline::side_of(int e) const {
  for (int steps = 0; steps < count && flat[e]; ++steps) e = before(e);
  return e;
}

// How much further than its corner `v` a straight side reaches at this depth below it: by how the other edge of the corner
// leans.
double ContactSearch::Outline::leans(int v, int side, double depth) const {
  const bool after_it = side_of(v) == side, before_it = side_of(before(v)) == side;
  if (after_it == before_it) return 0;  // a flat corner, or none of this side
  const int own = after_it ? v : before(v), other = after_it ? before(v) : v;
  const Vec2 outwards = (after_it ? -edge[own] : edge[own]) / length[own];
  const Vec2 away = (after_it ? -edge[other] : edge[other]) / length[other],
             down = turn_left(edge[own]) / length[own];
  const double sinks = dot(away, down);
  return sinks < kSteep ? 0 : depth * dot(away, outwards) / sinks;
}

// The last edge of the straight side that an edge belongs to.
int ContactSearch::Outline::last_of(int e) const {
  for (int steps = 0; steps < count && flat[after(e)]; ++steps) e = after(e);
  return e;
}

// Whether a place (an offset from the block's centroid) lies inside, or outside by no more than `tolerance`.
bool ContactSearch::Outline::holds(Vec2 place, double tolerance) const {
  bool inside = false;
  for (int k = 0; k < count; ++k) {
    const int v = k, w = after(k);
    const Vec2 p = corner[v], q = corner[w];
    if (tolerance > 0 && distance_to_segment(place, p, q) <= tolerance) return true;
    if ((p.y > place.y) != (q.y > place.y) && place.x < p.x + (place.y - p.y) / (q.y - p.y) * (q.x - p.x))
      inside = !inside;
  }
  return inside;
}

// The edge of the straight side from `first` on that has `place` (an offset from the block's centroid) beside
// it.
int ContactSearch::Outline::edge_beside(int first, Vec2 place) const {
  int e = first;
  for (int steps = 0; steps < count; ++steps) {
    const int end = after(e);
    if (!flat[end] || dot(place - corner[end], edge[e]) <= 0) break;
    e = static_cast<int>(end);
  }
  return e;
}

// Whether corner `k` can rest on a plane with outward normal n: both its edges leave upwards, by more than
// -`dip` (sine) (theory 13.6).
bool ContactSearch::Outline::may_enter(int k, Vec2 n, double dip) const {
  const int v = k, b = before(k);
  return convex[v] && !flat[v] && dot(edge[v], n) >= -dip * length[v] && -dot(edge[b], n) >= -dip * length[b];
}

// Whether edge f and edge e of another outline run against each other, within an angle (sine).
bool ContactSearch::Outline::runs_against(int f, const Outline& other, int e, double sine) const {
  return dot(edge[f], other.edge[e]) < 0 &&
         std::abs(cross(edge[f], other.edge[e])) <= sine * length[f] * other.length[e];
}

// Whether only convex corners lie between two edges, the shorter way round.
bool ContactSearch::Outline::on_convex_chain(int edge_1, int edge_2) const {
  const int forward = (edge_2 - edge_1 + count) % count;
  const int from = 2 * forward <= count ? edge_1 : edge_2, to = 2 * forward <= count ? edge_2 : edge_1;
  for (int k = from; k != to; k = after(k))
    if (!convex[after(k)]) return false;
  return true;
}

// Corner v of a comes towards edge e of b level with its end, where b's other edge there and an edge of a lie
// in one line: a slides over the joint between b and its neighbour. It touches b's other edge next, not the
// side of b (theory 13.6).
bool ContactSearch::is_flush(const BlockSet& blocks, const State& s, const Outline& a, int v,
                             const Outline& b, int e, int end) const {
  const int other = end == e ? b.before(e) : end;
  const CornerEdge over = corner_over_edge(blocks, s, {a.block, v}, {b.block, other});
  if (std::abs(over.gap) > same_) return false;
  return a.runs_against(v, b, other, kParallel) || a.runs_against(a.before(v), b, other, kParallel);
}

// Whether a corner of a that seems to lie inside edge e of b is nearer to another edge that it could enter:
// it is across a thin part of b, beside a corner of b that touches a.
bool ContactSearch::is_elsewhere(const Outline& a, int v, Vec2 place, const Outline& b, const Hit& hit,
                                 size_t first) {
  const double depth = -hit.point.gap;
  bool nearer = false;
  if (depth <= same_) return nearer;
  // it was seen to come over this edge, or the force of a corner that it has passed goes on to it
  const auto came_by = [&](const Contact& c) {
    if (c.key == hit.point.key) return true;
    if (c.key.block_a == a.block || !(c.force[0] > 0) || depth > most_reach_) return false;
    return norm(b.corner[c.key.vertex] - place) <= kBothIn * depth;
  };
  const bool deep = depth > kDeep * same_ && std::none_of(range_.known.begin(), range_.known.end(), came_by);
  for (int f = 0; f < b.count; ++f) {
    if (!a.may_enter(v, turn_right(b.edge[f]) / b.length[f], deep ? kDeepDip : kEntrance)) continue;
    // sides that the corner lies over are weighed against each other, where they are no covered ones
    if (std::any_of(hits_.begin() + first, hits_.end(), [f](const Hit& h) { return h.point.key.edge == f; }))
      continue;
    const Vec2 r = place - b.corner[f];
    const double along = std::clamp(dot(r, b.edge[f]) / (b.length[f] * b.length[f]), 0.0, 1.0);
    const double left = depth - same_ - norm(r - along * b.edge[f]);
    found_.clearance = std::min(found_.clearance, std::abs(left));
    nearer = nearer || left > 0;
  }
  return nearer;
}

// Whether x is the way out rather than y: what was in touch before, else the larger gap, or of nearly equal
// ones what is coming (theory 13.6 iv).
bool ContactSearch::is_better(const Hit& x, const Hit& y) {
  const bool x_stays = x.held && !x.covered, y_stays = y.held && !y.covered;
  if (x_stays != y_stays) return x_stays;
  // tip on corner, both in: the sharper one bears on a side of the other
  const bool tips = x.lone && y.lone && x.point.key.block_a != y.point.key.block_a;
  if (tips && std::max(x.point.gap, y.point.gap) <= same_ && std::abs(x.blunt - y.blunt) > kBlunter)
    return x.blunt < y.blunt;
  found_.clearance = std::min(found_.clearance, std::abs(std::abs(x.point.gap - y.point.gap) - same_));
  if (std::abs(x.point.gap - y.point.gap) > same_) return x.point.gap > y.point.gap;
  found_.clearance = 0;
  const double tie = 1e-3 * same_;
  // rates without rows point into what a corner slides along: they come second
  if (std::abs(x.as_before - y.as_before) > tie) return x.as_before > y.as_before;
  if (std::abs(x.expected - y.expected) > tie) return x.expected > y.expected;
  return x.point.key < y.point.key;
}

// Whether corner v of a bore on the straight side of b's edge e before, with a force or an overlap that it
// keeps (theory 13.6 i).
bool ContactSearch::was_in_touch(const Outline& a, int v, const Outline& b, int e) const {
  for (const Contact& c : range_.known) {
    if (c.key.block_a != a.block || c.key.vertex != v || c.memory == Contact::kNone) continue;
    if ((c.force[0] > 0 || c.allowed > 0) && b.side_of(c.key.edge) == b.side_of(e)) return true;
  }
  return false;
}

ContactSearch::Stretch ContactSearch::stretch_of(const Outline& a, int v, const Outline& b, int e,
                                                 Vec2 shift) const {
  Stretch out;
  const Vec2 along = b.edge[e] / b.length[e];
  for (const int f : {v, a.before(v)}) {
    if (!a.runs_against(f, b, e, kParallel)) continue;
    const int first_a = a.side_of(f), first_b = b.side_of(e);
    const Vec2 a0 = shift + a.corner[first_a], a1 = shift + a.corner[a.after(a.last_of(f))];
    const Vec2 b0 = b.corner[first_b], b1 = b.corner[b.after(b.last_of(e))];
    const double from = std::max(dot(along, b0), dot(along, a1)),
                 to = std::min(dot(along, b1), dot(along, a0));
    if (out.edge_a >= 0 && to - from <= out.length) continue;
    out = {std::max(to - from, 0.0), 0.5 * (from + to) - dot(along, b.corner[e]), f};
  }
  return out;
}

// Whether a place (an offset from the centroid of `block`) lies in a third block, in which the way `back` to
// the side of `block` that runs along `direction`, if one is given, leads out through a side along it. That
// block is noted.
bool ContactSearch::lies_in_third(const BlockSet& blocks, const State& s, int block, int other, Vec2 place,
                                  Vec2 back, Vec2 direction) {
  if (range_.neighbours == nullptr) return false;
  for (const int third : range_.neighbours->of(block)) {
    if (third == other || blocks.removed(third)) continue;
    const Vec2 at = place - (blocks.centroid[third] - blocks.centroid[block]) - s.displacement[third];
    if (!lies_in(blocks, s, third, at)) continue;
    if (norm(direction) > 0) {
      const Mat2& h = s.strain_part[third];
      outline_.clear();
      for (int k = 0; k < blocks.vertex_count(third); ++k) {
        const Vec2 X = blocks.corner({third, k});
        outline_.push_back(X + h * X);
      }
      if (!leaves_against(outline_, at, at + back, direction)) continue;
      found_.this_step_only = true;  // it may turn its sides while the place stays in it
    }
    const Vec2 arm = inverse(kIdentity + s.strain_part[block]) * (place - s.displacement[block]);
    const Cover cover{third, block > other, arm};
    if (std::find(found_.cover.begin(), found_.cover.end(), cover) == found_.cover.end())
      found_.cover.push_back(cover);
    return true;
  }
  return false;
}

bool covers(const BlockSet& blocks, const State& s, int a, int b, const Cover& cover) {
  if (blocks.removed(cover.block)) return false;
  const int of = cover.of_b ? b : a, ic = cover.block;
  const Vec2 at = (blocks.centroid[of] - blocks.centroid[ic]) + cover.at +
                  (s.displacement[of] - s.displacement[ic] + s.strain_part[of] * cover.at);
  return lies_in(blocks, s, cover.block, at);
}

// Whether a third block fills the place through which a hit would be pushed out: beside the side of b, or
// beside the antiparallel side of a, at the middle of the stretch that they share. Gaps narrower than `reach`
// hide nothing (theory 13.6 ii).
bool ContactSearch::is_covered(const BlockSet& blocks, const State& s, const Outline& a, const Outline& b,
                               Vec2 shift, const Hit& h, double reach) {
  if (range_.neighbours == nullptr) return false;
  const ContactKey& key = h.point.key;
  const Stretch stretch = stretch_of(a, key.vertex, b, key.edge, shift);
  // a block that leans over the side is kept off it only by a third one along the side
  bool leans = false;
  // two sides with an interface as good as any
  if (stretch.length > std::max(kLongStretch * same_, kLongerThanDeep * reach)) return false;
  // a corner far from the ends of the side, or one that all but lies along it and that the side beside it
  // could not hold, came in through this one, whoever stands there; in a fan of blocks it did not
  if (stretch.edge_a < 0) {
    const int v = key.vertex;
    const int first = b.side_of(key.edge), last = b.after(b.last_of(key.edge));
    const Vec2 place = shift + a.corner[v];
    const Vec2 side = b.corner[last] - b.corner[first];
    const double from = dot(side, place - b.corner[first]) / norm(side);
    const double to = norm(side) - from;
    if (std::min(from, to) > std::max(reach, most_reach_)) return false;
    const int beside = from < to ? b.before(first) : last;
    // a side of the corner that runs back along the edge, not on beyond its end
    const int e = key.edge, kb = a.before(key.vertex);
    const auto runs_back = [&](Vec2 leaving, double sine) {
      return (from < to) == (dot(leaving, b.edge[e]) > 0) &&
             std::abs(cross(leaving, b.edge[e])) <= sine * norm(leaving) * b.length[e];
    };
    const auto one_runs_back = [&](double sine) {
      return runs_back(a.edge[v], sine) || runs_back(-a.edge[kb], sine);
    };
    if (one_runs_back(kLeaning) &&
        !a.may_enter(key.vertex, turn_right(b.edge[beside]) / b.length[beside], dip_)) {
      if (one_runs_back(kNearly)) return false;
      leans = true;
    }
  }
  // before the overlap comes to be, the height over which the two lie beside each other tells what it will be
  reach = std::clamp(stretch.length, reach, std::max(reach, most_reach_));
  const int ke = key.edge;
  const double length = b.length[ke];
  const Vec2 along = b.edge[ke] / length, n = h.point.normal;
  const double foot = dot(along, shift + a.corner[key.vertex] - b.corner[ke]);
  // a corner at the surface does not reach down into a joint that stands open by a hair
  const double deep = stretch.length > 0 ? stretch.length : std::min(foot, length - foot);
  if (const double hair = kHairGap / kSamePlace * same_; deep <= hair) reach = std::max(reach, hair);
  // hair gaps are looked across; close by, a neighbour may be a thin wedge beside the end of the side
  const auto filled = [&](int block, int other, Vec2 first, Vec2 direction, double of, double at, Vec2 out) {
    const double inward = std::min(2 * same_, 0.5 * of), place = std::clamp(at, inward, of - inward);
    const Vec2 on = first + place * direction;
    const auto third = [&](double height) {
      return lies_in_third(blocks, s, block, other, on + height * out, -(height + reach) * out,
                           leans ? direction : Vec2{});
    };
    return third(reach) || third(std::min(reach, kWedge * std::min(place, of - place)));
  };
  const double middle = stretch.length > 0 ? stretch.middle : foot;
  if (filled(b.block, a.block, b.corner[ke], along, length, middle, n)) return true;
  // a neighbour may come and cover the side while the two stay as they are
  if (h.point.gap < -same_) found_.this_step_only = true;
  // corner on corner, the two share nothing yet: a block in the notch between them holds both
  if (stretch.edge_a < 0) return false;
  const int kf = stretch.edge_a;
  const Vec2 a0 = a.corner[kf], ea = a.edge[kf] / a.length[kf];
  const double at = dot(ea, b.corner[ke] + middle * along - shift - a0);
  return filled(a.block, b.block, a0, ea, a.length[kf], at, turn_right(ea));
}

// All corner-edge pairs of corners of a over edges of b. `shift` leads from the centroid of b to that of a
// (theory 13.6).
void ContactSearch::corners_over_edges(const BlockSet& blocks, const State& s, const Outline& a,
                                       const Outline& b, Vec2 shift) {
  const int ia = a.block, ib = b.block;
  for (int v = 0; v < a.count; ++v) {
    const Vec2 place = shift + a.corner[v];
    const size_t first = hits_.size();
    for (int e = 0; e < b.count; ++e) {
      // far from the line of the edge, as most are
      const Vec2 from_end = place - b.corner[e];
      const double off = -cross(b.edge[e], from_end);
      if (off > (range_.margin + same_) * b.length[e] || off < -(range_.depth + same_) * b.length[e])
        continue;
      // far beyond its ends: what comes within the look-ahead is nearer than the margin
      const double run = dot(b.edge[e], from_end), beside = 2 * (range_.margin + same_) * b.length[e];
      if (run < -beside || run > b.length[e] * b.length[e] + beside) continue;
      const CornerEdge c = corner_over_edge(blocks, s, {a.block, v}, {b.block, e});
      if (c.gap > range_.margin || c.gap < -range_.depth) continue;
      // beyond a convex end lies free space; beyond an end in a notch lies the block itself, and a corner
      // that has gone slightly into both sides of the notch is still held by both
      const double before = b.convex[e] ? same_ : range_.margin;
      const double beyond = b.convex[b.after(e)] ? same_ : range_.margin;
      const Vec2 b0 = blocks.corner({b.block, e}), b1 = blocks.corner({b.block, b.after(e)});
      const double along = std::clamp(c.along, 0.0, 1.0);
      const Vec2 foot = b0 + along * (b1 - b0);
      const Vec2 arm_a = acting_arm(blocks, s, ia, blocks.corner({a.block, v})),
                 arm_b = acting_arm(blocks, s, ib, foot);
      const auto moves = [&](const std::vector<BlockRate>& rate) {
        return velocity_at(rate[ia], arm_a) - velocity_at(rate[ib], arm_b);
      };
      const Vec2 u = moves(s.rate);
      const double expected = c.gap + range_.look_ahead * dot(c.normal, u);
      const double in_front = c.along * c.length + before, behind = beyond - (c.along - 1) * c.length;
      const bool above = in_front >= 0 && behind >= 0;
      found_.clearance = std::min({found_.clearance, std::abs(in_front), std::abs(behind)});
      // a corner that comes past the end of an edge and would be inside the block after the
      // look-ahead: corner runs into corner
      const double along_then = c.along + range_.look_ahead * dot(turn_left(c.normal), u) / c.length;
      const bool comes_in = c.gap > -same_ && expected < 0 && along_then >= 0 && along_then <= 1;
      if (!above && !comes_in) continue;
      if (!a.may_enter(v, c.normal, dip_)) continue;
      const bool held = was_in_touch(a, v, b, e);
      // behind the line of an edge, and yet not in the block: beyond another of its sides
      if (!held && c.gap < -kDeep * same_ && !b.holds(place, same_)) continue;
      found_.this_step_only = found_.this_step_only || !above;
      Hit hit;
      hit.point.key = {a.block, v, b.block, e};
      hit.point.normal = c.normal;
      hit.point.arm_a = blocks.corner({a.block, v});
      hit.point.arm_b = foot;
      hit.point.gap = c.gap;
      hit.point.slip = -c.along * norm(b1 - b0);  // in the material of b: stretching is no slip
      hit.expected = expected;
      const int kb = a.before(v);
      hit.lone = !a.runs_against(v, b, e, kParallel) && !a.runs_against(a.before(v), b, e, kParallel);
      hit.blunt = dot(a.edge[kb], a.edge[v]) / (a.length[kb] * a.length[v]);
      hit.as_before =
          c.gap + range_.look_ahead * dot(c.normal, moves(range_.before ? *range_.before : s.rate));
      hit.coming = !above;
      hit.held = held;
      if (c.along * c.length < same_) hit.at_corner = e;
      if ((1 - c.along) * c.length < same_) hit.at_corner = b.after(e);
      if (hit.at_corner >= 0) found_.clearance = 0;
      hit.apart = hit.at_corner >= 0 && c.gap > same_ && is_flush(blocks, s, a, v, b, e, hit.at_corner);
      hits_.push_back(hit);
    }
    // the far side of a thin tip is no overlap
    double reach = same_;
    for (size_t i = first; i < hits_.size(); ++i)
      if (-hits_[i].point.gap <= most_reach_) reach = std::max(reach, -hits_[i].point.gap);
    for (size_t i = first; i < hits_.size(); ++i)
      hits_[i].covered = is_covered(blocks, s, a, b, shift, hits_[i], reach);
    // both are asked with all hits in their places
    out_.assign(hits_.size() - first, 0);
    for (size_t i = first; i < hits_.size(); ++i)
      out_[i - first] = !hits_[i].held && (hits_[i].covered || is_elsewhere(a, v, place, b, hits_[i], first));
    // one that stays on a covered side goes as soon as it bears no force
    for (size_t i = first; i < hits_.size(); ++i)
      found_.this_step_only = found_.this_step_only || (hits_[i].held && hits_[i].covered);
    size_t kept = first;
    for (size_t i = first; i < hits_.size(); ++i)
      if (!out_[i - first]) hits_[kept++] = hits_[i];
    hits_.resize(kept);
    // where b is convex the corner obeys one edge, the one it is least behind
    for (size_t i = first; i < hits_.size(); ++i) {
      for (size_t j = i + 1; j < hits_.size();) {
        if (!b.on_convex_chain(hits_[i].point.key.edge, hits_[j].point.key.edge)) {
          ++j;
          continue;
        }
        if (is_better(hits_[j], hits_[i])) std::swap(hits_[i], hits_[j]);
        hits_.erase(hits_.begin() + j);
      }
    }
  }
}

// Where corner of a meets corner of b there may be hits both ways; one stays (theory 13.6 iv).
void ContactSearch::merge_corner_pairs(const Outline& a, const Outline& b, Vec2 shift) {
  // a tip and the corner that it went in beside, each in the other
  const auto both_in = [&](const Hit& x, const Hit& y) {
    const ContactKey &p = x.point.key, &q = y.point.key;
    if (!x.lone || !y.lone || p.block_a == q.block_a || x.point.gap >= 0 || y.point.gap >= 0) return false;
    const bool first = p.block_a == a.block;
    const Vec2 place_x = (first ? shift : Vec2{}) + (first ? a : b).corner[p.vertex];
    const Vec2 place_y = (first ? Vec2{} : shift) + (first ? b : a).corner[q.vertex];
    return norm(place_x - place_y) <= -kBothIn * std::min(x.point.gap, y.point.gap);
  };
  // the corners at one end of two antiparallel sides, each over the side of the other: where these stand apart like a wedge the
  // corners pass each other by its height times its angle
  const auto one_end = [&](const Hit& x, const Hit& y) {
    const ContactKey &p = x.point.key, &q = y.point.key;
    if (p.block_a != q.block_b || x.coming || y.coming) return false;
    const bool first = p.block_a == a.block;
    const Outline &on_x = first ? a : b, &on_y = first ? b : a;
    const int side_x = on_x.side_of(q.edge), side_y = on_y.side_of(p.edge);
    const bool x_begins = side_x == on_x.side_of(p.vertex), y_begins = side_y == on_y.side_of(q.vertex);
    const bool x_ends = side_x == on_x.side_of(on_x.before(p.vertex)),
               y_ends = side_y == on_y.side_of(on_y.before(q.vertex));
    // of a short overlap they are the two ends
    if (!(x_begins && y_ends) && !(x_ends && y_begins)) return false;
    if (!on_x.runs_against(q.edge, on_y, p.edge, dip_)) return false;
    const int kx = q.edge, ky = p.edge;
    const double angle = std::abs(cross(on_x.edge[kx], on_y.edge[ky])) / (on_x.length[kx] * on_y.length[ky]);
    const Vec2 apart = (first ? shift : -shift) + on_x.corner[p.vertex] - on_y.corner[q.vertex];
    const double wedge = angle * std::max(std::abs(x.point.gap), std::abs(y.point.gap));
    return std::abs(dot(apart, on_y.edge[ky])) <= (2 * same_ + wedge) * on_y.length[ky];
  };
  const auto same_place = [&](const Hit& x, const Hit& y) {
    if (both_in(x, y) || one_end(x, y)) return true;
    if (x.at_corner < 0 || y.at_corner < 0) return false;
    const ContactKey &p = x.point.key, &q = y.point.key;
    const Outline& owner = p.block_b == a.block ? a : b;
    // a corner in a notch rests on both sides of it
    return (p.block_a == q.block_a && p.vertex == q.vertex && x.at_corner == y.at_corner &&
            owner.convex[x.at_corner]) ||
           (p.block_a == q.block_b && p.vertex == y.at_corner && q.vertex == x.at_corner);
  };
  for (size_t i = 0; i < hits_.size(); ++i) {
    for (size_t j = i + 1; j < hits_.size();) {
      if (!same_place(hits_[i], hits_[j])) {
        ++j;
        continue;
      }
      if (is_better(hits_[j], hits_[i])) hits_[i] = hits_[j];
      hits_.erase(hits_.begin() + j);
    }
  }
}

// The pairs of antiparallel straight sides whose overlap a hit may end.
void ContactSearch::spans_of(const Outline& a, const Outline& b, const Hit& h,
                             std::vector<Span>& list) const {
  list.clear();
  const ContactKey& k = h.point.key;
  const Outline &on_a = k.block_a == a.block ? a : b, &on_b = k.block_a == a.block ? b : a;
  int eb[2] = {k.edge, -1};
  if (h.at_corner >= 0 && on_b.convex[h.at_corner])
    eb[1] = h.at_corner == k.edge ? on_b.before(k.edge) : on_b.after(k.edge);
  for (const int e : eb) {
    if (e < 0) continue;
    for (const int f : {k.vertex, on_a.before(k.vertex)}) {
      if (!on_a.runs_against(f, on_b, e, dip_)) continue;
      const int side_a = on_a.side_of(f), side_b = on_b.side_of(e);
      const Span span = k.block_a < k.block_b ? Span{side_a, side_b} : Span{side_b, side_a};
      if (std::find(list.begin(), list.end(), span) == list.end()) list.push_back(span);
    }
  }
}

// Two points that end the overlap of the same two antiparallel sides share its length. `shift` leads from the
// centroid of b to that of a (theory 13.6, interfaces).
void ContactSearch::share_faces(const Outline& a, const Outline& b, Vec2 shift) {
  if (spans_.size() < hits_.size()) spans_.resize(hits_.size());
  for (size_t i = 0; i < hits_.size(); ++i) spans_of(a, b, hits_[i], spans_[i]);
  const Outline &lo = a.block < b.block ? a : b, &hi = a.block < b.block ? b : a;
  const Vec2 lo_to_hi = a.block < b.block ? -shift : shift;
  // place of a hit's corner, seen from the lower block
  const auto place = [&](const Hit& h) {
    const ContactKey& k = h.point.key;
    const int v = k.vertex;
    return k.block_a == lo.block ? lo.corner[v] : hi.corner[v] + lo_to_hi;
  };
  for (int i = 0; i < count_of(hits_); ++i) {
    for (size_t j = i + 1; j < hits_.size(); ++j) {
      // the overlap is that of now: a corner beside it must not take the place of the end that it follows
      if (hits_[i].coming || hits_[j].coming) continue;
      for (const Span& span : spans_[i]) {
        if (std::find(spans_[j].begin(), spans_[j].end(), span) == spans_[j].end()) continue;
        ContactPoint &x = hits_[i].point, &y = hits_[j].point;
        const Vec2 px = place(hits_[i]), py = place(hits_[j]), middle = 0.5 * (px + py);
        const int side = span.side_lo;
        double length = std::abs(dot(px - py, lo.edge[side])) / lo.length[side];
        // two corners that have gone into each other: what they share ends where their other edges cross it
        if (const double deep = -0.5 * (x.gap + y.gap); length < kLongerThanDeep * deep) {
          double rest = length;
          for (const ContactPoint* end : {&x, &y}) {
            const bool of_lo = end->key.block_a == lo.block;
            rest += (of_lo ? lo : hi).leans(end->key.vertex, of_lo ? span.side_lo : span.side_hi, 0.5 * deep);
          }
          length = std::max(rest, kLeastStretch * length);
          found_.this_step_only = true;
        }
        // one partner each; what is left of a face whose other end has one goes to the free end
        const bool both = x.partner < 0 && y.partner < 0;
        if (both) {
          x.partner = static_cast<int>(j), y.partner = i;
          x.length = y.length = 0.5 * length;
          const bool first = dot(lo.edge[side], py - px) > 0;
          x.face = {span.side_lo, span.side_hi, first ? 0 : 1};
          y.face = {span.side_lo, span.side_hi, first ? 1 : 0};
        } else if (x.partner < 0 || y.partner < 0) {
          (x.partner < 0 ? x : y).length += 0.5 * length;
        }
        // both ends name the same edges: those beside the middle of the face
        const int edge_lo = lo.edge_beside(span.side_lo, middle);
        const int edge_hi = hi.edge_beside(span.side_hi, middle - lo_to_hi);
        for (ContactPoint* h : {&x, &y}) {
          if (h->face_edge_a >= 0 && !both) continue;  // its own face, not that of a third point
          h->face_edge_a = h->key.block_a == lo.block ? edge_lo : edge_hi;
          h->face_edge_b = h->key.block_a == lo.block ? edge_hi : edge_lo;
        }
      }
    }
  }
}

const Found& ContactSearch::touch(const BlockSet& blocks, const State& state, int a, int b,
                                  const SearchRange& range) {
  TALUS_ASSERT(a != b && range.margin >= 0);
  range_ = range;
  same_ = kSamePlace * std::min(blocks.size[a], blocks.size[b]);
  most_reach_ = kMostReach / kSamePlace * same_;
  // what turns within the look-ahead may be in the way before it is seen to
  const Mat2 turning = state.rate[a].G - state.rate[b].G;
  dip_ = kEntrance + range.look_ahead * std::sqrt(contract(turning, turning));
  found_.points.clear(), found_.cover.clear();
  found_.clearance = range.margin;
  found_.this_step_only = false;
  hits_.clear();
  first_.take(blocks, state, a);
  second_.take(blocks, state, b);
  const auto none_flat = [](const Outline& o) {
    return std::find(o.flat.begin(), o.flat.end(), 1) == o.flat.end();
  };
  found_.plain = none_flat(first_) && none_flat(second_);
  const Vec2 shift = blocks.centroid[a] - blocks.centroid[b];
  corners_over_edges(blocks, state, first_, second_, shift);
  corners_over_edges(blocks, state, second_, first_, -shift);
  merge_corner_pairs(first_, second_, shift);
  // they kept the two corners apart, whichever edge was to hold them; they hold nothing themselves
  std::erase_if(hits_, [](const Hit& h) { return h.apart; });
  std::sort(hits_.begin(), hits_.end(), [](const Hit& x, const Hit& y) { return x.point.key < y.point.key; });
  share_faces(first_, second_, shift);
  for (const Hit& h : hits_) found_.points.push_back(h.point);
  return found_;
}

void touch_blocks(const BlockSet& blocks, const State& state, int a, int b, double margin,
                  std::vector<ContactPoint>& out, double look_ahead) {
  SearchRange range;
  range.margin = range.depth = margin, range.look_ahead = look_ahead;
  ContactSearch search;
  const auto& points = search.touch(blocks, state, a, b, range).points;
  out.insert(out.end(), points.begin(), points.end());
}

}  // namespace talus
