// Wrong rock bolts are found before the first step, with what was found and what to do.

#include <doctest/doctest.h>

#include "support/told.h"
#include "talus/base/error.h"
#include "talus/run/run.h"

namespace test_wrong_input_bolts {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kSound = R"(talus = 1
[material.rock]
density = 2500
young = "9 GPa"
poisson = 0.25
[joint.glue]
kind = "bonded"
[[grid]]
name = "g"
min = [0, 0]
max = [4, 4]
cells = [2, 2]
material = "rock"
joint = "glue"
[[stage]]
name = "first"
kind = "static"
duration = "1 s"
[[stage]]
name = "go"
kind = "dynamic"
duration = "1 ms"
)";

const std::string kBar = "kind = \"grouted\"\ndiameter = \"25 mm\"\nspacing = 1\n",
                  kRod = "kind = \"anchored\"\ndiameter = \"25 mm\"\nspacing = 1\n",
                  kLine = "from = [1, 1]\nto = [3, 1.5]\n",
                  kRadial = "kind = \"radial\"\nlength = 1\ncenter = [2, 2]\nradius = 0.5\n";

std::string type(const std::string& keys) { return kSound + "[bolt_type.t]\n" + keys; }
std::string bolt(const std::string& type_keys, const std::string& keys) {
  return type(type_keys) + "[[bolt]]\nname = \"b\"\ntype = \"t\"\n" + keys;
}
std::string pattern(const std::string& keys) {
  return type(kBar) + "[[bolt_pattern]]\nname = \"p\"\ntype = \"t\"\n" + keys;
}

struct Case {
  std::string what, text;
  std::vector<std::string> pieces;
};

void check_cases(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    INFO(c.what);
    check_told(c.text, c.pieces);
  }
}

}  // namespace

TEST_CASE("sound bolts are taken without a word") {
  CHECK(told(bolt(kBar, kLine)).empty());
  CHECK(
      told(bolt(kRod + "pretension = \"10 kN\"\nyield_stress = \"400 MPa\"\nrupture_strain = 0.05\n", kLine))
          .empty());
  CHECK(told(pattern("kind = \"row\"\nlength = 3\nfrom = [0.5, 1]\nto = [0.5, 3.1]\nspacing = 0.7\n"
                     "direction = \"3 deg\"\n"))
            .empty());
}

TEST_CASE("wrong types of bolts") {
  check_cases({
      {"no kind", bolt("diameter = 0.025\nspacing = 1\n", kLine), {"bolt_type.t.kind: is missing"}},
      {"unknown kind",
       bolt("kind = \"grout\"\ndiameter = 0.025\nspacing = 1\n", kLine),
       {"must be anchored, grouted or superposed"}},
      {"no spacing",
       bolt("kind = \"grouted\"\ndiameter = 0.025\n", kLine),
       {"bolt_type.t.spacing: is missing"}},
      {"negative diameter", bolt("kind = \"grouted\"\ndiameter = -1\nspacing = 1\n", kLine), {"must be > 0"}},
      {"two yields",
       bolt(kBar + "yield_stress = \"400 MPa\"\nyield_force = \"100 kN\"\n", kLine),
       {"yield_force: is given beside yield_stress", "give one of the two"}},
      {"pretension above yield",
       bolt(kRod + "yield_force = \"10 kN\"\npretension = \"20 kN\"\n", kLine),
       {"pretension: 20000 N is not below the yield force 10000 N"}},
      {"rupture by pretension",
       bolt(kRod + "pretension = \"200 kN\"\nrupture_strain = 0.001\n", kLine),
       {"rupture_strain: is reached by the pretension", "percent"}},
      {"rupture before yield",
       bolt(kRod + "yield_stress = \"400 MPa\"\nrupture_strain = 0.001\n", kLine),
       {"rupture_strain: is reached before the bar yields"}},
      {"grout of an anchored bolt",
       bolt(kRod + "bond_strength = \"100 kN/m\"\n", kLine),
       {"bond_strength: is only for kind = \"grouted\""}},
      {"bond in MPa",
       bolt(kBar + "bond_strength = \"1 MPa\"\n", kLine),
       {"bond_strength", "a force per length (N/m, kN/m, MN/m)"}},
      {"unused", type(kBar), {"bolt_type.t: is used by no bolt"}},
  });
}

TEST_CASE("wrong bolts") {
  check_cases({
      {"unknown type",
       kSound + "[bolt_type.rod]\n" + kBar + "[[bolt]]\nname = \"b\"\ntype = \"rot\"\n" + kLine,
       {"bolt.b.type: there is no bolt_type called \"rot\"", "did you mean \"rod\"?"}},
      {"unknown stage",
       bolt(kBar, kLine + "stage = \"frist\"\n"),
       {"bolt.b.stage: there is no stage called \"frist\"", "did you mean \"first\"?"}},
      {"no length", bolt(kBar, "from = [1, 1]\nto = [1, 1]\n"), {"bolt.b.to: is where the bolt begins"}},
      {"begins outside", bolt(kBar, "from = [-1, 1]\nto = [3, 1]\n"), {"bolt.b: begins outside the blocks"}},
      {"ends outside", bolt(kBar, "from = [1, 1]\nto = [7, 1]\n"), {"bolt.b: ends outside the blocks"}},
      {"nowhere", bolt(kBar, "from = [11, 1]\nto = [17, 1]\n"), {"bolt.b: meets no block"}},
      {"anchored in one block",
       bolt(kRod, "from = [0.5, 1]\nto = [1.5, 1]\n"),
       {"bolt.b: begins and ends in the same block \"g[0,0]\""}},
      {"grouted in one block",
       bolt(kBar, "from = [0.5, 1]\nto = [1.5, 1]\n"),
       {"warning", "bolt.b: crosses no joint"}},
      {"along a joint",
       bolt(kBar, "from = [2, 0.5]\nto = [2, 3.5]\n"),
       {"bolt.b: runs along the joint between \"g[0,"}},
      {"tensioned in a dynamic stage",
       bolt(kRod + "pretension = \"20 kN\"\n", kLine + "stage = \"go\"\n"),
       {"warning", "is tensioned at once at the start of dynamic stage \"go\""}},
      {"two of a name",
       bolt(kBar, kLine) + "[[bolt]]\nname = \"b\"\ntype = \"t\"\n" + kLine,
       {"a second bolt is called \"b\""}},
      {"monitor of no bolt",
       bolt(kBar, kLine) + "[[monitor]]\nname = \"m\"\nbolt = \"c\"\n",
       {"monitor.m.bolt: there is no bolt called \"c\""}},
  });
}

TEST_CASE("wrong patterns of bolts") {
  check_cases({
      {"no place",
       pattern("kind = \"radial\"\nlength = 1\ncount = 3\n"),
       {"bolt_pattern.p: does not say around what"}},
      {"half a circle",
       pattern("kind = \"radial\"\nlength = 1\ncount = 3\nradius = 1\n"),
       {"bolt_pattern.p: does not say around what"}},
      {"unknown opening",
       pattern("kind = \"radial\"\nlength = 1\ncount = 3\nopening = \"o\"\n"),
       {"there is no opening called \"o\""}},
      {"no count", pattern(kRadial), {"bolt_pattern.p: does not say how many bolts"}},
      {"two counts",
       pattern(kRadial + "count = 3\nangle_spacing = \"10 deg\"\n"),
       {"bolt_pattern.p: says twice how many bolts"}},
      {"bolts all around, millions of them",
       pattern(kRadial + "angle_spacing = \"1e-9 deg\"\n"),
       {"angle_spacing: makes 3.6e+11 bolts"}},
      {"angle with a strange unit",
       pattern(kRadial + "angle_spacing = \"18'deg\"\n"),
       {"bolt_pattern.p.angle_spacing"}},
      {"angles backwards",
       pattern(kRadial + "count = 3\nangle_from = \"90 deg\"\nangle_to = \"10 deg\"\n"),
       {"angle_to: must lie above angle_from"}},
      {"row keys", pattern(kRadial + "count = 3\nspacing = 1\n"), {"spacing: is only for kind = \"row\""}},
      {"radial keys",
       pattern("kind = \"row\"\nlength = 1\ncount = 3\n"),
       {"count: is only for kind = \"radial\"", "p.from: is missing"}},
      {"a row of millions",
       pattern("kind = \"row\"\nlength = 1\nfrom = [0, 1]\nto = [4, 1]\nspacing = 1e-6\ndirection = 0\n"),
       {"spacing: makes 4e+06 bolts"}},
  });
}

TEST_CASE(
    "use = false leaves bolts out: their type is no finding, and a monitor of them records nothing, says "
    "so") {
  const auto read = [](const std::string& text, const std::vector<std::string>& overrides) {
    Findings findings("model.toml", text);
    const Model model = prepare_run("model.toml", text, overrides, findings).scene.model;
    return std::tuple(model.bolts.size(), model.monitors.size(), findings.render());
  };
  for (const std::string& out : {bolt(kBar, kLine + "use = false\n"),
                                 pattern(kRadial + "count = 3\nangle_from = \"20 deg\"\nuse = false\n")}) {
    const bool one = out.find("[[bolt]]") != std::string::npos;
    const std::string name = one ? "b" : "p", section = one ? "bolt.b" : "bolt_pattern.p";
    const std::string text = out + "[[monitor]]\nname = \"m\"\nbolt = \"" + name + "\"\n";
    const auto [bolts, monitors, told] = read(text, {});
    CHECK(bolts == 0);
    CHECK(monitors == 0);
    CHECK(told.find("monitor.m.bolt: \"" + name + "\" is left out (use = false)") != std::string::npos);
    CHECK(told.find("is used by no bolt") == std::string::npos);
    const auto [more, recorded, nothing] = read(text, {section + ".use=true"});
    CHECK(more >= 1);
    CHECK(recorded == 1);
    CHECK(nothing.find("left out") == std::string::npos);
  }
}

}  // namespace test_wrong_input_bolts
