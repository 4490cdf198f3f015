#include "talus/contact/bonds.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/block_scene.h"
#include "support/box_polygon.h"
#include "support/relative.h"
#include "talus/step/scene.h"

namespace test_bonds {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kTensile = 2e6, kCohesion = 3e6, kThickness = 0.5;
enum Joint { kBonded, kBreakable, kPlain, kFrictional };

Model empty_model(int joint) {
  Model model;
  model.thickness = kThickness;
  model.materials = {{"rock", 2700, 50e9, 0.25}};
  model.joints = {{"bonded", true, 0, 0, 0},
                  {"breakable", false, 0, kCohesion, kTensile},
                  {"plain", false, 0.5, 0, 0},
                  {"frictional", false, 0.5, kCohesion, kTensile}};
  model.default_joint = joint;
  return model;
}

Scene scene_of(Model model) {
  Findings findings("case.toml", "");
  Layout layout = make_layout(model, findings);
  INFO(findings.render());
  REQUIRE_FALSE(findings.has_errors());
  return build_scene(std::move(model), std::move(layout));
}

Scene scene_of(const std::vector<Polygon>& polygons, int joint) {
  Findings findings("case.toml", "");
  Scene scene = laid_out_scene(empty_model(joint), polygons, &findings);
  INFO(findings.render());
  REQUIRE_FALSE(findings.has_errors());
  return scene;
}

Scene grid_scene(int joint, GridPattern pattern = GridPattern::kRectangles) {
  Model model = empty_model(-1);
  GridInput g;
  g.name = "wall";
  g.max = {3, 1};
  g.columns = 3, g.rows = 2;
  g.pattern = pattern;
  g.material = 0;
  g.joint = joint;
  model.grids = {g};
  return scene_of(std::move(model));
}

// One square on another.
Scene pair_scene(int joint) { return scene_of({box_polygon(0, 0, 1, 1), box_polygon(0, 1, 1, 2)}, joint); }

int update(const Scene& s, double dt, State& state) {
  return update_bonds(s.blocks, s.bonds, joint_laws(s.model.joints), dt, Workers(1), state);
}

constexpr double kEnd = 0.5 * 1 * kThickness;  // area of half the face of pair_scene [m2]

}  // namespace

TEST_CASE("faces of a grid: one per shared side, its ends on both blocks") {
  const Scene s = grid_scene(kBonded);
  REQUIRE(s.bonds.faces.size() == 2 * 2 + 3);
  for (const BondFace& f : s.bonds.faces) {
    const int a = f.block_a, b = f.block_b;
    CHECK(f.block_a < f.block_b);
    CHECK(f.unbreakable);
    CHECK(f.joint == kBonded);
    CHECK(f.length == relative(b == a + 1 ? 0.5 : 1, 1e-14));  // beside: 0.5 high; above: 1 wide
    CHECK(norm(f.arm_b[1] - f.arm_b[0]) == relative(f.length, 1e-14));
    for (int end = 0; end < 2; ++end) {
      // both arms lead to one place; roundings of numbers of order 1
      CHECK(norm(s.blocks.centroid[a] + f.arm_a[end] - s.blocks.centroid[b] - f.arm_b[end]) <= 1e-14);
    }
    // the normal of b's edge points into a
    const Vec2 along = f.arm_b[1] - f.arm_b[0];
    CHECK(dot(turn_right(along), s.blocks.centroid[a] - s.blocks.centroid[b]) > 0);
    CHECK(f.memory == relative(std::sqrt(0.5) / std::sqrt(60e9 / 2700), 1e-12));
  }
  CHECK(std::is_sorted(s.bonds.faces.begin(), s.bonds.faces.end(), [](const BondFace& x, const BondFace& y) {
    return std::pair(x.block_a, x.block_b) < std::pair(y.block_a, y.block_b);
  }));
  // crossed triangles: four inner sides in each of six cells, and the seven between the cells
  CHECK(grid_scene(kBonded, GridPattern::kCrossedTriangles).bonds.faces.size() == 31);
  CHECK(grid_scene(kPlain).bonds.faces.empty());
}

TEST_CASE("blocks of different size are bonded over the common length only") {
  const Scene s = scene_of({box_polygon(0, 0, 10, 1), box_polygon(2, 1, 2.25, 1.25),
                            box_polygon(9.5, 1, 11, 2), box_polygon(12, 0, 13, 1)},
                           kBreakable);
  REQUIRE(s.bonds.faces.size() == 2);
  CHECK(s.bonds.faces[0].block_b == 1);
  CHECK(s.bonds.faces[0].length == relative(0.25, 1e-14));
  CHECK(s.bonds.faces[1].block_b == 2);
  CHECK(s.bonds.faces[1].length == relative(0.5, 1e-14));
  CHECK_FALSE(s.bonds.faces[0].unbreakable);
  std::vector<double> x;
  for (const Vec2 arm : s.bonds.faces[1].arm_a) x.push_back(s.blocks.centroid[0].x + arm.x);
  std::sort(x.begin(), x.end());
  CHECK(x[0] == relative(9.5, 1e-14));
  CHECK(x[1] == relative(10, 1e-14));
  // the memory is the transit of the slower, larger block
  CHECK(s.bonds.faces[0].memory == relative(std::sqrt(10.0) / std::sqrt(60e9 / 2700), 1e-12));
}

TEST_CASE("a slit, a corner or a gap makes no face") {
  CHECK(scene_of({box_polygon(0, 0, 1, 1), box_polygon(1, 1, 2, 2)}, kBreakable).bonds.faces.empty());
  CHECK(scene_of({box_polygon(0, 0, 1, 1), box_polygon(1.001, 0, 2, 1)}, kBreakable).bonds.faces.empty());
  CHECK(scene_of({box_polygon(0, 0, 1, 1), box_polygon(1 + 1e-9, 0, 2, 1)}, kBreakable).bonds.faces.size() ==
        1);
  CHECK(scene_of({box_polygon(0, 0, 1, 1), {{1, 0}, {2, 0}, {1.1, 1}}}, kBreakable)
            .bonds.faces.empty());  // not parallel
}

TEST_CASE("two faces between the same two blocks") {
  const Polygon l{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  const Scene s = scene_of({l, box_polygon(1, 1, 2, 2)}, kBreakable);
  REQUIRE(s.bonds.faces.size() == 2);
  State state = start_state(s);
  state.face[0].broken = true;
  CHECK(is_tied(s.bonds, state, 0, 1));  // by the other
  state.face[1].broken = true;
  CHECK_FALSE(is_tied(s.bonds, state, 0, 1));
}

TEST_CASE("is_tied: by intact faces, and always within a bonded body") {
  Scene s = grid_scene(kBonded);
  State state = start_state(s);
  CHECK(is_tied(s.bonds, state, 0, 1));
  CHECK(is_tied(s.bonds, state, 0, 4));  // across a corner
  CHECK_FALSE(is_tied(s.bonds, state, 0, 2));
  s = grid_scene(kBreakable);
  state = start_state(s);
  CHECK(is_tied(s.bonds, state, 0, 1));
  CHECK_FALSE(is_tied(s.bonds, state, 0, 4));  // free to touch there
  for (size_t f = 0; f < state.face.size(); ++f)
    state.face[f].broken = s.bonds.faces[f].block_a == 0 && s.bonds.faces[f].block_b == 1;
  CHECK_FALSE(is_tied(s.bonds, state, 0, 1));
  CHECK(is_tied(s.bonds, state, 1, 2));
}

TEST_CASE("a slow pull breaks a face at tensile strength times area") {
  const Scene s = pair_scene(kBreakable);
  State state = start_state(s);
  const double dt = 0.1 * s.bonds.faces[0].memory, limit = kTensile * kEnd;
  const int steps = 100000;  // to the limit: 10 000 memories, so that the mean lags by 1e-4 of the limit
  int at = 0;
  for (int n = 1; n < 2 * steps && at == 0; ++n) {
    const double pull = std::min(1.0, static_cast<double>(n) / steps) * limit;
    state.bond_force[0] = state.bond_force[1] = {-pull, 0};
    if (update(s, dt, state) == 1) at = n;
  }
  CHECK(state.face[0].broken);
  CHECK(state.bond_force[0][0] == 0);
  CHECK(state.bond_force[1][0] == 0);
  // the mean lags by 1e-4 when the pull stops rising; the face gives way at 0.99999 of the limit, ln(10)
  // memories later
  CHECK(static_cast<double>(at) / steps == relative(1 + std::log(10) / 0.0953 / steps, 2e-5));
  CHECK(update(s, dt, state) == 0);  // once
}

TEST_CASE("the running mean forgives a short blow and counts a long one") {
  const Scene s = pair_scene(kBreakable);
  State state = start_state(s);
  const double dt = 0.1 * s.bonds.faces[0].memory, limit = kTensile * kEnd;
  const auto steps_to_break = [&](double share, int most) {
    state = start_state(s);
    for (int n = 1; n <= most; ++n) {
      state.bond_force[0] = state.bond_force[1] = {-share * limit, 0};
      if (update(s, dt, state) > 0) return n;
    }
    return 0;
  };
  // the mean comes to 1 - (1 - dt / (memory + dt))^n of a constant force
  const double decay = -std::log1p(-dt / (s.bonds.faces[0].memory + dt));
  CHECK(steps_to_break(1, 10000) == static_cast<int>(std::ceil(std::log(100000) / decay)));
  CHECK(steps_to_break(0.99998, 10000) == 0);
  CHECK(steps_to_break(1, 20) == 0);
  CHECK(state.face[0].mean_force[0] == relative(-limit * (1 - std::exp(-20 * decay)), 1e-12));
}

TEST_CASE("a face breaks only when both ends are at their limit") {
  const Scene s = pair_scene(kBreakable);
  const double dt = s.bonds.faces[0].memory, pull = -kTensile * kEnd, shear = kCohesion * kEnd;
  const auto breaks = [&](std::array<double, 2> first, std::array<double, 2> second) {
    State state = start_state(s);
    for (int n = 0; n < 200; ++n) {
      state.bond_force[0] = first, state.bond_force[1] = second;
      if (update(s, dt, state) > 0) return true;
    }
    return false;
  };
  CHECK(breaks({pull, 0}, {pull, 0}));
  CHECK_FALSE(breaks({pull, 0}, {0.99 * pull, 0}));
  CHECK_FALSE(breaks({0.99 * pull, 0}, {pull, 0}));
  CHECK_FALSE(breaks({-pull, 0}, {-pull, 0}));  // pressed
  CHECK(breaks({0, shear}, {0, shear}));
  CHECK_FALSE(breaks({0, shear}, {0, -shear}));  // no shear of the face as a whole
  CHECK_FALSE(breaks({0, shear}, {0, 0.99 * shear}));
  CHECK(breaks({0, shear}, {pull, 0}));
}

TEST_CASE("pressure raises the shear strength by friction") {
  const Scene s = pair_scene(kFrictional);
  const double dt = s.bonds.faces[0].memory, pressure = 1e6;
  const double limit = kCohesion * kEnd + std::tan(0.5) * pressure;
  for (const double share : {0.998, 1.0}) {
    State state = start_state(s);
    int broken = 0;
    for (int n = 0; n < 200 && broken == 0; ++n) {
      state.bond_force[0] = state.bond_force[1] = {pressure, share * limit};
      broken = update(s, dt, state);
    }
    CHECK(broken == (share == 1.0));
  }
}

TEST_CASE("an unbreakable face never breaks") {
  const Scene s = pair_scene(kBonded);
  State state = start_state(s);
  for (int n = 0; n < 100; ++n) {
    state.bond_force[0] = state.bond_force[1] = {-1e12, 1e12};
    CHECK(update(s, 1, state) == 0);
  }
  CHECK_FALSE(state.face[0].broken);
}

TEST_CASE("rows of an intact face hold its ends together within its strength") {
  for (const int joint : {static_cast<int>(kBonded), static_cast<int>(kFrictional)}) {
    CAPTURE(joint);
    const Scene s = pair_scene(joint);
    State state = start_state(s);
    // the upper block (b) lifted by 1e-5 and pushed to the right by 3e-5
    state.displacement[1] = {3e-5, 1e-5};
    state.bond_force[1] = {5, 7};
    const double dt = 1e-4, dt_kick = 5e-5;
    RowSet rows;
    add_bond_rows(s.blocks, s.bonds, joint_laws(s.model.joints), {}, state, state.rate, {dt, dt_kick, 0.2},
                  Workers(1), rows);
    REQUIRE(rows.size() == 2);
    for (const int end : {0, 1}) {
      CHECK(rows.owner[end].family == Family::kFace);
      CHECK(rows.owner[end].index == end);
    }
    REQUIRE(rows.points.size() == 2);
    for (const PointRows& p : rows.points) {
      // normal from b, above, into a: downwards; so the opening counts positive; the tangent points to -x
      CHECK(p.normal.y == relative(-1, 1e-14));
      CHECK(p.row[0].bias == relative(1e-5 / dt, 1e-12));
      CHECK(p.row[1].bias == relative(3e-5 / dt, 1e-12));
      CHECK(bounds_of(p, 0, 0).upper == std::numeric_limits<double>::infinity());
      if (joint == kBonded) {
        CHECK(bounds_of(p, 0, 0).lower == -std::numeric_limits<double>::infinity());
        CHECK(bounds_of(p, 1, -1e9).upper == std::numeric_limits<double>::infinity());
      } else {
        CHECK(bounds_of(p, 0, 0).lower == relative(-kTensile * kEnd * dt_kick, 1e-14));
        CHECK(bounds_of(p, 1, 10).upper == relative(kCohesion * kEnd * dt_kick + 10 * std::tan(0.5), 1e-14));
      }
    }
    CHECK(rows.impulse[1][0] == relative(5 * dt_kick, 1e-14));
    CHECK(rows.impulse[1][1] == relative(7 * dt_kick, 1e-14));
    state.face[0].broken = true;
    rows = {};
    add_bond_rows(s.blocks, s.bonds, joint_laws(s.model.joints), {}, state, state.rate, {dt, dt_kick, 0.2},
                  Workers(1), rows);
    CHECK(rows.points.empty());
  }
}

TEST_CASE(
    "rows of an elastic face begin where they hold if the blocks go on as before, within their strength") {
  Scene s = pair_scene(kFrictional);
  s.model.joints[kFrictional].normal_stiffness = 2e9;
  s.model.joints[kFrictional].shear_stiffness = 1e9;
  s.bonds.faces[0].elastic_shear = true;
  for (const double push : {1e-6, 1000.0}) {  // the second far beyond the strength along the face
    CAPTURE(push);
    State state = start_state(s);
    state.displacement[1] = {2e-5, -1e-4};
    state.rate[0].a = {push, 0.003};
    state.rate[1].G = {1e-3, 2e-3, -1e-3, 5e-4};  // the two ends move differently
    RowSet rows;
    add_bond_rows(s.blocks, s.bonds, joint_laws(s.model.joints), {}, state, state.rate, {1e-4, 9e-5, 0.2},
                  Workers(1), rows);
    REQUIRE(rows.points.size() == 2);
    for (size_t r = 0; r < 2; ++r) {
      const PointRows& p = rows.points[r];
      const auto u = relative_velocity(p, state.rate);
      const auto left_over = [&](int k) {
        return u[k] + p.row[k].bias + p.row[k].compliance * rows.impulse[r][k] +
               p.cross(k) * rows.impulse[1 - r][k];
      };
      CHECK(std::abs(left_over(0)) < 1e-12 * std::abs(p.row[0].bias));
      if (push < 1)
        CHECK(std::abs(left_over(1)) < 1e-12 * std::abs(p.row[1].bias));
      else
        CHECK(std::abs(rows.impulse[r][1]) == relative(bounds_of(p, 1, rows.impulse[r][0]).upper, 1e-14));
    }
  }
}

TEST_CASE("an end that slides at the limit of an elastic face keeps its slip and unloads along ks") {
  Scene s = pair_scene(kFrictional);
  const double stiffness = 2e9;
  s.model.joints[kFrictional].normal_stiffness = s.model.joints[kFrictional].shear_stiffness = stiffness;
  s.bonds.faces[0].elastic_shear = true;
  State state = start_state(s);
  // the upper block (b) pushed to the right, against the tangent
  const double off = 3e-3, dt = 1e-4, dt_kick = 1e-4;
  state.displacement[1] = {off, -1e-4};
  const StepClock timing{dt, dt_kick, 0.2};
  RowSet rows;
  const auto make_rows = [&] {
    rows = {};
    add_bond_rows(s.blocks, s.bonds, joint_laws(s.model.joints), {}, state, state.rate, timing, Workers(1),
                  rows);
  };
  make_rows();
  REQUIRE(rows.points.size() == 2);

  // both blocks stand still, end 0 at its limit, end 1 below it; the face has the compliance
  // 1/(k l t/2) [[2, -1], [-1, 2]]
  const double normal = stiffness * kEnd * 1e-4, limit = kCohesion * kEnd + std::tan(0.5) * normal;
  rows.impulse = {{normal * dt_kick, -limit * dt_kick}, {normal * dt_kick, -0.9 * limit * dt_kick}};
  remember_bonds(s.blocks, s.bonds, rows, timing, Workers(1), state);
  const double elastic = (2 * limit - 0.9 * limit) / (stiffness * kEnd);
  CHECK(state.face[0].slip[0] == relative(off - elastic, 1e-12));
  CHECK(state.face[0].slip[1] == 0);  // below its limit
  CHECK(state.bond_force[0][1] == relative(-limit, 1e-14));

  // in the next step the same forces hold it where it is: no further slip, and it has forgotten the way there
  const auto left_over = [&](double share) {
    make_rows();
    const PointRows& p = rows.points[0];
    return p.row[1].bias +
           dt_kick * (p.row[1].compliance * -limit * share + p.cross(1) * -0.9 * limit * share);
  };
  CHECK(left_over(1) == doctest::Approx(0).scale(off / dt).epsilon(1e-12));
  // moved back by a tenth of the elastic slip it carries a tenth less, not the limit
  state.displacement[1].x -= 0.1 * elastic;
  CHECK(left_over(0.9) == doctest::Approx(0).scale(off / dt).epsilon(1e-12));
}

}  // namespace test_bonds
