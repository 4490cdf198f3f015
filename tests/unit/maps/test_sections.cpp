// From drawings to sections, with drawings made in memory.

#include <doctest/doctest.h>

#include <string>

#include "support/relative.h"
#include "talus/base/error.h"
#include "talus/maps/expand.h"
#include "talus/maps/import.h"
#include "talus/model/read_model.h"
#include "talus/model/with_folder.h"
#include "talus/schema/toml_source.h"

namespace test_sections {

using namespace talus;
using namespace talus::maps;

namespace {

Feature line(const std::string& layer, const Polyline& points) {
  Feature f;
  f.layer = layer, f.points = points, f.id = "feature 1";
  return f;
}

Feature point(const std::string& layer, Vec2 p) {
  Feature f = line(layer, {p});
  f.is_point = true;
  return f;
}

// A section of 10 x 6 in units of `unit` metres, its corner at `corner` [m].
Drawing drawing(double unit, Vec2 corner) {
  Drawing d;
  d.unit = unit, d.unit_source = "as the test says";
  const auto at = [&](std::initializer_list<Vec2> points) {
    Polyline out;
    for (const Vec2 p : points) out.push_back({(p.x + corner.x) / unit, (p.y + corner.y) / unit});
    return out;
  };
  d.features.push_back(line("edge", at({{0, 0}, {10, 0}, {10, 6}, {0, 6}, {0, 0}})));
  d.features.push_back(line("joints", at({{0.02, 3.1}, {9.97, 2.9}})));
  d.features.push_back(line("joints", at({{4, 0}, {4.1, 6}})));
  d.features.push_back(line("pit", at({{7, 4}, {8, 4}, {8, 5}, {7, 5}, {7, 4}})));
  d.features.push_back(point("gauges", at({{1, 1}})[0]));
  return d;
}

MapInput map_of(const std::string& name, const std::string& layer, MapUse use) {
  MapInput m;
  m.name = name, m.layer = layer, m.use = use, m.file = "d.dxf";
  return m;
}

MapsInput section_maps() {
  MapsInput maps;
  maps.snap = 0.05;
  maps.list = {map_of("rock", "edge", MapUse::kOutline), map_of("steep", "joints", MapUse::kJoints),
               map_of("pit", "pit", MapUse::kOpening), map_of("gauge", "gauges", MapUse::kMonitor)};
  maps.list[0].material = "stone";
  return maps;
}

MapSections sections(const MapsInput& maps, const Drawing& d, std::string* told = nullptr) {
  Findings findings("m.toml", "");
  MapSections out = make_sections(
      maps, "", [&d](const std::filesystem::path&, double) { return d; }, findings);
  if (told) *told = findings.render();
  return out;
}

// The sections and their material as a model, without an error.
Model model_of(const MapSections& made) {
  const std::string text =
      "talus = 1\n[material.stone]\ndensity = 2700\nyoung = \"5 GPa\"\npoisson = 0.2\n" + made.text;
  Findings findings("m.toml", text);
  Model model = read_model("m.toml", text, {}, findings);
  INFO(findings.render());
  CHECK(!findings.has_errors());
  return model;
}

}  // namespace

TEST_CASE("maps: the same drawing in other units and far from zero gives the same sections") {
  const MapSections metres = sections(section_maps(), drawing(1, {0, 0}));
  CHECK(!metres.text.empty());
  CHECK(!metres.report.shifted);
  for (const double unit : {1e-3, 1e-2, 0.0254, 0.3048, 1000.0})
    CHECK(sections(section_maps(), drawing(unit, {0, 0})).text == metres.text);
  for (const double unit : {1.0, 1e-3}) {
    const MapSections far = sections(section_maps(), drawing(unit, {352000, 3456000}));
    CHECK(far.report.shifted);
    CHECK(far.report.origin == Vec2{352000, 3456000});
    CHECK(far.text.find(metres.text) != std::string::npos);  // below the line that tells the shift
  }
}

TEST_CASE("maps: ends near the outline go through it, and the sections are a model") {
  const MapSections made = sections(section_maps(), drawing(1, {0, 0}));
  const Model model = model_of(made);
  REQUIRE(model.traces.size() == 1);
  const Polyline& level = model.traces[0].lines[0];
  CHECK(level.front().x < 0);
  CHECK(level.front().x > -1e-5);
  CHECK(level.back().x > 10);
  CHECK(made.report.maps[1].mended[Mend::kGap] == 2);
  CHECK(model.monitors[0].name == "gauge");
  CHECK(model.openings[0].polygon.size() == 4);
}

TEST_CASE("maps: what is left out is counted with layer and reason") {
  Drawing d = drawing(1, {0, 0});
  d.features.push_back(line("frame", {{0, 0}, {1, 1}}));
  d.features.push_back(line("frame", {{0, 0}, {1, 2}}));
  d.features.push_back(point("joints", {3, 3}));
  d.leave_out("notes", "TEXT", "is no line or point", 4);
  const std::string report = map_report_text(sections(section_maps(), d).report);
  CHECK(report.find("2 line on layer \"frame\": no [[map]] takes it") != std::string::npos);
  CHECK(report.find("1 point on layer \"joints\": cannot become joints") != std::string::npos);
  CHECK(report.find("4 TEXT on layer \"notes\"") != std::string::npos);
}

TEST_CASE("maps: an outline that nearly closes is closed, points too close to each other go, both counted") {
  Drawing d = drawing(1, {0, 0});
  d.features[0].points = {{0, 0}, {10, 0}, {10.01, 0.01}, {10, 6}, {0, 6}, {0.03, 0.02}};
  d.features.push_back(line("joints", {}));
  MapsInput maps = section_maps();
  maps.shortest = 0.02;
  const MapSections made = sections(maps, d);
  CHECK(made.text.find("polygon = [[0, 0], [10, 0], [10, 6], [0, 6]]") != std::string::npos);
  CHECK(made.report.maps[0].mended[Mend::kGap] == 1);
  CHECK(made.report.maps[0].mended[Mend::kPoint] == 1);
  CHECK(map_report_text(made.report).find("1 line on layer \"joints\": has too few points") !=
        std::string::npos);
}

TEST_CASE("maps: wrong ones are told") {
  std::string told;
  Drawing d = drawing(1, {0, 0});
  d.unit = std::nan(""), d.unit_source = "it has no $INSUNITS";
  CHECK(sections(section_maps(), d, &told).text.empty());
  CHECK(told.find("the unit of \"d.dxf\" is not known: it has no $INSUNITS") != std::string::npos);
  d.geographic = true;
  sections(section_maps(), d, &told);
  CHECK(told.find("degrees of longitude") != std::string::npos);
  MapsInput given = section_maps();
  for (MapInput& m : given.list) m.unit = 1;
  CHECK(!sections(given, d, &told).text.empty());

  d = drawing(1, {0, 0});
  d.features[0].points[2] = {5, -3};  // crosses itself
  sections(section_maps(), d, &told);
  CHECK(told.find("map.rock: feature 1 at (0, 0)") != std::string::npos);
  d = drawing(1, {0, 0});
  d.features[0].points.pop_back();
  sections(section_maps(), d, &told);
  CHECK(told.find("is not closed: its ends are 6 m apart") != std::string::npos);
}

TEST_CASE("maps: areas are outlines, openings or stones, of any kind, as joints they warn") {
  Drawing d = drawing(1, {0, 0});
  const auto area = [&d](const std::string& layer, const Polyline& ring, bool is_hole = false) {
    Feature f = line(layer, ring);
    f.is_area = true, f.is_hole = is_hole;
    d.features.push_back(f);
  };
  area("wall", {{20, 0}, {21, 0}, {21, 1}, {20, 1}, {20, 0}});
  area("wall", {{20, 1}, {21, 1}, {21, 2}, {20, 2}, {20, 1}});
  area("wall", {{20.2, 1.2}, {20.4, 1.2}, {20.4, 1.4}, {20.2, 1.2}}, true);
  MapsInput maps = section_maps();
  maps.list[0].kind = "rigid";
  maps.list.push_back(map_of("stone", "wall", MapUse::kStone));
  maps.list.back().material = "stone", maps.list.back().kind = "fixed";
  std::string told;
  const MapSections made = sections(maps, d, &told);
  CHECK(told.empty());
  CHECK(map_report_text(made.report).find("hole in an area") != std::string::npos);
  const Model model = model_of(made);
  REQUIRE(model.blocks.size() == 2);
  CHECK(model.blocks[1].name == "stone-2");
  CHECK(model.blocks[1].kind == BlockKind::kFixed);
  CHECK(std::abs(signed_area(model.blocks[1].polygon)) == test::approx(1));
  CHECK(model.regions[0].kind == BlockKind::kRigid);

  maps.list.back() = map_of("rims", "wall", MapUse::kJoints);
  maps.list[0].kind.clear();
  CHECK(!sections(maps, d, &told).text.empty());
  CHECK(told.find("map.rims.becomes: \"joints\" takes areas") != std::string::npos);
}

TEST_CASE("maps in a model text: lines keep their numbers, wrong keys are told") {
  const std::string text =
      "talus = 1\n[maps]\nsnap = \"5 cm\"\n[[map]]\nname = \"rock\"\nfile = \"d.dxf\"\n"
      "layer = \"edge\"\nbecomes = \"outline\"\nmaterial = \"stone\"\n\n[material.stone]\ndensity = 2700\n";
  Findings findings("m.toml", text);
  const auto reader = [](const std::filesystem::path&, double) { return drawing(1, {0, 0}); };
  const ExpandedModel made = expand_model("m.toml", text, {}, reader, findings);
  CHECK(!findings.has_errors());
  CHECK(made.has_maps);
  CHECK(made.text.find("# [[map]]\n# name = \"rock\"\n") != std::string::npos);
  const auto line_of = [](const std::string& all, const std::string& part) {
    return std::count(all.begin(), all.begin() + all.find(part), '\n');
  };
  CHECK(line_of(made.text, "[material.stone]") == line_of(text, "[material.stone]"));
  CHECK(made.text.find("[[region]]") != std::string::npos);

  // the key `folder` replaces the one that is there, whatever the lines before it look like
  const std::string moved =
      with_folder("\xef\xbb\xbf# folder\n\"folder\" = \"x\"\ntitle = \"\"\"\n[a]\"\"\"\n", "/a/b", "/a/c/d");
  CHECK(moved.find("folder = \"../../b") == 0);
  Findings of_moved("m.toml", moved);
  CHECK(parse_toml(moved, {}, of_moved).root["folder"].value_or(std::string()).rfind("../../b", 0) == 0);
  CHECK(!of_moved.has_errors());

  const auto told = [&](const std::string& from, const std::string& to, const std::string& part) {
    std::string wrong = text;
    wrong.replace(wrong.find(from), from.size(), to);
    Findings found("m.toml", wrong);
    expand_model("m.toml", wrong, {}, reader, found);
    INFO(found.render());
    CHECK(found.render().find(part) != std::string::npos);
  };
  told("\"outline\"", "\"outlines\"", "did you mean \"outline\"?");
  told("material = \"stone\"", "type = \"bar\"", "map.rock.type: has no meaning for \"outline\"");
  told("material = \"stone\"", "", "map.rock.material: is missing");
  told("material = \"stone\"", "material = \"stone\"\nkind = \"soft\"", "map.rock.kind");
  told("layer = \"edge\"", "layer = \"egde\"", "did you mean \"edge\"?");
  told("layer = \"edge\"", "attribute = \"set\"", "map.rock.values: is missing");
  told("[maps]\nsnap", "maps.snap", "is written in a way that cannot be replaced");
  told("\"5 cm\"", "\"5 kg\"", "maps.snap");
  told("\"5 cm\"", "\"-5 cm\"", "is not allowed; must be >= 0");
}

TEST_CASE("import: guesses from names and shapes") {
  CHECK(guessed_use("Outline of face", {.lines = true}) == MapUse::kOutline);
  CHECK(guessed_use("TUNNEL", {.lines = true}) == MapUse::kOpening);
  CHECK(guessed_use("F1 fault", {.lines = true}) == MapUse::kFault);
  CHECK(guessed_use("rock bolts", {.lines = true}) == MapUse::kBolt);
  CHECK(guessed_use("anything", {.points = true}) == MapUse::kMonitor);
  CHECK(guessed_use("set 3", {.lines = true}) == MapUse::kJoints);
  // areas are never joints
  CHECK(guessed_use("set 3", {.areas = true}) == MapUse::kOutline);
  CHECK(guessed_use("limestone", {.areas = true}) == MapUse::kOutline);
  CHECK(guessed_use("cavern", {.areas = true}) == MapUse::kOpening);
  CHECK(guessed_use("Stones", {.areas = true}) == MapUse::kStone);
}

}  // namespace test_sections
