#include "talus/geometry/open_holes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "talus/geometry/arrangement.h"

namespace talus {

namespace {

// Points along an island from which cuts may begin, besides its corners; cuts that are looked at; how much
// longer two cuts may be for the sake of larger pieces; share of a cut within which a corner takes up its
// end.
constexpr int kSamples = 24;
constexpr size_t kMostLinks = 48;
constexpr double kSlack = 1.02, kAtCorner = 0.1;

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

struct Island {
  Polygon ring;  // clockwise
  Vec2 inside;
  double area = 0;
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

  void open(Holed face) {
    if (face.islands.empty()) return;
    size_t next = 0;
    double least = kInfinity;
    for (size_t i = 0; i < face.islands.size(); ++i) {
      const double d = distance(face.islands[i].ring, face.outer);
      if (d < least) least = d, next = i;
    }
    std::swap(face.islands[next], face.islands.back());
    const Polygon island = face.islands.back().ring;
    face.islands.pop_back();
    const std::vector<Link> links = links_of(face, island);
    const std::array<size_t, 2> pair = choose(face, island, links);
    if (pair[0] == pair[1]) return;  // no two cuts: the caller finds the face holed still
    for (const size_t i : pair)
      if (links[i].length > 0) cuts.push_back({links[i].inner.at, links[i].outer.at});
    for (const bool first : {true, false}) {
      Holed piece;
      piece.outer = piece_between(face.outer, island, links[pair[first ? 0 : 1]], links[pair[first ? 1 : 0]]);
      for (const Island& other : face.islands)
        if (contains(piece.outer, other.inside)) piece.islands.push_back(other);
      open(std::move(piece));
    }
  }

  std::vector<Polyline> cuts;

 private:
  // Cuts in sight, the shortest first: from places along the island straight to the ring around, and back.
  std::vector<Link> links_of(const Holed& face, const Polygon& island) const {
    std::vector<Link> links;
    const auto add = [&](const OnRing& inner, const OnRing& outer) {
      Link link{inner, outer, norm(outer.at - inner.at)};
      if (in_sight(face, island, link)) links.push_back(link);
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
    std::stable_sort(links.begin(), links.end(),
                     [](const Link& x, const Link& y) { return x.length < y.length; });
    if (links.size() > kMostLinks) {
      // the shortest, and of the rest here and there one: a piece may have to be large
      std::vector<Link> some(links.begin(), links.begin() + kMostLinks / 2);
      const size_t rest = links.size() - kMostLinks / 2;
      for (size_t i = 0; i < kMostLinks / 2; ++i)
        some.push_back(links[kMostLinks / 2 + i * rest / (kMostLinks / 2)]);
      links = std::move(some);
    }
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

  // Whether a cut meets the rings at its ends only and runs inside the face.
  static bool in_sight(const Holed& face, const Polygon& island, const Link& link) {
    if (link.length == 0) return true;
    const Vec2 d = link.outer.at - link.inner.at, a = link.inner.at + 1e-6 * d, b = link.outer.at - 1e-6 * d;
    const auto meets = [&](const Polygon& ring) {
      for (size_t k = 0; k < ring.size(); ++k)
        if (cross_each_other(a, b, ring[k], ring[(k + 1) % ring.size()])) return true;
      return false;
    };
    if (meets(face.outer) || meets(island) || contains(island, 0.5 * (a + b)) ||
        !contains(face.outer, 0.5 * (a + b)))
      return false;
    return std::none_of(face.islands.begin(), face.islands.end(), [&](const Island& other) {
      return meets(other.ring) || contains(other.ring, 0.5 * (a + b));
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

  double net_area(const Holed& face, const Polygon& piece) const {
    double area = signed_area(piece);
    for (const Island& other : face.islands)
      if (contains(piece, other.inside)) area -= other.area;
    return area;
  }

  std::array<size_t, 2> choose(const Holed& face, const Polygon& island,
                               const std::vector<Link>& links) const {
    struct Choice {
      double total = kInfinity, area = -kInfinity;
      std::array<size_t, 2> pair{0, 0};
    };
    std::vector<Choice> all;
    for (size_t i = 0; i < links.size(); ++i) {
      for (size_t j = i + 1; j < links.size(); ++j) {
        if (!may_go_together(links[i], links[j])) continue;
        const double area = std::min(net_area(face, piece_between(face.outer, island, links[i], links[j])),
                                     net_area(face, piece_between(face.outer, island, links[j], links[i])));
        all.push_back({links[i].length + links[j].length, area, {i, j}});
      }
    }
    Choice best;
    double least = kInfinity;
    for (const Choice& c : all)
      if (c.area >= least_area_) least = std::min(least, c.total);
    for (const Choice& c : all)
      if ((least == kInfinity || c.total <= kSlack * least) && c.area > best.area) best = c;
    return best.pair;
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
    if (is_outer)
      face.outer = std::move(polygon);
    else
      face.islands.push_back({polygon, interior_point(polygon), std::abs(signed_area(polygon))});
  }
  Opener opener(least_area, near);
  opener.open(std::move(face));
  return opener.cuts;
}

}  // namespace talus
