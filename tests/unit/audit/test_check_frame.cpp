#include "talus/audit/check_frame.h"
#include "talus/base/index.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include "support/box_polygon.h"
#include "support/relative.h"
#include "talus/audit/read_results.h"
#include "talus/audit/tip.h"

namespace test_check_frame {

using namespace talus;
using namespace talus::test;
using namespace talus::audit;

namespace {

// Blocks of 1 m; names "b0", "b1" ...; one joint: friction 30 deg, 20 GPa/m where it is soft.
struct Case {
  Rules rules;
  Frame frame;

  explicit Case(const std::vector<Polygon>& polygons, double stiffness = 0) {
    for (const Polygon& p : polygons) {
      rules.names.push_back("b" + std::to_string(rules.names.size()));
      frame.blocks.push_back({Hold::kFree, p, {}});
    }
    rules.laws.push_back({.friction = std::tan(std::acos(-1) / 6), .normal_stiffness = stiffness});
    rules.slop = 1e-7;
    rules.joints_everywhere = true;
    frame.time = 2, frame.step = 1e-4;
  }
  // a corner of block a over an edge of block b
  Point& add(int a, int corner, int b, int edge, double gap, double normal, double shear = 0) {
    Point p;
    p.block_a = a, p.corner = corner, p.block_b = b, p.edge = edge;
    p.gap = gap, p.normal_force = normal, p.shear_force = shear, p.joint = 0;
    frame.points.push_back(p);
    return frame.points.back();
  }
  void pair_last_two() {
    const int n = count_of(frame.points);
    frame.points[n - 1].partner = n - 2;
    frame.points[n - 2].partner = n - 1;
  }
  FrameResult look() const { return check_frame(rules, frame); }
};

bool has(const FrameResult& r, Defect defect, bool invalid) {
  return std::any_of(r.findings.begin(), r.findings.end(),
                     [&](const Finding& f) { return f.defect == defect && f.invalid == invalid; });
}

bool has_any(const FrameResult& r, Defect defect) { return has(r, defect, false) || has(r, defect, true); }

// A block on a wider one, `closure` inside it, one point at each end.
Case face(double closure, double force, double stiffness = 0) {
  Case c({box_polygon(-1, -1, 2, 0), box_polygon(0, -closure, 1, 1 - closure)}, stiffness);
  c.add(1, 0, 0, 2, -closure, force);
  c.add(1, 1, 0, 2, -closure, force);
  c.pair_last_two();
  return c;
}

}  // namespace

TEST_CASE("audit: a face whose two ends account for its overlap is clean, at a closure of 4 % too") {
  for (const double closure : {0.0, 1e-6, 1e-3, 0.04}) {
    const FrameResult r = face(closure, 1e5).look();
    CHECK(r.findings.empty());
    CHECK(r.unexplained_share < 1e-12);
    CHECK(r.closure_share == approx(closure));
  }
  // of the thinner: 3 m wide and 1 m high against 1 m x 1 m
  CHECK(has(face(0.06, 1e5).look(), Defect::kDeepClosure, false));
  CHECK(has(face(0.3, 1e5).look(), Defect::kDeepClosure, true));
}

TEST_CASE("audit: an overlap that no point accounts for is named with its pair, place and share") {
  Case c = face(0.02, 1e5);
  c.frame.points.clear();
  FrameResult r = c.look();
  REQUIRE(r.findings.size() == 1);
  const Finding& f = r.findings[0];
  CHECK(f.defect == Defect::kUnexplainedOverlap);
  CHECK(f.invalid);
  CHECK(f.block_a == 0);
  CHECK(f.block_b == 1);
  CHECK(f.time == 2);
  CHECK(f.share == approx(0.02));
  CHECK(f.place.x == approx(0.5));
  CHECK(f.place.y == approx(-0.01));

  c = face(1e-3, 1e5);
  c.frame.points.clear();
  CHECK(has(c.look(), Defect::kUnexplainedOverlap, false));  // 0.1 %: a warning
  c = face(5e-5, 1e5);
  c.frame.points.clear();
  CHECK(c.look().findings.empty());

  // points that tell too small a depth explain only that
  c = face(0.02, 1e5);
  for (Point& p : c.frame.points) p.gap = -0.005;
  CHECK(c.look().unexplained_share == approx(0.015).epsilon(1e-4));
}

TEST_CASE(
    "audit: a corner alone accounts for its wedge, a block across a crossing for the product of closures") {
  // a square on its corner, 1 cm deep: legs at 45 degrees, area d^2
  const double d = 0.01, r = std::sqrt(0.5);
  Case c({box_polygon(-1, -1, 1, 0), {{0, -d}, {r, r - d}, {0, 2 * r - d}, {-r, r - d}}});
  c.add(1, 0, 0, 2, -d, 1e5);
  CHECK(c.look().findings.empty());
  CHECK(c.look().unexplained_share < 1e-9);
  c.frame.points.clear();
  CHECK(c.look().unexplained_area == approx(d * d));

  // four blocks at a crossing of two joints closed by 2 cm: 0 and 3 overlap by 2 cm x 2 cm, at no point
  const double k = 0.02;
  Case x({box_polygon(0, 0, 1, 1), box_polygon(1 - k, 0, 2 - k, 1), box_polygon(0, 1 - k, 1, 2 - k),
          box_polygon(1 - k, 1 - k, 2 - k, 2 - k)});
  const auto join = [&x, k](int a, int corner_0, int corner_1, int b, int edge) {
    x.add(a, corner_0, b, edge, -k, 1e5);
    x.add(a, corner_1, b, edge, -k, 1e5);
    x.pair_last_two();
  };
  join(1, 3, 0, 0, 1), join(2, 0, 1, 0, 2), join(3, 0, 1, 1, 2), join(3, 3, 0, 2, 1);
  CHECK(x.look().unexplained_share < 1e-9);
  x.frame.points.resize(4);  // 3 without an interface: its overlaps with 1 and 2, and across, are nobody's
  CHECK(has(x.look(), Defect::kUnexplainedOverlap, true));
}

TEST_CASE("audit: an intact glued face accounts for its overlap by its two ends") {
  Case c({box_polygon(0, 0, 1, 1), box_polygon(0, 0.98, 1, 1.98)});
  for (const double x : {0.0, 1.0}) {
    Point p;
    p.block_a = 1, p.block_b = 0, p.place = {x, 0.98}, p.normal_force = 1e5, p.joint = 0;
    c.frame.points.push_back(p);
  }
  c.pair_last_two();
  CHECK(c.look().findings.empty());
  CHECK(c.look().unexplained_share < 1e-9);
}

TEST_CASE("audit: prescribed blocks that overlap are not valid") {
  Case c({box_polygon(0, 0, 1, 1), box_polygon(0.9, 0, 2, 1)});
  c.frame.blocks[0].hold = c.frame.blocks[1].hold = Hold::kPrescribed;
  const FrameResult r = c.look();
  REQUIRE(r.findings.size() == 1);
  CHECK(r.findings[0].defect == Defect::kPrescribedOverlap);
  CHECK(r.findings[0].invalid);
  CHECK(r.findings[0].share == approx(0.1));
  CHECK(r.unexplained_share == 0);
  c.frame.blocks[1].polygon = box_polygon(1, 0, 2, 1);
  CHECK(c.look().findings.empty());
  c.frame.blocks[1] = {Hold::kRemoved, {}, {}};
  CHECK(c.look().findings.empty());
}

TEST_CASE("audit: a force needs the two in touch") {
  const auto lifted = [](double gap) {
    Case c({box_polygon(-1, -1, 2, 0), box_polygon(0, gap, 1, 1 + gap)});
    c.add(1, 0, 0, 2, gap, 1e5);
    c.add(1, 1, 0, 2, gap, 1e5);
    c.pair_last_two();
    return c;
  };
  CHECK(has(lifted(1e-3).look(), Defect::kForceAcrossGap, true));
  CHECK(lifted(5e-6).look().findings.empty());
  // a gap that closes within the step, a rise over roughness, closure by the stress of the ground
  Case c = lifted(1e-3);
  c.frame.blocks[1].velocity.assign(4, {0, -5});
  CHECK(c.look().findings.empty());
  c = lifted(1e-3);
  for (Point& p : c.frame.points) p.rise = 1e-3;
  CHECK(c.look().findings.empty());
  c = lifted(1e-3);
  for (Point& p : c.frame.points) p.in_situ = 1e-3;
  CHECK(c.look().findings.empty());
}

TEST_CASE("audit: a force at a point without a joint, where the model gives joints, warns") {
  Case c = face(0, 1e5);
  c.frame.points[0].joint = c.frame.points[1].joint = kNoJoint;
  CHECK(has(c.look(), Defect::kNoJoint, false));
  c.rules.joints_everywhere = false;
  CHECK(c.look().findings.empty());
}

TEST_CASE("audit: a corner on a side that the next block covers is not valid") {
  // 2 stands on 0 and 1, its left lower corner 1 um inside the left side of 1, which 0 covers
  const double d = 1e-6;
  const auto stack = [d](double opening, double step, double depth) {
    Case c({box_polygon(-1, 0, 0 - opening, 1), box_polygon(0, 0, 1, 1 + step),
            box_polygon(-1, 1 - depth, d, 2)});
    c.add(2, 1, 1, 3, -d, 1e5);
    c.add(2, 0, 0, 2, -depth, 1e5);
    c.add(0, 2, 2, 0, -depth, 1e5);  // the other end of what they share
    c.pair_last_two();
    return c.look();
  };
  CHECK(has(stack(0, 0, 1e-5), Defect::kCoveredSide, true));
  CHECK(has(stack(2e-5, 0, 1e-5), Defect::kCoveredSide, true));  // a hair gap hides nothing
  // a real step of 1 mm, and a corner that has fallen 1 cm into a gap of 1 cm
  CHECK(!has(stack(0, 1e-3, 0), Defect::kCoveredSide, true));
  CHECK(!has(stack(0.01, 0, 0.01), Defect::kCoveredSide, true));

  // level blocks, and a closure that is deeper than a hair gap: still no way out
  CHECK(has(stack(0, 0, 1e-3), Defect::kCoveredSide, true));
  // a step of 3 mm beside a slot of 11 mm, and a corner on a soft joint that has gone into its side by 6 mm: it stands
  // before the step, though that is lower than the corner is deep, since the floor has closed by 30 um only
  const auto before_step = [](double step) {
    Case c(
        {box_polygon(-1, 0, -0.011, 1), box_polygon(0, 0, 1, 1 + step), box_polygon(-1, 1 - 3e-5, 6e-3, 2)});
    c.add(2, 1, 1, 3, -6e-3, 1e5);
    c.add(2, 0, 0, 2, -3e-5, 1e5);
    c.add(0, 2, 2, 0, -3e-5, 1e5);
    c.pair_last_two();
    return c.look();
  };
  CHECK(!has(before_step(3e-3), Defect::kCoveredSide, true));

  // the top of 1, on the other hand, is its way out
  Case c({box_polygon(-1, 0, 0, 1), box_polygon(0, 0, 1, 1), box_polygon(-1, 1 - d, d, 2)});
  c.add(2, 1, 1, 2, -d, 1e5);
  CHECK(!has(c.look(), Defect::kCoveredSide, true));
}

TEST_CASE("audit: what is glued to the corner's own block does not make a side a way out") {
  // 0 and 1 glued, 2 and 3 glued on top; the corner of 1 bears on the right side of 2, level with that of 0
  Case c(
      {box_polygon(-1, 0, 0, 1), box_polygon(0, 0, 1, 1), box_polygon(-1, 1, 0, 2), box_polygon(0, 1, 1, 2)});
  c.frame.blocks[1].polygon[3].y = 1 + 1e-6;
  c.add(1, 3, 2, 1, 0, 1e5);
  for (const auto& [a, b, y] : {std::tuple{0, 1, 0.0}, std::tuple{2, 3, 1.0}}) {
    for (const double end : {0.0, 1.0}) {
      Point p;
      p.block_a = a, p.block_b = b, p.place = {0, y + end}, p.joint = 0;
      c.frame.points.push_back(p);
    }
    c.pair_last_two();
  }
  CHECK(has(c.look(), Defect::kCoveredSide, true));
}

TEST_CASE("audit: a tip that is pressed out through what the next block covers is not valid") {
  // a wedge in the corner of a wall (1) that stands on a floor (0), or beside one; 1 mm in both
  struct Tip {
    double lean;  // of the normal of the wall's force below the horizontal [deg]
    double force = 1e5;
    Polygon wall = box_polygon(-1, 0, 0, 2), floor = box_polygon(-1, -1, 2, 0);
    double lifted = 0;
  };
  const auto look = [](const Tip& tip) {
    const double d = 1e-3, degree = std::acos(-1) / 180;
    Polygon wall = tip.wall;
    for (Vec2& x : wall) x.y += tip.lifted;
    Case c({tip.floor, wall, {{-d, -d}, {1 - d, 0.3}, {0.7, 0.8}}});
    const auto patch = [&c](int b, Vec2 from, Vec2 to, Vec2 normal, double force) {
      for (const Vec2 x : {from, to}) {
        Point p;
        p.block_a = 2, p.block_b = b, p.edge = -2, p.corner = -2, p.place = x, p.normal = normal;
        p.gap = -1e-3, p.normal_force = 0.5 * force, p.joint = 0;
        c.frame.points.push_back(p);
      }
      c.pair_last_two();
    };
    patch(0, {-d, -d / 2}, {2 * d, -d / 2}, {0, 1}, 1e5);
    patch(1, {-d / 2, -d}, {-d / 2, 2 * d}, {std::cos(tip.lean * degree), -std::sin(tip.lean * degree)},
          tip.force);
    return c.look();
  };
  CHECK(!has_any(look({0}), Defect::kCoveredSide));
  CHECK(!has_any(look({4.5}), Defect::kCoveredSide));
  CHECK(has(look({5.5}), Defect::kCoveredSide, true));
  CHECK(has(look({30}), Defect::kCoveredSide, true));
  CHECK(has(look({90}), Defect::kCoveredSide, true));
  // that of a patch which hardly bears counts less, and then not at all
  CHECK(has(look({30, 5e3}), Defect::kCoveredSide, false));
  CHECK(has(look({30, 7e2}), Defect::kCoveredSide, false));
  CHECK(!has_any(look({30, 5e2}), Defect::kCoveredSide));
  // upwards nothing is in the way of the wedge
  CHECK(!has_any(look({-30}), Defect::kCoveredSide));
  Tip lifted{30};
  lifted.lifted = 1e-4;
  CHECK(has(look(lifted), Defect::kCoveredSide, true));
  lifted.lifted = 0.01;
  CHECK(!has_any(look(lifted), Defect::kCoveredSide));
  // a mitred wall: its own face is steeper than what covers its bottom
  const Polygon mitred{{-1, -1}, {0, 0}, {0, 2}, {-1, 2}}, floor{{-1, -1}, {2, -1}, {2, 0}, {0, 0}};
  CHECK(!has_any(look({0, 1e5, mitred, floor}), Defect::kCoveredSide));
  CHECK(has(look({40, 1e5, mitred, floor}), Defect::kCoveredSide, true));
}

TEST_CASE("audit: a side that a force is normal to, near by and within 5 degrees") {
  const double degree = std::acos(-1) / 180;
  const auto has = [&](double turned, Vec2 place) {
    return has_side(box_polygon(0, 0, 1, 1), {std::cos(turned * degree), std::sin(turned * degree)},
                    {place, place, 1e-3, 0});
  };
  CHECK(has(0, {1, 0.5}));
  CHECK(has(4.5, {1, 0.5}));
  CHECK(!has(5.5, {1, 0.5}));
  CHECK(!has(180, {1, 0.5}));
  CHECK(has(0, {1.0009, 1}));
  CHECK(!has(0, {1.0011, 1}));
}

TEST_CASE("audit: resultants of faces are held to the joint's law") {
  const double mu = std::tan(std::acos(-1) / 6);
  Case c = face(0, 1e5);
  c.frame.points[0].shear_force = 1.2 * mu * 1e5, c.frame.points[1].shear_force = 0.79 * mu * 1e5;
  CHECK(c.look().findings.empty());  // the resultant counts
  c.frame.points[1].shear_force = 0.9 * mu * 1e5;
  CHECK(has(c.look(), Defect::kShearLaw, true));
  c.rules.laws[0].cohesion = 1e5;
  CHECK(c.look().findings.empty());
  c.frame.points[0].normal_force = c.frame.points[1].normal_force = -1e5;
  CHECK(has(c.look(), Defect::kShearLaw, true));
  c.rules.laws[0].tension = 3e5;
  c.frame.points[0].shear_force = c.frame.points[1].shear_force = 0;
  CHECK(c.look().findings.empty());
  c.frame.points[0].joint = c.frame.points[1].joint = kUnknownJoint;
  c.rules.laws[0] = {};
  CHECK(c.look().findings.empty());  // what is not known is not asked for
}

TEST_CASE("audit: an elastic joint pushes by its stiffness times the overlap") {
  const double kn = 1e9, closure = 1e-3;
  CHECK(face(closure, 0.5 * kn * closure, kn).look().findings.empty());
  CHECK(has(face(closure, 0.5 * kn * closure / 3, kn).look(), Defect::kNormalLaw, false));
  CHECK(has(face(closure, 0.5 * kn * closure / 12, kn).look(), Defect::kNormalLaw, true));
  CHECK(has(face(closure, 6 * kn * closure, kn).look(), Defect::kNormalLaw, true));
}

namespace {

// A block on a wider one as a patch of an elastic joint, closed by `closure`; forces times `scale`.
Case patch(double closure, double scale, double kn = 1e9) {
  Case c({box_polygon(-1, -1, 2, 0), box_polygon(0, -closure, 1, 1 - closure)}, kn);
  for (const int end : {0, 1}) {
    Point p;
    p.block_a = 0, p.block_b = 1, p.corner = end, p.edge = -2, p.joint = 0;
    p.place = {1.0 - end, 0}, p.normal = {0, -1}, p.gap = -closure, p.closing = 0;
    p.normal_force = scale * 0.5 * kn * closure * (1 - 0.5 * closure);
    c.frame.points.push_back(p);
  }
  c.pair_last_two();
  return c;
}

}  // namespace

TEST_CASE("audit: stiffness times overlap is asked of one interface that hardly moves") {
  const double c = 1e-3;
  CHECK(has_any(patch(c, 6).look(), Defect::kNormalLaw));
  Case moves = patch(c, 6), slow = patch(c, 6);  // in three steps by 0.15 and 0.03 of the closure
  for (Point& p : moves.frame.points) p.closing = 0.05 * c;
  for (Point& p : slow.frame.points) p.closing = 0.01 * c;
  CHECK(!has_any(moves.look(), Defect::kNormalLaw));
  CHECK(has_any(slow.look(), Defect::kNormalLaw));
  Case two = patch(c, 6);  // ends on two sides at 0.2 rad
  two.frame.points[1].normal = {std::sin(0.2), -std::cos(0.2)};
  CHECK(!has_any(two.look(), Defect::kNormalLaw));
  Case ground =
      patch(c, 6);  // a tunnel's blocks have slid to the next ones, whose outlines are moved as theirs are
  ground.rules.in_situ = true;
  CHECK(!has_any(ground.look(), Defect::kNormalLaw));
}

TEST_CASE("audit: the force of a patch is that of the energy of the overlap") {
  for (const double closure : {1e-7, 1e-4, 0.02}) {
    const FrameResult r = patch(closure, 1).look();
    CHECK(r.findings.empty());
    CHECK(r.patches_by_energy == 1);
    CHECK(has(patch(closure, 1.05).look(), Defect::kEnergyLaw, true));
    CHECK(has(patch(closure, 0.95).look(), Defect::kEnergyLaw, true));
    CHECK(has(patch(closure, 1.02).look(), Defect::kEnergyLaw, false));
    CHECK(!has_any(patch(closure, 1.009).look(), Defect::kEnergyLaw));
  }
  const double c = 1e-4;
  // the force belongs to where the two are half as closed
  Case moving = patch(c, 0.5);
  for (Point& p : moving.frame.points) p.closing = -0.5 * c * (1 - 0.5 * c);
  CHECK(moving.look().patches_by_energy == 1);
  CHECK(!has_any(moving.look(), Defect::kEnergyLaw));
  for (Point& p : moving.frame.points) p.normal_force *= 2;
  CHECK(has(moving.look(), Defect::kEnergyLaw, true));
  // as large, another way
  Case aside = patch(c, 1);
  for (Point& p : aside.frame.points) p.normal = {std::sin(0.05), -std::cos(0.05)};
  CHECK(has(aside.look(), Defect::kEnergyLaw, true));
}

TEST_CASE("audit: what of an overlap is nearer to the sides beside a face is accounted for, no more") {
  // the block's two end cells, half of the square of the closure each, push along the face
  const double c = 0.02;
  const auto told = [&](double less) {
    Case one = patch(c, 1);
    for (Point& p : one.frame.points) p.gap = -(c - less);
    return one.look();
  };
  CHECK(!has_any(told(0.5 * c * c), Defect::kUnexplainedOverlap));
  CHECK(has(told(3 * c * c), Defect::kUnexplainedOverlap, false));
}

TEST_CASE("audit: what else may close or hold a patch is not compared with its energy") {
  const auto not_judged = [](auto change) {
    Case c = patch(1e-4, 1.05);
    change(c);
    const FrameResult r = c.look();
    CHECK(r.patches_by_energy == 0);
    CHECK(!has_any(r, Defect::kEnergyLaw));
  };
  not_judged([](Case& c) { c.rules.in_situ = true; });
  not_judged([](Case& c) { c.rules.changes = true; });
  not_judged([](Case& c) { c.rules.laws[0].dilates = true; });
  not_judged([](Case& c) { c.frame.points[0].joint = c.frame.points[1].joint = kUnknownJoint; });
  not_judged([](Case& c) { c.frame.points[0].closing = Point::kNotKnown; });
  not_judged([](Case& c) { c.frame.points[0].normal_force = 0; });
  not_judged([](Case& c) { c.rules.tolerance = 1e-6; });  // a hundredth of the closure
  not_judged([](Case& c) {                                // a notch
    c.frame.blocks[1].polygon.insert(c.frame.blocks[1].polygon.begin() + 2, {0.9, 0.5});
  });
  not_judged([](Case& c) {  // glued to a third one
    c.frame.blocks.push_back({Hold::kFree, box_polygon(0, 1 - 1e-4, 1, 2), {}});
    c.rules.names.push_back("b2");
    for (const double x : {0.0, 1.0}) {
      Point p;
      p.block_a = 2, p.block_b = 1, p.place = {x, 1}, p.joint = 0;
      c.frame.points.push_back(p);
    }
    c.pair_last_two();
  });
}

TEST_CASE("audit: of many patches each frame compares some, and two frames all") {
  constexpr int kPairs = 700;
  Case c({});
  c.rules.laws[0].normal_stiffness = 1e9;
  for (int k = 0; k < kPairs; ++k) {
    Case one = patch(1e-4, 1);
    for (Block& b : one.frame.blocks) {
      for (Vec2& x : b.polygon) x.x += 4 * k;
      c.frame.blocks.push_back(b), c.rules.names.emplace_back("b");
    }
    for (Point& p : one.frame.points) {
      p.block_a += 2 * k, p.block_b += 2 * k, p.place.x += 4 * k;
      c.frame.points.push_back(p);
    }
    c.pair_last_two();
  }
  const int first = check_frame(c.rules, c.frame, Workers(), 0).patches_by_energy,
            second = check_frame(c.rules, c.frame, Workers(2), 1).patches_by_energy;
  CHECK(first <= 500);
  CHECK(first + second == kPairs);
}

TEST_CASE("audit: a patch that presses between outlines apart is not valid, whatever it says of its gap") {
  const auto apart = [](double gap) {
    Case c = patch(1e-3, 1, 0);
    c.frame.blocks[1].polygon = box_polygon(0, gap, 1, 1 + gap);
    for (Point& p : c.frame.points) p.normal_force = 1e5;
    return c;
  };
  CHECK(has(apart(1e-3).look(), Defect::kForceAcrossGap, true));
  CHECK(!has_any(apart(5e-6).look(), Defect::kForceAcrossGap));
  // what closes it before the force acts, by speed where the frame does not say, rise, and stress of the ground
  Case c = apart(1e-3);
  for (Point& p : c.frame.points) p.closing = 1e-3;
  CHECK(!has_any(c.look(), Defect::kForceAcrossGap));
  c = apart(1e-3);
  for (Point& p : c.frame.points) p.closing = Point::kNotKnown;
  CHECK(has(c.look(), Defect::kForceAcrossGap, true));
  c.frame.blocks[1].velocity.assign(4, {0, -5});
  CHECK(!has_any(c.look(), Defect::kForceAcrossGap));
  c = apart(1e-3);
  for (Point& p : c.frame.points) p.rise = 1e-3;
  CHECK(!has_any(c.look(), Defect::kForceAcrossGap));
  c = apart(1e-3);
  for (Point& p : c.frame.points) p.in_situ = 1e-3;
  CHECK(!has_any(c.look(), Defect::kForceAcrossGap));
  c = apart(1e-3);
  c.rules.in_situ = true;  // moved outlines of sides that did not face each other
  CHECK(!has_any(c.look(), Defect::kForceAcrossGap));
}

TEST_CASE("audit: an overlap without a patch counts by what its joint would push with") {
  // 1e-6 of the block, at 1e9 Pa/m 1 kN where forces are 50 kN
  const auto bare = [](double depth) {
    Case c = patch(1e-4, 1);
    c.frame.blocks.push_back({Hold::kFree, box_polygon(-1, -2, 2, -1 + depth / 3), {}});
    c.rules.names.push_back("b2");
    return c;
  };
  CHECK(has(bare(1e-6).look(), Defect::kUnexplainedOverlap, false));
  CHECK(has(bare(1e-5).look(), Defect::kUnexplainedOverlap, true));
  CHECK(!has_any(bare(1e-7).look(), Defect::kUnexplainedOverlap));
  Case c = bare(1e-5);
  c.rules.laws.push_back({});  // a hard joint: no stiffness to ask by
  CHECK(!has_any(c.look(), Defect::kUnexplainedOverlap));
  c = bare(1e-5);
  for (const double x : {-1.0, 2.0}) {  // a bond between them accounts for it
    Point p;
    p.block_a = 2, p.block_b = 0, p.place = {x, -1}, p.joint = 0;
    c.frame.points.push_back(p);
  }
  c.pair_last_two();
  CHECK(!has_any(c.look(), Defect::kUnexplainedOverlap));
}

TEST_CASE(
    "audit: an overlap of a crumb between joints with stiffness is a warning while its force is nothing") {
  // a crumb of 1e-2 m that lies by a tenth in another block: 1e-5 m2, at 1e9 Pa/m 10 kN; and one of 1 mm, 0.1 kN of 50 kN
  const auto crumb = [](double size) {
    Case c = patch(1e-4, 1);
    c.frame.blocks.push_back(
        {Hold::kFree, box_polygon(0.2, -1 - 0.9 * size, 0.2 + size, -1 + 0.1 * size), {}});
    c.rules.names.push_back("crumb");
    return c;
  };
  CHECK(has(crumb(1e-2).look(), Defect::kUnexplainedOverlap, true));
  CHECK(has(crumb(1e-3).look(), Defect::kUnexplainedOverlap, false));
  Case hard = crumb(1e-3);
  hard.rules.laws.push_back({});
  CHECK(has(hard.look(), Defect::kUnexplainedOverlap, true));
}

TEST_CASE("audit: elastic joints give back no more than they have taken") {
  const auto given = [](double work, double friction, bool lifting, const Rules& rules = {},
                        double slack = 0) {
    Report report;
    report.slack = slack;
    add_joint_work(rules, work, friction, 1000, lifting, 0.5, report);
    return !report.valid();
  };
  CHECK(!given(-500, 0, false));
  CHECK(!given(0.9, 0, false));
  CHECK(given(1.1, 0, false));  // 1e-3 of the largest term
  CHECK(!given(1.1, 0, false, {}, 0.2));
  // friction pays for what dilation lifts
  CHECK(!given(50, -60, true));
  CHECK(given(70, -60, true));
  CHECK(given(50, -60, false));
  Rules ground, changing;
  ground.in_situ = changing.changes = true;
  CHECK(!given(50, 0, false, ground));
  CHECK(!given(50, 0, false, changing));
}

TEST_CASE("audit: findings do not depend on threads, nor on where the model lies") {
  Case c = face(0.02, 1e5);
  c.frame.points.clear();
  const FrameResult one = c.look(), two = check_frame(c.rules, c.frame, Workers(2));
  REQUIRE(one.findings.size() == two.findings.size());
  CHECK(one.findings[0].share == two.findings[0].share);
  for (Block& b : c.frame.blocks)
    for (Vec2& p : b.polygon) p += Vec2{1048576, -1048576};
  CHECK(c.look().findings[0].share == approx(one.findings[0].share).epsilon(1e-6));
}

}  // namespace test_check_frame
