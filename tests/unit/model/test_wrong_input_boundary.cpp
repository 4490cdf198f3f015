// Wrong boundaries and loads are found before the first step, with what was found and what to do.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "support/told.h"
#include "talus/base/error.h"
#include "talus/run/run.h"

namespace test_wrong_input_boundary {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kSound = R"(talus = 1
[material.rock]
density = 2500
young = "9 GPa"
poisson = 0.25
[material.lead]
density = 11000
[joint.glue]
kind = "bonded"
[joint.soft]
normal_stiffness = "2 GPa/m"
[history.v]
time = [0, 1]
value = [0, 0]
[[grid]]
name = "g"
min = [0, 0]
max = [4, 6]
cells = [2, 3]
material = "rock"
joint = "glue"
[[stage]]
name = "go"
kind = "dynamic"
duration = "1 ms"
)";

std::string boundary(const std::string& keys) { return kSound + "[[boundary]]\nname = \"b\"\n" + keys; }
std::string load(const std::string& keys) { return kSound + "[[load]]\nname = \"l\"\n" + keys; }

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

const std::string kBase = "edge = [[0, 0], [4, 0]]\n", kLeft = "edge = [[0, 0], [0, 6]]\n";

}  // namespace

TEST_CASE("wrong boundaries: kinds, places, motions") {
  check_cases({
      {"no kind", boundary(kBase), {"boundary.b.kind: is missing"}},
      {"unknown kind",
       boundary(kBase + "kind = \"viscos\"\n"),
       {"must be viscous, free_field or tied", "did you mean \"viscous\"?"}},
      {"no place", boundary("kind = \"viscous\"\n"), {"boundary.b: has no place", "give one of edge"}},
      {"two places",
       boundary(kBase + "along = \"x\"\nkind = \"viscous\"\n"),
       {"boundary.b: has more than one place"}},
      {"a point", boundary("point = [0, 0]\nkind = \"viscous\"\n"), {"boundary.b.point: unknown key"}},
      {"off the blocks",
       boundary("edge = [[0, -1], [4, -1]]\nkind = \"viscous\"\n"),
       {"no block edge lies on the segment"}},
      {"inside",
       boundary("edge = [[0, 2], [4, 2]]\nkind = \"viscous\"\n"),
       {"every edge there has a block on its other side"}},
      {"covered in part",
       boundary(kBase + "kind = \"viscous\"\n[[block]]\nname = \"under\"\npolygon = [[0, -1], [1, -1], [1, "
                        "0], [0, 0]]\nmaterial = \"rock\"\n"),
       {"an edge of \"g[0,0]\" from (0, 0) to (2, 0) is covered in part by \"under\"", "cut the block"}},
      {"no such line",
       boundary("along = \"floor\"\nkind = \"viscous\"\n"),
       {"boundary.b.along: there is no side, opening, fault or joint set called \"floor\""}},
      {"no such block",
       boundary(kBase + "block = \"h\"\nkind = \"viscous\"\n"),
       {"boundary.b.block: there is no block, grid or region called \"h\""}},
      {"unknown history",
       boundary(kBase + "kind = \"viscous\"\nvelocity_x = \"w\"\nmotion = \"upgoing\"\n"),
       {"boundary.b.velocity_x: there is no history called \"w\""}},
      {"motion not named",
       boundary(kBase + "kind = \"viscous\"\nvelocity_x = \"v\"\n"),
       {"boundary.b.motion: is missing: upgoing and outcrop motion differ by a factor of two",
        "motion = \"outcrop\""}},
      {"within",
       boundary(kBase + "kind = \"viscous\"\nvelocity_x = \"v\"\nmotion = \"within\"\n"),
       {"boundary.b.motion: \"within\" is the real motion of the base",
        "give the motion of the base to a [[support]]"}},
      {"moves for ever",
       boundary(kBase + "kind = \"viscous\"\nvelocity_y = \"w\"\nmotion = \"upgoing\"\n[history.w]\ntime = "
                        "[0, 1]\nvalue = [0, 2]\n"),
       {"warning: boundary.b.velocity_y: history \"w\" ends at 2 m/s", "let a velocity end at 0"}},
      {"motion of nothing",
       boundary(kBase + "kind = \"viscous\"\nmotion = \"outcrop\"\n"),
       {"boundary.b.motion: says what no history is"}},
      {"input at a side",
       boundary(kLeft + "kind = \"free_field\"\nvelocity_x = \"v\"\n"),
       {"boundary.b.velocity_x: is only for kind = \"viscous\"", "its column takes the motion of the base"}},
      {"opposite of a viscous edge",
       boundary(kLeft + "kind = \"viscous\"\nto = \"x\"\n"),
       {"boundary.b.to: is only for kind = \"tied\""}},
      {"no elastic constants",
       boundary(kBase + "kind = \"viscous\"\nmaterial = \"lead\"\n"),
       {"boundary.b: has material \"lead\" behind it, which has no young", "give it in [material.lead]"}},
      {"unknown static",
       boundary(kBase + "kind = \"viscous\"\nstatic = \"held\"\n"),
       {"boundary.b.static: \"held\" is not known; must be fixed, roller or free"}},
      {"one edge twice",
       boundary(kBase + "kind = \"viscous\"\n[[boundary]]\nname = \"c\"\nkind = \"viscous\"\n" + kBase),
       {"boundary.c: takes an edge of \"g[0,0]\" at (1, 0) that belongs to boundary \"b\""}},
      {"one name twice",
       boundary(kBase + "kind = \"viscous\"\n[[boundary]]\nname = \"b\"\nkind = \"viscous\"\n" + kLeft),
       {"a second boundary is called \"b\""}},
      {"fixed blocks",
       [] {
         std::string text = boundary(kBase + "kind = \"viscous\"\n");
         return text.insert(text.find("joint = \"glue\"\n[[stage]]"), "kind = \"fixed\"\n");
       }(),
       {"boundary.b: lies on fixed or driven blocks only"}},
      {"held as well",
       boundary(kBase + "kind = \"viscous\"\n[[support]]\nname = \"s\"\n" + kBase),
       {"warning: boundary.b: is held by supports along its whole length"}},
  });
}

TEST_CASE("wrong boundaries: free field and tied sides") {
  const std::string soft = [] {
    std::string text = boundary(kLeft + "kind = \"free_field\"\n");
    text.replace(text.find("joint = \"glue\"\n[[stage]]"), 14,
                 "joint = \"soft\"\npattern = \"crossed_triangles\"");
    return text;
  }();
  const std::string right = "to_edge = [[4, 0], [4, 6]]\n";
  check_cases({
      {"level side",
       boundary(kBase + "kind = \"free_field\"\n"),
       {"boundary.b: is level", "use kind = \"viscous\""}},
      {"gap",
       boundary("edge = [[0, 0], [0, 9]]\nkind = \"free_field\"\n[[block]]\nname = \"top\"\npolygon = [[0, "
                "7], [4, 7], [4, 9], [0, 9]]\nmaterial = \"rock\"\n"),
       {"boundary.b: has no block edge at the height 6.5 m"}},
      {"soft pattern",
       soft,
       {"stands beside \"g\", whose joints have stiffness but no one direction and spacing"}},
      {"tied to nothing",
       boundary(kLeft + "kind = \"tied\"\n"),
       {"boundary.b: has no opposite side", "give one of to"}},
      {"tied twice",
       boundary(kLeft + "kind = \"tied\"\nto = \"x\"\n" + right),
       {"boundary.b: has more than one opposite side"}},
      {"tied static",
       boundary(kLeft + "kind = \"tied\"\nstatic = \"free\"\n" + right),
       {"boundary.b.static: has no meaning for tied sides"}},
      {"opposite off the blocks",
       boundary(kLeft + "kind = \"tied\"\nto_edge = [[9, 0], [9, 6]]\n"),
       {"boundary.b: no block edge lies on the segment"}},
      {"not as high",
       boundary(kLeft + "kind = \"tied\"\nto_edge = [[4, 0], [4, 4]]\n"),
       {"boundary.b: has no opposite point for (0, ", "kind = \"free_field\""}},
      {"level edge",
       boundary(kBase + "kind = \"tied\"\n" + right),
       {"boundary.b: has a level edge at (0, 0)"}},
      {"one column of blocks",
       [&] {
         std::string text = boundary(kLeft + "kind = \"tied\"\n" + right);
         return text.replace(text.find("cells = [2, 3]"), 14, "cells = [1, 3]");
       }(),
       {"boundary.b: would tie \"g[0,0]\" to itself", "at least two columns of blocks"}},
  });
}

TEST_CASE("wrong loads") {
  check_cases({
      {"nothing", load(""), {"load.l: has no effect", "give an acceleration"}},
      {"mixed",
       load(kLeft + "pressure = \"v\"\nacceleration_x = \"v\"\n"),
       {"load.l: mixes accelerations, tractions and forces"}},
      {"acceleration at a place",
       load(kLeft + "acceleration_x = \"v\"\n"),
       {"load.l: has a place, but an acceleration acts on whole blocks"}},
      {"pressure nowhere", load("pressure = \"v\"\n"), {"load.l: has no place"}},
      {"pressure at a point",
       load("point = [0, 0]\npressure = \"v\"\n"),
       {"load.l.point: has no area for a pressure or traction"}},
      {"force on an edge", load(kLeft + "force_x = \"v\"\n"), {"load.l: has a force on an edge"}},
      {"pressure inside",
       load("edge = [[0, 2], [4, 2]]\npressure = \"v\"\n"),
       {"load.l: every edge there has a block on its other side"}},
      {"force off the blocks",
       load("point = [9, 9]\nforce_x = \"v\"\n"),
       {"load.l: the point lies on no block"}},
      {"no history of that name",
       load(kLeft + "pressure = \"w\"\n"),
       {"load.l.pressure: there is no history called \"w\""}},
      {"a unit of something else", load(kLeft + "pressure = \"2 kN\"\n"), {"load.l.pressure", "kN"}},
      {"no direction", load(kLeft + "traction = 5\n"), {"load.l.traction: has no direction"}},
      {"a direction of nothing",
       load(kLeft + "pressure = 5\ndirection = \"3 deg\"\n"),
       {"load.l.direction: has no traction to go with"}},
      {"size and component",
       load("point = [0, 0]\nforce = 5\nforce_x = 4\ndirection = \"3 deg\"\n"),
       {"load.l.force: and force_x or force_y are given"}},
      {"not a segment",
       load("edge = [[0, 0], [0, 0]]\npressure = \"v\"\n"),
       {"load.l.edge: must be a segment: two different points"}},
  });
}

TEST_CASE("use = false leaves a boundary out, an override brings it back, its keys are read all the same") {
  const auto boundaries = [](const std::string& text, const std::vector<std::string>& overrides) {
    Findings findings("model.toml", text);
    return prepare_run("model.toml", text, overrides, findings).scene.model.boundaries.size();
  };
  const std::string text = boundary(kBase + "kind = \"viscous\"\nuse = false\n");
  CHECK(boundaries(boundary(kBase + "kind = \"viscous\"\n"), {}) == 1);
  CHECK(boundaries(text, {}) == 0);
  CHECK(boundaries(text, {"boundary.b.use=true"}) == 1);
  check_cases({
      {"a wrong key",
       boundary(kBase + "kind = \"viscos\"\nuse = false\n"),
       {"boundary.b.kind: \"viscos\" is not known"}},
      {"no truth", boundary(kBase + "kind = \"viscous\"\nuse = 3\n"), {"boundary.b.use:", "true or false"}},
  });
}

}  // namespace test_wrong_input_boundary
