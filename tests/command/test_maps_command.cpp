// talus import and maps in talus cut as a user meets them, on drawings written by ezdxf and ogr2ogr
// (tests/fixtures/make_maps.py says what they hold).

#include <doctest/doctest.h>

#include <fmt/format.h>
#include <fstream>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "support/command.h"
#include "support/relative.h"
#include "talus/cut/cut.h"
#include "talus/model/read_model.h"

namespace test_maps_command {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

const std::string kMaps = std::string(TALUS_SOURCE_DIR) + "/tests/fixtures/maps/";
const std::string kUses =
    " --as OUTLINE=outline --as TUNNEL=opening --as STEEP=joints --as FLAT=joints --as CURVED=joints"
    " --as BOLTS=bolt --as GAUGES=monitor";
const std::string kHead = R"(talus = 1
[material.rock]
density = "2700 kg/m3"
young = "5 GPa"
poisson = 0.25
[bolt_type.bolt]
kind = "anchored"
diameter = "25 mm"
spacing = "1 m"
)";

const std::string kRegion =
    "[[region]]\nname = \"r\"\nmaterial = \"rock\"\npolygon = [[0, 0], [12, 0], [12, 8], [0, 8]]\n";

// A build without GDAL has no module; tests of what it reads then say so.
bool has_module() {
  static const bool there =
      fs::exists(fs::path(TALUS_COMMAND).parent_path() / "../modules/libtalus_vector.so");
  if (!there) MESSAGE("skipped: talus was built without GDAL");
  return there;
}

Model model_of(const std::string& sections) {
  Findings findings("imported.toml", kHead + sections);
  const Model model = read_model("imported.toml", kHead + sections, {}, findings);
  INFO(findings.render());
  CHECK(!findings.has_errors());
  return model;
}

const TracesInput& traces(const Model& m, const std::string& name) {
  for (const TracesInput& t : m.traces)
    if (t.name == name) return t;
  FAIL("no traces called ", name);
  return m.traces.front();
}

bool is_line(const Polyline& line, Vec2 a, Vec2 b) {
  return line.size() == 2 && ((norm(line[0] - a) < 1e-5 && norm(line[1] - b) < 1e-5) ||
                              (norm(line[0] - b) < 1e-5 && norm(line[1] - a) < 1e-5));
}

double sin10(int n) { return std::sin(n * std::numbers::pi / 18); }

}  // namespace

TEST_CASE("import: bulge, circle, arc, spline and block insert of a DXF come out where they are drawn") {
  if (!has_module()) return;
  const Folder folder;
  const Outcome o = shell(folder, "$talus import " + kMaps + "metres.dxf" + kUses + " -o out.toml");
  INFO(o.text);
  REQUIRE(o.code == 0);
  has(o.text, "unit $INSUNITS = 6 (m)");
  has(o.text, "1 TEXT on layer \"NOTES\"");
  has(o.text, "1 filled area on layer \"NOTES\"");
  const Model m = model_of(read_text_file(folder / "out.toml"));

  // bulge: a quarter circle around (9, 5) over the chord of 6 m, in nine pieces of 10 degrees
  REQUIRE(m.regions.size() == 1);
  const double r = 3 * std::numbers::sqrt2;
  CHECK(signed_area(m.regions[0].polygon) == approx(96 + 0.5 * r * r * (9 * sin10(1) - 1)).epsilon(1e-7));
  int on_arc = 0;
  for (const Vec2 p : m.regions[0].polygon) on_arc += std::abs(norm(p - Vec2{9, 5}) - r) < 1e-6;
  CHECK(on_arc == 10);
  // circle: 36 pieces
  REQUIRE(m.openings.size() == 1);
  CHECK(std::abs(signed_area(m.openings[0].polygon)) == approx(18 * sin10(1)).epsilon(1e-6));
  // insert, twice as large as the block: its line of layer 0 is on the layer of the insert
  REQUIRE(traces(m, "STEEP").lines.size() == 2);
  CHECK(is_line(traces(m, "STEEP").lines[0], {5, -1}, {5, 9}));
  CHECK(is_line(traces(m, "STEEP").lines[1], {4, 0}, {12, 8}));
  REQUIRE(traces(m, "FLAT").lines.size() == 1);
  CHECK(is_line(traces(m, "FLAT").lines[0], {2, 8}, {14, 0}));
  // spline (a single cubic of Bezier) and arc
  REQUIRE(traces(m, "CURVED").lines.size() == 2);
  for (const Polyline& line : traces(m, "CURVED").lines) {
    const bool is_arc = norm(line.front() - Vec2{-1, 6}) > 0.1 && norm(line.back() - Vec2{-1, 6}) > 0.1;
    CHECK(line.size() >= 9);
    for (const Vec2 p : line) {
      double off = std::abs(norm(p - Vec2{6, -9}) - 10);
      if (!is_arc) {
        off = 1;  // distance to the curve, by 20000 points of it
        for (int k = 0; k <= 20000; ++k) {
          const double t = k / 20000.0, s = 1 - t;
          const Vec2 q = s * s * s * Vec2{-1, 6} + 3 * s * s * t * Vec2{4, 8} + 3 * s * t * t * Vec2{8, 4} +
                         t * t * t * Vec2{13, 6};
          off = std::min(off, norm(p - q));
        }
      }
      CHECK(off < (is_arc ? 1e-5 : 1e-3));
    }
  }
  REQUIRE(m.bolts.size() == 2);
  CHECK(norm(m.bolts[1].to - Vec2{3, 5.5}) < 1e-6);
  REQUIRE(m.monitors.size() == 2);
  CHECK(m.monitors[1].point == Vec2{11, 7});

  // and it cuts: nothing of the section is lost
  Findings findings("imported.toml", "");
  const Cut cut = cut_model(m, findings);
  CHECK(!findings.has_errors());
  double area = 0;
  for (const CutBlock& b : cut.whole) area += signed_area(cut.polygon(b));
  CHECK(area == approx(signed_area(m.regions[0].polygon)).epsilon(1e-7));
  CHECK(cut.taken_out >= 1);
}

TEST_CASE("import: the same drawing in metres, in millimetres and without a unit") {
  if (!has_module()) return;
  const Folder folder;
  REQUIRE(shell(folder, "$talus import " + kMaps + "metres.dxf" + kUses + " -o m.toml").code == 0);
  REQUIRE(shell(folder, "$talus import " + kMaps + "millimetres.dxf" + kUses + " -o mm.toml").code == 0);
  const auto without_comments = [](const std::string& text) {
    std::string out;
    for (size_t at = 0; at < text.size();) {
      const size_t end = std::min(text.find('\n', at), text.size());
      if (text[at] != '#') out += text.substr(at, end - at) + "\n";
      at = end + 1;
    }
    return out;
  };
  CHECK(without_comments(read_text_file(folder / "m.toml")) ==
        without_comments(read_text_file(folder / "mm.toml")));

  const Outcome o = shell(folder, "$talus import " + kMaps + "no_units.dxf" + kUses);
  CHECK(o.code == 3);
  has(o.text, "the unit of \"" + kMaps + "no_units.dxf\" is not known: it has no $INSUNITS");
  has(o.text, "give unit");
  REQUIRE(shell(folder, "$talus import " + kMaps + "no_units.dxf --unit m" + kUses + " -o given.toml").code ==
          0);
  CHECK(without_comments(read_text_file(folder / "given.toml")) ==
        without_comments(read_text_file(folder / "m.toml")));
}

TEST_CASE("import: polylines of R12, and a file of ogr2ogr, which calls all units inches") {
  if (!has_module()) return;
  const Folder folder;
  Outcome o = shell(folder, "$talus import " + kMaps +
                                "r12.dxf --unit m --as OUTLINE=outline --as STEEP=joints -o r12.toml");
  INFO(o.text);
  REQUIRE(o.code == 0);
  const Model m = model_of(read_text_file(folder / "r12.toml"));
  CHECK(signed_area(m.regions[0].polygon) == approx(96 + 9 * (9 * sin10(1) - 1)).epsilon(1e-7));

  // it calls everything inches, whatever it is
  has(shell(folder, "$talus import " + kMaps + "ogr2ogr.dxf --as A=joints").text,
      "unit $INSUNITS = 1 (inch)");
  o = shell(folder, "$talus import " + kMaps +
                        "ogr2ogr.dxf --unit m --as A=joints --as B=joints --as gauge=monitor -o o.toml");
  INFO(o.text);
  REQUIRE(o.code == 0);
  const Model from_ogr = model_of(read_text_file(folder / "o.toml") + kRegion);
  CHECK(traces(from_ogr, "B").lines.size() == 2);
}

TEST_CASE("import: shapefile, GeoPackage and GeoJSON give the same traces, shifted to a local origin") {
  if (!has_module()) return;
  const Folder folder;
  for (const std::string file : {"map.geojson", "map.gpkg", "lines.shp"}) {
    INFO(file);
    const Outcome o = shell(folder, "$talus import " + kMaps + file +
                                        " --attribute set --as A=joints --as B=joints"
                                        " --origin 500000 3400000 -o out.toml");
    INFO(o.text);
    REQUIRE(o.code == 0);
    has(o.text, "(500000, 3400000) m of the map is (0, 0) of the model");
    const Model m = model_of(
        read_text_file(folder / "out.toml") +
        "[[region]]\nname = \"r\"\nmaterial = \"rock\"\npolygon = [[0, 0], [12, 0], [12, 8], [0, 8]]\n");
    REQUIRE(traces(m, "A").lines.size() == 1);
    CHECK(is_line(traces(m, "A").lines[0], {5, -1}, {5, 9}));
    REQUIRE(traces(m, "B").lines.size() == 2);
    CHECK(is_line(traces(m, "B").lines[1], {-1, 6}, {13, 6}));
    Findings findings("imported.toml", "");
    CHECK(cut_model(m, findings).blocks.size() == 6);
  }
  // the origin that talus finds: the lower left corner of what is taken
  const Outcome o =
      shell(folder, "$talus import " + kMaps + "map.gpkg --attribute set --as border=outline -o out.toml");
  REQUIRE(o.code == 0);
  has(o.text, "(500000, 3400000) m of the map is (0, 0) of the model");
  has(read_text_file(folder / "out.toml"), "polygon = [[0, 0], [12, 0], [12, 8], [0, 8]]");
}

TEST_CASE("import: what cannot be read or is not there is told, and nothing is written") {
  if (!has_module()) return;
  const Folder folder;
  const auto refused = [&](const std::string& arguments, int code, const std::string& part) {
    const Outcome o = shell(folder, "$talus import " + arguments + " -o out.toml");
    INFO(arguments);
    CHECK(o.code == code);
    has(o.text, part);
    CHECK(!fs::exists(folder / "out.toml"));
  };
  refused(kMaps + "cut_short.dxf" + kUses, 3, "without its EOF: the file was cut short");
  refused(kMaps + "metres.dxf --as STEPP=joints", 3, "has no layer \"STEPP\"");
  refused(kMaps + "metres.dxf --as STEPP=joints", 3, "did you mean \"STEEP\"?");
  refused(kMaps + "metres.dxf --as STEEP=joint", 3,
          "USE is joints, fault, outline, opening, stone, bolt, monitor or ignored");
  refused(kMaps + "metres.dxf --as STEEP=outline", 3, "is not closed: its ends are 10 m apart");
  refused(kMaps + "metres.dxf --as CURVED=bolt", 3, "a bolt is a straight line");
  refused(kMaps + "metres.dxf --unit furlong --as STEEP=joints", 3, "must be auto, m, mm, cm, km, in or ft");
  refused(kMaps + "metres.dxf --snap much --as STEEP=joints", 2, "--snap");
  refused(kMaps + "degrees.geojson --attribute set --as A=joints", 3,
          "is in degrees of longitude and latitude");
  refused(kMaps + "map.gpkg --attribute sett --as A=joints", 3, "its attributes: \"set\"");
  refused(kMaps + "map.gpkg --attribute set --as D=joints", 3, "its values: \"A\"");
  refused(kMaps + "cut_short.shp --attribute set --as A=joints", 3, "is damaged");
  refused("nothing.gpkg --as A=joints", 4, "there is no such file");
  shell(folder, "echo no map > text.gpkg; echo '{}' > empty.geojson");
  shell(folder, "cp " + kMaps + "metres.dxf drawing.txt");
  refused("drawing.txt --as STEEP=joints", 3, "give its name the ending .dxf");
  refused(kMaps + "metres.dxf --as STEEP=joints --curve-step 0", 2, "must be from 1 deg to 90 deg");
  refused("text.gpkg --as A=joints", 3, "is no DXF, shapefile, GeoPackage or GeoJSON");
  refused("empty.geojson --as A=joints", 3, "empty.geojson");
}

TEST_CASE("import: a spline given by fit points alone is left out, and said, the rest is read") {
  if (!has_module()) return;
  const Folder folder;
  const Outcome o = shell(folder, "$talus import " + kMaps + "fit_spline.dxf -o out.toml");
  INFO(o.text);
  CHECK(o.code == 0);
  has(o.text, "1 SPLINE on layer \"CURVED\": is given by fit points alone");
  has(o.text, "STEEP: taken for joints (a guess)");
  CHECK(model_of(read_text_file(folder / "out.toml")).traces.size() == 1);
}

TEST_CASE("cut: maps in a model become sections, run refuses them and takes the model that cut writes") {
  if (!has_module()) return;
  const Folder folder;
  shell(folder, "cp " + kMaps +
                    "metres.dxf drawing.dxf; printf 'time [s],velocity [m/s]\\n0,0\\n1,1\\n' > motion.csv");
  const std::string model = kHead + R"([joint.steep]
friction_angle = "30 deg"
[maps]
snap = "10 cm"
[[map]]
name = "rock"
file = "drawing.dxf"
layer = "OUTLINE"
becomes = "outline"
material = "rock"
[[map]]
name = "steep"
file = "drawing.dxf"
layer = "ST*"
becomes = "joints"
joint = "steep"
[[map]]
name = "gauge"
file = "drawing.dxf"
layer = "GAUGES"
becomes = "monitor"
[history.motion]
file = "motion.csv"              # counts from the folder of the model, wherever its copy goes
[contact]
joint = "steep"
[[stage]]
name = "fall"
kind = "dynamic"
duration = "1 ms"
)";
  std::ofstream(folder / "m.toml") << model;
  Outcome o = shell(folder, "$talus run m.toml -o r");
  CHECK(o.code == 3);
  has(o.text, "m.toml:14:1: error: map: maps are read by talus cut alone");
  o = shell(folder, "mkdir other; cd other; $talus cut ../m.toml -o ../c");
  INFO(o.text);
  REQUIRE(o.code == 0);
  has(o.text, "\"steep\": 2 joints");
  has(o.text, "left out: 1 line on layer \"TUNNEL\": no [[map]] takes it");
  for (const char* file : {"map.svg", "map.png", "cut.svg", "model.toml"})
    CHECK(fs::file_size(folder / "c" / file) > 0);
  const auto cut = nlohmann::json::parse(read_text_file(folder / "c" / "cut.json"));
  CHECK(cut["traces"][0]["lines"] == 2);
  o = shell(folder, "$talus run c/model.toml -o r");
  INFO(o.text);
  CHECK(o.code == 0);
  has(read_text_file(folder / "r" / "histories.csv"), "gauge-2.displacement_x");
  // a key of a map by --set; a wrong one is told with its place
  o = shell(folder, "$talus cut m.toml -o d --set map.steep.layer=FLAT");
  CHECK(o.code == 0);
  has(read_text_file(folder / "d" / "model.toml"), "# --set map.steep.layer=FLAT");
  o = shell(folder, "$talus cut m.toml -o e --set map.steep.layer=FLAX");
  CHECK(o.code == 3);
  has(o.text, "--set map.steep.layer=FLAX");
  has(o.text, "did you mean \"FLAT\"?");
  o = shell(folder, "sed 's/drawing.dxf/other.dxf/' m.toml > n.toml; $talus cut n.toml -o f");
  CHECK(o.code == 3);
  has(o.text, "n.toml:16:1: error: map.rock.file");
  has(o.text, "other.dxf: cannot be read");
}

TEST_CASE("maps: without the module the message says what to install") {
  const Folder folder;
  shell(folder, "cp " TALUS_COMMAND " talus_alone");
  const Outcome o = shell(folder, "./talus_alone import " + kMaps + "metres.dxf --as STEEP=joints");
  CHECK(o.code == 4);
  has(o.text, "install the package talus-maps, or libgdal-dev and build again");
}

}  // namespace test_maps_command
