#include <doctest/doctest.h>

#include "talus/run/branch.h"

namespace test_branch_keys {

using namespace talus;

namespace {

const std::string kModel = R"(talus = 1
title = "a"
[material.rock]
density = 2500
[history.wave]
time = [0, 1]
value = [0, 1]
[[support]]
name = "base.left"
edge = [[0, 0], [1, 0]]
x = { velocity = "wave" }
stages = ["shake"]
[[support]]
name = "side"
edge = [[0, 0], [0, 1]]
[[bolt]]
name = "pin"
from = [0, 0]
to = [1, 1]
stage = "shake"
[[change]]
stage = "dig"
joint = "face"
cohesion = 1
[[stage]]
name = "rest"
kind = "static"
duration = 1
[[stage]]
name = "dig"
kind = "static"
duration = 1
[[stage]]
name = "shake"
kind = "dynamic"
duration = 1
)";

std::string with(const std::string& what, const std::string& by) {
  std::string text = kModel;
  REQUIRE(text.find(what) != std::string::npos);
  return text.replace(text.find(what), what.size(), by);
}

// The keys that a branch after `begun` may have, and those it may not: "+title -material.rock.density".
std::string sorted(const std::string& now, std::vector<std::string> begun = {"rest", "dig"},
                   bool moved = false, bool bolted = false) {
  const ModelKeys a = keys_in_force(now), b = keys_in_force(kModel);
  const BranchKeys keys = branch_keys(a, b, begun, moved, bolted);
  std::string out;
  for (const KeyDifference& d : keys.later) out += "+" + d.key + " ";
  for (const KeyDifference& d : keys.earlier) out += "-" + d.key + " ";
  return out;
}

}  // namespace

TEST_CASE("branch: keys are told apart by what they act on") {
  CHECK(sorted(kModel) == "");
  CHECK(sorted(with("\"a\"", "\"b\"")) == "+title ");
  CHECK(sorted(with("2500", "2600")) == "-material.rock.density ");
  CHECK(sorted(with("[0, 1]\n[[sup", "[0, 2]\n[[sup")) == "+history.wave.value ");
  CHECK(sorted(with("[0, 1]\n[[sup", "[0, 2]\n[[sup"), {"rest", "dig", "shake"}, true) ==
        "-history.wave.value ");
  // names and keys that hold dots
  CHECK(sorted(with("x = { velocity = \"wave\" }", "x = { displacement = \"wave\" }")) ==
        "+support.base.left.x.displacement +support.base.left.x.velocity ");
  CHECK(sorted(with("[[0, 0], [0, 1]]", "[[0, 0], [0, 2]]")) == "-support.side.edge ");
  // a support that comes has points of which the state knows nothing
  CHECK(sorted(kModel + "[[support]]\nname = \"top\"\nedge = [[0, 1], [1, 1]]\nstages = [\"shake\"]\n") ==
        "-support.top.edge -support.top.name -support.top.stages ");
  CHECK(sorted(kModel + "[[load]]\nname = \"wind\"\nstages = [\"shake\"]\n") ==
        "+load.wind.name +load.wind.stages ");
  CHECK(sorted(kModel + "[[load]]\nname = \"wind\"\nstages = [\"dig\", \"shake\"]\n") ==
        "-load.wind.name -load.wind.stages ");
  CHECK(sorted(with("to = [1, 1]", "to = [1, 2]")) == "+bolt.pin.to ");
  CHECK(sorted(with("to = [1, 1]", "to = [1, 2]"), {"rest"}, false, true) == "-bolt.pin.to ");
}

TEST_CASE("branch: changes and stages by whether they have begun") {
  CHECK(sorted(with("cohesion = 1", "cohesion = 2")) == "-change.0.cohesion ");
  CHECK(sorted(with("cohesion = 1", "cohesion = 2"), {"rest"}) == "+change.0.cohesion ");
  CHECK(sorted(kModel + "[[change]]\nstage = \"shake\"\njoint = \"face\"\n") ==
        "+change.1.joint +change.1.stage ");
  // one that goes before another gives it another number
  CHECK(sorted(with("[[change]]", "[[change]]\nstage = \"rest\"\njoint = \"face\"\n[[change]]"))[0] == '-');
  CHECK(sorted(with("kind = \"dynamic\"\nduration = 1", "kind = \"dynamic\"\nduration = 2")) ==
        "+stage.shake.duration ");
  CHECK(sorted(with("kind = \"dynamic\"\nduration = 1", "kind = \"dynamic\"\nduration = 2"),
               {"rest", "dig", "shake"}, true) == "-stage.shake.duration ");
}

TEST_CASE("branch: overrides count as what they override") {
  CHECK(sorted(kModel + "\n# --set stage.shake.duration=3\n# --set title=c") ==
        "+stage.shake.duration +title ");
  CHECK(sorted(kModel + "\n# --set title=a") == "");
  const ModelKeys now = keys_in_force(kModel + "\n# --set stage.shake.duration=0.2"),
                  before = keys_in_force(kModel);
  CHECK(differences(now, before)[0].text() == "stage.shake.duration: 0.2, was 1");
}

}  // namespace test_branch_keys
