#include "talus/geometry/arrangement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/random.h"
#include "talus/geometry/geos.h"
#include "talus/geometry/open_holes.h"

namespace talus {

namespace {

// Noding moves a line by less than one cell of the grid, and again by as much in every round of cuts that
// open holes.
constexpr double kMoved = 1.5, kMovedTwice = 16;

// Least area of a piece beside a cut, as share of the smallest face; corners that take up the end of a cut,
// in cells of the grid.
constexpr double kLeastPiece = 0.25, kNearCorner = 64;

using Node = std::array<int64_t, 2>;  // in cells of the grid

struct NodeHash {
  size_t operator()(const Node& n) const {
    const uint64_t x = static_cast<uint64_t>(n[0]) * 0x9E3779B97F4A7C15ULL;
    const uint64_t y = static_cast<uint64_t>(n[1]) * 0xC2B2AE3D27D4EB4FULL;
    return (x ^ (x >> 29)) + (y ^ (y >> 31));
  }
};

// Lines by the squares of a coarse grid that they pass through.
class LineIndex {
 public:
  LineIndex(const std::vector<Polyline>& lines, double cell, double reach)
      : lines_(lines), cell_(cell), reach_(reach) {
    for (int l = 0; l < count_of(lines); ++l)
      for (int k = 0; k + 1 < count_of(lines[l]); ++k) add(l, k);
    std::sort(entries_.begin(), entries_.end());
    entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
  }

  // The first line that passes both points within `near`, at most the reach; -1 when none does.
  int first_along(Vec2 a, Vec2 b, double near) const {
    const Node square = square_of(0.5 * (a + b));
    auto it = std::lower_bound(entries_.begin(), entries_.end(), Entry{square, -1, -1});
    for (; it != entries_.end() && it->square == square; ++it) {
      const Polyline& line = lines_[it->line];
      const Vec2 p = line[it->part], q = line[it->part + 1];
      if (distance_to_segment(a, p, q) <= near && distance_to_segment(b, p, q) <= near) return it->line;
    }
    return -1;
  }

 private:
  struct Entry {
    Node square;
    int line, part;
    auto operator<=>(const Entry&) const = default;
  };

  Node square_of(Vec2 p) const {
    return {static_cast<int64_t>(std::floor(p.x / cell_)), static_cast<int64_t>(std::floor(p.y / cell_))};
  }

  // in pieces no longer than a square, so that few squares are touched in vain
  void add(int line, int part) {
    const Polyline& l = lines_[line];
    const Vec2 p = l[part], q = l[part + 1];
    const auto pieces = static_cast<int64_t>(std::ceil(norm(q - p) / cell_)) + 1;
    for (int64_t i = 0; i < pieces; ++i) {
      const Vec2 a = p + (static_cast<double>(i) / static_cast<double>(pieces)) * (q - p);
      const Vec2 b = p + (static_cast<double>(i + 1) / static_cast<double>(pieces)) * (q - p);
      const Vec2 r{2 * reach_, 2 * reach_};
      const Node lo = square_of(Vec2{std::min(a.x, b.x), std::min(a.y, b.y)} - r);
      const Node hi = square_of(Vec2{std::max(a.x, b.x), std::max(a.y, b.y)} + r);
      for (int64_t x = lo[0]; x <= hi[0]; ++x)
        for (int64_t y = lo[1]; y <= hi[1]; ++y) entries_.push_back({{x, y}, line, part});
    }
  }

  const std::vector<Polyline>& lines_;
  double cell_, reach_;
  std::vector<Entry> entries_;
};

using Edge = std::array<Node, 2>;  // lower node first

struct EdgeHash {
  size_t operator()(const Edge& e) const { return NodeHash()(e[0]) * 31 + NodeHash()(e[1]); }
};

Edge edge_between(Vec2 a, Vec2 b, double grid) {
  const auto node = [grid](Vec2 p) { return Node{std::llround(p.x / grid), std::llround(p.y / grid)}; };
  const Node m = node(a), n = node(b);
  return m < n ? Edge{m, n} : Edge{n, m};
}

struct HoledFace {
  std::vector<Polyline> rings;  // the outer one first
  Vec2 inside;                  // a place in the face
};

struct Noded {
  std::vector<Polygon> rings;  // counter-clockwise, without the closing corner
  std::vector<HoledFace> holed;
  std::vector<Polyline> dead_ends;
};

void for_parts(const GEOSGeometry* collection, const auto& use) {
  const GEOSContextHandle_t context = geos().context();
  const int n = GEOSGetNumGeometries_r(context, collection);
  for (int i = 0; i < n; ++i) use(GEOSGetGeometryN_r(context, collection, i));
}

Polygon open_ring(const GEOSGeometry* ring) {
  Polygon corners = geos().corners_of(ring);
  corners.pop_back();
  return corners;
}

// The lines as they come from the noder: each ends where it meets another.
std::vector<Polyline> node(const std::vector<Polyline>& lines, double grid) {
  const GEOSContextHandle_t context = geos().context();
  // in mixed order: the noder keeps its nodes in a tree that it does not balance, and parallel lines from one
  // side to the other would make it half a list (measured: 31 s instead of 15 s at half a million faces)
  std::vector<Polyline> mixed = lines;
  Random random(1);
  for (size_t i = mixed.size(); i > 1; --i) std::swap(mixed[i - 1], mixed[random.next() % i]);
  const auto input = geos().make_lines(mixed, {0, 0});
  const auto noded = geos().own(input ? GEOSUnaryUnionPrec_r(context, input.get(), grid) : nullptr);
  if (!noded) throw std::runtime_error("noding of the joints failed");
  std::vector<Polyline> out;
  for_parts(noded.get(), [&out](const GEOSGeometry* line) { out.push_back(geos().corners_of(line)); });
  return out;
}

// Noded lines, and cuts that end on them: only what is near a cut is noded again.
std::vector<Polyline> node_again(std::vector<Polyline> lines, const std::vector<Polyline>& cuts,
                                 double grid) {
  std::vector<Box> boxes;
  for (const Polyline& line : lines) boxes.push_back(bounding_box(line));
  for (const Polyline& cut : cuts) boxes.push_back(bounding_box(cut));
  const auto first_cut = count_of(lines);
  std::vector<bool> is_near(lines.size(), false);
  for (const auto& [i, j] : close_pairs(boxes, kMovedTwice * grid))
    if (i < first_cut && j >= first_cut) is_near[i] = true;
  std::vector<Polyline> near = cuts, out;
  for (size_t i = 0; i < lines.size(); ++i) (is_near[i] ? near : out).push_back(std::move(lines[i]));
  for (Polyline& line : node(near, grid)) out.push_back(std::move(line));
  return out;
}

Noded polygonize(const std::vector<Polyline>& noded) {
  const GEOSContextHandle_t context = geos().context();
  const auto lines = geos().make_lines(noded, {0, 0});
  GEOSGeometry *cuts = nullptr, *dangles = nullptr, *invalid = nullptr;
  const auto faces =
      geos().own(lines ? GEOSPolygonize_full_r(context, lines.get(), &cuts, &dangles, &invalid) : nullptr);
  const auto own_cuts = geos().own(cuts), own_dangles = geos().own(dangles),
             own_invalid = geos().own(invalid);
  if (!faces) throw std::runtime_error("collecting the faces between the joints failed");
  if (invalid && GEOSGetNumGeometries_r(context, invalid) > 0)
    throw std::runtime_error(
        fmt::format("{} faces between the joints are not simple", GEOSGetNumGeometries_r(context, invalid)));
  Noded out;
  for_parts(faces.get(), [&](const GEOSGeometry* polygon) {
    Polygon outer = open_ring(GEOSGetExteriorRing_r(context, polygon));
    const int holes = GEOSGetNumInteriorRings_r(context, polygon);
    if (holes > 0) {
      std::vector<Polyline> rings{outer};
      for (int h = 0; h < holes; ++h) rings.push_back(open_ring(GEOSGetInteriorRingN_r(context, polygon, h)));
      const auto inside = geos().own(GEOSPointOnSurface_r(context, polygon));
      if (!inside) throw std::runtime_error("no place found inside a face with holes");
      out.holed.push_back({std::move(rings), geos().corners_of(inside.get()).at(0)});
      return;
    }
    if (signed_area(outer) < 0) std::reverse(outer.begin(), outer.end());
    out.rings.push_back(std::move(outer));
  });
  // pieces of one dead end, between crossings with others, as one line
  for (const GEOSGeometry* list : {own_cuts.get(), own_dangles.get()}) {
    const auto merged = geos().own(list ? GEOSLineMerge_r(context, list) : nullptr);
    if (merged)
      for_parts(merged.get(),
                [&](const GEOSGeometry* line) { out.dead_ends.push_back(geos().corners_of(line)); });
  }
  return out;
}

// Noded lines along which faces lie: dead ends would become joints where a cut meets them.
std::vector<Polyline> live_lines(std::vector<Polyline> noded, const Noded& faces, double grid) {
  std::unordered_set<Edge, EdgeHash> live;
  const auto add = [&](const Polyline& ring) {
    for (size_t k = 0; k < ring.size(); ++k)
      live.insert(edge_between(ring[k], ring[(k + 1) % ring.size()], grid));
  };
  for (const Polygon& ring : faces.rings) add(ring);
  for (const HoledFace& face : faces.holed)
    for (const Polyline& ring : face.rings) add(ring);
  std::erase_if(noded,
                [&](const Polyline& line) { return !live.count(edge_between(line[0], line[1], grid)); });
  return noded;
}

// Area of the smallest face that is solid [m2].
double smallest_area(const Noded& faces, const std::function<bool(Vec2)>& is_solid) {
  double least = std::numeric_limits<double>::infinity();
  for (const Polygon& ring : faces.rings) {
    const double area = std::abs(signed_area(ring));
    if (area < least && is_solid(interior_point(ring))) least = area;
  }
  return least;
}

[[noreturn]] void fail_to_open(const HoledFace& face, Vec2 origin) {
  throw std::runtime_error(fmt::format("no cuts open the face with {} holes around ({:.9g}, {:.9g})",
                                       face.rings.size() - 1, face.inside.x + origin.x,
                                       face.inside.y + origin.y));
}

// Nodes the lines and opens the solid faces with holes. Cuts are added to what is noded already: they end on
// its edges, which may lie a cell away from the lines themselves.
Noded node_and_open(const std::vector<Polyline>& lines, double grid, Vec2 origin,
                    const std::function<bool(Vec2)>& is_solid, std::vector<Polyline>& cuts, int& opened) {
  auto noded = node(lines, grid);
  std::vector<Polyline> dead_ends;
  double least = -1;
  size_t left = std::numeric_limits<size_t>::max();  // holes of solid faces
  for (;;) {
    Noded out = polygonize(noded);
    dead_ends.insert(dead_ends.end(), out.dead_ends.begin(), out.dead_ends.end());
    const size_t before = cuts.size();
    size_t holes = 0;
    for (const HoledFace& face : out.holed) {
      if (!is_solid(face.inside)) continue;
      holes += face.rings.size() - 1;
      if (holes >= left) fail_to_open(face, origin);  // rounding brings cuts onto other lines, but not all
      if (least < 0) least = smallest_area(out, is_solid);
      const auto found =
          opening_cuts(face.rings, std::isfinite(least) ? kLeastPiece * least : 0, kNearCorner * grid);
      if (found.empty()) fail_to_open(face, origin);
      cuts.insert(cuts.end(), found.begin(), found.end());
      ++opened;
    }
    if (holes == 0) {
      out.dead_ends = std::move(dead_ends);
      return out;
    }
    left = holes;
    const std::vector<Polyline> fresh(cuts.begin() + before, cuts.end());
    noded = node_again(live_lines(std::move(noded), out, grid), fresh, grid);
  }
}

bool lower_left(Vec2 a, Vec2 b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

}  // namespace

double grid_width(double extent, double wanted) {
  const double limit = std::isnan(wanted) ? std::min(0x1p-20, 1e-8 * extent) : wanted;
  return std::exp2(std::floor(std::log2(limit)));
}

Arrangement arrange(const std::vector<Polyline>& lines, double grid, Vec2 origin,
                    const std::function<bool(Vec2)>& is_solid) {
  TALUS_ASSERT(grid > 0);
  Arrangement out;
  out.grid = grid;
  if (lines.empty()) return out;
  std::vector<Polyline> local = lines;
  for (Polyline& l : local)
    for (Vec2& p : l) p -= origin;
  const auto is_solid_local = [&](Vec2 p) { return is_solid && is_solid(p + origin); };
  Noded noded = node_and_open(local, grid, origin, is_solid_local, out.cuts, out.opened);
  local.insert(local.end(), out.cuts.begin(), out.cuts.end());

  // faces in an order that depends on their places only
  for (Polygon& ring : noded.rings)
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), lower_left), ring.end());
  std::sort(noded.rings.begin(), noded.rings.end(), [](const Polygon& a, const Polygon& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), lower_left);
  });

  // points and edges by number
  std::unordered_map<Node, int, NodeHash> number_of;
  std::unordered_map<Node, int, NodeHash> edge_of;
  const auto point_number = [&](Vec2 p) {
    const Node node{std::llround(p.x / grid), std::llround(p.y / grid)};
    const auto [it, fresh] = number_of.try_emplace(node, count_of(out.point));
    if (fresh) out.point.push_back(p);
    return it->second;
  };
  double total = 0;
  for (const Polygon& ring : noded.rings) {
    Arrangement::Face face;
    for (const Vec2 p : ring) face.point.push_back(point_number(p));
    const int f = count_of(out.face);
    for (size_t k = 0; k < face.point.size(); ++k) {
      const int a = face.point[k], b = face.point[(k + 1) % face.point.size()];
      const auto [it, fresh] = edge_of.try_emplace({std::min(a, b), std::max(a, b)}, count_of(out.edge));
      if (fresh) {
        out.edge.push_back({std::min(a, b), std::max(a, b)});
        out.edge_face.push_back({-1, -1});
        total += norm(ring[(k + 1) % ring.size()] - ring[k]);
      }
      int& side = out.edge_face[it->second][a < b ? 0 : 1];
      if (side >= 0) throw std::runtime_error("two faces between the joints overlap");
      side = f;
      face.edge.push_back(it->second);
    }
    out.face.push_back(std::move(face));
  }

  // the line along each edge; an index with no more places than edges and lines: of lines thinner than the grid nothing may
  // be left but their length
  double length = 0;
  for (const Polyline& line : local)
    for (size_t k = 0; k + 1 < line.size(); ++k) length += norm(line[k + 1] - line[k]);
  const auto edges = static_cast<double>(std::max<size_t>(out.edge.size(), 1)),
             all = edges + static_cast<double>(local.size());
  const double cell = std::max({total / edges, length / all, 4 * grid});
  const LineIndex index(local, cell, kMovedTwice * grid);
  for (const auto& [a, b] : out.edge) {
    const Vec2 p = out.point[a], q = out.point[b];
    int source = index.first_along(p, q, kMoved * grid);
    if (source < 0) source = index.first_along(p, q, kMovedTwice * grid);
    out.edge_source.push_back(source);
    if (source < 0)
      throw std::runtime_error(
          fmt::format("no joint runs along the edge from ({:.9g}, {:.9g}) to ({:.9g}, {:.9g})",
                      p.x + origin.x, p.y + origin.y, q.x + origin.x, q.y + origin.y));
  }

  for (Vec2& p : out.point) p += origin;
  out.dead_ends = std::move(noded.dead_ends);
  for (HoledFace& face : noded.holed) {
    for (Polyline& ring : face.rings)
      for (Vec2& p : ring) p += origin;
    out.rings_of_holed.push_back(std::move(face.rings));
  }
  for (std::vector<Polyline>* list : {&out.dead_ends, &out.cuts})
    for (Polyline& l : *list)
      for (Vec2& p : l) p += origin;
  return out;
}

}  // namespace talus
