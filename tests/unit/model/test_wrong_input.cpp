// Every kind of wrong input is found before the first step, with file, line, key, what was found and what is
// allowed.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "support/told.h"
#include "talus/base/error.h"
#include "talus/model/read_model.h"
#include "talus/run/run.h"

namespace test_wrong_input {

using namespace talus;
using namespace talus::test;

namespace {

// A sound model of twelve numbered sections; tests replace one piece of it.
const std::string kSound = R"(talus = 1
title = "sound"
[model]
gravity = [0, -9.81]
[material.rock]
density = "2700 kg/m3"
young = "5 GPa"
poisson = 0.25
[joint.face]
friction_angle = "35 deg"
[[block]]
name = "lower"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "rock"
kind = "fixed"
[[block]]
name = "upper"
polygon = [[0, 1], [1, 1], [1, 2], [0, 2]]
material = "rock"
[contact]
joint = "face"
[[stage]]
name = "go"
kind = "dynamic"
duration = "1 ms"
[[monitor]]
name = "m"
point = [0.5, 1.5]
)";

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = kSound;
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

void check_message(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    INFO("message:\n", message, "\nshould hold: ", part);
    CHECK(message.find(part) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("wrong input: the sound model is accepted") { CHECK(refusal(kSound) == ""); }

TEST_CASE("wrong input: what cannot be read is not said to be missing") {
  for (const std::string& text : {replaced("[model]", "[model"), std::string("talus = 1\nx = [")})
    check_message(refusal(text), {"error: syntax:", "1 error; nothing was run"});
  check_message(refusal(kSound, {"joint.fase.friction_angle=20"}),
                {"the file has no [joint.fase]", "1 error; nothing was run"});
}

TEST_CASE("wrong input: what a step may keep is at least what its solvers aim at") {
  const auto said = [](const std::string& solver) {
    return refusal(replaced("[[monitor]]", "[solver]\n" + solver + "\n[[monitor]]"));
  };
  check_message(
      said("tolerance = 1e-7\nlimit = 1e-9"),
      {"model.toml:28:1: error: solver.limit: 1e-09 is not allowed; must be at least solver.tolerance, 1e-07",
       "give a larger limit or a smaller tolerance", "1 error; nothing was run"});
  check_message(said("limit = 0"),
                {"model.toml:27:9: error: solver.limit: 0 is not allowed; must be > 0 and <= 0.01"});
  CHECK(said("tolerance = 1e-7\nlimit = 1e-7") == "");
  check_message(
      refusal(replaced("joint = \"face\"", "joint = \"face\"\nlaw = \"smoothed\""), {"solver.limit=1e-4"}),
      {"error: solver.limit: is of the exact law", "leave it out, or use contact.law = \"exact\""});
  check_message(refusal(kSound, {"model.formulation=as_printed", "solver.limit=1e-4"}),
                {"error: solver.limit: is of the exact law"});

  // where none is given a tolerance above the usual limit is the limit, and smoothed steps keep nothing
  const auto limit = [](const std::vector<std::string>& overrides) {
    Findings findings("model.toml", kSound);
    return read_model("model.toml", kSound, overrides, findings).solver.limit;
  };
  CHECK(limit({"solver.tolerance=1e-4"}) == 1e-4);
  CHECK(limit({"solver.tolerance=1e-12"}) == 1e-5);
  CHECK(limit({"contact.law=\"smoothed\""}) == 1e-8);
}

TEST_CASE("wrong input: each kind has its message") {
  struct Wrong {
    const char* kind;
    std::string from, to;
    std::vector<std::string> parts;
  };
  const std::vector<Wrong> cases = {
      {"syntax", "title = \"sound\"", "title = sound\"", {"model.toml:2:", "error: syntax:"}},
      {"key given twice",
       "young = \"5 GPa\"",
       "young = \"5 GPa\"\nyoung = 3",
       {"model.toml:8:9: error: syntax:", "young"}},
      {"bytes that are no text",
       "sound",
       "so\x01und",
       {"model.toml:2:1: error: the line holds bytes that are not UTF-8 text"}},
      {"format missing", "talus = 1", "", {"model.toml:1:1: error: talus: is missing"}},
      {"newer format",
       "talus = 1",
       "talus = 2",
       {"model.toml:1:1: error: talus: the file is in format 2, newer than this program",
        "use a newer talus"}},
      {"format below 1",
       "talus = 1",
       "talus = 0",
       {"model.toml:1:9: error: talus: 0 is not allowed; must be >= 1"}},
      {"unknown section",
       "[contact]",
       "[contacts]",
       {"model.toml:20:2: error: contacts: unknown section", "did you mean \"contact\"?"}},
      {"unknown key",
       "density =",
       "densty =",
       {"model.toml:6:1: error: material.rock.densty: unknown key", "did you mean \"density\"?",
        "material.rock.density: is missing"}},
      {"wrong type",
       "poisson = 0.25",
       "poisson = true",
       {"model.toml:8:11: error: material.rock.poisson: is true or false; expected a plain number"}},
      {"wrong unit",
       "\"5 GPa\"",
       "\"5 kN\"",
       {"model.toml:7:9: error: material.rock.young: \"5 kN\" is a force; expected a stress (Pa, kPa, MPa, "
        "GPa, psi)"}},
      {"unknown unit", "\"5 GPa\"", "\"5 Gpa\"", {"unknown unit \"Gpa\"", "did you mean \"GPa\"?"}},
      {"no number", "\"5 GPa\"", "\"stiff\"", {"\"stiff\" does not begin with a number; expected a stress"}},
      {"bare angle",
       "\"35 deg\"",
       "35",
       {"model.toml:10:18: error: joint.face.friction_angle: an angle needs its unit: write \"35 deg\" or "
        "\"35 rad\""}},
      {"negative density",
       "\"2700 kg/m3\"",
       "-2700",
       {"model.toml:6:11: error: material.rock.density: -2700 kg/m3 is not allowed; must be > 0 kg/m3",
        "density = -2700"}},
      {"poisson out of range",
       "0.25",
       "0.5",
       {"material.rock.poisson: 0.5 is not allowed; must be > -1 and < 0.5"}},
      {"not finite", "0.25", "nan", {"material.rock.poisson: is not a finite number"}},
      {"missing key", "duration = \"1 ms\"", "", {"model.toml:22:1: error: stage.go.duration: is missing"}},
      {"unknown choice",
       "kind = \"fixed\"",
       "kind = \"fixd\"",
       {"block.lower.kind: \"fixd\" is not known; must be deformable, rigid, fixed or driven",
        "did you mean \"fixed\"?"}},
      {"unknown name",
       "joint = \"face\"",
       "joint = \"fase\"",
       {"model.toml:21:1: error: contact.joint: there is no joint called \"fase\"",
        "did you mean \"face\"?"}},
      {"name used twice",
       "name = \"upper\"",
       "name = \"lower\"",
       {"model.toml:17:1: error: block.lower.name: a second block or grid is called \"lower\""}},
      {"deformable without modulus",
       "young = \"5 GPa\"",
       "",
       {"block.upper: is deformable, but material \"rock\" has no young"}},
      {"self-intersecting polygon",
       "[[0, 1], [1, 1], [1, 2], [0, 2]]",
       "[[0, 1], [1, 2], [1, 1], [0, 2]]",
       {"model.toml:18:1: error: block.upper.polygon: crosses or touches itself at (0.5, 1.5)"}},
      {"polygon of two corners",
       "[[0, 1], [1, 1], [1, 2], [0, 2]]",
       "[[0, 1], [1, 1]]",
       {"has 2 corners; a polygon needs at least 3"}},
      {"edge of length zero",
       "[[0, 1], [1, 1], [1, 2], [0, 2]]",
       "[[0, 1], [1, 1], [1, 1], [0, 2]]",
       {"has an edge of length zero: corners 2 and 3 are both (1, 1)"}},
      {"overlapping blocks",
       "[[0, 1], [1, 1], [1, 2], [0, 2]]",
       "[[0, 0.9], [1, 0.9], [1, 2], [0, 2]]",
       {"model.toml:18:1: error: upper: overlaps \"lower\" by 0.1 m2 around (0.5, 0.95)"}},
      {"monitor outside every block",
       "point = [0.5, 1.5]",
       "point = [0.5, 2.5]",
       {"model.toml:28:1: error: monitor.m: (0.5, 2.5) lies outside every block",
        "the nearest block, \"upper\", is 0.5 m away"}},
      {"monitor of nothing",
       "point = [0.5, 1.5]",
       "",
       {"monitor.m: does not say what to record",
        "give one of point, centroid, convergence, crack, block, support, contact"}},
      {"monitor of unknown block",
       "point = [0.5, 1.5]",
       "block = \"uper\"",
       {"there is no block, grid or region called \"uper\"", "did you mean \"upper\"?"}},
      {"step above the stable limit",
       "duration = \"1 ms\"",
       "duration = \"1 s\"\ntime_step = \"10 ms\"\nelasticity = \"explicit\"",
       {"model.toml:26:1: error: stage.go.time_step: 0.01 s is above the stable limit",
        "set by block \"upper\"", "use \"auto\""}},
      {"steps from rest in a dynamic stage",
       "kind = \"dynamic\"",
       "kind = \"dynamic\"\nintegration = \"implicit\"",
       {"model.toml:25:1: error: stage.go.integration: is \"implicit\", which knows no inertia",
        "say kind = \"static\""}},
      {"damping of steps from rest",
       "kind = \"dynamic\"",
       "kind = \"static\"\nintegration = \"implicit\"\ndamping_local = 0.5",
       {"stage.go.damping_local: has nothing to do where integration = \"implicit\"",
        "leave one of the two out"}},
      {"a stable limit for steps from rest",
       "kind = \"dynamic\"",
       "kind = \"static\"\nintegration = \"implicit\"\nsafety = 0.5",
       {"stage.go.safety: has nothing to do where integration = \"implicit\""}},
      {"explicit elasticity of steps from rest",
       "kind = \"dynamic\"",
       "kind = \"static\"\nintegration = \"implicit\"\nelasticity = \"explicit\"",
       {"stage.go.elasticity: is \"explicit\"", "has no stable limit to keep"}},
      {"a way of integration that there is not",
       "kind = \"dynamic\"",
       "kind = \"static\"\nintegration = \"implict\"",
       {"stage.go.integration", "\"implict\"", "implicit"}},
      {"a solver of the exact law on the smoothed one",
       "[contact]",
       "[solver]\nmethod = \"primal_newton\"\n[contact]\nlaw = \"smoothed\"",
       {"solver.method: primal_newton solves the exact law only", "method = \"newton\""}},
      {"difference quotients for a solver that takes none",
       "[contact]",
       "[solver]\nmethod = \"gauss_seidel\"\njacobian = \"difference\"\n[contact]",
       {"solver.jacobian: difference quotients are of newton; gauss_seidel takes none", "leave it out"}},
      {"support off every block",
       "[contact]",
       "[[support]]\nname = \"s\"\npoint = [5, 5]\n[contact]",
       {"support.s: the point lies on no block"}},
      {"history that does not rise",
       "[contact]",
       "[history.h]\ntime = [0, 1, 1]\nvalue = [0, 1, 2]\n[contact]",
       {"history.h.time: does not rise: 1 s is followed by 1 s"}},
      {"formula that cannot be read",
       "[contact]",
       "[history.h]\nexpression = \"sin(2*\"\nduration = 1\n[contact]",
       {"history.h.expression: the formula cannot be read:"}},
      {"formula that is not finite",
       "[contact]",
       "[history.h]\nexpression = \"1/t\"\nduration = 1\n[contact]",
       {"the formula is not finite at t = 0 s"}},
      {"strength of a bonded joint",
       "[joint.face]",
       "[joint.face]\nkind = \"bonded\"",
       {"joint.face.friction_angle: has no meaning for a bonded joint"}},
      {"motion of a block that is not driven",
       "kind = \"fixed\"",
       "kind = \"fixed\"\nmotion_x = \"fixed\"",
       {"block.lower.motion_x: is only for a block of kind = \"driven\""}},
      {"single brackets", "[[block]]\nname = \"lower\"", "[block]\nname = \"lower\"", {"error: syntax:"}},
  };
  for (const Wrong& w : cases) {
    CAPTURE(w.kind);
    const std::string message = refusal(replaced(w.from, w.to));
    CHECK(message != "");
    check_message(message, w.parts);
    check_message(message, {"nothing was run"});
  }
}

TEST_CASE("wrong input: all findings are listed at once, in the order of the file") {
  std::string text = replaced("2700 kg/m3", "-1 kg/m3");
  text.replace(text.find("0.25"), 4, "0.75");
  text.replace(text.find("\"35 deg\""), 8, "\"95 deg\"");
  const std::string message = refusal(text);
  check_message(message, {"density", "poisson", "95 deg is not allowed; must be >= 0 deg and <= 89 deg",
                          "3 errors; nothing was run"});
  CHECK(message.find("density") < message.find("poisson"));
  CHECK(message.find("poisson") < message.find("friction_angle"));
}

TEST_CASE("wrong input: no block, no stage") {
  const std::string message = refusal("talus = 1\n");
  check_message(message, {"the file has no [[stage]]"});
  check_message(refusal("talus = 1\n[[stage]]\nname=\"s\"\nkind=\"dynamic\"\nduration=1\ntime_step=0.1\n"),
                {"the model has no block", "add a [[block]], a [[grid]], a [[mesh]] or a [[region]]"});
}

TEST_CASE("overrides: values, names in lists, and their own mistakes") {
  CHECK(refusal(kSound,
                {"material.rock.young=6 GPa", "block.upper.velocity=[1,0]", "stage.go.duration=2 ms"}) == "");
  check_message(refusal(kSound, {"material.rock.young=-6 GPa"}),
                {"material.rock.young: -6e+09 Pa is not allowed", "from --set material.rock.young=-6 GPa"});
  check_message(refusal(kSound, {"material.rock.yung=6 GPa"}),
                {"material.rock.yung: unknown key", "did you mean \"young\"?"});
  check_message(refusal(kSound, {"block.uper.kind=rigid"}),
                {"no block is called \"uper\"", "there is lower or upper"});
  check_message(refusal(kSound, {"young"}), {"an override is written path=value"});
  check_message(refusal(kSound, {"title=\"x\" # \nevil = 1"}), {"an override has more than one line"});
  check_message(refusal(kSound, {"talus.x=1"}), {"\"talus\" holds no further keys"});
}

TEST_CASE(
    "an automatic step where no block deforms: from gravity and motions, refused where nothing sets a time") {
  const std::string rigid =
      replaced("material = \"rock\"\n[contact]", "material = \"rock\"\nkind = \"rigid\"\n[contact]");
  CHECK(refusal(rigid).empty());
  const std::string message = refusal(rigid, {"model.gravity=[0,0]"});
  CHECK(message.find("stage.go.time_step: \"auto\" finds nothing in this model that sets a time") !=
        std::string::npos);
  CHECK(message.find("give a time_step") != std::string::npos);
}

}  // namespace test_wrong_input
