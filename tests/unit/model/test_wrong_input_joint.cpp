// Wrong strengths of joints and wrong settings of the search for the factor of safety are found before the
// first step.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>
#include <vector>

#include "talus/base/error.h"
#include "talus/run/run.h"

using namespace talus;

namespace {

std::string refusal(const std::string& joint, const std::string& more = "") {
  const std::string text = "talus = 1\n[material.m]\ndensity = 2000\n[joint.face]\n" + joint +
                           "\n[[block]]\nname = \"a\"\npolygon = [[0, 0], [1, 0], [1, 1], [0, 1]]\nmaterial "
                           "= \"m\"\nkind = \"rigid\"\n"
                           "[contact]\njoint = \"face\"\n" +
                           more +
                           "\n[[stage]]\nname = \"s\"\nkind = \"static\"\nduration = 1\ntime_step = 1e-3\n";
  Findings findings("model.toml", text);
  try {
    prepare_run("model.toml", text, {}, findings);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
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
  CHECK(refusal(sound, "[safety]\njoints = [\"face\"]\n") == "");
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
    const std::string message = refusal(wrong.joint, wrong.more);
    for (const std::string& part : wrong.parts) {
      INFO("message:\n", message, "\nshould hold: ", part);
      CHECK(message.find(part) != std::string::npos);
    }
  }
}
