// Surveyed joints, [[traces]]: what they cut and what is told of wrong ones.

#include <doctest/doctest.h>

#include <string>

#include "support/cut_case.h"
#include "support/relative.h"

namespace test_cut_traces {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kRock = R"(talus = 1
[material.stone]
density = 2700
young = "5 GPa"
poisson = 0.25
[joint.weak]
friction_angle = "10 deg"
[contact]
joint = "weak"
[[region]]
name = "rock"
polygon = [[0, 0], [12, 0], [12, 8], [0, 8]]
material = "stone"
[[traces]]
name = "survey"
joint = "weak"
)";

std::string defects(const std::string& text) {
  Findings findings("m.toml", text);
  read_model("m.toml", text, {}, findings);
  return findings.render();
}

}  // namespace

TEST_CASE("cut along surveyed traces: lines with their bends, dead ends taken back") {
  const std::string text = kRock + R"(lines = [
  [[-1, 2], [6, 2], [13, 3]],
  [[4, -1], [4, 5]],           # ends inside a block
  [[20, 0], [30, 0]],          # outside
]
)";
  Findings findings("m.toml", text);
  const Model model = read_model("m.toml", text, {}, findings);
  REQUIRE(!findings.has_errors());
  const Cut cut = cut_model(model, findings);
  CHECK(cut.blocks.size() == 3);  // below: two, by the steep line; above: one
  REQUIRE(cut.surveys.size() == 1);
  CHECK(cut.surveys[0].lines == 3);
  CHECK(cut.surveys[0].inside == 2);
  // 6 m level, then to the side at (12, 20/7): sqrt(6^2 + (6/7)^2); 5 m steep
  CHECK(cut.surveys[0].length == approx(6 + std::sqrt(36 + 36.0 / 49) + 5).epsilon(1e-9));
  CHECK(cut.dead_end_length == approx(3).epsilon(1e-6));
  double below = 0;
  for (const CutBlock& b : cut.blocks)
    if (cut.point[b.point[0]].y == 0) below += signed_area(cut.polygon(b));
  CHECK(below == approx(12 + 6 * 2 + 0.5 * 6 * 6.0 / 7 - 0.0 * 8).epsilon(1e-6));
  const auto weak = std::find_if(cut.origins.begin(), cut.origins.end(),
                                 [](const Origin& o) { return o.name == "survey"; });
  REQUIRE(weak != cut.origins.end());
  CHECK(weak->joint == 0);
}

TEST_CASE("traces: wrong lists are told") {
  const auto told = [](const std::string& lines, const std::string& part) {
    const std::string text = defects(kRock + "lines = " + lines + "\n");
    INFO(text);
    CHECK(text.find(part) != std::string::npos);
  };
  told("[]", "traces.survey.lines: is empty");
  told("[[[0, 0]]]", "is a line of fewer than two points");
  told("[[0, 0], [1, 1]]", "is a number; expected a point [x, y]");
  told("\"map.dxf\"", "is text; expected a list of lines");
  told("[[[0, 0], [1, \"2 kg\"]]]", "traces.survey.lines");
  const std::string twice = defects(
      kRock + "lines = [[[0, 1], [9, 1]]]\n[[fault]]\nname = \"survey\"\npoints = [[0, 0], [1, 1]]\n");
  CHECK(twice.find("is called \"survey\"") != std::string::npos);
}

}  // namespace test_cut_traces
