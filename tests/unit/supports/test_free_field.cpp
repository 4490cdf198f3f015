#include "talus/supports/free_field.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "support/relative.h"
#include "support/run_case.h"
#include "talus/results/joint_report.h"
#include "talus/supports/boundaries.h"

namespace test_free_field {

using namespace talus;
using namespace talus::test;

namespace {

const PlaneModuli kRock = plane_moduli(9e9, 0.25, Plane::kStrain);

// Strain of intact rock under a stress (xx, yy, xy), and of the joints it crosses, put together from
// tractions.
std::array<double, 3> strain_by_hand(const std::array<double, 3>& s,
                                     const std::vector<JointsOfRock>& joints) {
  const double e = 9e9, nu = 0.25;
  std::array<double, 3> strain{((1 - nu * nu) * s[0] - nu * (1 + nu) * s[1]) / e,
                               ((1 - nu * nu) * s[1] - nu * (1 + nu) * s[0]) / e, 2 * (1 + nu) / e * s[2]};
  for (const JointsOfRock& j : joints) {
    const Vec2 n = j.normal, t = turn_left(n), traction{s[0] * n.x + s[2] * n.y, s[2] * n.x + s[1] * n.y};
    const Vec2 jump = j.frequency * (dot(traction, n) / j.kn * n + dot(traction, t) / j.ks * t);
    strain[0] += jump.x * n.x, strain[1] += jump.y * n.y, strain[2] += jump.x * n.y + jump.y * n.x;
  }
  return strain;
}

}  // namespace

TEST_CASE("stiffness of jointed ground: the strains of rock and joints add up") {
  const std::vector<JointsOfRock> joints{{{std::cos(0.3), std::sin(0.3)}, 0.5, 2e9, 1e9},
                                         {{0, 1}, 0.25, 4e9, 3e9}};
  const Stiffness c = jointed_stiffness(kRock, joints);
  for (const std::array<double, 3>& s :
       {std::array{1e6, 0.0, 0.0}, {0.0, 2e6, 0.0}, {0.0, 0.0, 1e6}, {1e6, -3e6, 5e5}}) {
    const auto strain = strain_by_hand(s, joints);
    for (size_t k = 0; k < 3; ++k)
      CHECK(std::abs(c[k][0] * strain[0] + c[k][1] * strain[1] + c[k][2] * strain[2] - s[k]) < 1e-6);
  }
}

TEST_CASE("hard joints add nothing to the stiffness of the ground") {
  const Stiffness c = jointed_stiffness(kRock, {{{0, 1}, 1, 0, 0}});
  CHECK(c[0][0] == approx(kRock.c11).epsilon(1e-12));
  CHECK(c[0][1] == approx(kRock.c12).epsilon(1e-12));
  CHECK(c[2][2] == approx(kRock.c33).epsilon(1e-12));
  CHECK(std::abs(c[0][2]) < 1e-3);
}

namespace {

const std::string kGround = R"(
talus = 1
[material.soil]
density = 2000
young = "450 MPa"
poisson = 0.25
[material.rock]
density = 2500
young = "9 GPa"
poisson = 0.25
[joint.glue]
kind = "bonded"
[joint.soft]
normal_stiffness = "2 GPa/m"
shear_stiffness = "1 GPa/m"
[[boundary]]
name = "left"
kind = "free_field"
edge = [[0, 0], [0, 6]]
[[stage]]
name = "go"
kind = "dynamic"
duration = "10 ms"
)";

std::string grid(const std::string& name, double bottom, double top, int rows, const std::string& material,
                 const std::string& joint = "glue") {
  return fmt::format(
      "[[grid]]\nname = \"{}\"\nmin = [0, {}]\nmax = [4, {}]\ncells = [2, {}]\nmaterial = \"{}\"\njoint = "
      "\"{}\"\n",
      name, bottom, top, rows, material, joint);
}

Scene scene_of(const std::string& text, std::string* warnings = nullptr) {
  Findings findings("case.toml", text);
  Scene scene = prepare_run("case.toml", text, {}, findings).scene;
  if (warnings) *warnings = findings.render();
  return scene;
}

const std::string kFixed = "[[support]]\nname = \"base\"\nedge = [[0, 0], [4, 0]]\n";

}  // namespace

TEST_CASE("a column has the layers, heights and joints of its side") {
  const Scene scene =
      scene_of(kGround + grid("low", 0, 2, 1, "rock") + grid("up", 2, 6, 4, "soil", "soft") + kFixed);
  const FreeField& f = scene.boundaries.free_field;
  REQUIRE(f.columns.size() == 1);
  CHECK(f.height == std::vector<double>{0, 2, 3, 4, 5, 6});
  CHECK(f.elements[0].density == 2500);
  CHECK(f.elements[0].stiffness[2][2] == approx(3.6e9));
  // a joint of 1 GPa/m each metre up and none along: 1/G = 1/0.18 + 1/1 (beds) + 0.5/1 (2 m apart) per GPa
  CHECK(f.elements[1].stiffness[2][2] == approx(1e9 / (1 / 0.18 + 1 + 0.5)).epsilon(1e-12));
  CHECK_FALSE(f.columns[0].base.viscous);
  CHECK(f.columns[0].base.motion[0].kind == Motion::kFixed);
}

TEST_CASE("corners close to each other do not make thin elements") {
  // the rock changes at 2 m and at 2.05 m; the corners at 2.02 m and 4.01 m are of no account
  std::string text = kGround + kFixed;
  const double heights[] = {0, 2, 2.02, 2.05, 4, 4.01, 6};
  for (int k = 0; k < 6; ++k)
    text += grid(fmt::format("g{}", k), heights[k], heights[k + 1], 1, k == 1 || k == 2 ? "soil" : "rock");
  CHECK(scene_of(text).boundaries.free_field.height == std::vector<double>{0, 2, 2.05, 4, 6});
}

TEST_CASE("what a column stands on") {
  const std::string ground = kGround + grid("g", 0, 6, 3, "soil");
  std::string warnings;
  const FreeField none = scene_of(ground, &warnings).boundaries.free_field;
  CHECK(none.columns[0].base.motion[1].kind == Motion::kFixed);
  CHECK(warnings.find("boundary.left: stands on nothing at (0, 0): its column is held there") !=
        std::string::npos);

  const FreeField wave = scene_of(ground +
                                  "[history.v]\ntime = [0, 1]\nvalue = [0, 0]\n[[boundary]]\nname = "
                                  "\"base\"\nkind = \"viscous\"\nedge = [[0, 0], [4, 0]]\n"
                                  "material = \"rock\"\nvelocity_y = \"v\"\nmotion = \"upgoing\"\n")
                             .boundaries.free_field;
  CHECK(wave.columns[0].base.viscous);
  CHECK(wave.columns[0].base.impedance[0] == approx(2500.0 * 1200));
  CHECK(wave.columns[0].base.impedance[1] == approx(2500.0 * 1200 * std::sqrt(3.0)));
  CHECK(wave.columns[0].base.history[0] == -1);
  CHECK(wave.columns[0].base.history[1] == 0);
  CHECK(wave.columns[0].base.incoming == 2);
}

TEST_CASE("a column stands on the driven block below, which is no part of it") {
  const std::string text =
      kGround + grid("g", 2, 6, 2, "soil") +
      "[history.v]\ntime = [0, 1]\nvalue = [0, 1]\n[[block]]\nname = \"table\"\npolygon = [[0, 0], [4, 0], "
      "[4, 2], [0, 2]]\nmaterial = \"rock\"\nkind = \"driven\"\nmotion_x = { velocity = \"v\" }\n";
  const FreeField f = scene_of(text).boundaries.free_field;
  CHECK(f.height == std::vector<double>{2, 4, 6});
  CHECK(f.columns[0].base.motion[0].kind == Motion::kVelocity);
  CHECK(f.columns[0].base.motion[1].kind == Motion::kFixed);
}

TEST_CASE("shares of a segment: its two ends sum to its length in every element") {
  const Scene scene = scene_of(kGround + grid("g", 0, 6, 3, "soil") + kFixed);
  const FreeField& f = scene.boundaries.free_field;
  const Vec2 a{0, 1}, b{-1, 4.5};
  std::array<double, 3> length{}, moment{};
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
    for (const auto& [element, weight] : shares_of_segment(f, f.columns[0], from, to)) {
      length[element] += weight;
      moment[element] += weight * from.y;
    }
  const double per_height = norm(b - a) / 3.5;
  const double pieces[3][2] = {{1, 2}, {2, 4}, {4, 4.5}};
  for (size_t k = 0; k < 3; ++k) {
    const double rise = pieces[k][1] - pieces[k][0];
    CHECK(length[k] == approx(rise * per_height).epsilon(1e-12));
    CHECK(moment[k] == approx(rise * per_height * 0.5 * (pieces[k][0] + pieces[k][1])).epsilon(1e-12));
  }
}

TEST_CASE("a column that limits the time step is named, and a step above its limit refused") {
  // stiff rock behind a soft side: waves in the column are faster than in the blocks
  const std::string text = kGround + grid("g", 0, 6, 3, "soil") + kFixed;
  std::string fast = text;
  fast.replace(fast.find("kind = \"free_field\""), 19, "kind = \"free_field\"\nmaterial = \"rock\"");
  Findings findings("case.toml", fast);
  const PreparedRun run = prepare_run("case.toml", fast, {}, findings);
  CHECK(bound_name(run.scene, run.plans[0]) == "free field of left");
  // 2 m elements of rock: 2 h / (sqrt(12) cp)
  CHECK(run.plans[0].dt_bound == approx(2 * 2 / std::sqrt(12.0) / (1200 * std::sqrt(3.0))).epsilon(1e-12));
  CHECK_THROWS_WITH_AS(prepare_run("case.toml", fast, {"stage.go.time_step=0.7 ms"}, findings),
                       doctest::Contains("is above the stable limit 0.0005556 s of the free field of left"),
                       InputError);
  // with elasticity in the mass of the step nothing limits it
  Findings others("case.toml", fast);
  const PreparedRun implicit =
      prepare_run("case.toml", fast, {"stage.go.elasticity=implicit", "stage.go.time_step=5 ms"}, others);
  CHECK(std::isinf(implicit.plans[0].dt_bound));
  CHECK(implicit.plans[0].dt == approx(5e-3));
  CHECK(bound_name(implicit.scene, implicit.plans[0]).empty());
}

TEST_CASE("the kick of a column solves (M + s K) v+ = (M + r^2 s K) v- + dt F with axes coupled") {
  // inclined joints couple shear with height; the foot is free along y and driven along x
  FreeField field;
  for (const double h : {0.0, 1.0, 3.0}) field.height.push_back(h);
  const std::vector<JointsOfRock> joints{{{std::cos(0.7), std::sin(0.7)}, 0.5, 2e9, 1e9}};
  for (const double height : {1.0, 2.0})
    field.elements.push_back({height, 2000, jointed_stiffness(kRock, joints), 0});
  GroundColumn column;
  column.elements = 2;
  column.base.motion[0].kind = Motion::kFixed, column.base.motion[1].kind = Motion::kFree;
  field.columns.push_back(column);
  State s;
  s.dt_before = 1e-3;
  s.column_displacement = {{0, 1e-3}, {2e-3, -1e-3}, {1e-3, 3e-3}};
  s.column_rate = {{0, 2}, {1, -1}, {-2, 0.5}};
  StepClock clock;
  clock.dt = clock.dt_kick = 2e-3, clock.alpha = 0.2;
  const Vec2 gravity{0.5, -3};

  // the same by hand, all equations of both axes in one matrix
  Eigen::Matrix<double, 6, 6> M, K;
  Eigen::Matrix<double, 6, 1> F, before, u;
  M.setZero(), K.setZero(), F.setZero();
  for (int e = 0; e < 2; ++e) {
    const double h = e + 1.0, m = 2000 * h;
    const Stiffness& c = field.elements[0].stiffness;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        for (int k = 0; k < 2; ++k) M(2 * (e + i) + k, 2 * (e + j) + k) += i == j ? m / 3 : m / 6;
        const double sign = (i == j ? 1 : -1) / h;
        K(2 * (e + i), 2 * (e + j)) += sign * c[2][2], K(2 * (e + i), 2 * (e + j) + 1) += sign * c[2][1];
        K(2 * (e + i) + 1, 2 * (e + j)) += sign * c[1][2],
            K(2 * (e + i) + 1, 2 * (e + j) + 1) += sign * c[1][1];
      }
    for (int i = 0; i < 2; ++i) F(2 * (e + i)) += m / 2 * gravity.x, F(2 * (e + i) + 1) += m / 2 * gravity.y;
  }
  for (int i = 0; i < 3; ++i) {
    before(2 * i) = s.column_rate[i].x, before(2 * i + 1) = s.column_rate[i].y;
    u(2 * i) = s.column_displacement[i].x, u(2 * i + 1) = s.column_displacement[i].y;
  }
  const double k = 4 / (1.2 * 1.2), r2 = std::pow(0.8 / 1.2, 2), stiff = 2e-3 * 2e-3 / k;
  Eigen::Matrix<double, 6, 6> A = M + stiff * K;
  Eigen::Matrix<double, 6, 1> b = (M + r2 * stiff * K) * before + 2e-3 * (F - K * u);
  A.row(0).setZero(), A(0, 0) = 1, b(0) = 0;
  const Eigen::Matrix<double, 6, 1> after = A.partialPivLu().solve(b);

  ColumnMotion motion;
  kick_columns(field, {}, clock, 0, false, clock.elastic_weights(0), {gravity}, s, motion);
  for (int i = 0; i < 3; ++i) {
    CHECK(s.column_rate[i].x == approx(after(2 * i)).epsilon(1e-10).scale(1));
    CHECK(s.column_rate[i].y == approx(after(2 * i + 1)).epsilon(1e-10));
    CHECK(motion.velocity[i].y == approx(0.5 * (before(2 * i + 1) + after(2 * i + 1))).epsilon(1e-10));
    // the stress that acted is that of u + dt/k (v+ - r^2 v-)
    CHECK(motion.displacement[i].y ==
          approx(u(2 * i + 1) + 2e-3 / k * (after(2 * i + 1) - r2 * before(2 * i + 1))).epsilon(1e-10));
  }
}

TEST_CASE("the side at which the joint with the largest slip ends is named") {
  const Scene scene = scene_of(kGround + grid("g", 0, 6, 3, "soil") + kFixed);
  std::vector<char> at_side(scene.blocks.count, 0);
  for (const BoundaryPoint& p : scene.boundaries.points) at_side[p.block] = 1;
  const auto first = [&at_side](char value) {
    return static_cast<int>(std::find(at_side.begin(), at_side.end(), value) - at_side.begin());
  };
  JointSummary joints;
  joints.most_residual.block_a = first(0), joints.most_residual.block_b = first(1);
  CHECK(free_field_side(scene, joints) == "");  // nothing has slipped
  joints.slipped_joints = 1;
  CHECK(free_field_side(scene, joints) == "left");
  joints.most_residual.block_b = joints.most_residual.block_a;
  CHECK(free_field_side(scene, joints) == "");
}

TEST_CASE("a static stage after a dynamic one puts the free field to rest and keeps the places") {
  const Scene scene = scene_of(kGround + grid("g", 0, 6, 3, "soil") + kFixed);
  State s = start_state(scene);
  for (Vec2& d : s.displacement) d = {1e-3, 2e-3};
  for (Vec2& d : s.column_displacement) d = {1, 1};
  for (HeldPoint& p : s.boundaries) p.force = {5, 7};
  enter_stage(scene.boundaries, false, true, s);
  CHECK(s.column_displacement[1] == Vec2{});
  CHECK(s.boundaries[0].hold == Vec2{1e-3, 2e-3});
  CHECK(s.boundaries[0].kept[0] == 0);
  enter_stage(scene.boundaries, true, false, s);
  CHECK(s.boundaries[0].kept[1] == 7);
  for (HeldPoint& p : s.boundaries) p.force = {0, 0};
  enter_stage(scene.boundaries, false, false, s);  // dynamic after dynamic: kept
  CHECK(s.boundaries[0].kept[1] == 7);
}

}  // namespace test_free_field
