// Contact forces along smooth motions of a few blocks: the judge itself on laws that are known to be smooth
// or to jump, and what it finds of patches.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "support/box_polygon.h"
#include "support/contact_jumps.h"
#include "support/contact_paths.h"
#include "support/contact_paths_laws.h"
#include "support/relative.h"
#include "talus/audit/shapes.h"
#include "talus/base/index.h"
#include "talus/geometry/polygon_check.h"

namespace test_contact_paths {

using namespace talus;
using namespace talus::test;

namespace {

// A law without corners: two blocks are pressed apart along the line between their centroids by as much as
// their polygons overlap, and held across it by a spring that slips at 0.6 of that: smooth, with memory.
class OverlapForces : public ContactForces {
 public:
  explicit OverlapForces(const ContactPath& path) : path_(&path) {}
  std::unique_ptr<ContactForces> copy() const override { return std::make_unique<OverlapForces>(*this); }

  PathForces at(double s, double) override {
    const std::vector<Polygon> blocks = path_->placed(s);
    const std::vector<PathPose> pose = path_->pose(s);
    PathForces out(blocks.size());
    for (int a = 0; a < count_of(blocks); ++a)
      for (size_t b = a + 1; b < blocks.size(); ++b) {
        const double area = audit::common_part(blocks[a], blocks[b]).area;
        const Vec2 u = pose[a].displacement - pose[b].displacement;
        const Vec2 apart = path_->centroid[a] - path_->centroid[b] + u;
        const Vec2 n = apart / norm(apart), t = turn_right(n);
        double& anchor = anchor_.try_emplace({a, b}, dot(u, t)).first->second;
        constexpr double kElastic = 1e-3;  // [m] slip at which the shear is as large as the overlap
        const double slip = std::clamp(dot(u, t) - anchor, -0.6 * kElastic, 0.6 * kElastic);
        const double shear = -area * slip / kElastic;
        anchor = dot(u, t) - slip;
        add(a, area * n, shear * t, out), add(b, -area * n, -shear * t, out);
        out.pairs.push_back({a, static_cast<int>(b), area});
      }
    return out;
  }

 private:
  static void add(size_t block, Vec2 normal, Vec2 shear, PathForces& out) {
    out.normal[block].force += normal;
    out.whole[block].force += normal + shear;
    out.load[block] += norm(normal);
  }

  const ContactPath* path_;
  std::map<std::pair<size_t, size_t>, double> anchor_;
};

struct Planted {
  double size = 0;        // [m2]
  double place = 0;       // s
  double length = 0;      // in s, over which it comes; 0: a jump
  bool friction = false;  // of the whole forces alone
};

// Another law, and on block 0 a force that comes in at some place.
class PlantedForces : public ContactForces {
 public:
  PlantedForces(const ContactForces& law, const Planted& planted) : law_(law.copy()), planted_(planted) {}
  std::unique_ptr<ContactForces> copy() const override {
    return std::make_unique<PlantedForces>(*law_, planted_);
  }

  PathForces at(double s, double ds) override {
    PathForces out = law_->at(s, ds);
    const double past = s - planted_.place;
    const double share = planted_.length > 0 ? 0.5 + 0.5 * std::tanh(past / planted_.length) : past >= 0;
    if (!planted_.friction) out.normal[0].force.x += share * planted_.size;
    out.whole[0].force.x += share * planted_.size;
    return out;
  }

 private:
  std::unique_ptr<ContactForces> law_;
  Planted planted_;
};

// Forces of another law; those said to act between pairs changed.
class SpoiltForces : public ContactForces {
 public:
  SpoiltForces(const ContactForces& law, double factor, double more)
      : law_(law.copy()), factor_(factor), more_(more) {}
  std::unique_ptr<ContactForces> copy() const override {
    return std::make_unique<SpoiltForces>(*law_, factor_, more_);
  }
  PathForces at(double s, double ds) override {
    PathForces out = law_->at(s, ds);
    for (PairForce& p : out.pairs) p.normal = factor_ * p.normal + more_;
    return out;
  }

 private:
  std::unique_ptr<ContactForces> law_;
  double factor_, more_;
};

// Two boxes, the upper one 1 m wide, on its way along a wide one at a given overlap.
ContactPath pressed_box(double closure, double way) {
  ContactPath path;
  path.blocks = {box_polygon(-2, -1, 2, 0), box_polygon(-0.5, 0, 0.5, 1)};
  path.centroid = {{0, -0.5}, {0, 0.5}};
  path.pose = [=](double s) { return std::vector<PathPose>{{}, {{way * s, -closure}, 0}}; };
  return path;
}

}  // namespace

TEST_CASE("contact paths: blocks are whole, touch and move without jumps, the same for the same seed") {
  for (const char family : kPathFamilies)
    for (uint64_t seed = 1; seed <= 6; ++seed) {
      INFO("family " << family << ", seed " << seed);
      const ContactPath path = contact_path(family, seed);
      REQUIRE(path.blocks.size() >= 2);
      REQUIRE(path.blocks.size() <= 4);
      for (const Polygon& p : path.blocks) CHECK(polygon_defect(p) == "");
      for (const Polygon& p : path.blocks) CHECK(signed_area(p) > 0.05);
      CHECK(contact_path(family, seed).placed(0.3) == path.placed(0.3));
      CHECK(contact_path(family, seed + 100).placed(0.3) != path.placed(0.3));
      double share = 0;
      for (const double s : {0.1, 0.3, 0.5, 0.7, 0.9}) {
        const std::vector<Polygon> now = path.placed(s);
        for (size_t a = 0; a < now.size(); ++a)
          for (size_t b = a + 1; b < now.size(); ++b)
            share = std::max(share, audit::common_part(now[a], now[b]).area / (path.size * path.size));
      }
      CHECK(share > 1e-10);
      CHECK(share < 0.05);
    }
  // drawn by our own generator: no machine differs
  CHECK(std::abs(contact_path('f', 1).size - 0.676022795898084) < 1e-12);
}

TEST_CASE("contact paths: a planted jump is found where it is, a steep rise is none") {
  for (const char family : kPathFamilies)
    for (uint64_t seed = 1; seed <= 2; ++seed) {
      INFO("family " << family << ", seed " << seed);
      const ContactPath path = contact_path(family, seed);
      const OverlapForces smooth(path);
      const PathFindings none = walk(path, smooth);
      REQUIRE(none.load > 0);
      CHECK(none.normal.size == 0);
      CHECK(none.whole.size == 0);
      CHECK(none.without_overlap == 0);
      CHECK(none.without_force == 0);
      CHECK(none.force_by_area == approx(1));

      const double place = 0.2345678912 + 0.1 * static_cast<double>(seed);
      const PathFindings jump = walk(path, PlantedForces(smooth, {1e-3 * none.load, place, 0, false}));
      CHECK(std::abs(jump.normal.size / 1e-3 - 1) < 0.12);  // of a change just before it settles
      CHECK(jump.normal.at == approx(place).epsilon(1e-6));
      CHECK(jump.whole.size == 0);  // less than counts
      const PathFindings steep = walk(path, PlantedForces(smooth, {1e-3 * none.load, place, 1e-4, false}));
      CHECK(steep.normal.size == 0);
      const PathFindings slip = walk(path, PlantedForces(smooth, {2e-2 * none.load, place, 0, true}));
      CHECK(slip.normal.size == 0);
      CHECK(std::abs(slip.whole.size / 2e-2 - 1) < 0.12);
      CHECK(slip.whole.at == approx(place).epsilon(1e-6));
    }
}

TEST_CASE(
    "contact paths: a force that is no number, forces without overlap and overlaps without force are found") {
  const ContactPath path = pressed_box(1e-3, 0.01);
  const OverlapForces law(path);
  const PathFindings none = walk(path, law);
  CHECK(none.looked_at == 301);
  CHECK(walk(path, SpoiltForces(law, 0, 0)).without_force == none.looked_at);
  ContactPath above = pressed_box(-1e-3, 0.01);
  const OverlapForces nothing(above);
  CHECK(walk(above, nothing).load == 0);
  // pairs of a law that loads the blocks all the same
  CHECK(walk(path, SpoiltForces(law, 1, none.load)).without_overlap == 0);
  above.pose = [pose = std::move(above.pose)](double s) {
    std::vector<PathPose> all = pose(s);
    if (s < 0.5) all[1].displacement.y = -1e-3;
    return all;
  };
  const PathFindings ghost = walk(above, SpoiltForces(OverlapForces(above), 1, 1e-4));
  CHECK(ghost.without_overlap == 151);
  CHECK(ghost.normal.size == 0);  // it is the path that jumps
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(walk(path, PlantedForces(law, {nan, 0.7, 0, false})).normal.size == HUGE_VAL);
}

TEST_CASE("contact paths: patches bear the overlap of a face, and its shear up to the friction") {
  const ContactPath path = pressed_box(1e-3, 1e-2);
  const auto law = patch_forces(path);
  PathForces now;
  constexpr int kSteps = 100;                     // of 0.1 mm
  constexpr double kBears = 1e-3 * (1 - 0.5e-3);  // its ends bear half (theory 3.2)
  for (int i = 0; i <= kSteps; ++i) {
    now = law->at(static_cast<double>(i) / kSteps, 1.0 / kSteps);
    CHECK(now.normal[1].force.y == approx(kBears));
    CHECK(now.normal[0].force.y == approx(-kBears));
    CHECK(now.load[1] == approx(kBears));
    CHECK(now.whole[1].force.x == approx(-std::min(1e-4 * i, 0.6 * kBears)));
  }
}

namespace {

using Law = std::unique_ptr<ContactForces> (*)(const ContactPath&);

struct Defects {
  int touching = 0, normal = 0, whole = 0, without_overlap = 0, without_force = 0;
  Jump worst_normal, worst_whole;
};

// What is wrong along the paths of a family from seed 1 on, printed as a line of a table.
Defects defects_of(Law law, const JumpSearch& search, char family, double deepest, uint64_t paths) {
  Defects d;
  for (uint64_t seed = 1; seed <= paths; ++seed) {
    const ContactPath path = contact_path(family, seed, deepest);
    const PathFindings found = walk(path, *law(path), search);
    if (found.load == 0) continue;
    ++d.touching;
    d.normal += found.normal.size > 0, d.whole += found.whole.size > 0;
    d.without_overlap += found.without_overlap > 0, d.without_force += found.without_force > 0;
    if (found.normal.size > d.worst_normal.size) d.worst_normal = found.normal;
    if (found.whole.size > d.worst_whole.size) d.worst_whole = found.whole;
  }
  fmt::print("| {} | {:g} | {} | {} | {:.3g} | {} | {:.3g} | {} | {} |\n", family, deepest, d.touching,
             d.normal, d.worst_normal.size, d.whole, d.worst_whole.size, d.without_overlap, d.without_force);
  return d;
}

// No normal force jumps by 1e-4 of the load, none with friction and memory by 1e-2; no force without overlap, no
// overlap without force.
void patches_are_continuous(uint64_t paths) {
  const auto check = [&](char family, double deepest) {
    CAPTURE(family);
    CAPTURE(deepest);
    const Defects d = defects_of(patch_forces, {.normal = 1e-4, .whole = 1e-2}, family, deepest, paths);
    CHECK(d.touching > 0.9 * static_cast<double>(paths));
    CHECK(d.normal == 0);
    CHECK(d.whole == 0);
    CHECK(d.without_overlap + d.without_force == 0);
  };
  for (const char family : kPathFamilies) check(family, kDeepestClosure);
  for (const char family : {'a', 'b', 'd'}) check(family, 5e-2);
}

}  // namespace

TEST_CASE("contact paths: forces of patches do not jump along thirty paths of each family") {
  patches_are_continuous(30);
}

TEST_SUITE("long: paths") {
  TEST_CASE("contact paths: forces of patches do not jump along many paths") { patches_are_continuous(2000); }
}

}  // namespace test_contact_paths
