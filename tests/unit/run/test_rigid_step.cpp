// The step of a model in which nothing deforms.

#include "support/run_case.h"

namespace test_rigid_step {

using namespace talus;
using namespace talus::test;

namespace {

// Of a stone of 1 m x 0.5 m at some height over a floor at y = 0, and what else there is.
double step_of(double height, const std::string& more = "", double duration = 10,
               const std::string& kind = "\"dynamic\"") {
  const std::string text =
      "talus = 1\n[model]\ngravity = [0, -10]\n[material.m]\ndensity = 2000\n[joint.j]\nfriction_angle = "
      "\"30 deg\"\n"
      "[contact]\njoint = \"j\"\n" +
      fmt::format(
          "[[block]]\nname = \"floor\"\npolygon = [[-5,-1],[9,-1],[9,0],[-5,0]]\nmaterial = \"m\"\nkind = "
          "\"fixed\"\n[[block]]\nname = \"a\"\npolygon = [[0,{0}],[1,{0}],[1,{1}],[0,{1}]]\nmaterial = "
          "\"m\"\nkind = \"rigid\"\n",
          height, height + 0.5) +
      more + fmt::format("[[stage]]\nname = \"s\"\nkind = {}\nduration = {}\n", kind, duration);
  Findings findings("m", text);
  return prepare_run("m", text, {}, findings).plans.at(0).dt;
}

bool is_near(double step, double wanted) { return std::abs(step / wanted - 1) < 1e-3; }

// Area over twice the way from the centroid to the farthest corner.
const double kThickness = 0.5 / (2 * std::hypot(0.5, 0.25));

}  // namespace

TEST_CASE("auto step of rigid blocks: 0.005 sqrt(h/g) where all stands on the ground") {
  CHECK(is_near(step_of(0), 0.005 * std::sqrt(kThickness / 10)));
  // in a chain over a block that stands
  const std::string pillar =
      "[[block]]\nname = \"b\"\npolygon = [[0,0],[1,0],[1,3],[0,3]]\nmaterial = \"m\"\nkind = \"rigid\"\n";
  CHECK(is_near(step_of(3, pillar), 0.005 * std::sqrt(kThickness / 10)));
  // and on a support
  CHECK(is_near(step_of(3, "[[support]]\nname = \"peg\"\npoint = [0.5, 3]\nx = \"fixed\"\ny = \"fixed\"\n"),
                0.005 * std::sqrt(kThickness / 10)));
}

TEST_CASE("auto step of rigid blocks: 0.02 sqrt(h/g) on the way to rest") {
  CHECK(is_near(step_of(0, "", 10, "\"static\"\nintegration = \"dynamic\""),
                0.02 * std::sqrt(kThickness / 10)));
}

TEST_CASE("auto step of rigid blocks: a tenth of the thickness at the end of a fall") {
  // to the lowest place, the underside of the floor at -1 m
  CHECK(is_near(step_of(199), 0.1 * kThickness / std::sqrt(2 * 10 * 200)));
  // or as fast as it gets in the time
  CHECK(is_near(step_of(1e4, "", 5), 0.1 * kThickness / 50));
}

TEST_CASE("auto step of rigid blocks: six to a swing on elastic joints, those of groups too") {
  // 1000 kg; half of 3 m of sides at 10 GPa/m
  const double wanted = std::sqrt(1000 / (0.5 * 3 * 10e9));
  const std::string soft =
      "[joint.soft]\nfriction_angle = \"30 deg\"\nnormal_stiffness = \"10 GPa/m\"\nshear_stiffness = \"5 GPa/m\"\n";
  CHECK(is_near(step_of(0, soft + "[[contact_pair]]\nbetween = [\"a\", \"floor\"]\njoint = \"soft\"\n"),
                wanted));
  CHECK(step_of(0, soft) > 2 * wanted);
}

}  // namespace test_rigid_step
