// Wrong input to the sections that the cutter reads: each mistake is told once, with its place, its key and a
// next move, and nothing else is blamed beside it.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <sstream>

#include "support/told.h"

namespace test_wrong_input_cut {

using namespace talus;
using namespace talus::test;

namespace {

// A sound model with every section of the cutter; tests replace one piece of it. Support and monitor stand on
// the floor, which is no cut block: a failed cut does not concern them.
const std::string kSound = R"(talus = 1
[material.stone]
density = "2700 kg/m3"
young = "5 GPa"
poisson = 0.25
[joint.rough]
friction_angle = "35 deg"
[joint.mortar]
friction_angle = "30 deg"
[cut]
section_azimuth = "90 deg"
seed = 3
slivers = "keep"
[[region]]
name = "rock"
polygon = [[0, 0], [40, 0], [40, 30], [0, 30]]
sides = ["base", "right", "top", "left"]
material = "stone"
joint = "rough"
[[region]]
name = "wall"
polygon = [[50, 0], [54, 0], [54, 3], [50, 3]]
material = "stone"
[[region]]
name = "plate"
polygon = [[60, 0], [64, 0], [64, 3], [60, 3]]
material = "stone"
kind = "rigid"
[[arch]]
name = "ring"
center = [80, 0]
radius = "4 m"
thickness = "0.5 m"
from = "0 deg"
to = "180 deg"
voussoirs = 9
material = "stone"
joint = "mortar"
[[joint_set]]
name = "steep"
angle = { mean = "70 deg", normal = "3 deg" }
spacing = "4 m"
trace_length = { mean = "12 m", uniform = "4 m" }
gap = "1 m"
region = "rock"
joint = "rough"
[[joint_set]]
name = "bedding"
dip = "20 deg"
dip_direction = "250 deg"
fisher = 500
spacing = { exponential = "5 m" }
region = "rock"
[[fault]]
name = "shear"
points = [[-1, 8], [20, 10], [41, 14]]
joint = "mortar"
[[opening]]
name = "tunnel"
shape = "circle"
center = [20, 20]
diameter = "6 m"
segments = 16
[[opening]]
name = "gallery"
shape = "polygon"
polygon = [[5, 15], [8, 15], [8, 18], [5, 18]]
rock = "kept"
joint = "mortar"
[[opening]]
name = "cavern"
shape = "horseshoe"
center = [31, 22]
width = "5 m"
height = "6 m"
[[masonry]]
name = "bond"
region = "wall"
length = "1 m"
height = "0.5 m"
overlap = 0.5
bed_joint = "mortar"
head_joint = "mortar"
[[tessellation]]
name = "grains"
region = "plate"
cells = "voronoi"
size = "1 m"
irregularity = 0.3
joint = "mortar"
[[block]]
name = "floor"
polygon = [[0, -5], [90, -5], [90, 0], [0, 0]]
material = "stone"
kind = "fixed"
[contact]
joint = "rough"
[[contact_pair]]
between = ["floor", "rock"]
joint = "mortar"
[[support]]
name = "held"
point = [90, -5]
[[stage]]
name = "go"
kind = "dynamic"
duration = "1 ms"
[[monitor]]
name = "deep"
point = [20, -2]
[model]
gravity = [0, -9.81]
)";

// Text in which every "\n" of the tables below is a new line.
std::string with_lines(std::string text) {
  for (size_t at = 0; (at = text.find("\\n", at)) != std::string::npos;) text.replace(at, 2, "\n");
  return text;
}

void check_one(const std::string& message, const std::string& finding, const std::string& hint = "") {
  INFO("message:\n", message, "\nshould hold: ", finding, "\n= ", hint);
  CHECK(message.find(finding) != std::string::npos);
  if (!hint.empty()) CHECK(message.find("      = " + hint + "\n") != std::string::npos);
  size_t count = 0;
  for (const char* level : {": error: ", ": warning: "})
    for (size_t at = 0; (at = message.find(level, at)) != std::string::npos; ++at) ++count;
  CHECK(count == 1);
  if (finding.find(": error: ") != std::string::npos)
    CHECK(message.find(": 1 error; nothing was run") != std::string::npos);
}

// Cases of three lines: piece of the sound model => what stands there instead; the one finding, from its line
// on; its hint after "=", where it has one.
void check_all(const std::string& table) {
  std::istringstream in(table);
  std::string from, to, finding, hint;
  const auto check = [&] {
    if (!finding.empty()) check_one(told(replaced(kSound, from, to)), "model.toml:" + finding, hint);
    finding = hint = "";
  };
  for (std::string line; std::getline(in, line);) {
    const size_t arrow = line.find(" =>");
    if (line.rfind("  = ", 0) == 0) {
      hint = line.substr(4);
    } else if (line.rfind("  ", 0) == 0) {
      finding = line.substr(2);
    } else if (arrow != std::string::npos) {
      check();
      from = with_lines(line.substr(0, arrow));
      to = with_lines(line.substr(std::min(arrow + 4, line.size())));
    }
  }
  REQUIRE(!finding.empty());
  check();
}

}  // namespace

TEST_CASE("wrong cut: the sound model is accepted, with each kind of place in a support") {
  CHECK(told(kSound) == "");
  for (const char* along :
       {"left", "wall-4", "ring-start", "shear", "tunnel", "bond-bed", "grains", "bedding"})
    CHECK(told(replaced(kSound, "point = [90, -5]", fmt::format("along = \"{}\"", along))) == "");
}

TEST_CASE("wrong cut: joint sets") {
  check_all(R"~(
"70 deg" => 70
  41:18: error: joint_set.steep.angle: an angle needs its unit: write "70 deg" or "70 rad"
dip = "20 deg" => dip = 20
  49:7: error: joint_set.bedding.dip: an angle needs its unit: write "20 deg" or "20 rad"
dip_direction = "250 deg"\n =>
  47:1: error: joint_set.bedding: has no dip_direction
  = an orientation in space needs both
dip = "20 deg"\n =>
  47:1: error: joint_set.bedding: has no dip
  = an orientation in space needs both
section_azimuth = "90 deg"\n =>
  48:1: error: joint_set.bedding.dip: needs the direction of the section
  = give section_azimuth in [cut]
spacing = "4 m" => spacing = "4 m"\nfisher = 100
  43:1: error: joint_set.steep.fisher: belongs to dip and dip_direction
  = an angle scatters by itself: angle = { mean = ..., normal = ... }
dip = "20 deg" => angle = "20 deg"\ndip = "20 deg"
  47:1: error: joint_set.bedding: has both angle and dip
  = give angle, or dip and dip_direction
angle = { mean = "70 deg", normal = "3 deg" }\n =>
  39:1: error: joint_set.steep: has no direction
  = give angle, or dip and dip_direction
dip = "20 deg"\ndip_direction = "250 deg" => dip = "90 deg"\ndip_direction = "0 deg"
  47:1: error: joint_set.bedding.dip_direction: is parallel to the section: its joints have no trace in it
spacing = "4 m" => spacing = "0 m"
  42:11: error: joint_set.steep.spacing: 0 m is not allowed; must be > 0 m
spacing = "4 m" => spacing = -4
  42:11: error: joint_set.steep.spacing: -4 m is not allowed; must be > 0 m
spacing = "4 m" => spacing = "0.001 mm"
  42:1: error: joint_set.steep.spacing: makes most of about 7.9e+07 blocks, which need 395 GB
spacing = "4 m" => spacing = { mean = "4 m" }
  42:11: error: joint_set.steep.spacing: is a table; expected a quantity, { mean = ..., normal = standard deviation }, { mean = ..., uniform = half width } or { exponential = mean }
spacing = "4 m" => spacing = { normal = "4 m" }
  42:11: error: joint_set.steep.spacing: is a table; expected a quantity, { mean = ..., normal = standard deviation }, { mean = ..., uniform = half width } or { exponential = mean }
spacing = "4 m" => spacing = { mean = "4 m", normal = "1 m", uniform = "1 m" }
  42:11: error: joint_set.steep.spacing: is a table; expected a quantity, { mean = ..., normal = standard deviation }, { mean = ..., uniform = half width } or { exponential = mean }
spacing = "4 m" => spacing = { mean = "4 m", normal = "-1 m" }
  42:36: error: joint_set.steep.spacing: a scatter cannot be negative
spacing = "4 m" => spacing = { mean = "4 m", uniform = "5 m" }
  42:37: error: joint_set.steep.spacing: is wider than the mean: values would go below 0 m
spacing = "4 m" => spacing = "{ mean = 4 m }"
  42:11: error: joint_set.steep.spacing: "{ mean = 4 m }" does not begin with a number; expected a length (m, mm, cm, km, ft), for example "1 m"
trace_length = { mean = "12 m", uniform = "4 m" }\n =>
  43:1: error: joint_set.steep.gap: has no meaning for a through-going set
  = give trace_length
region = "rock" => region = "rok"
  45:1: error: joint_set.steep.region: there is no region called "rok"
  = did you mean "rock"?
region = "rock" => region = "quarry"
  45:1: error: joint_set.steep.region: there is no region called "quarry"
  = there is rock, wall or plate
joint = "rough"\n[[joint_set]] => joint = "ruogh"\n[[joint_set]]
  46:1: error: joint_set.steep.joint: there is no joint called "ruogh"
  = did you mean "rough"?
spacing = "4 m" => spacing = "1 km"\norigin = [-200, -200]
  39:1: warning: joint_set.steep: has no joint in the regions
  = its spacing may be wider than they are, or its origin far away with few traces
)~");
}

TEST_CASE("wrong cut: regions and arches") {
  check_all(R"~(
"left"]\nmaterial = "stone" => "left"]\nmaterial = "ston"
  18:1: error: region.rock.material: there is no material called "ston"
  = did you mean "stone"?
["base", "right", "top", "left"] => ["base", "right", "left"]
  17:1: error: region.rock.sides: has 3 names for 4 edges
  = give one name per edge, the first for the edge from the first to the second corner
["base", "right", "top", "left"] => ["base", "right", "top", "left", "more"]
  17:1: error: region.rock.sides: has 5 names for 4 edges
  = give one name per edge, the first for the edge from the first to the second corner
["base", "right", "top", "left"] => ["base", "right", "t.op", "left"]
  17:1: error: region.rock.sides: "t.op" is no name: names hold no dot, comma, quote or bracket
[[0, 0], [40, 0], [40, 30], [0, 30]] => [[0, 0], [40, 30], [40, 0], [0, 30]]
  16:1: error: region.rock.polygon: crosses or touches itself at (20, 15)
[[0, 0], [40, 0], [40, 30], [0, 30]]\nsides = ["base", "right", "top", "left"] => [[0, 0], [40, 0]]
  16:1: error: region.rock.polygon: has 2 corners; a polygon needs at least 3
[[0, 0], [40, 0], [40, 30], [0, 30]]\nsides = ["base", "right", "top", "left"] => [0, 0, 40, 0, 40, 30]
  16:12: error: region.rock.polygon: is a number; expected a point [x, y] with a length (m, mm, cm, km, ft)
[[arch]] => [[region]]\npolygon = [[95, 0], [96, 0], [96, 1]]\nmaterial = "stone"\n[[arch]]
  29:1: error: region.3.name: is missing
  = Unique name; stands for all its blocks.
name = "gallery" => name = "wall"
  65:1: error: opening.wall.name: a second block, grid, region or opening is called "wall"
name = "shear" => name = "ring"
  55:1: error: fault.ring.name: a second source of joints is called "ring"
[90, 0], [0, 0]] => [90, 0], [85, 0], [85, 0.1], [83, 0.1], [83, 0], [0, 0]]
  29:1: error: ring[24]: overlaps "floor" by 0.05 m2
  = blocks may touch but not share area; move or trim one of them
to = "180 deg" => to = "360 deg"
  35:1: error: arch.ring.to: must be larger than from, by less than a full turn
voussoirs = 9 => voussoirs = 1
  36:1: error: arch.ring.voussoirs: each must span less than 180 deg
  = give more of them
)~");
}

TEST_CASE("wrong cut: openings, faults, masonry, tessellation") {
  check_all(R"~(
center = [20, 20] => center = [20, 200]
  58:1: error: opening.tunnel: holds no rock
  = it lies outside every region, or a later opening covers it
height = "6 m" => height = "2 m"
  75:1: error: opening.cavern.height: is less than half the width
  = the half circle alone is half the width high
diameter = "6 m" => diameter = "6 m"\nwidth = "5 m"
  63:1: error: opening.tunnel.width: does not belong to shape = "circle"
width = "5 m" => width = "5 m"\npolygon = [[0, 0], [1, 0], [1, 1]]
  75:1: error: opening.cavern.polygon: does not belong to shape = "horseshoe"
segments = 16 => joint = "mortar"
  63:1: warning: opening.tunnel.joint: has no effect: removed rock has no joint
[[opening]] => [[fault]]\nname = "shear"\npoints = [[0, 1], [40, 2]]\n[[opening]]
  59:1: error: fault.shear.name: a second source of joints is called "shear"
name = "shear" => name = "F.1"
  55:1: error: fault.F.1.name: "F.1" is no name: names hold no dot, comma, quote or bracket
[[fault]]\nname = "shear" => [fault.shear]
  54:1: error: fault: is a list: write [[fault]] with double brackets
[[-1, 8], [20, 10], [41, 14]] => [[-1, 8]]
  56:1: error: fault.shear.points: needs two points or more
name = "bond"\nregion = "wall"\n => name = "bond"\n
  76:1: error: masonry.bond.region: is missing
  = The region it fills.
region = "wall" => region = "walls"
  78:1: error: masonry.bond.region: there is no region called "walls"
  = did you mean "wall"?
"1 m"\nheight = "0.5 m" => "0.4 mm"\nheight = "0.2 mm"
  79:1: error: masonry.bond.length: makes about 1.5e+08 cells, more than 1e+07
  = is a unit missing?
length = "1 m"\nheight => length = 0\nheight
  79:10: error: masonry.bond.length: 0 m is not allowed; must be > 0 m
size = "1 m" => size = 0
  88:8: error: tessellation.grains.size: 0 m is not allowed; must be > 0 m
to = "180 deg" => to = 180
  35:6: error: arch.ring.to: an angle needs its unit: write "180 deg" or "180 rad"
size = "1 m" => size = "0.3 mm"
  88:1: error: tessellation.grains.size: makes about 1.3e+08 cells, more than 1e+07
  = is a unit missing?
)~");
}

TEST_CASE("wrong cut: settings of the cut") {
  check_all(R"~(
seed = 3 => seed = -3
  12:8: error: cut.seed: -3 is not allowed; must be >= 0
"keep" => "remove"
  13:11: error: cut.slivers: "remove" is not known; must be keep, merge or delete
slivers = "keep" => merge_along = ["steep"]
  13:1: warning: cut.merge_along: has no effect: nothing is merged
  = it counts with slivers = "merge"
slivers = "keep" => sliver_area_share = 2
  13:21: error: cut.sliver_area_share: 2 is not allowed; must be >= 0 and <= 0.5
seed = 3 => blocks = ""
  12:1: error: cut.blocks: is empty
  = name a file that talus cut has written
)~");
  const std::string unknown = told(
      replaced(kSound, "slivers = \"keep\"", "slivers = \"merge\"\nmerge_along = [\"steep\", \"sloppy\"]"));
  CHECK(unknown.find("14:1: error: cut.merge_along: \"sloppy\" is no joint set") != std::string::npos);
  // of the grid the place of the section is told, not yet of the key
  const auto with_grid = [](const char* grid) {
    return told(replaced(kSound, "seed = 3", fmt::format("grid = \"{}\"", grid)));
  };
  check_one(with_grid("1e-14 m"), "error: cut.grid: 7.11e-15 m is too fine for a model of 84.5 m",
            "coordinates have no digits left for it: give a wider grid, or move the model to the origin");
  check_one(with_grid("50 mm"), "warning: cut.grid: 0.0312 m is coarse for a model of 84.5 m",
            "corners move by up to half of it");
}

TEST_CASE("wrong cut: what refers to cut blocks") {
  check_all(R"~(
point = [90, -5] => along = "lefd"
  101:1: error: support.held.along: there is no side, opening, fault or joint set called "lefd"
  = did you mean "left"?
point = [90, -5] => point = [90, -5]\nalong = "left"
  101:1: error: support.held: has more than one place
  = give one of point = [x, y], edge = [[x0, y0], [x1, y1]], along = "NAME"
point = [90, -5] => along = "tunnel"\nblock = "wall"
  101:1: error: support.held: no block edge is left along "tunnel"
  = see with talus cut which edges there are
point = [20, -2] => point = [20, 20]
  110:1: error: monitor.deep: (20, 20) lies outside every block
point = [20, -2] => block = "wall"
  110:1: error: monitor.deep: "wall" is 27 blocks, not one
  = name one of its blocks, for example "wall[14]"
["floor", "rock"] => ["floor", "rock[3]"]
  99:1: error: contact_pair.between: "rock[3]" is one block of several
  = a joint belongs to whole groups: name the grid or region
["floor", "rock"] => ["floor", "rok"]
  99:1: error: contact_pair.between: there is no block, grid or region called "rok"
  = did you mean "rock"?
)~");
}

TEST_CASE("wrong cut: cutting without a region") {
  const std::string stage = "[[stage]]\nname = \"s\"\nkind = \"dynamic\"\nduration = 1\ntime_step = 0.1\n";
  const std::string nothing =
      "model.toml:2:1: error: region: the file has no [[region]]: there is nothing to cut";
  const std::string hint = "give the outline of the rock as [[region]] with name, polygon and material";
  check_one(told("talus = 1\n[[joint_set]]\nname = \"a\"\nangle = \"20 deg\"\nspacing = 1\n" + stage),
            nothing, hint);
  check_one(told("talus = 1\n[[fault]]\nname = \"a\"\npoints = [[0, 0], [1, 1]]\n" + stage), nothing, hint);
  check_one(told("talus = 1\n[[masonry]]\nname = \"a\"\nregion = \"b\"\nlength = 1\nheight = 1\n" + stage),
            "model.toml:4:1: error: masonry.a.region: there is no region called \"b\"",
            "the file defines no region");
}

// --- one mistake, one message, at its place ---

TEST_CASE("wrong cut: a failed cut is the only thing told") {
  check_all(R"~(
point = [90, -5] => along = "left"\n[[joint_set]]\nname = "fine"\nangle = "0 deg"\nspacing = "0.001 mm"
  107:1: error: joint_set.fine.spacing: makes most of about 3.4e+08 blocks
)~");
}

TEST_CASE("wrong cut: names are told once") {
  check_all(R"~(
name = "tunnel" => name = "tunnel.1"
  59:1: error: opening.tunnel.1.name: "tunnel.1" is no name
name = "gallery" => name = "tunnel"
  65:1: error: opening.tunnel.name: a second
)~");
}

TEST_CASE("wrong cut: directions of joint sets are told once") {
  check_all(R"~(
dip = "20 deg"\ndip_direction = "250 deg"\nfisher = 500 => dip = "90 deg"
  47:1: error: joint_set.bedding: has no dip_direction
section_azimuth = "90 deg" => section_azimuth = 90
  11:19: error: cut.section_azimuth: an angle needs its unit: write "90 deg" or "90 rad"
dip = "20 deg"\ndip_direction = "250 deg" => angle = "20 deg"\ndip = "20 deg"
  47:1: error: joint_set.bedding: has both angle and dip
)~");
}

TEST_CASE("wrong cut: a wrong region is told once") {
  check_all(R"~(
[[0, 0], [40, 0], [40, 30], [0, 30]] => [[0, 0], [40, 0]]
  16:1: error: region.rock.polygon: has 2 corners; a polygon needs at least 3
)~");
}

TEST_CASE("wrong cut: the place is that of the mistake") {
  check_all(R"~(
["base", "right", "top", "left"] => ["base", "steep", "top", "left"]
  17:1: error: region.rock.sides: "steep" is
{ mean = "12 m", uniform = "4 m" }\ngap = "1 m" => "0.001 mm"
  43:1: error: joint_set.steep
seed = 3 => grid = "1e-14 m"
  12:1: error: cut.grid
)~");
}

TEST_CASE("wrong cut: a block over many cut blocks is told once") {
  check_all(R"~(
[90, 0], [0, 0]] => [90, 0], [45, 0], [45, 1], [0, 1]]
  14:1: error: rock[0]: overlaps "floor"
)~");
}

TEST_CASE("wrong cut: a place without a name is refused") {
  check_all(R"~(
point = [90, -5] => along = ""
  103:1: error: support.held.along: is empty
)~");
}

TEST_CASE("wrong cut: a name without blocks is not its own correction") {
  check_all(R"~(
point = [20, -2] => block = "tunnel"
  110:1: error: monitor.deep: "tunnel" has no block left
)~");
}

TEST_CASE("wrong cut: a fault outside every region is told") {
  check_all(R"~(
[[-1, 8], [20, 10], [41, 14]] => [[-1, 80], [20, 100]]
  54:1: warning: fault.shear
)~");
}

}  // namespace test_wrong_input_cut
