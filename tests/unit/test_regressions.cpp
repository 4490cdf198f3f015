// Defects found and mended, each by the input that showed it.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "support/block_scene.h"
#include "support/box_polygon.h"
#include "support/relative.h"
#include "support/run_case.h"
#include "talus/base/text.h"
#include "talus/corners/corner_rows.h"
#include "talus/geometry/polygon_check.h"
#include "talus/output/result_folder.h"

namespace test_regressions {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

// Blocks of rock with one joint between all: 0 bonded, 1 breakable, -1 none.
Scene scene_of(const std::vector<Polygon>& polygons, int joint = -1) {
  Model model = plain_rock();
  model.joints = {{"bonded", true, 0, 0, 0}, {"breakable", false, 0, 1e6, 1e6}};
  model.default_joint = joint;
  Findings findings("m", "");
  Scene scene = laid_out_scene(std::move(model), polygons, &findings);
  CHECK(findings.list().empty());
  return scene;
}

fs::path fresh_folder(const char* name) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("talus_regression_{}_{}", name, getpid());
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

}  // namespace

TEST_CASE("regression: a clamped block does not amplify its own motion") {
  std::string text = "talus = 1\n[material.m]\ndensity=2500\nyoung='5 GPa'\npoisson=0.25\n";
  int i = 0;
  for (const char* polygon :
       {"[[0,0],[1,0],[1,1],[0,1]]", "[[2,0],[3,0],[3,0.05],[2,0.05]]", "[[4,0],[5,0],[5,1],[4,1]]"})
    text += fmt::format("[[block]]\nname='b{}'\npolygon={}\nmaterial='m'\n", i++, polygon);
  text += "[[stage]]\nname='s'\nkind='dynamic'\nduration=1\ntime_step='0.1 ms'\nmoment_clamp=true\n";
  double strain = 0, start = 0;
  test::run_case(
      text, {},
      [&](const Instant& at) {
        if (at.state.step == 0) start = at.report.energy.kinetic;
        strain = std::max(strain, at.report.energy.strain);
      },
      [](const Scene&, State& state) {
        state.rate[1].G = {0, 0, 0, 1e-3};
      });
  // strain energy swings up to 1 / (1 - 0.9^2) = 5.3 times the kinetic energy at the start (central
  // differences)
  CHECK(strain <= 6 * start);
}

TEST_CASE("regression: blocks of a bonded pair that lie apart, or meet at a corner alone, can touch") {
  const Scene apart = scene_of({{{0, 0}, {2, 0}, {0, 2}}, {{2, 2}, {1, 2}, {2, 1}}}, 0);
  State state = start_state(apart);
  CHECK_FALSE(is_tied(apart.bonds, state, 0, 1));
  state.displacement[1] = {-0.51, -0.51};
  CHECK_FALSE(find_contacts(apart.blocks, apart.bonds, state, 0.05).empty());

  const Scene corner = scene_of({box_polygon(0, 0, 1, 1), box_polygon(1, 1, 2, 2)}, 0);
  CHECK_FALSE(is_tied(corner.bonds, start_state(corner), 0, 1));
  const Scene held = scene_of({box_polygon(0, 0, 1, 1), box_polygon(1, 1, 2, 2), box_polygon(1, 0, 2, 1)},
                              0);  // joined by the third
  CHECK(is_tied(held.bonds, start_state(held), 0, 1));
}

TEST_CASE("regression: a corner in a notch keeps both sides when it touches them") {
  const Polygon l{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const double gap : {1e-5, 5e-7, 0.0, -5e-7, -2e-6}) {
    CAPTURE(gap);
    const Scene s = scene_of({l});
    Scene both = scene_of({l, box_polygon(1.1, 1.1, 1.7, 1.7)});
    State state = start_state(both);
    state.displacement[1] = {gap - 0.1, gap - 0.1};
    std::vector<ContactPoint> out;
    touch_blocks(both.blocks, state, 0, 1, 0.05, out);
    const auto find = [&](ContactKey key) {
      return std::find_if(out.begin(), out.end(), [&](const ContactPoint& c) { return c.key == key; });
    };
    for (const ContactKey key :
         {ContactKey{1, 0, 0, 2}, ContactKey{1, 0, 0, 3}, ContactKey{1, 1, 0, 2}, ContactKey{1, 3, 0, 3}}) {
      REQUIRE(find(key) != out.end());
      CHECK(find(key)->length == approx(0.3).epsilon(1e-4));
    }
    CHECK(out.size() == 4);
  }
}

TEST_CASE("regression: an exact column name goes before longer ones that begin with it") {
  CsvTable table;
  table.columns = {"tip u_x [m]", "tip u_y [m]", "tip"};
  table.values = {{1}, {2}, {3}};
  CHECK(table.column("tip") == std::vector<double>{3});
}

TEST_CASE("regression: a bond between two blocks does not depend on a third") {
  const Polygon a = box_polygon(0, 0, 100, 100), b = box_polygon(100 + 5e-5, 0, 200, 100),
                small = box_polygon(300, 0, 300.01, 0.01);
  CHECK(scene_of({a, b}, 1).bonds.faces.size() == 1);
  CHECK(scene_of({a, b, small}, 1).bonds.faces.size() == 1);
}

TEST_CASE("regression: the inertia of an accepted sliver is positive and does not depend on its direction") {
  for (const double thin : {1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    const Polygon flat{{0, 0}, {1, 0}, {0.4, thin}};
    Polygon askew = flat;
    for (Vec2& p : askew) p = p + rotation_minus_identity(0.7) * p;
    if (!polygon_defect(askew).empty()) {
      CHECK(thin < 1e-6);  // only these are refused
      continue;
    }
    const double one = stable_step_of(scene_of({flat}).blocks, 0),
                 other = stable_step_of(scene_of({askew}).blocks, 0);
    CHECK(std::abs(other - one) <= 0.01 * one);
    CHECK(det(scene_of({askew}).blocks.inertia[0]) > 0);
  }
}

TEST_CASE("regression: words without a common letter are no suggestion") {
  CHECK(closest_name("xy", {"ab"}) == "");
  CHECK(closest_name("", {"ab"}) == "");
  CHECK(closest_name("abc", {"xyc"}) == "");
}

TEST_CASE("regression: the folder of a killed run can be replaced by force") {
  const fs::path folder = fresh_folder("killed");
  fs::create_directories(folder / "fields");
  for (const char* name : {"model.toml", "histories.csv", "steps.csv"}) write_file(folder / name, "x");
  CHECK_NOTHROW(ResultFolder(folder, true));
  fs::remove_all(folder);
}

}  // namespace test_regressions
