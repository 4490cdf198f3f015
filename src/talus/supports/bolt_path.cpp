#include "talus/supports/bolt_path.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/base/index.h"

namespace talus {

namespace {

// Two blocks may lie over each other on so much of a piece; more of it means that the line runs along their
// joint.
constexpr double kMostOverlap = 0.1;

// Corners of a block as they lie, from the beginning of the line.
Polygon corners_now(const BlockSet& blocks, const State& state, size_t k, Vec2 origin) {
  Polygon polygon;
  const int i = static_cast<int>(k);
  for (int v = 0; v < blocks.vertex_count(i); ++v)
    polygon.push_back((blocks.centroid[k] - origin) + offset_now(state, k, blocks.corner({i, v})));
  return polygon;
}

// Distances along the line at which it meets the outline.
std::vector<double> meetings(const Polygon& polygon, Vec2 t, double length) {
  std::vector<double> at{0, length};
  for (size_t v = 0; v < polygon.size(); ++v) {
    const Vec2 a = polygon[v], b = polygon[(v + 1) % polygon.size()];
    const double ha = cross(t, a), hb = cross(t, b);  // heights over the line
    if ((ha > 0) == (hb > 0)) continue;
    const double s = dot(t, a) + ha / (ha - hb) * dot(t, b - a);
    if (s > 0 && s < length) at.push_back(s);
  }
  std::sort(at.begin(), at.end());
  return at;
}

void add_pieces(const Polygon& polygon, int block, Vec2 t, double length, double least,
                std::vector<PathPiece>& pieces) {
  const std::vector<double> at = meetings(polygon, t, length);
  PathPiece piece{block, 0, -1};
  for (size_t i = 0; i + 1 < at.size(); ++i) {
    if (at[i + 1] <= at[i] || !contains(polygon, 0.5 * (at[i] + at[i + 1]) * t)) continue;
    if (piece.to == at[i]) {
      piece.to = at[i + 1];
      continue;
    }
    if (piece.to - piece.from > least) pieces.push_back(piece);
    piece = {block, at[i], at[i + 1]};
  }
  if (piece.to - piece.from > least) pieces.push_back(piece);
}

}  // namespace

// Theory 4.21.
BoltPath path_through(const BlockSet& blocks, const State& state, Vec2 from, Vec2 to, double least) {
  BoltPath path;
  const double length = norm(to - from);
  const Vec2 t = (to - from) / length;
  for (int k = 0; k < count_of(blocks.name); ++k) {
    if (blocks.removed(k)) continue;
    const Vec2 centre = blocks.centroid[k] + state.displacement[k] - from;
    const double along = std::clamp(dot(t, centre), 0.0, length);
    if (norm(centre - along * t) > 2 * blocks.radius[k]) continue;  // strains of 1 are never met
    add_pieces(corners_now(blocks, state, k, from), k, t, length, least, path.pieces);
  }
  if (path.pieces.empty()) path.trouble = "meets no block";
  std::sort(path.pieces.begin(), path.pieces.end(),
            [](const PathPiece& a, const PathPiece& b) { return a.from < b.from; });
  for (size_t i = 1; i < path.pieces.size(); ++i) {
    PathPiece &a = path.pieces[i - 1], &b = path.pieces[i];
    const double over = a.to - b.from;
    if (over <= 0) continue;
    if (over > kMostOverlap * std::min(a.to - a.from, b.to - b.from)) {
      path.trouble = fmt::format("runs along the joint between \"{}\" and \"{}\"", blocks.name[a.block],
                                 blocks.name[b.block]);
      break;
    }
    a.to = b.from = 0.5 * (a.to + b.from);
  }
  return path;
}

}  // namespace talus
