// Wrong strengths of joints and wrong settings of the search for the factor of safety are found before the
// first step.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>
#include <vector>

#include "support/told.h"
#include "talus/base/error.h"
#include "talus/run/run.h"

namespace test_wrong_input_joint {

using namespace talus;
using namespace talus::test;

namespace {

std::string joint_refusal(const std::string& joint, const std::string& more = "") {
  const std::string text = "talus = 1\n[material.m]\ndensity = 2000\n[joint.face]\n" + joint +
                           "\n[[block]]\nname = \"a\"\npolygon = [[0, 0], [1, 0], [1, 1], [0, 1]]\nmaterial "
                           "= \"m\"\nkind = \"rigid\"\n"
                           "[contact]\njoint = \"face\"\n" +
                           more +
                           "\n[[stage]]\nname = \"s\"\nkind = \"static\"\nduration = 1\ntime_step = 1e-3\n";
  return refusal(text);
}

struct Wrong {
  std::string joint, more;
  std::vector<std::string> parts;
};

}  // namespace

TEST_CASE("wrong input: strengths of joints, safety") {
  const std::string sound =
      "friction_angle = \"40 deg\"\nresidual_friction_angle = \"30 deg\"\ncohesion = 5\nresidual_cohesion = "
      "5\n"
      "dilation_angle = \"30 deg\"\n";
  CHECK(joint_refusal(sound, "[safety]\njoints = [\"face\"]\n") == "");
  const std::vector<Wrong> cases = {
      {"friction_angle = \"30 deg\"\nresidual_friction_angle = \"31 deg\"",
       "",
       {"model.toml:6:", "joint.face.residual_friction_angle", "larger than friction_angle"}},
      {"cohesion = 4\nresidual_cohesion = 5",
       "",
       {"model.toml:6:", "joint.face.residual_cohesion", "larger than cohesion"}},
      {"residual_tensile_strength = 5", "", {"model.toml:5:", "larger than tensile_strength"}},
      {"friction_angle = \"30 deg\"\ndilation_angle = \"31 deg\"",
       "",
       {"model.toml:6:", "31 deg", "friction_angle of 30 deg"}},
      {"friction_angle = \"30 deg\"\nresidual_friction_angle = \"20 deg\"\ndilation_angle = \"21 deg\"",
       "",
       {"model.toml:7:", "21 deg", "residual_friction_angle of 20 deg"}},
      {"dilation_slip = 0.1", "", {"model.toml:5:", "no meaning without dilation_angle"}},
      {"kind = \"bonded\"\ndilation_angle = 0", "", {"joint.face.dilation_angle", "bonded"}},
      {"restitution = 0.5\nfriction_angle = \"9 deg\"\ndilation_angle = \"9 deg\"",
       "",
       {"model.toml:5:", "restitution", "dilation"}},
      {sound, "law = \"smoothed\"\n", {"contact.law", "dilates"}},
      {sound, "[safety]\nlowest = 2\nhighest = 1\n", {"safety.highest", "larger than lowest"}},
      {sound, "[safety]\ntolerance = 0\n", {"safety.tolerance"}},
      {sound, "[safety]\njoints = [\"fase\"]\n", {"safety.joints", "did you mean \"face\""}},
      {"kind = \"bonded\"", "[safety]\njoints = [\"face\"]\n", {"safety.joints", "is bonded"}},
  };
  for (const Wrong& wrong : cases) {
    const std::string message = joint_refusal(wrong.joint, wrong.more);
    for (const std::string& part : wrong.parts) {
      INFO("message:\n", message, "\nshould hold: ", part);
      CHECK(message.find(part) != std::string::npos);
    }
  }
}

TEST_CASE("wrong input: a change that leaves a joint which could not be one from the start") {
  const std::string joint =
      "friction_angle = \"40 deg\"\nresidual_friction_angle = \"30 deg\"\ncohesion = 5\nresidual_cohesion = "
      "2\ntensile_strength = 4\n";
  const std::string rough = "friction_angle = \"40 deg\"\ndilation_angle = \"20 deg\"\n";
  const auto change = [](const std::string& keys, const std::string& stage = "s") {
    return fmt::format("[[change]]\nstage = \"{}\"\njoint = \"face\"\n{}\n", stage, keys);
  };
  const std::string later = "[[stage]]\nname = \"t\"\nkind = \"static\"\nduration = 1\ntime_step = 1e-3\n";
  CHECK(joint_refusal(joint, change("friction_angle = \"30 deg\"\ncohesion = 2\ntensile_strength = 0")) ==
        "");
  CHECK(joint_refusal(rough, change("friction_angle = \"20 deg\"")) == "");
  // a stage is judged when all its changes are made
  CHECK(joint_refusal(rough, change("friction_angle = \"10 deg\"") + change("friction_angle = \"25 deg\"")) ==
        "");

  const std::vector<Wrong> cases = {
      {rough,
       change("friction_angle = \"19 deg\""),
       {"model.toml:18:", "change.0.friction_angle", "is 19 deg",
        "dilation_angle of joint \"face\" is 20 deg", "give at least 20 deg", "[joint.face]"}},
      {joint,
       change("friction_angle = \"29 deg\""),
       {"change.0.friction_angle", "is 29 deg", "residual_friction_angle", "give at least 30 deg"}},
      {joint,
       change("cohesion = 1"),
       {"change.0.cohesion", "is 1 Pa", "residual_cohesion", "give at least 2 Pa"}},
      {joint + "residual_tensile_strength = 3\n",
       change("tensile_strength = 2"),
       {"change.0.tensile_strength", "residual_tensile_strength", "give at least 3 Pa"}},
      {"friction_angle = \"30 deg\"\nresidual_friction_angle = \"30 deg\"\nrestitution = 0.5\n",
       change("friction_angle = \"31 deg\""),
       {"change.0.friction_angle", "restitution of joint \"face\" is only for hard joints"}},
      // what one stage leaves is what the next one changes; of several changes the last is told
      {rough,
       later + change("friction_angle = \"25 deg\"") + change("friction_angle = \"15 deg\"", "t"),
       {"change.1.friction_angle", "is 15 deg"}},
      {rough,
       change("friction_angle = \"25 deg\"") + change("friction_angle = \"15 deg\""),
       {"change.1.friction_angle", "is 15 deg"}},
  };
  for (const Wrong& wrong : cases) {
    const std::string message = joint_refusal(wrong.joint, wrong.more);
    for (const std::string& part : wrong.parts) {
      INFO("message:\n", message, "\nshould hold: ", part);
      CHECK(message.find(part) != std::string::npos);
    }
  }
}

}  // namespace test_wrong_input_joint
