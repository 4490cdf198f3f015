// [variables] of the model file.

#include <doctest/doctest.h>

#include <numbers>
#include <string>
#include <vector>

#include "support/relative.h"
#include "support/told.h"
#include "talus/model/model_keys.h"
#include "talus/model/read_model.h"

namespace test_variables {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kBlocks =
    "[material.m]\ndensity = 2000\n"
    "[[block]]\nname = \"a\"\npolygon = [[0, 0], [1, 0], [1, 1], [0, 1]]\nmaterial = \"m\"\nkind = \"rigid\"\n";

Model read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Findings findings("model.toml", text);
  Model model = read_model("model.toml", text, overrides, findings);
  findings.throw_if_errors();
  return model;
}

}  // namespace

TEST_CASE("variables stand for values of any type, within texts and in expressions") {
  const std::string text =
      "talus = 1\ntitle = \"$who for $$ 5, $count times\"\n[variables]\nphi = \"30 deg\"\nwho = \"wall\"\ncount = 3\n"
      "g = [0, \"$(-pull) m/s2\"]\npull = \"9.81 m/s2\"\nhalf = \"$(phi / 2) rad\"\nlaw = { velocity = \"push\" }\n" +
      kBlocks +
      "[model]\ngravity = \"$g\"\n[joint.face]\nfriction_angle = \"$phi\"\nresidual_friction_angle = \"$half\"\n"
      "[contact]\njoint = \"face\"\n[solver]\nmax_iterations = \"$(2 * count + 1)\"\n"
      "[history.push]\ntime = [0, \"$(sqrt(count + 1))\"]\nvalue = [0, 1]\n"
      "[[support]]\nname = \"s\"\npoint = [0, 0]\nx = \"$law\"\n";
  const Model m = read(text);
  CHECK(m.title == "wall for $ 5, 3 times");
  CHECK(m.gravity.y == -9.81);
  CHECK(m.joints.at(0).friction_angle == approx(std::numbers::pi / 6).epsilon(1e-15));
  CHECK(m.joints.at(0).residual_friction_angle == approx(std::numbers::pi / 12).epsilon(1e-15));
  CHECK(m.solver.max_iterations == 7);
  CHECK(m.histories.at(0).time.at(1) == 2);
  CHECK(m.supports.at(0).x.history == 0);
  // what stands on a variable follows it
  const Model other = read(text, {"variables.phi=20 deg", "variables.count=8"});
  CHECK(other.joints.at(0).residual_friction_angle == approx(std::numbers::pi / 18).epsilon(1e-15));
  CHECK(other.solver.max_iterations == 17);
  // and a key that is overridden may name one
  CHECK(read(text, {"solver.max_iterations=$(count)"}).solver.max_iterations == 3);
  // two models differ where their values do
  const std::string moved = text + "\n# --set variables.count=8";
  const auto all = differences(keys_in_force(moved), keys_in_force(text));
  REQUIRE(all.size() == 3);
  CHECK(all[0].key == "history.push.time");
  CHECK(all[1].key == "solver.max_iterations");
  CHECK(all[2].key == "title");
}

TEST_CASE("wrong variables are told before anything is read") {
  struct Wrong {
    std::string head, use;
    std::vector<std::string> parts;
  };
  const std::vector<Wrong> cases = {
      {"phi = 1", "$ph", {"model.toml:2:", "title", "no variable \"ph\"", "did you mean \"$phi\""}},
      {"", "$phi", {"no variable \"phi\"", "given in [variables]"}},
      {"a = \"$b\"\nb = \"$(a + 1)\"", "$a", {"stands on itself", "ring"}},
      {"a = 1", "$(a + )", {"model.toml:2:", "title", "cannot be read"}},
      {"a = 1", "$(a + b)", {"cannot be read", "b"}},
      {"a = 0", "$(1 / a)", {"not finite"}},
      {"a = \"text\"", "$(a)", {"variable \"a\" is no number"}},
      {"a = 1", "$(a", {"no closing bracket"}},
      {"a = [1, 2]", "x $a", {"no number or text to stand within one"}},
      {"\"2a\" = 1\nb = 1", "$b", {"variables.2a", "no name of a variable"}},
  };
  for (const Wrong& w : cases) {
    INFO(w.head, " / ", w.use);
    check_told("talus = 1\ntitle = \"" + w.use + "\"\n[variables]\n" + w.head + "\n" + kBlocks, w.parts);
  }
}

TEST_CASE("variables that nothing uses are told, and refused where they were given by hand") {
  const std::string text = "talus = 1\n[variables]\nphi = 1\n" + kBlocks;
  check_told(text + "[[stage]]\nname = \"s\"\nkind = \"static\"\nduration = 1\ntime_step = 1e-3\n",
             {"model.toml:3:", "variables.phi", "used by nothing", "\"$phi\""});
  const std::string said = refusal(text, {"variables.psi=2"});
  CHECK(said.find("--set variables.psi=2") != std::string::npos);
  CHECK(said.find("used by nothing") != std::string::npos);
}

}  // namespace test_variables
