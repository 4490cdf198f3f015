#include "talus/base/index.h"
#include "talus/geometry/open_holes.h"

#include <doctest/doctest.h>

#include <cmath>

#include "support/box_polygon.h"
#include "support/relative.h"
#include "support/shortest_tree.h"
#include "talus/base/random.h"
#include "talus/geometry/arrangement.h"
#include "talus/geometry/polygon_check.h"

namespace test_open_holes {

using namespace talus;
using namespace talus::test;

namespace {

double length_of(const std::vector<Polyline>& lines) {
  double sum = 0;
  for (const Polyline& l : lines)
    for (size_t k = 0; k + 1 < l.size(); ++k) sum += norm(l[k + 1] - l[k]);
  return sum;
}

// Distance of two rings that do not cross, corner by corner.
double distance(const Polyline& a, const Polyline& b) {
  double least = 1e300;
  for (const auto& [x, y] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const Vec2 p : *x)
      for (size_t k = 0; k < y->size(); ++k)
        least = std::min(least, distance_to_segment(p, (*y)[k], (*y)[(k + 1) % y->size()]));
  return least;
}

bool cross_anywhere(const Polyline& a, const Polyline& b) {
  const auto side = [](Vec2 o, Vec2 p, Vec2 q) { return cross(p - o, q - o) > 0; };
  for (size_t i = 0; i < a.size(); ++i)
    for (size_t k = 0; k < b.size(); ++k) {
      const Vec2 p = a[i], q = a[(i + 1) % a.size()], r = b[k], t = b[(k + 1) % b.size()];
      if (side(p, q, r) != side(p, q, t) && side(r, t, p) != side(r, t, q)) return true;
    }
  return false;
}

// The shortest tree that connects all rings.
double tree_length(const std::vector<Polyline>& rings) {
  return shortest_tree(rings.size(), [&rings](size_t i, size_t j) { return distance(rings[i], rings[j]); });
}

// Faces of the rings and the cuts, islands among them.
std::vector<Polygon> faces(const std::vector<Polyline>& rings, const std::vector<Polyline>& cuts) {
  std::vector<Polyline> lines = cuts;
  for (Polyline ring : rings) {
    ring.push_back(ring[0]);
    lines.push_back(ring);
  }
  const Arrangement net = arrange(lines, 0x1p-30, {0, 0});
  CHECK(net.rings_of_holed.empty());
  CHECK(net.dead_ends.empty());
  std::vector<Polygon> out;
  for (const auto& f : net.face) {
    out.emplace_back();
    for (const int p : f.point) out.back().push_back(net.point[p]);
  }
  return out;
}

Polygon star(Random& random, Vec2 center, double radius) {
  Polygon out;
  const int corners = 3 + static_cast<int>(6 * random.uniform());
  const double turn = 6.28 * random.uniform();
  for (int k = 0; k < corners; ++k) {
    const double a = turn + 2 * M_PI * k / corners, r = radius * (0.4 + 0.6 * random.uniform());
    out.push_back(center + Vec2{r * std::cos(a), r * std::sin(a)});
  }
  return out;
}

}  // namespace

TEST_CASE("cuts that open a hole: two, straight across the gap, and far apart") {
  const std::vector<Polyline> rings{box_polygon(0, 0, 10, 10), box_polygon(4, 1, 6, 3)};
  const auto cuts = opening_cuts(rings, 0.1, 1e-9);
  REQUIRE(cuts.size() == 2);
  CHECK(length_of(cuts) == approx(2));  // down to the side 1 m below
  CHECK(faces(rings, cuts).size() == 3);
  // from corner to corner: the piece between them is as large as the gap
  CHECK(std::abs(cuts[0][0].x - cuts[1][0].x) == approx(2));
}

TEST_CASE("cuts that open a hole: longer where the piece beside them would be a sliver") {
  const std::vector<Polyline> rings{box_polygon(0, 0, 10, 10), box_polygon(4, 0.01, 6, 3)};
  double least = 1e300;
  for (const Polygon& face : faces(rings, opening_cuts(rings, 1, 1e-9)))
    least = std::min(least, signed_area(face));
  CHECK(least >= 1);
}

TEST_CASE("cuts that open a hole: an island that touches the ring at a corner needs one") {
  const std::vector<Polyline> rings{box_polygon(0, 0, 10, 10), {{5, 0}, {6, 2}, {4, 2}}};
  const auto cuts = opening_cuts(rings, 0.1, 1e-9);
  CHECK(cuts.size() == 1);
  CHECK(faces(rings, cuts).size() == 3);
}

TEST_CASE("cuts that open a hole: none beside an edge that the grid makes one with it") {
  // of a random network: the island touches the ring at a corner, and edges of both go on nearly straight
  // there
  const std::vector<Polyline> rings{{{-1.766886711, -135.017883301},
                                     {-2.405463219, -135.271182060},
                                     {-2.675610542, -134.972914696},
                                     {-3.428407669, -134.141759872},
                                     {-3.362809181, -134.053074837},
                                     {-3.272314072, -133.930732727},
                                     {-3.564259529, -133.991766930},
                                     {-4.873910904, -132.545793533},
                                     {-4.134120941, -131.773878098},
                                     {-2.402442932, -129.967000008},
                                     {-0.778583527, -130.532567978},
                                     {0.260872841, -132.715235710},
                                     {-0.257416725, -132.938515663},
                                     {-0.916017532, -134.680377960},
                                     {-1.595655441, -134.949963570},
                                     {-1.606255531, -134.850469589}},
                                    {{-2.828163147, -133.330268860},
                                     {-2.908917427, -133.439444542},
                                     {-2.949295044, -133.494031906},
                                     {-3.272314072, -133.930732727},
                                     {-2.854527473, -133.843389511}}};
  const double grid = 0x1p-20;
  const auto cuts = opening_cuts(rings, 1e-11, 64 * grid);
  std::vector<Polyline> lines = cuts;
  for (Polyline ring : rings) {
    ring.push_back(ring[0]);
    lines.push_back(ring);
  }
  const Arrangement net = arrange(lines, grid, {0, 0});
  CHECK(net.rings_of_holed.empty());
  CHECK(net.face.size() == 3);
}

TEST_CASE("cuts that open holes of any face are short and leave simple polygons of some size") {
  int islands = 0;
  double longest = 0;
  for (uint64_t seed = 1; seed <= 120; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    std::vector<Polyline> rings{star(random, {0, 0}, 20)};
    for (int i = 0; i < 400 && rings.size() < 12; ++i) {
      const Vec2 center{40 * random.uniform() - 20, 40 * random.uniform() - 20};
      const Polygon island = star(random, center, 0.5 + 2 * random.uniform());
      bool is_free =
          contains(rings[0], center) && distance(island, rings[0]) > 0.3 && !cross_anywhere(island, rings[0]);
      for (const Vec2 p : island) is_free = is_free && contains(rings[0], p);
      for (const Vec2 p : rings[0]) is_free = is_free && !contains(island, p);
      for (size_t k = 1; k < rings.size(); ++k)
        is_free = is_free && distance(island, rings[k]) > 0.3 && !cross_anywhere(island, rings[k]) &&
                  !contains(rings[k], center) && !contains(island, rings[k][0]);
      if (is_free) rings.push_back(island);
    }
    if (rings.size() < 2) continue;
    double smallest = 1e300;
    for (size_t k = 1; k < rings.size(); ++k) smallest = std::min(smallest, std::abs(signed_area(rings[k])));
    const auto cuts = opening_cuts(rings, 0.25 * smallest, 1e-9);
    CHECK(cuts.size() == 2 * (rings.size() - 1));
    islands += count_of(rings) - 1;
    const auto pieces = faces(rings, cuts);
    CHECK(pieces.size() == 2 * (rings.size() - 1) + 1);  // Euler: islands, and one piece more for every cut
    for (const Polygon& piece : pieces) {
      CHECK(polygon_defect(piece) == "");
      CHECK(signed_area(piece) >= 0.25 * smallest * (1 - 1e-6));
    }
    const double share = length_of(cuts) / (2 * tree_length(rings));
    longest = std::max(longest, share);
    CHECK(share <= 1.3);
  }
  CHECK(islands > 250);
  MESSAGE("cuts at most ", longest, " times twice the tree");
}

TEST_CASE("cuts that open five hundred holes in one face") {
  Random random(7);
  std::vector<Polyline> rings{box_polygon(0, 0, 23, 23)};
  for (int i = 0; i < 22; ++i)
    for (int j = 0; j < 22; ++j) {
      const Vec2 center{i + 0.8 + 0.4 * random.uniform(), j + 0.8 + 0.4 * random.uniform()};
      rings.push_back(star(random, center, 0.1 + 0.15 * random.uniform()));
    }
  const auto cuts = opening_cuts(rings, 0, 1e-9);
  CHECK(cuts.size() == 2 * (rings.size() - 1));
  CHECK(faces(rings, cuts).size() == 2 * (rings.size() - 1) + 1);
  CHECK(length_of(cuts) <= 1.3 * 2 * tree_length(rings));
}

}  // namespace test_open_holes
