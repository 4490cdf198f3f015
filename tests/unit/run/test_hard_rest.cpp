// Static stages of rock with hard joints go in steps from rest: friction in turns, faces with strength that close loops
// (theory 4.22, 14.1, 5.8).

#include <fmt/format.h>

#include "support/relative.h"
#include "support/run_case.h"

namespace test_hard_rest {

using namespace talus;
using namespace talus::test;

namespace {

// A slope in two sets of joints; the steeper the friction the more of it sticks.
std::string slope(double friction, const std::string& strength, double angle) {
  const std::string law = fmt::format("friction_angle = \"{} deg\"\n{}", friction, strength);
  return "talus = 1\n[model]\ngravity = [0, -9.81]\n[material.m]\ndensity = 2500\nyoung = \"20 GPa\"\npoisson = 0.25\n"
         "[joint.a]\n" +
         law + "[joint.b]\n" + law +
         "[contact]\njoint = \"b\"\n[[region]]\nname = \"rock\"\n"
         "polygon = [[0, 0], [40, 0], [40, 25], [22, 25], [14, 8], [0, 8]]\n"
         "sides = [\"base\", \"right\", \"crest\", \"face\", \"bench\", \"left\"]\nmaterial = \"m\"\njoint = \"b\"\n" +
         fmt::format(
             "[[joint_set]]\nname = \"a\"\nangle = \"{} deg\"\nspacing = 4.3\noffset = 0.3\njoint = \"a\"\n",
             -angle) +
         fmt::format(
             "[[joint_set]]\nname = \"b\"\nangle = \"{} deg\"\nspacing = 5.1\noffset = 1.2\njoint = \"b\"\n",
             90 - angle) +
         "[[support]]\nname = \"base\"\nalong = \"base\"\n"
         "[[support]]\nname = \"right\"\nalong = \"right\"\nx = \"fixed\"\ny = \"free\"\n"
         "[[support]]\nname = \"left\"\nalong = \"left\"\nx = \"fixed\"\ny = \"free\"\n"
         "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20\n";
}

}  // namespace

TEST_CASE(
    "hard rock rests in few steps, none of them loose, whatever the friction and the strength of its joints") {
  for (const std::string strength : {"", "cohesion = 1e6\n", "cohesion = 1e6\ntensile_strength = 1e6\n"})
    for (const double friction : {30.0, 40.0, 60.0})
      for (const double angle : {38.0, 52.0}) {
        if (strength.empty() && friction < 60) continue;  // a plane of 52 deg comes out in the face
        CAPTURE(strength);
        CAPTURE(friction);
        CAPTURE(angle);
        const CaseResult r = run_case(slope(friction, strength, angle));  // no step failed or loose
        CHECK(r.run.stages.at(0).at_rest);
        CHECK(!r.run.stages.at(0).followed());
        CHECK(r.run.stages.at(0).steps <= 40);
      }
}

TEST_CASE("hard rock with strength goes from rest where its contacts give, else by damped motion") {
  for (const bool gives : {true, false}) {
    Findings findings("m.toml", "");
    const std::string contact = gives ? "contact.stiffness=\"auto\"" : "contact.stiffness=\"none\"";
    CHECK(prepare_run("m.toml", slope(40, "cohesion = 1e6\n", 38), {contact}, findings)
              .scene.model.stages.at(0)
              .from_rest == gives);
  }
}

TEST_CASE("what stands on the free part of a side that a tie covers the rest of rests there, step by step") {
  const auto block = [](const char* name, const char* polygon, const char* kind) {
    return fmt::format("[[block]]\nname = \"{}\"\npolygon = {}\nmaterial = \"m\"\nkind = \"{}\"\n", name,
                       polygon, kind);
  };
  const std::string text =
      "talus = 1\n[model]\ngravity = [0, -10]\n[material.m]\ndensity = 2500\nyoung = \"20 GPa\"\npoisson = 0.2\n"
      "[joint.dry]\nfriction_angle = \"30 deg\"\n[joint.glue]\nfriction_angle = \"30 deg\"\ncohesion = 1e6\n"
      "[contact]\njoint = \"dry\"\n[[contact_pair]]\nbetween = [\"below\", \"glued\"]\njoint = \"glue\"\n" +
      block("ground", "[[-1, -1], [4, -1], [4, 0], [-1, 0]]", "fixed") +
      block("below", "[[0, 0], [3, 0], [3, 1], [0, 1]]", "deformable") +
      block("glued", "[[0, 1], [2, 1], [2, 2], [0, 2]]", "deformable") +
      block("stands", "[[2.2, 1], [3, 1], [3, 2], [2.2, 2]]", "deformable") +
      "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20\nunbalanced = 1e-9\n";
  int contacts = 0;  // points in the first step
  const CaseResult r = run_case(text, {}, [&](const Instant& i) {
    if (i.stage_start) contacts = i.report.contacts;
  });
  CHECK(contacts == 4);  // the first step knows all of them
  CHECK(r.run.stages.at(0).steps <= 6);
  double borne = 0;
  for (const Patch& p : r.state.patches)
    if (p.block_a == 3 || p.block_b == 3) borne += p.force[0][0] + p.force[1][0];
  CHECK(borne == approx(0.8 * 2500 * 10).epsilon(1e-6));
}

}  // namespace test_hard_rest
