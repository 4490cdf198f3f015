// Numbers of blocks foretold against those that are cut.

#include "talus/cut/expected.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "support/relative.h"
#include "support/told.h"
#include "talus/cut/layout.h"
#include "talus/model/read_model.h"

namespace test_expected {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kRock = R"(talus = 1
[material.m]
density = 2700
young = 1e10
poisson = 0.25
[joint.j]
friction_angle = "30 deg"
[[region]]
name = "rock"
polygon = [[0, 0], [60, 0], [70, 40], [0, 50]]
material = "m"
joint = "j"
)";

std::string set(const std::string& name, const std::string& angle, const std::string& spacing,
                const std::string& more = "") {
  return fmt::format("[[joint_set]]\nname = \"{}\"\nangle = \"{} deg\"\nspacing = {}\n{}\n", name, angle,
                     spacing, more);
}

struct Numbers {
  double expected = 0, cut = 0;
};

Numbers numbers(const std::string& text) {
  Findings findings("model.toml", text);
  const Model model = read_model("model.toml", text, {}, findings);
  Numbers n;
  for (const ExpectedPart& p : expected_blocks(model)) n.expected += p.blocks;
  n.cut = static_cast<double>(make_layout(model, findings).blocks.size());
  INFO(findings.render());
  REQUIRE(findings.error_count() == 0);
  return n;
}

}  // namespace

TEST_CASE("expected blocks: what sections will make, before anything is drawn") {
  std::string grid =
      "[[grid]]\nname = \"g\"\nmin = [100, 0]\nmax = [140, 20]\ncells = [40, 25]\nmaterial = \"m\"\njoint = "
      "\"j\"\n";
  for (const auto& [what, more] : std::vector<std::pair<std::string, std::string>>{
           {"two sets", set("a", "75", "0.9") + set("b", "125", "1.1")},
           {"two sets nearly parallel", set("a", "75", "0.4") + set("b", "95", "0.4")},
           {"three sets", set("a", "75", "1.6") + set("b", "125", "1.6") + set("c", "10", "1.6")},
           {"traces", set("a", "75", "0.5", "trace_length = 9\ngap = 1") +
                          set("b", "125", "{ exponential = 0.5 }", "trace_length = 7\ngap = 2")},
           {"masonry",
            "[[masonry]]\nname = \"w\"\nregion = \"rock\"\nlength = 1.2\nheight = 0.5\nbed_joint = \"j\"\n"
            "head_joint = \"j\"\n"},
           {"cells",
            "[[tessellation]]\nname = \"v\"\nregion = \"rock\"\ncells = \"voronoi\"\nsize = 1\njoint = "
            "\"j\"\n"},
           {"triangles",
            "[[tessellation]]\nname = \"v\"\nregion = \"rock\"\ncells = \"triangles\"\nsize = 1\n"
            "joint = \"j\"\n"},
           {"grid", grid},
           {"crossed", grid + "pattern = \"crossed_triangles\"\n"},
       }) {
    const Numbers n = numbers(kRock + more);
    INFO(what, ": ", n.expected, " expected, ", n.cut);
    CHECK(n.cut > 500);
    CHECK(n.expected == approx(n.cut).epsilon(0.25));
  }
}

TEST_CASE("expected blocks: what does not fit the memory is told before it is drawn, where it is made") {
  const auto refusal = [](const std::string& more, double memory) {
    Findings findings("model.toml", kRock + more);
    const Model model = read_model("model.toml", kRock + more, {}, findings);
    check_expected(model, memory, findings);
    return findings.render();
  };
  const std::string sets = set("a", "75", "1e-4") + set("b", "125", "1e-2");
  const std::string said = refusal(sets, 20e9);
  INFO(said);
  CHECK(said.find("model.toml:16:1: error: joint_set.a.spacing: makes most of about 2.3e+09 blocks") !=
        std::string::npos);
  CHECK(said.find("room is for about 4e+06") != std::string::npos);
  CHECK(refusal(set("a", "75", "1") + set("b", "125", "1"), 20e9) == "");
  CHECK(refusal(set("a", "75", "1") + set("b", "125", "1"), 1e6) != "");
  CHECK(
      refusal(
          "[[masonry]]\nname = \"w\"\nregion = \"rock\"\nlength = 2.5e-4\nheight = 6e-5\nbed_joint = \"j\"\n"
          "head_joint = \"j\"\n",
          20e9)
          .find("masonry.w: makes most of about") != std::string::npos);
  CHECK(refusal("[[tessellation]]\nname = \"v\"\nregion = \"rock\"\ncells = \"voronoi\"\nsize = 1e-3\njoint "
                "= \"j\"\n",
                20e9)
            .find("tessellation.v: makes most of about") != std::string::npos);
}

}  // namespace test_expected
