#include "talus/contact/outlines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/blocks/in_situ.h"

namespace talus {

namespace {

// Sines, shares and lengths that differ by less, of what they are shares of, are the same: coordinates are rounded to
// 1e-16 of a block.
constexpr double kSame = 1e-9;

// The lines of two moved sides meet at most so many times off as they are moved by, else a cut joins their ends.
constexpr double kFarthestOff = 10;

struct NotchCut {
  size_t corner = 0, side = 0;  // from which corner, to which side
  Vec2 end;
  double length = std::numeric_limits<double>::infinity();
};

bool is_notch(const std::vector<Vec2>& p, size_t i) {
  const size_t n = p.size();
  const Vec2 e = p[i] - p[(i + n - 1) % n], f = p[(i + 1) % n] - p[i];
  return cross(e, f) < -kSame * norm(e) * norm(f);
}

// The way from a notch along the bisector into the block, to the side it meets first.
NotchCut cut_from(const std::vector<Vec2>& p, size_t i) {
  const size_t n = p.size();
  const Vec2 at = p[i], e = at - p[(i + n - 1) % n], f = p[(i + 1) % n] - at;
  const Vec2 way = e / norm(e) - f / norm(f);
  const Vec2 u = way / norm(way);
  NotchCut cut;
  for (size_t j = 0; j < n; ++j) {
    if (j == i || (j + 1) % n == i) continue;
    const Vec2 q = p[j], side = p[(j + 1) % n] - q;
    const double d = cross(u, side);
    if (d == 0) continue;
    const double t = cross(q - at, side) / d, s = cross(q - at, u) / d;
    if (t <= 0 || s < -kSame || s > 1 + kSame || t >= cut.length) continue;
    cut = {i, j, q + std::clamp(s, 0.0, 1.0) * side, t};
  }
  return cut;
}

void leave_out_double_corners(ConvexPart& part) {
  double size = 0;
  for (const Vec2 c : part.corner) size = std::max(size, norm(c - part.corner[0]));
  ConvexPart out;
  for (size_t k = 0; k < part.corner.size(); ++k) {
    if (norm(part.corner[(k + 1) % part.corner.size()] - part.corner[k]) <= kSame * size) continue;
    out.corner.push_back(part.corner[k]), out.side.push_back(part.side[k]);
  }
  part = std::move(out);
}

// Of two cuts of one length that cross, none comes first: both end where they meet.
struct Crossing {
  size_t corner = 0;  // the other notch
  Vec2 at;
  double share = 1;  // of the way along the first cut
};

Crossing crossing_of(const std::vector<Vec2>& p, const NotchCut& cut) {
  Crossing out;
  for (size_t i = 0; i < p.size(); ++i) {
    if (i == cut.corner || !is_notch(p, i)) continue;
    const NotchCut other = cut_from(p, i);
    if (!(other.length <= (1 + kSame) * cut.length)) continue;
    const Vec2 u = cut.end - p[cut.corner], v = other.end - p[i], between = p[i] - p[cut.corner];
    const double d = cross(u, v), s = cross(between, v) / d, t = cross(between, u) / d;
    if (d != 0 && s > kSame && t > kSame && t < 1 - kSame && s < (1 - kSame) * out.share)
      out = {i, p[cut.corner] + s * u, s};
  }
  return out;
}

// The sides of a part from one corner to another, and back by way of a place within it.
ConvexPart piece(const ConvexPart& part, size_t from, size_t to, Vec2 by) {
  ConvexPart out;
  for (size_t k = from; k != to; k = (k + 1) % part.corner.size())
    out.corner.push_back(part.corner[k]), out.side.push_back(part.side[k]);
  out.corner.push_back(part.corner[to]), out.side.push_back({});
  out.corner.push_back(by), out.side.push_back({});
  return out;
}

void cut_on(const ConvexPart& part, int depth, std::vector<ConvexPart>& out) {
  constexpr int kDeepest = 1000;  // more notches no block has
  NotchCut best;
  for (size_t i = 0; i < part.corner.size() && depth < kDeepest; ++i)
    if (is_notch(part.corner, i))
      if (const NotchCut cut = cut_from(part.corner, i); cut.length < best.length) best = cut;
  if (!std::isfinite(best.length)) {
    out.push_back(part);
    leave_out_double_corners(out.back());
    return;
  }
  if (const Crossing x = crossing_of(part.corner, best); x.share < 1) {
    cut_on(piece(part, best.corner, x.corner, x.at), depth + 1, out);
    cut_on(piece(part, x.corner, best.corner, x.at), depth + 1, out);
    return;
  }
  const size_t n = part.corner.size();
  ConvexPart one, two;
  for (size_t k = best.corner;; k = (k + 1) % n) {
    one.corner.push_back(part.corner[k]), one.side.push_back(part.side[k]);
    if (k == best.side) break;
  }
  one.corner.push_back(best.end), one.side.push_back({});
  two.corner.push_back(best.end), two.side.push_back(part.side[best.side]);
  for (size_t k = (best.side + 1) % n; k != best.corner; k = (k + 1) % n)
    two.corner.push_back(part.corner[k]), two.side.push_back(part.side[k]);
  two.corner.push_back(part.corner[best.corner]), two.side.push_back({});
  // a cut that ends at a corner leaves a side of round-off there, whose way is none
  leave_out_double_corners(one), leave_out_double_corners(two);
  cut_on(one, depth + 1, out), cut_on(two, depth + 1, out);
}

// A place on a side of a block at which something begins or ends: a bonded face, a face that the ground closes.
struct Stretch {
  double from = 0, to = 0;  // along the edge [m]
  int face = -1;            // bonded
  int joint = -1;           // that the ground closes: the side is moved outwards
};

// Stretches of all edges, by the edge's place in the list of corners.
using Stretches = std::vector<std::vector<Stretch>>;

void add_stretch(const BlockSet& blocks, int block, int edge, const Vec2 (&arm)[2], Stretch s,
                 Stretches& out) {
  const Vec2 from = blocks.corner({block, edge}), side = blocks.corner(blocks.end_of({block, edge})) - from;
  const double length = norm(side), first = dot(arm[0] - from, side) / length,
               second = dot(arm[1] - from, side) / length;
  s.from = std::min(first, second), s.to = std::max(first, second);
  out[blocks.vertex_begin[block] + edge].push_back(s);
}

Stretches stretches_of(const Model& model, const Layout& layout, const BlockSet& blocks, const BondSet& bonds,
                       const std::vector<JointLaw>& laws, Outlines& outlines) {
  Stretches out(blocks.arm.size());
  const auto add = [&](const BondFace& f, const Stretch& s) {
    add_stretch(blocks, f.block_a, f.edge_a, f.arm_a, s, out);
    add_stretch(blocks, f.block_b, f.edge_b, f.arm_b, s, out);
  };
  for (int f = 0; f < count_of(bonds.faces); ++f) {
    Stretch s;
    s.face = f;
    add(bonds.faces[f], s);
  }
  if (!model.in_situ.given) return out;
  for (const BondFace& face : shared_faces(layout, blocks)) {
    if (face.joint < 0) continue;
    const JointLaw& law = laws[face.joint];
    if (law.bonded()) continue;
    outlines.closed.emplace_back(face.block_a, face.block_b);
    if (!law.is_soft(0)) continue;
    Stretch s;
    s.joint = face.joint;
    add(face, s);
  }
  return out;
}

// The outline of a block with a corner wherever a bonded face begins or ends, and how far each side is moved.
struct Marked {
  ConvexPart outline;
  std::vector<std::array<double, 2>> moved;  // [sides] at its first corner, at its second [m]
  bool any = false;
};

// Half the closure by the stress of the ground, along a side of a block (theory 3.4): a function of the place alone, so that
// faces beside each other on one side leave no step, whatever their own ends are rounded to.
struct Ground {
  const Model& model;
  const std::vector<JointLaw>& laws;
  Vec2 normal;
  double height, rise;  // of the side's begin [m], along it

  double moved_out(int joint, double along) const {
    const Mat2 stress = in_situ_stress(model.in_situ, model.gravity, height + along * rise);
    return -0.5 * laws[joint].closure(stress, normal).x;
  }
  std::array<double, 2> moved_between(const std::vector<Stretch>& list, double from, double to) const {
    std::array<double, 2> out{};
    const double middle = 0.5 * (from + to);
    for (const Stretch& s : list)
      if (s.joint >= 0 && middle >= s.from && middle <= s.to)
        out = {moved_out(s.joint, from), moved_out(s.joint, to)};
    return out;
  }
};

Marked marked_outline(const Model& model, const BlockSet& blocks, const std::vector<JointLaw>& laws,
                      const Stretches& stretches, int block) {
  Marked out;
  const double least = kTouching * blocks.size[block];
  for (int e = 0; e < blocks.vertex_count(block); ++e) {
    const auto& list = stretches[blocks.vertex_begin[block] + e];
    const Vec2 from = blocks.corner({block, e}), side = blocks.corner(blocks.end_of({block, e})) - from;
    const double length = norm(side);
    const Ground ground{model, laws, turn_right(side) / length, blocks.centroid[block].y + from.y,
                        side.y / length};
    std::vector<double> at{0, length};
    for (const Stretch& s : list)
      for (const double end : {s.from, s.to})
        if (std::all_of(at.begin(), at.end(), [&](double x) { return std::abs(x - end) > least; }) &&
            end > 0 && end < length)
          at.push_back(end);
    std::sort(at.begin(), at.end());
    for (size_t k = 0; k + 1 < at.size(); ++k) {
      PartSide mark{e, -1};
      for (const Stretch& s : list)
        if (s.face >= 0 && s.from <= 0.5 * (at[k] + at[k + 1]) && s.to >= 0.5 * (at[k] + at[k + 1]))
          mark.face = s.face;
      const auto moved = ground.moved_between(list, at[k], at[k + 1]);
      out.any = out.any || moved[0] != 0 || moved[1] != 0;
      out.outline.corner.push_back(from + (at[k] / length) * side);
      out.outline.side.push_back(mark), out.moved.push_back(moved);
    }
  }
  return out;
}

// Where two moved sides meet. Of sides in line each keeps its own end: where those differ, a cut joins them
// (theory 3.4).
void move_outwards(const Marked& marked, ConvexPart& outline) {
  const std::vector<Vec2>& p = marked.outline.corner;
  const size_t n = p.size();
  ConvexPart out;
  for (size_t k = 0; k < n; ++k) {
    const size_t before = (k + n - 1) % n;
    const Vec2 at = p[k], u = turn_right(at - p[before]) / norm(at - p[before]),
               v = turn_right(p[(k + 1) % n] - at) / norm(p[(k + 1) % n] - at);
    const double one = marked.moved[before][1], two = marked.moved[k][0], d = cross(u, v);
    const double most = std::max(std::abs(one), std::abs(two));
    const Vec2 end = at + one * u, begin = at + two * v;
    const Vec2 meets{one * v.y - two * u.y, two * u.x - one * v.x};  // times d
    if (norm(begin - end) <= kSame * most) {
      out.corner.push_back(begin);
    } else if (norm(meets) <= kFarthestOff * most * std::abs(d)) {
      out.corner.push_back(at + meets / d);
    } else {
      out.corner.push_back(end), out.side.push_back({});
      out.corner.push_back(begin);
    }
    out.side.push_back(outline.side[k]);
  }
  outline = std::move(out);
}

}  // namespace

std::vector<ConvexPart> convex_parts(const ConvexPart& outline) {
  TALUS_ASSERT(outline.corner.size() == outline.side.size() && outline.corner.size() > 2);
  std::vector<ConvexPart> out;
  cut_on(outline, 0, out);
  return out;
}

Outlines build_outlines(const Model& model, const Layout& layout, const BlockSet& blocks,
                        const BondSet& bonds, const std::vector<JointLaw>& laws) {
  Outlines out;
  const Stretches stretches = stretches_of(model, layout, blocks, bonds, laws, out);
  out.part_begin.push_back(0), out.corner_begin.push_back(0);
  for (int i = 0; i < blocks.count; ++i) {
    const Marked marked = marked_outline(model, blocks, laws, stretches, i);
    ConvexPart outline = marked.outline;
    if (marked.any) move_outwards(marked, outline);
    for (const ConvexPart& part : convex_parts(outline)) {
      out.corner.insert(out.corner.end(), part.corner.begin(), part.corner.end());
      out.side.insert(out.side.end(), part.side.begin(), part.side.end());
      out.corner_begin.push_back(count_of(out.corner));
      out.plain.push_back(std::all_of(part.side.begin(), part.side.end(),
                                      [](const PartSide& s) { return s.edge >= 0 && s.face < 0; }));
    }
    out.part_begin.push_back(count_of(out.corner_begin) - 1);
  }
  return out;
}

}  // namespace talus
