// What acts on a model, as symbols on its picture: which, where and how many.

#include "support/relative.h"
#include "talus/plot/conditions.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "talus/base/text_file.h"
#include "talus/cut/check_places.h"
#include "talus/model/read_model.h"

namespace test_conditions {

using namespace talus;
using namespace talus::plot;

namespace {

// 100 px to a metre, (0, 0) at (500, 500) of the sheet.
const View kView{{0, 0, 1000, 1000}, {0, 0}, 100};

struct Shown {
  Model model;
  Layout layout;
  std::vector<Condition> list;

  const Condition& labelled(const std::string& label) const {
    for (const Condition& c : list)
      if (c.label == label) return c;
    std::string all;
    for (const Condition& c : list) all += "\n  " + c.label;
    FAIL("no condition \"", label, "\" among", all);
    return list.front();
  }
};

Shown shown(const std::string& more) {
  const std::string text = R"(talus = 1
[model]
gravity = [0, -9.81]
[material.rock]
density = 2600
young = 1e10
poisson = 0.25
[history.motion]
time = [0, 1]
value = [0, 1]
[[region]]
name = "rock"
material = "rock"
polygon = [[-2, -1], [2, -1], [2, 1], [-2, 1]]
sides = ["base", "right", "top", "left"]
[[stage]]
name = "rest"
kind = "static"
duration = 1
[[stage]]
name = "shake"
kind = "dynamic"
duration = 1
)" + more;
  Findings findings("model.toml", text);
  Shown out;
  out.model = read_model("model.toml", text, {}, findings);
  out.layout = checked_layout(out.model, findings);
  INFO(findings.render());
  REQUIRE(!findings.has_errors());
  out.list = conditions_of(out.model, out.layout, kView);
  return out;
}

bool near(Vec2 a, Vec2 b) { return norm(a - b) < 1e-9; }

}  // namespace

TEST_CASE("conditions: supports stand outside the edge they hold, apart from each other") {
  const Shown s = shown(R"(
[[support]]
name = "floor"
along = "base"
[[support]]
name = "sides"
along = "left"
y = "free"
[[support]]
name = "other side"
along = "right"
y = "free"
stages = ["rest"]
)");
  const Condition& pins = s.labelled("held: floor");
  CHECK(pins.symbol == Symbol::kPin);
  CHECK(pins.marks.size() == 16);  // 400 px, at least 24 apart
  for (const Mark& m : pins.marks) {
    CHECK(m.at.y == test::approx(600));
    CHECK(near(m.direction, {0, 1}));  // downwards on the sheet
  }
  const Condition& rollers = s.labelled("held along x: sides");
  CHECK(rollers.symbol == Symbol::kRoller);
  CHECK(rollers.marks.size() == 8);
  for (const Mark& m : rollers.marks) CHECK(near(m.direction, {-1, 0}));
  for (const Mark& m : s.labelled("held along x in \"rest\": other side").marks)
    CHECK(near(m.direction, {1, 0}));
  CHECK(s.labelled("gravity 9.81 m/s²").marks.empty());
  CHECK(near(s.labelled("gravity 9.81 m/s²").sample, {0, 1}));
}

TEST_CASE("conditions: a thousand blocks along an edge take no more symbols than one") {
  const std::string support = "[[support]]\nname = \"floor\"\nalong = \"base\"\n";
  const Shown s = shown(support + "[[joint_set]]\nname = \"s\"\nangle = \"90 deg\"\nspacing = 0.004\n");
  CHECK(s.layout.blocks.size() >= 1000);
  CHECK(s.labelled("held: floor").marks.size() <= 400 / 0.7 / 24 + 1);
  CHECK(s.labelled("held: floor").marks.size() >= 16);
}

TEST_CASE("conditions: boundaries, waves, loads, motions, bolts, measured lengths") {
  const Shown s = shown(R"(
[[boundary]]
name = "below"
kind = "viscous"
along = "base"
velocity_x = "motion"
motion = "upgoing"
[[load]]
name = "weight"
pressure = 1000
edge = [[-2, 1], [2, 1]]
[[load]]
name = "push"
force = 1000
direction = "53.13010235415598 deg"
point = [2, 1]
[[load]]
name = "quake"
acceleration_x = "motion"
[[block]]
name = "ball"
polygon = [[0, 2], [1, 2], [1, 3], [0, 3]]
material = "rock"
velocity = [0, -5]
[bolt_type.bar]
kind = "anchored"
diameter = "25 mm"
young = "200 GPa"
spacing = 1
[[bolt]]
name = "b"
from = [2, 0]
to = [-1, 0]
type = "bar"
stage = "shake"
[[monitor]]
name = "width"
convergence = [[-2, 0], [2, 0]]
)");
  const Condition& band = s.labelled("viscous boundary: below");
  REQUIRE(band.marks.size() == 1);
  CHECK(near(band.marks[0].at, {300, 600}));
  CHECK(band.marks[0].length == test::approx(400));
  const Condition& waves = s.labelled("waves along x come in: below");
  for (const Mark& m : waves.marks) CHECK(near(m.direction, {0, -1}));  // into the rock
  const Condition& pressure = s.labelled("pressure: weight");
  CHECK(pressure.marks.size() == 16);
  for (const Mark& m : pressure.marks) CHECK(near(m.direction, {0, 1}));  // onto the top
  const Condition& force = s.labelled("force: push");
  REQUIRE(force.marks.size() == 1);
  CHECK(near(force.marks[0].at, {700, 400}));
  CHECK(near(force.marks[0].direction, {0.6, -0.8}));
  CHECK(s.labelled("acceleration of all blocks: quake").marks.empty());
  const Condition& ball = s.labelled("starts at a velocity: ball");
  REQUIRE(ball.marks.size() == 1);
  CHECK(near(ball.marks[0].direction, {0, 1}));
  CHECK(near(ball.marks[0].at - 0.5 * ball.marks[0].length * Vec2{0, 1}, {550, 250}));  // its middle
  const Condition& bolts = s.labelled("1 bolt of type bar in \"shake\"");
  REQUIRE(bolts.marks.size() == 1);
  CHECK(near(bolts.marks[0].at, {700, 500}));
  CHECK(near(bolts.marks[0].direction, {-1, 0}));
  CHECK(bolts.marks[0].length == test::approx(300));
  CHECK(s.labelled("measured length: width").marks.size() == 1);
}

TEST_CASE("conditions: symbols and lines of a cut know the line of the file that they come from") {
  const std::string file = std::string(TALUS_SOURCE_DIR) + "/tests/fixtures/section.toml",
                    text = read_text_file(file);
  Findings findings(file, text);
  const Model model = read_model(file, text, {}, findings);
  const Cut cut = cut_or_read(model, findings);
  const Layout layout = checked_layout(model, cut, findings);
  findings.throw_if_errors();
  // the name that the section of a line has
  const auto name_at = [&text](int line) {
    size_t at = 0;
    for (int k = 1; k < line; ++k) at = text.find('\n', at) + 1;
    const size_t head = text.rfind("\n[", at), name = text.find("name = \"", head) + 8;
    return text.substr(name, text.find('"', name) - name);
  };
  const auto name_of = [&](const std::string& label) {
    for (const Condition& c : conditions_of(model, layout, kView))
      if (c.label == label && !c.marks.empty()) return name_at(c.marks.front().line);
    return std::string("not there");
  };
  CHECK(name_of("held along x: corner") == "corner");
  CHECK(name_of("pressure: push") == "push");
  CHECK(name_of("1 bolt of type bar") == "nail");
  int faults = 0;
  for (const Origin& o : cut.origins) {
    CHECK(name_at(o.where.line) == (o.kind == OriginKind::kFault ? "crack" : "rock"));
    faults += o.kind == OriginKind::kFault;
  }
  CHECK(faults == 1);
}

}  // namespace test_conditions
