#include "talus/geometry/open_holes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace talus {

namespace {

// Points along an island from which cuts may begin, besides its corners; cuts that are looked at, the
// shortest and about as many farther ones; how much longer two cuts may be for the sake of larger pieces;
// share of a cut within which a corner takes up its end, and by which it keeps clear of what it passes at
// most.
constexpr int kSamples = 24;
constexpr size_t kShortest = 24, kFarther = 24;
constexpr double kSlack = 1.02, kAtCorner = 0.1, kClear = 0.05;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A place on a ring: on the edge from corner `edge`, at `share` of its length.
struct OnRing {
  size_t edge = 0;
  double share = 0;
  Vec2 at;

  auto order() const { return std::pair(edge, share); }
};

// A cut from an island to the ring around it.
struct Link {
  OnRing inner, outer;
  double length = 0;
};

bool meet(const Box& a, const Box& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y;
}

double distance(const Box& a, const Box& b) {
  const Vec2 gap{std::max({0.0, a.min.x - b.max.x, b.min.x - a.max.x}),
                 std::max({0.0, a.min.y - b.max.y, b.min.y - a.max.y})};
  return norm(gap);
}

struct Island {
  Polygon ring;  // clockwise
  Box box;
  Vec2 inside;
  double area = 0;
  double to_outer = kInfinity;  // distance to the ring around it [m]
};

struct Holed {
  Polygon outer;  // counter-clockwise
  std::vector<Island> islands;
};

OnRing nearest_on(const Polygon& ring, Vec2 p) {
  OnRing best;
  double least = kInfinity;
  for (size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k], d = ring[(k + 1) % ring.size()] - a;
    const double share = std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0);
    const Vec2 at = a + share * d;
    if (norm(at - p) < least) least = norm(at - p), best = {k, share, at};
  }
  return best;
}

double distance(const Polygon& a, const Polygon& b) {
  double least = kInfinity;
  for (const Vec2 p : a) least = std::min(least, norm(nearest_on(b, p).at - p));
  for (const Vec2 p : b) least = std::min(least, norm(nearest_on(a, p).at - p));
  return least;
}

bool cross_each_other(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  const double u = cross(b - a, c - a), v = cross(b - a, d - a), w = cross(d - c, a - c),
               x = cross(d - c, b - c);
  return ((u > 0) != (v > 0)) && ((w > 0) != (x > 0));
}

class Opener {
 public:
  Opener(double least_area, double near) : least_area_(least_area), near_(near) {}

  void open(Holed whole) {
    for (Island& island : whole.islands) island.to_outer = distance(island.ring, whole.outer);
    std::vector<Holed> left;
    left.push_back(std::move(whole));
    while (!left.empty()) {
      Holed face = std::move(left.back());
      left.pop_back();
      if (!face.islands.empty()) open_nearest(face, left);
    }
  }

  std::vector<Polyline> cuts;

 private:
  // Cuts the island nearest to the ring around it free, and appends the two pieces. The others are as far
  // from the ring of their piece as from the old ring, or nearer to the island: what lies behind the cuts is
  // farther away than the cuts.
  void open_nearest(Holed& face, std::vector<Holed>& left) {
    const auto nearest =
        std::min_element(face.islands.begin(), face.islands.end(),
                         [](const Island& a, const Island& b) { return a.to_outer < b.to_outer; });
    std::swap(*nearest, face.islands.back());
    const Polygon island = std::move(face.islands.back().ring);
    face.islands.pop_back();
    const std::vector<Link> links = links_of(face, island);
    const std::array<size_t, 2> pair = choose(face, island, links);
    if (pair[0] == pair[1]) return;  // no two cuts: the caller finds the face holed still
    Polygon added = island;
    for (const size_t i : pair) {
      if (links[i].length > 0) cuts.push_back({links[i].inner.at, links[i].outer.at});
      added.push_back(links[i].inner.at);
      added.push_back(links[i].outer.at);
    }
    const Box box = bounding_box(added);
    for (Island& other : face.islands) {
      if (distance(other.box, box) >= other.to_outer) continue;
      other.to_outer = std::min(other.to_outer, distance(other.ring, island));
      for (const size_t i : pair)
        other.to_outer =
            std::min(other.to_outer, distance(other.ring, Polygon{links[i].inner.at, links[i].outer.at}));
    }
    Holed first{piece_between(face.outer, island, links[pair[0]], links[pair[1]]), {}};
    Holed second{piece_between(face.outer, island, links[pair[1]], links[pair[0]]), {}};
    if (first.outer.size() > second.outer.size()) std::swap(first, second);
    const Box small = bounding_box(first.outer);
    for (Island& other : face.islands)
      (lies_in(other, first.outer, small) ? first : second).islands.push_back(std::move(other));
    left.push_back(std::move(second));
    left.push_back(std::move(first));
  }

  static bool lies_in(const Island& island, const Polygon& piece, const Box& box) {
    return meet(island.box, box) && contains(piece, island.inside);
  }

  // Cuts in sight: the shortest, and of the rest here and there one, for a piece may have to be large. From
  // places along the island straight to the ring around, and back.
  std::vector<Link> links_of(const Holed& face, const Polygon& island) const {
    std::vector<Link> all;
    const auto add = [&](const OnRing& inner, const OnRing& outer) {
      all.push_back({inner, outer, norm(outer.at - inner.at)});
    };
    double around = 0;
    for (size_t k = 0; k < island.size(); ++k) around += norm(island[(k + 1) % island.size()] - island[k]);
    for (size_t k = 0; k < island.size(); ++k) {
      const Vec2 a = island[k], d = island[(k + 1) % island.size()] - a;
      const int pieces = std::max(1, static_cast<int>(std::ceil(norm(d) / around * kSamples)));
      for (int i = 0; i < pieces; ++i) {
        const double share = static_cast<double>(i) / pieces;
        const Vec2 p = a + share * d;
        add({k, share, p}, at_corner(face.outer, nearest_on(face.outer, p), p));
      }
    }
    for (size_t k = 0; k < face.outer.size(); ++k)
      add(at_corner(island, nearest_on(island, face.outer[k]), face.outer[k]), {k, 0, face.outer[k]});
    std::stable_sort(all.begin(), all.end(),
                     [](const Link& x, const Link& y) { return x.length < y.length; });
    std::vector<Link> links;
    size_t i = 0;
    for (; i < all.size() && links.size() < kShortest; ++i)
      if (in_sight(face, island, all[i])) links.push_back(all[i]);
    const size_t stride = std::max<size_t>(1, (all.size() - i) / kFarther);
    for (; i < all.size(); i += stride)
      if (in_sight(face, island, all[i])) links.push_back(all[i]);
    return links;
  }

  // A corner of the ring near the place, seen from `from`, takes it up.
  OnRing at_corner(const Polygon& ring, const OnRing& place, Vec2 from) const {
    const double reach = std::max(near_, kAtCorner * norm(place.at - from));
    const size_t next = (place.edge + 1) % ring.size();
    const double to_this = norm(ring[place.edge] - place.at), to_next = norm(ring[next] - place.at);
    if (std::min(to_this, to_next) > reach) return place;
    const size_t k = to_this <= to_next ? place.edge : next;
    return {k, 0, ring[k]};
  }

  // Whether a cut meets the rings at its ends only, runs inside the face, and keeps clear of what it passes:
  // the grid would make one line of a cut and an edge beside it.
  bool in_sight(const Holed& face, const Polygon& island, const Link& link) const {
    if (link.length == 0) return true;
    const Vec2 from = link.inner.at, to = link.outer.at, middle = 0.5 * (from + to);
    const Vec2 a = from + 1e-6 * (to - from), b = to - 1e-6 * (to - from);
    const double clear = std::min(near_, kClear * link.length);
    const Box box = bounding_box(std::array{from, to});
    const Box room{box.min - Vec2{clear, clear}, box.max + Vec2{clear, clear}};
    const auto meets = [&](const Polygon& ring) {
      for (size_t k = 0; k < ring.size(); ++k) {
        const Vec2 p = ring[k], q = ring[k + 1 < ring.size() ? k + 1 : 0];
        if (!meet(Box{{std::min(p.x, q.x), std::min(p.y, q.y)}, {std::max(p.x, q.x), std::max(p.y, q.y)}},
                  room))
          continue;
        if (cross_each_other(a, b, p, q) || distance_to_segment(middle, p, q) < clear) return true;
        if (std::min(norm(p - from), norm(p - to)) > clear && distance_to_segment(p, from, to) < clear)
          return true;
      }
      return false;
    };
    if (meets(face.outer) || meets(island) || contains(island, middle) || !contains(face.outer, middle))
      return false;
    return std::none_of(face.islands.begin(), face.islands.end(), [&](const Island& other) {
      return meet(other.box, room) && (meets(other.ring) || contains(other.ring, middle));
    });
  }

  bool may_go_together(const Link& x, const Link& y) const {
    if (norm(x.inner.at - y.inner.at) <= near_ || norm(x.outer.at - y.outer.at) <= near_) return false;
    return !cross_each_other(x.inner.at, x.outer.at, y.inner.at, y.outer.at);
  }

  // Corners from one place of a ring to another, both included.
  static void walk(const Polygon& ring, const OnRing& from, const OnRing& to, Polygon& out) {
    out.push_back(from.at);
    const bool ahead = from.order() < to.order();
    for (size_t k = from.edge, n = 0; n <= ring.size(); ++n) {
      if (k == to.edge && (n > 0 || ahead)) break;
      k = (k + 1) % ring.size();
      out.push_back(ring[k]);
    }
    out.push_back(to.at);
  }

  // From x along the outer ring to y, over, and back along the island.
  static Polygon piece_between(const Polygon& outer, const Polygon& island, const Link& x, const Link& y) {
    Polygon all, out;
    walk(outer, x.outer, y.outer, all);
    walk(island, y.inner, x.inner, all);
    for (const Vec2 p : all)
      if (out.empty() || norm(p - out.back()) > 0) out.push_back(p);
    while (out.size() > 1 && norm(out.back() - out.front()) == 0) out.pop_back();
    return out;
  }

  // Area of the smaller of the two pieces, islands in them taken off [m2].
  double smaller_piece(const Holed& face, const Polygon& island, double total, const Link& x,
                       const Link& y) const {
    Polygon piece = piece_between(face.outer, island, x, y);
    if (Polygon other = piece_between(face.outer, island, y, x); other.size() < piece.size())
      piece = std::move(other);
    const Box box = bounding_box(piece);
    double area = signed_area(piece);
    for (const Island& other : face.islands)
      if (lies_in(other, piece, box)) area -= other.area;
    return std::min(area, total - area);
  }

  // The shortest two cuts, or such as are little longer and leave larger pieces; where all leave a piece
  // below the least area, those that leave the largest. The same link twice when there are no two.
  std::array<size_t, 2> choose(const Holed& face, const Polygon& island,
                               const std::vector<Link>& links) const {
    double total = signed_area(face.outer) - std::abs(signed_area(island));
    for (const Island& other : face.islands) total -= other.area;
    struct Pair {
      double length;
      std::array<size_t, 2> link;
    };
    std::vector<Pair> pairs;
    for (size_t i = 0; i < links.size(); ++i)
      for (size_t j = i + 1; j < links.size(); ++j)
        if (may_go_together(links[i], links[j])) pairs.push_back({links[i].length + links[j].length, {i, j}});
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.length < b.length; });
    std::array<size_t, 2> best{0, 0};
    double largest = -kInfinity, shortest = kInfinity;
    for (const Pair& pair : pairs) {
      if (pair.length > kSlack * shortest) break;
      const double area = smaller_piece(face, island, total, links[pair.link[0]], links[pair.link[1]]);
      if (area >= least_area_) shortest = std::min(shortest, pair.length);
      if (area > largest) largest = area, best = pair.link;
    }
    return best;
  }

  double least_area_, near_;
};

}  // namespace

std::vector<Polyline> opening_cuts(const std::vector<Polyline>& rings, double least_area, double near) {
  Holed face;
  for (const Polyline& ring : rings) {
    Polygon polygon = ring;
    const bool is_outer = face.outer.empty();
    if ((signed_area(polygon) > 0) != is_outer) std::reverse(polygon.begin(), polygon.end());
    if (is_outer) {
      face.outer = std::move(polygon);
      continue;
    }
    Island island{polygon, bounding_box(polygon), interior_point(polygon), std::abs(signed_area(polygon))};
    face.islands.push_back(std::move(island));
  }
  Opener opener(least_area, near);
  opener.open(std::move(face));
  return opener.cuts;
}

}  // namespace talus
