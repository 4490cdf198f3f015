// What a joint bears, gives and rises, by hand.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/relative.h"
#include "talus/model/joint_law.h"

namespace test_joint_law {

using namespace talus;

namespace {
constexpr double kDegree = std::numbers::pi / 180;
}

TEST_CASE("joint law: strength before and after, over areas and times") {
  JointProperty j;
  j.friction_angle = 45 * kDegree, j.cohesion = 6, j.tensile_strength = 4;
  j.residual_cohesion = 2, j.residual_tensile_strength = 1;
  const JointLaw law(j);
  CHECK(law.can_break());
  CHECK(law.holds());
  CHECK(law.residual().friction == law.peak().friction);  // none of its own
  const JointStrength force = law.peak().over(0.5);
  CHECK(force.tension == 2);
  CHECK(force.limit(10) == test::approx(13).epsilon(1e-14));
  CHECK(force.limit(-1) == test::approx(2).epsilon(1e-14));
  CHECK(force.limit(-4) == 0);
  CHECK(law.residual().over(0.5).over(0.1).cohesion == test::approx(0.1));

  j.cohesion = j.tensile_strength = 0;
  CHECK_FALSE(JointLaw(j).can_break());
  j.residual_friction_angle = 30 * kDegree;  // what is lost is friction
  CHECK(JointLaw(j).can_break());
  CHECK(JointLaw(j).residual().friction == test::approx(1 / std::sqrt(3.0)).epsilon(1e-14));
  j.bonded = true;
  CHECK_FALSE(JointLaw(j).can_break());
  CHECK(JointLaw(j).holds());
  CHECK_FALSE(JointLaw().holds());
}

TEST_CASE("joint law: rise, give and the closure under a stress") {
  JointProperty j;
  j.dilation_angle = 45 * kDegree, j.dilation_slip = 0.01;
  j.normal_stiffness = 100;
  const JointLaw law(j);
  CHECK(law.rise(0.004) == test::approx(0.004).epsilon(1e-14));
  CHECK(law.rise(0.04) == test::approx(0.01).epsilon(1e-14));
  CHECK(JointLaw().rise(1) == 0);
  CHECK(law.is_soft(0));
  CHECK_FALSE(law.is_soft(1));
  CHECK(law.stiffness(0, 0.5) == 50);
  CHECK(law.give(0, -10, 0.5) == -0.2);
  CHECK(law.give(1, -10, 0.5) == 0);  // hard
  const Vec2 closure = law.closure({-7, 3, 3, -20}, {0, 1});
  CHECK(closure.x == -0.2);
  CHECK(closure.y == 0);
}

TEST_CASE("joint law: weakened by any factor a sound joint stays sound") {
  JointProperty j;
  j.friction_angle = 40 * kDegree, j.residual_friction_angle = 40 * kDegree, j.dilation_angle = 40 * kDegree;
  j.cohesion = j.residual_cohesion = 1e5, j.tensile_strength = j.residual_tensile_strength = 3e4;
  for (double factor = 0.5; factor < 4; factor += 0.07) CHECK(JointLaw::defects(reduced(j, factor)).empty());
}

}  // namespace test_joint_law
