// What the stress is that hard contacts give by, and who gives (theory 4.22).

#include "support/relative.h"
#include "talus/contact/contact_give.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "talus/model/read_model.h"
#include "talus/run/run.h"

namespace test_contact_give {

using namespace talus;

namespace {

// Two blocks of 2 m x 1 m and 2000 kg/m3 on each other, the lower one fixed: the upper one reaches from 1 to 2.
PreparedRun prepared(const std::string& model, const std::string& more = "",
                     const std::string& kind = "rigid") {
  const std::string text = fmt::format(
      "talus = 1\n[model]\n{}\n[material.m]\ndensity = 2000\nyoung = \"8 GPa\"\npoisson = 0\n"
      "[[block]]\nname = \"lower\"\npolygon = [[0,0],[2,0],[2,1],[0,1]]\nmaterial = \"m\"\nkind = \"fixed\"\n"
      "[[block]]\nname = \"upper\"\npolygon = [[0,1],[2,1],[2,2],[0,2]]\nmaterial = \"m\"\nkind = \"{}\"\n"
      "{}\n[[stage]]\nname = \"s\"\nkind = \"dynamic\"\nduration = \"10 ms\"\ntime_step = \"0.1 ms\"\n",
      model, kind, more);
  Findings findings("give.toml", text);
  return prepare_run("give.toml", text, {}, findings);
}

void check_give(const PreparedRun& run, double stress, const std::string& cause) {
  CHECK(run.scene.give.stress == test::approx(stress).epsilon(1e-9));
  CHECK(run.scene.give.cause == cause);
}

const std::string kGravity = "gravity = [0, -10]";

}  // namespace

TEST_CASE("contact give: the largest stress that the model gives to be foreseen") {
  check_give(prepared(kGravity), 2000 * 10 * 1, "weight of the blocks");
  // the extent along gravity
  check_give(prepared("gravity = [10, 0]"), 2000 * 10 * 2, "weight of the blocks");
  check_give(prepared(kGravity, "[[load]]\nname = \"p\"\nedge = [[0,2],[2,2]]\npressure = \"3 MPa\"\n"), 3e6,
             "pressures and tractions given");
  check_give(prepared(kGravity,
                      "[history.p]\ntime = [0, 1, 2]\nvalue = [0, -4e6, 1e6]\n[[load]]\nname = \"p\"\n"
                      "edge = [[0,2],[2,2]]\npressure = \"p\"\n"),
             4e6, "pressures and tractions given");
  check_give(
      prepared(kGravity, "[[load]]\nname = \"f\"\npoint = [0, 2]\nforce_x = \"3 MN\"\nforce_y = \"4 MN\"\n"),
      5e6 / std::sqrt(2), "forces given");
  check_give(prepared(kGravity, "[[load]]\nname = \"a\"\nacceleration_x = 20\n"), 2000 * 20 * std::sqrt(5.0),
             "accelerations given");
  // what strains rock by 0.2 %
  check_give(prepared(kGravity, "", "deformable"), 2e-3 * 8e9, "stiffness of the blocks");
  // rho cp = sqrt(rho E), waves of deformable blocks only
  check_give(prepared("gravity = [0, 0]", "velocity = [0, -5]", "deformable"), std::sqrt(2000 * 8e9) * 5,
             "velocities given");
  check_give(prepared("gravity = [0, 0]", "velocity = [0, -3]"), 0, "");
}

TEST_CASE("contact give: none where it is not wanted, and where nothing acts") {
  CHECK(prepared(kGravity, "[contact]\nstiffness = \"none\"\n").scene.give.stress == 0);
  CHECK(prepared(kGravity, "[contact]\nlaw = \"smoothed\"\n").scene.give.stress == 0);
  CHECK(prepared(kGravity, "[contact]\nstiffness = \"auto\"\n").scene.give.stress > 0);
  CHECK(prepared("gravity = [0, 0]").scene.give.stress == 0);
}

TEST_CASE("contact give: a face of length l closes by 1e-5 l under the stress") {
  const ContactGive give{3e6, "", 0};
  // two points bear l t times the stress
  const double l = 0.7, thickness = 2, force = 0.5 * l * thickness * give.stress;
  CHECK(force * give.per_force(thickness) == test::approx(1e-5 * l));
  CHECK(ContactGive{}.per_force(1) == 0);
}

TEST_CASE("contact give: blocks meet hard over joints without both stiffnesses") {
  const auto meets = [](const std::string& joint) {
    const PreparedRun run = prepared(kGravity, "[joint.j]\n" + joint + "\n[contact]\njoint = \"j\"\n");
    return meets_hard(run.scene.layout, run.scene.laws);
  };
  CHECK(meets("friction_angle = \"30 deg\""));
  CHECK(meets("normal_stiffness = \"1 GPa/m\""));
  CHECK_FALSE(meets("normal_stiffness = \"1 GPa/m\"\nshear_stiffness = \"1 GPa/m\""));
  CHECK_FALSE(meets("kind = \"bonded\""));
  const PreparedRun none = prepared(kGravity);
  CHECK(meets_hard(none.scene.layout, none.scene.laws));
}

TEST_CASE("contact give: no stage is shorter than the step that it is limited by") {
  // W/C: kYield / m dt^2 / give, at least kLeastYield
  const PreparedRun run = prepared(kGravity);
  CHECK(yields_more(run.scene, run.plans) == kLeastYield);
  PreparedRun slow = prepared(kGravity);
  slow.plans[0].dt = 0.1;
  const double per_force = 2e-5 / 20000, mass = 4000;
  CHECK(yields_more(slow.scene, slow.plans) == test::approx(4 / mass * 0.01 / per_force));
}

}  // namespace test_contact_give
