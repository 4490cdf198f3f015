#include "talus/contact/find.h"

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

// Two corners closer than this share of the smaller block are one place.
constexpr double kSamePlace = 1e-6;

// Edges within this angle of parallel (sine) form a face.
constexpr double kParallel = 0.02;

// How far below the tangent plane the corner's own edges may dip (sine): parallel faces must pass the
// entrance condition in spite of round-off and of the strain of a step.
constexpr double kEntrance = 0.02;

Vec2 edge_vector(const BlockSet& blocks, const State& s, int block, int k) {
  const int n = blocks.vertex_count(block);
  const Vec2 e = blocks.corner(block, (k + 1) % n) - blocks.corner(block, k);
  return e + s.strain_part[static_cast<size_t>(block)] * e;
}

// A corner that turns by less than this (sine) lies on a straight side: a joint ends there on the other side,
// or the side belongs to two sources. It enters nothing; the corner across does.
constexpr double kFlat = 1e-4;

bool is_flat(const BlockSet& blocks, const State& s, int block, int k) {
  const int n = blocks.vertex_count(block);
  const Vec2 in = edge_vector(blocks, s, block, (k + n - 1) % n), out = edge_vector(blocks, s, block, k);
  return dot(in, out) > 0 && std::abs(cross(in, out)) <= kFlat * norm(in) * norm(out);
}

bool is_convex(const BlockSet& blocks, const State& s, int block, int k) {
  const int n = blocks.vertex_count(block);
  return cross(edge_vector(blocks, s, block, (k + n - 1) % n), edge_vector(blocks, s, block, k)) > 0 ||
         is_flat(blocks, s, block, k);
}

// The first edge of the straight side that an edge belongs to.
int side_of(const BlockSet& blocks, const State& s, int block, int edge) {
  const int n = blocks.vertex_count(block);
  for (int steps = 0; steps < n && is_flat(blocks, s, block, edge); ++steps) edge = (edge + n - 1) % n;
  return edge;
}

// The edge of the straight side from `first` on that has `place` (an offset from the block's centroid) beside
// it.
int edge_beside(const BlockSet& blocks, const State& s, int block, int first, Vec2 place) {
  const int n = blocks.vertex_count(block);
  int edge = first;
  for (int steps = 0; steps < n; ++steps) {
    const int end = (edge + 1) % n;
    const Vec2 beyond = place - offset_now(s, static_cast<size_t>(block), blocks.corner(block, end));
    if (!is_flat(blocks, s, block, end) || dot(beyond, edge_vector(blocks, s, block, edge)) <= 0) break;
    edge = end;
  }
  return edge;
}

// Whether corner `k` can rest on a plane with outward normal n: both its edges leave upwards.
bool may_enter(const BlockSet& blocks, const State& s, int block, int k, Vec2 n) {
  const int m = blocks.vertex_count(block);
  const Vec2 out = edge_vector(blocks, s, block, k), back = -edge_vector(blocks, s, block, (k + m - 1) % m);
  return !is_flat(blocks, s, block, k) && cross(-back, out) > 0 && dot(out, n) >= -kEntrance * norm(out) &&
         dot(back, n) >= -kEntrance * norm(back);
}

// Whether only convex corners lie between two edges of a block, the shorter way round.
bool on_convex_chain(const BlockSet& blocks, const State& s, int block, int edge_1, int edge_2) {
  const int n = blocks.vertex_count(block);
  const int forward = (edge_2 - edge_1 + n) % n;
  const int from = 2 * forward <= n ? edge_1 : edge_2, to = 2 * forward <= n ? edge_2 : edge_1;
  for (int k = from; k != to; k = (k + 1) % n)
    if (!is_convex(blocks, s, block, (k + 1) % n)) return false;
  return true;
}

// Corner v of a comes towards edge e of b level with its end, where b's other edge there and an edge of a lie
// in one line: a slides over the joint between b and its neighbour. It touches b's other edge next, not the
// side of b.
bool is_flush(const BlockSet& blocks, const State& s, int a, int v, int b, int e, int end, double same) {
  const int na = blocks.vertex_count(a), nb = blocks.vertex_count(b);
  const int other = end == e ? (e + nb - 1) % nb : end;
  const CornerEdge over = corner_over_edge(blocks, s, a, v, b, other);
  if (std::abs(over.gap) > same) return false;
  const Vec2 db = edge_vector(blocks, s, b, other);
  for (const int f : {v, (v + na - 1) % na}) {
    const Vec2 da = edge_vector(blocks, s, a, f);
    if (dot(da, db) < 0 && std::abs(cross(da, db)) <= kParallel * norm(da) * norm(db)) return true;
  }
  return false;
}

struct Hit {
  ContactPoint point;
  int at_corner = -1;   // corner of b at the foot, -1 inside the edge
  double expected = 0;  // gap after the look-ahead
};

// Whether x is the way out rather than y: larger gap, or nearly equal ones by what is coming.
bool is_better(const Hit& x, const Hit& y, double same) {
  if (std::abs(x.point.gap - y.point.gap) > same) return x.point.gap > y.point.gap;
  const double tie = 1e-3 * same;
  if (std::abs(x.expected - y.expected) > tie) return x.expected > y.expected;
  return x.point.key < y.point.key;
}

// All corner-edge pairs of corners of a over edges of b.
void corners_over_edges(const BlockSet& blocks, const State& s, int a, int b, double margin, double same,
                        double look_ahead, std::vector<Hit>& hits) {
  const int na = blocks.vertex_count(a), nb = blocks.vertex_count(b);
  for (int v = 0; v < na; ++v) {
    const size_t first = hits.size();
    for (int e = 0; e < nb; ++e) {
      const CornerEdge c = corner_over_edge(blocks, s, a, v, b, e);
      // beyond a convex end lies free space; beyond an end in a notch lies the block itself, and a corner
      // that has gone slightly into both sides of the notch is still held by both
      const double before = is_convex(blocks, s, b, e) ? same : margin;
      const double beyond = is_convex(blocks, s, b, (e + 1) % nb) ? same : margin;
      if (std::abs(c.gap) > margin) continue;
      const auto ia = static_cast<size_t>(a), ib = static_cast<size_t>(b);
      const Vec2 b0 = blocks.corner(b, e), b1 = blocks.corner(b, (e + 1) % nb);
      const double along = std::clamp(c.along, 0.0, 1.0);
      const Vec2 foot = b0 + along * (b1 - b0);
      const Vec2 u = velocity_at(s.rate[ia], acting_arm(blocks, s, ia, blocks.corner(a, v))) -
                     velocity_at(s.rate[ib], acting_arm(blocks, s, ib, foot));
      const double expected = c.gap + look_ahead * dot(c.normal, u);
      const bool above = c.along * c.length >= -before && (c.along - 1) * c.length <= beyond;
      // a corner that comes past the end of an edge and would be inside the block after the look-ahead:
      // corner runs into corner
      const double along_then = c.along + look_ahead * dot(turn_left(c.normal), u) / c.length;
      const bool comes_in = c.gap > -same && expected < 0 && along_then >= 0 && along_then <= 1;
      if (!above && !comes_in) continue;
      if (!may_enter(blocks, s, a, v, c.normal)) continue;
      Hit hit;
      hit.point.key = {a, v, b, e};
      hit.point.normal = c.normal;
      hit.point.arm_a = blocks.corner(a, v);
      hit.point.arm_b = foot;
      hit.point.gap = c.gap;
      hit.point.slip = -c.along * norm(b1 - b0);  // in the material of b: stretching is no slip
      hit.expected = expected;
      if (c.along * c.length < same) hit.at_corner = e;
      if ((1 - c.along) * c.length < same) hit.at_corner = (e + 1) % nb;
      if (hit.at_corner >= 0 && c.gap > same && is_flush(blocks, s, a, v, b, e, hit.at_corner, same))
        continue;
      hits.push_back(hit);
    }
    // where b is convex the corner obeys one edge, the one it is least behind
    for (size_t i = first; i < hits.size(); ++i) {
      for (size_t j = i + 1; j < hits.size();) {
        if (!on_convex_chain(blocks, s, b, hits[i].point.key.edge, hits[j].point.key.edge)) {
          ++j;
          continue;
        }
        if (is_better(hits[j], hits[i], same)) std::swap(hits[i], hits[j]);
        hits.erase(hits.begin() + static_cast<std::ptrdiff_t>(j));
      }
    }
  }
}

// Where corner of a meets corner of b there may be hits both ways; one stays.
void merge_corner_pairs(const BlockSet& blocks, const State& s, double same, std::vector<Hit>& hits) {
  const auto same_place = [&](const Hit& x, const Hit& y) {
    if (x.at_corner < 0 || y.at_corner < 0) return false;
    const ContactKey &p = x.point.key, &q = y.point.key;
    // a corner in a notch rests on both sides of it
    return (p.block_a == q.block_a && p.vertex == q.vertex && x.at_corner == y.at_corner &&
            is_convex(blocks, s, p.block_b, x.at_corner)) ||
           (p.block_a == q.block_b && p.vertex == y.at_corner && q.vertex == x.at_corner);
  };
  for (size_t i = 0; i < hits.size(); ++i) {
    for (size_t j = i + 1; j < hits.size();) {
      if (!same_place(hits[i], hits[j])) {
        ++j;
        continue;
      }
      if (is_better(hits[j], hits[i], same)) hits[i] = hits[j];
      hits.erase(hits.begin() + static_cast<std::ptrdiff_t>(j));
    }
  }
}

// Two points become the ends of one face of the sides given (of the lower and the higher block id).
void make_face(const BlockSet& blocks, const State& s, int side_lo, int side_hi, ContactPoint& x,
               ContactPoint& y) {
  const auto place = [&](const ContactPoint& h, int block) {
    const auto a = static_cast<size_t>(h.key.block_a);
    return (blocks.centroid[a] - blocks.centroid[static_cast<size_t>(block)]) + offset_now(s, a, h.arm_a);
  };
  const int lo = std::min(x.key.block_a, x.key.block_b), hi = std::max(x.key.block_a, x.key.block_b);
  const double length = norm(place(x, lo) - place(y, lo));
  x.length += 0.5 * length, y.length += 0.5 * length;
  x.partner = y.key, y.partner = x.key;
  // both ends name the same edges: those beside the middle of the face
  const int edge_lo = edge_beside(blocks, s, lo, side_lo, 0.5 * (place(x, lo) + place(y, lo)));
  const int edge_hi = edge_beside(blocks, s, hi, side_hi, 0.5 * (place(x, hi) + place(y, hi)));
  for (ContactPoint* h : {&x, &y}) {
    h->face_edge_a = h->key.block_a == lo ? edge_lo : edge_hi;
    h->face_edge_b = h->key.block_a == lo ? edge_hi : edge_lo;
  }
}

// Two points that end the overlap of the same two antiparallel edges share its length.
void share_faces(const BlockSet& blocks, const State& s, std::vector<Hit>& hits) {
  struct Span {
    int side_lo, side_hi;  // straight sides of the lower and the higher block id
    bool operator==(const Span&) const = default;
  };
  // the sides of a's corner that may lie on b's side
  const auto faces_of = [&](const Hit& h) {
    std::vector<Span> list;
    const ContactKey& k = h.point.key;
    const int na = blocks.vertex_count(k.block_a), nb = blocks.vertex_count(k.block_b);
    std::vector<int> eb{k.edge};
    if (h.at_corner >= 0 && is_convex(blocks, s, k.block_b, h.at_corner))
      eb.push_back(h.at_corner == k.edge ? (k.edge + nb - 1) % nb : (k.edge + 1) % nb);
    for (const int e : eb) {
      const Vec2 db = edge_vector(blocks, s, k.block_b, e);
      for (const int f : {k.vertex, (k.vertex + na - 1) % na}) {
        const Vec2 da = edge_vector(blocks, s, k.block_a, f);
        if (std::abs(cross(da, db)) > kParallel * norm(da) * norm(db) || dot(da, db) > 0) continue;
        const int side_a = side_of(blocks, s, k.block_a, f), side_b = side_of(blocks, s, k.block_b, e);
        const Span span = k.block_a < k.block_b ? Span{side_a, side_b} : Span{side_b, side_a};
        if (std::find(list.begin(), list.end(), span) == list.end()) list.push_back(span);
      }
    }
    return list;
  };
  std::vector<std::vector<Span>> faces;
  for (const Hit& h : hits) faces.push_back(faces_of(h));
  for (size_t i = 0; i < hits.size(); ++i) {
    for (size_t j = i + 1; j < hits.size(); ++j) {
      for (const Span& p : faces[i]) {
        if (std::find(faces[j].begin(), faces[j].end(), p) == faces[j].end()) continue;
        make_face(blocks, s, p.side_lo, p.side_hi, hits[i].point, hits[j].point);
      }
    }
  }
}

}  // namespace

CornerEdge corner_over_edge(const BlockSet& blocks, const State& state, int a, int vertex, int b, int edge) {
  const auto ia = static_cast<size_t>(a), ib = static_cast<size_t>(b);
  const Vec2 Xa = blocks.corner(a, vertex), Xb = blocks.corner(b, edge);
  // the difference of reference places first, then the difference of displacements: both small
  const Vec2 reference = (blocks.centroid[ia] - blocks.centroid[ib]) + (Xa - Xb);
  const Vec2 r = reference + (displacement_at(state, ia, Xa) - displacement_at(state, ib, Xb));
  const Vec2 e = edge_vector(blocks, state, b, edge);
  const double length = norm(e);
  const Vec2 n = turn_right(e) / length;
  return {dot(n, r), dot(r, e) / (length * length), length, n};
}

void touch_blocks(const BlockSet& blocks, const State& state, int a, int b, double margin,
                  std::vector<ContactPoint>& out, double look_ahead) {
  const double same =
      kSamePlace * std::min(blocks.size[static_cast<size_t>(a)], blocks.size[static_cast<size_t>(b)]);
  std::vector<Hit> hits;
  corners_over_edges(blocks, state, a, b, margin, same, look_ahead, hits);
  corners_over_edges(blocks, state, b, a, margin, same, look_ahead, hits);
  merge_corner_pairs(blocks, state, same, hits);
  share_faces(blocks, state, hits);
  std::sort(hits.begin(), hits.end(), [](const Hit& x, const Hit& y) { return x.point.key < y.point.key; });
  for (const Hit& h : hits) out.push_back(h.point);
}

bool CandidateFinder::still_valid(const BlockSet& blocks, const State& state, double margin) const {
  if (margin_ != margin || displacement_.size() != static_cast<size_t>(blocks.count)) return false;
  for (size_t i = 0; i < displacement_.size(); ++i) {
    const Mat2 h = state.strain_part[i] - strain_part_[i];
    const double moved =
        norm(state.displacement[i] - displacement_[i]) + std::sqrt(contract(h, h)) * radius_[i];
    if (!(moved < 0.5 * skin_)) return false;
  }
  return true;
}

const std::vector<std::pair<int, int>>& CandidateFinder::pairs(const BlockSet& blocks, const State& state,
                                                               double margin) {
  if (still_valid(blocks, state, margin)) return pairs_;
  ++rebuilds_;
  margin_ = margin;
  displacement_ = state.displacement;
  strain_part_ = state.strain_part;
  radius_.assign(static_cast<size_t>(blocks.count), 0);

  double least = blocks.size.empty() ? 0 : blocks.size[0];
  for (const double s : blocks.size) least = std::min(least, s);
  skin_ = 0.1 * least;
  std::vector<Box> boxes;
  std::vector<Vec2> corners;
  const Vec2 origin = blocks.centroid[0];
  for (int i = 0; i < blocks.count; ++i) {
    const auto k = static_cast<size_t>(i);
    corners.clear();
    for (int v = 0; v < blocks.vertex_count(i); ++v) {
      corners.push_back((blocks.centroid[k] - origin) + offset_now(state, k, blocks.corner(i, v)));
      radius_[k] = std::max(radius_[k], norm(blocks.corner(i, v)));
    }
    boxes.push_back(bounding_box(corners));
  }
  pairs_ = close_pairs(boxes, margin + skin_);
  const auto idle = [&blocks](const std::pair<int, int>& p) {
    return !blocks.moves_freely(p.first) && !blocks.moves_freely(p.second);
  };
  pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), idle), pairs_.end());
  return pairs_;
}

}  // namespace talus
