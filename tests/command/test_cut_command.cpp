// talus cut as a user meets it, and the blocks file that runs read instead of cutting.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "support/command.h"
#include "talus/base/text_file.h"
#include "talus/output/csv.h"
#include "talus/output/files.h"

namespace test_cut_command {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

const std::string kExamples = std::string(TALUS_SOURCE_DIR) + "/examples/";
const std::string kSettle = kExamples + "settle/settle.toml", kTunnel = kExamples + "tunnel/tunnel.toml";
const std::string kShort = "--set 'stage.settle.duration=\"5 ms\"'";

// Blocks and cut regions side by side, a removed and a kept opening inside single blocks (opened by level
// cuts), supports and monitors of every kind.
const std::string kMixed = R"(talus = 1
[model]
gravity = [0, -9.81]
[material.stone]
density = "2700 kg/m3"
young = "5 GPa"
poisson = 0.25
[joint.rough]
friction_angle = "35 deg"
normal_stiffness = "5 GPa/m"
shear_stiffness = "5 GPa/m"
[joint.weak]
friction_angle = "10 deg"
normal_stiffness = "1 GPa/m"
shear_stiffness = "1 GPa/m"
[contact]
joint = "rough"
[cut]
seed = 1
[[block]]
name = "floor"
polygon = [[-2, -2], [22, -2], [22, 0], [-2, 0]]
material = "stone"
kind = "fixed"
[[region]]
name = "rock"
polygon = [[0, 0], [20, 0], [20, 12], [0, 12]]
sides = ["base", "right", "top", "left"]
material = "stone"
[[region]]
name = "cover"
polygon = [[0, 12], [20, 12], [20, 14], [0, 14]]
material = "stone"
kind = "rigid"
[[joint_set]]
name = "steep"
angle = { mean = "80 deg", normal = "4 deg" }
spacing = { mean = "6 m", uniform = "1 m" }
region = "rock"
joint = "weak"
[[opening]]
name = "tunnel"
shape = "circle"
center = [3, 6]
diameter = "1 m"
segments = 12
[[opening]]
name = "core"
shape = "polygon"
polygon = [[9, 3], [10, 3], [10, 4], [9, 4]]
rock = "kept"
joint = "weak"
[[support]]
name = "sides"
along = "left"
y = "free"
[[stage]]
name = "go"
kind = "dynamic"
duration = "5 ms"
[[monitor]]
name = "top"
point = [10, 13.5]
[[monitor]]
name = "held"
support = "sides"
[[monitor]]
name = "under"
contact = ["rock", "floor"]
[[monitor]]
name = "stress"
block = "rock[0]"
)";

size_t lines(const std::string& text) {
  return static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
}

// Outcome of a check of the mixed model with its blocks file after a change of the content of that file.
Outcome check_changed(const std::function<void(nlohmann::json&)>& change) {
  const Folder f;
  write_file(f / "m.toml", kMixed);
  CHECK(shell(f, "$talus cut m.toml -o cut").code == 0);
  auto json = nlohmann::json::parse(read_text_file(f / "cut/blocks.json"));
  change(json);
  write_file(f / "b.json", json.dump());
  return shell(f, "$talus check m.toml --set cut.blocks=b.json");
}

}  // namespace

TEST_CASE("command: check -o takes nothing of an earlier cut away") {
  const Folder f;
  REQUIRE(shell(f, fmt::format("$talus cut {} -o out", kSettle)).code == 0);
  const Outcome o = shell(f, fmt::format("$talus check {} -o out --force", kSettle));
  CHECK(o.code == 4);
  has(o.text, "out: holds results of talus cut, which --force of talus check does not replace");
  for (const char* name : {"cut.json", "cut.png", "blocks.json", "blocks.csv", "report.txt"})
    CHECK(fs::exists(f / "out" / name));
}

TEST_CASE("command: cut writes every file and runs nothing, with a stage or without") {
  const Folder f;
  for (const std::string& model : {kTunnel, kSettle}) {
    const Outcome o = shell(f, fmt::format("$talus cut {} -o out --force", model));
    CHECK(o.code == 0);
    std::set<std::string> files;
    for (const auto& e : fs::directory_iterator(f / "out")) files.insert(e.path().filename().string());
    CHECK(files == std::set<std::string>{"blocks.csv", "blocks.json", "cut.json", "cut.png", "cut.svg",
                                         "model.toml", "report.txt", "slivers.csv", "talus_manifest.txt"});
    CHECK(read_text_file(f / "out/model.toml") == read_text_file(model));
    has(o.text, read_text_file(f / "out/report.txt"));
    has(o.text, "written to out:");
    const auto summary = nlohmann::json::parse(read_text_file(f / "out/cut.json"));
    const auto blocks = nlohmann::json::parse(read_text_file(f / "out/blocks.json"));
    const auto count = summary["after"]["blocks"].get<size_t>();
    CHECK(count > 100);
    CHECK(blocks["blocks"].size() == count);
    CHECK(lines(read_text_file(f / "out/blocks.csv")) == count + 1);
    has(o.text, fmt::format("blocks     {}, ", count));
    CHECK(lines(read_text_file(f / "out/slivers.csv")) ==
          1 + summary["slivers"]["merged"].get<size_t>() + summary["slivers"]["kept"].get<size_t>());
    has(read_text_file(f / "out/cut.svg"), "<svg");
    CHECK(fs::file_size(f / "out/cut.png") > 5000);
  }
  // the tunnel has no stage: that is no matter of the cut, but of check and run
  has(shell(f, fmt::format("$talus check {}", kTunnel)).text, "the file has no [[stage]]");
}

// A program in the place of the one that opens pages: it notes what it was given.
std::string with_opener(const Folder& f) {
  fs::create_directories(f / "bin");
  write_file(f / "bin/xdg-open", "#!/bin/sh\necho \"$1\" > opened.part && mv opened.part opened\n");
  fs::permissions(f / "bin/xdg-open", fs::perms::owner_all);
  return "PATH=$PWD/bin:$PATH DISPLAY=:0 ";
}

TEST_CASE("command: --open writes the section as a page and opens it, of a cut and of a check") {
  if (!page_was_built()) return;
  const Folder f;
  const std::string section = std::string(TALUS_SOURCE_DIR) + "/tests/fixtures/section.toml";
  for (const char* verb : {"cut", "check"}) {
    const Outcome o =
        shell(f, with_opener(f) + fmt::format("$talus {} {} -o {} --open; for k in $(seq 100); do [ "
                                              "-e opened ] && break; sleep 0.05; done; cat opened",
                                              verb, section, verb));
    CHECK(o.code == 0);
    has(o.text, fmt::format("opened in a browser: {}/section.html", verb));
    has(o.text, (f / verb / "section.html").string());  // what the opener was given
    CHECK(read_text_file(f / verb / "section.html").find("talus-index") != std::string::npos);
    fs::remove(f / "opened");
    // the page belongs to the results: it goes with them
    CHECK(shell(f, fmt::format("$talus {} {} -o {} --force", verb, section, verb)).code == 0);
    CHECK(!fs::exists(f / verb / "section.html"));
  }
}

TEST_CASE("command: --open without a screen says which file to open") {
  if (!page_was_built()) return;
  const Folder f;
  const Outcome o = shell(f, fmt::format("DISPLAY= WAYLAND_DISPLAY= $talus cut {} -o out --open", kSettle));
  CHECK(o.code == 0);
  has(o.text, "open in a browser: out/section.html");
  const Outcome none =
      shell(f, fmt::format("DISPLAY=:0 PATH=/nowhere $talus cut {} -o out2 --open", kSettle));
  CHECK(none.code == 0);
  has(none.text, "open in a browser: out2/section.html");
}

TEST_CASE("command: check --open wants a folder, cut of blocks points to it") {
  const Folder f;
  const Outcome o = shell(f, fmt::format("$talus check {} --open", kSettle));
  CHECK(o.code == 2);
  has(o.text, "give it by -o DIR");
  const Outcome blocks = shell(f, fmt::format("$talus cut {}impact_bar/impact_bar.toml -o out", kExamples));
  CHECK(blocks.code == 3);
  has(blocks.text, "talus check FILE -o DIR --open");
}

TEST_CASE("command: cut twice gives the same bytes, of every file") {
  const Folder f;
  for (const std::string name : {"tunnel", "slope", "cavern", "wall", "specimen", "arch", "settle"}) {
    CAPTURE(name);
    for (const char* out : {"a", "b"})
      CHECK(shell(f, fmt::format("$talus cut {0}{1}/{1}.toml -o {2}_{1}", kExamples, name, out)).code == 0);
    for (const auto& e : fs::directory_iterator(f / ("a_" + name))) {
      const std::string file = e.path().filename().string();
      CAPTURE(file);
      CHECK(read_text_file(e.path()) == read_text_file(f / ("b_" + name) / file));
    }
  }
}

TEST_CASE("command: cut replaces its own results only") {
  const Folder f;
  const std::string cut = fmt::format("$talus cut {} -o ", kSettle);
  CHECK(shell(f, cut + "out").code == 0);
  const Outcome again = shell(f, cut + "out");
  CHECK(again.code == 4);
  has(again.text, "out: exists already; nothing was run. Give another folder with -o, or --force");
  CHECK(shell(f, cut + "out --force").code == 0);
  // results of a run are none of a cut, and the other way round
  CHECK(shell(f, fmt::format("$talus run {} -o run -q {}", kSettle, kShort)).code == 0);
  CHECK(shell(f, cut + "run").code == 4);
  const Outcome over_run = shell(f, cut + "run --force");
  CHECK(over_run.code == 4);
  has(over_run.text, "run: holds results of talus run, which --force of talus cut does not replace");
  CHECK(fs::exists(f / "run/histories.csv"));
  CHECK(!fs::exists(f / "run/blocks.json"));
  CHECK(shell(f, fmt::format("$talus run {} -o out -q --force {}", kSettle, kShort)).code == 4);
  CHECK(fs::exists(f / "out/blocks.json"));
  // a folder of somebody else stays as it is
  const Outcome foreign = shell(f, "mkdir mine && echo x > mine/x && " + cut + "mine --force");
  CHECK(foreign.code == 4);
  has(foreign.text, "mine: is not empty and holds no results of talus");
  CHECK(read_text_file(f / "mine/x") == "x\n");
  CHECK(!fs::exists(f / "mine/cut.json"));
}

TEST_CASE("command: exit codes of cut") {
  const Folder f;
  write_file(f / "wrong.toml", kMixed + "[[joint_set]]\nname = \"flat\"\nangle = 0\nspacing = -1\n");
  const Outcome wrong = shell(f, "$talus cut wrong.toml -o out");
  CHECK(wrong.code == 3);
  has(wrong.text, "wrong.toml:76:11: error: joint_set.flat.spacing: -1 m is not allowed; must be > 0 m");
  has(wrong.text, "wrong.toml: 1 error; nothing was run");
  write_file(f / "empty.toml", "talus = 1\n");
  const Outcome empty = shell(f, "$talus cut empty.toml -o out");
  CHECK(empty.code == 3);
  has(empty.text,
      "empty.toml:1:1: error: region: the file has no [[region]] or [[arch]]: there is nothing to cut");
  CHECK(!fs::exists(f / "out"));

  for (const char* line : {"$talus cut", "$talus cut m.toml", "$talus cut m.toml -o out more",
                           "$talus cut m.toml --out x", "$talus cut m.toml -o out --quiet"})
    CHECK(shell(f, line).code == 2);
  has(shell(f, "$talus cutt m.toml").text, "did you mean \"cut\"?");
  has(shell(f, "$talus cut --help").text, "Example: talus cut");

  const Outcome missing = shell(f, "$talus cut nothing.toml -o out");
  CHECK(missing.code == 4);
  has(missing.text, "nothing.toml: cannot be read: No such file or directory");
  CHECK(shell(f, "$talus cut . -o out").code == 4);
  for (const char* folder : {"wrong.toml", "wrong.toml/below", "/proc/talus/below"}) {
    const Outcome o = shell(f, fmt::format("$talus cut {} -o {}", kSettle, folder));
    CHECK(o.code == 4);
    has(o.text, fmt::format("talus: {}: ", folder));
  }
}

TEST_CASE("command: warnings of the cut are told and do not stop it") {
  const Folder f;
  write_file(f / "m.toml", kMixed);
  const Outcome o = shell(f, "$talus cut m.toml -o out --set 'cut.grid=20 mm'");
  CHECK(o.code == 0);
  has(o.text, "warning: cut.grid: 0.0156 m is coarse for a model of 20 m");
  has(o.text, "from --set cut.grid=20 mm");
  CHECK(fs::exists(f / "out/blocks.json"));
}

TEST_CASE("command: a run from a blocks file has the bits of the run that cuts") {
  const Folder f;
  CHECK(shell(f, fmt::format("$talus cut {} -o cut", kSettle)).code == 0);
  CHECK(shell(f, fmt::format("$talus run {} -o a -q {}", kSettle, kShort)).code == 0);
  CHECK(shell(f, fmt::format("$talus run {} -o b -q {} --set \"cut.blocks=\\\"$PWD/cut/blocks.json\\\"\"",
                             kSettle, kShort))
            .code == 0);
  CHECK(lines(read_text_file(f / "a/histories.csv")) > 5);
  for (const char* file : {"histories.csv", "steps.csv"})
    CHECK(read_text_file(f / "a" / file) == read_text_file(f / "b" / file));
}

TEST_CASE("command: blocks, regions, supports along and monitors work from a blocks file") {
  const Folder f;
  fs::create_directories(f / "model");
  write_file(f / "model/m.toml", kMixed);
  const Outcome cut = shell(f, "$talus cut model/m.toml -o model/cut");
  CHECK(cut.code == 0);
  has(cut.text, "holes      2 opened by short glued cuts");
  has(cut.text, "openings   1 taken out");
  has(read_text_file(f / "model/cut/blocks.csv"), "\ncore[");
  CHECK(shell(f, "$talus run model/m.toml -o a -q").code == 0);
  // the path is taken from the place of the model file
  CHECK(shell(f, "$talus run model/m.toml -o b -q --set cut.blocks=cut/blocks.json").code == 0);
  CHECK(read_text_file(f / "a/histories.csv") == read_text_file(f / "b/histories.csv"));
  const CsvTable histories = read_csv(f / "b/histories.csv");
  for (const char* column :
       {"top.velocity_y [m/s]", "held.reaction_x [N]", "under.force_y [N]", "stress.stress_yy [Pa]"})
    CHECK(histories.column(column).back() != 0);
  // cutting goes on to cut, whatever blocks file the model names
  CHECK(shell(f, "$talus cut model/m.toml -o c --set cut.blocks=cut/blocks.json").code == 0);
  CHECK(read_text_file(f / "c/blocks.json") == read_text_file(f / "model/cut/blocks.json"));
}

TEST_CASE("command: a blocks file outlives values, not the shapes it was cut from") {
  const Folder f;
  write_file(f / "m.toml", kMixed);
  CHECK(shell(f, "$talus cut m.toml -o cut").code == 0);
  const auto check = [&](const std::string& item) {
    return shell(f, fmt::format("$talus check m.toml --set cut.blocks=cut/blocks.json --set '{}'", item));
  };
  for (const char* item :
       {"material.stone.young=8 GPa", "joint.weak.friction_angle=20 deg", "joint_set.steep.joint=rough",
        "region.rock.joint=weak", "region.cover.kind=deformable", "opening.core.joint=rough",
        "stage.go.duration=1 ms", "support.sides.along=right", "block.floor.kind=rigid"}) {
    CAPTURE(item);
    CHECK(check(item).code == 0);
  }
  for (const char* item :
       {"joint_set.steep.spacing=5 m", "joint_set.steep.angle.mean=81 deg", "joint_set.steep.name=other",
        "region.rock.polygon=[[0,0],[20,0],[20,12],[0,11.9]]",
        "region.rock.sides=[\"a\",\"b\",\"c\",\"left\"]", "opening.tunnel.segments=16",
        "opening.tunnel.rock=kept", "cut.seed=2", "cut.slivers=delete", "cut.grid=1 mm"}) {
    const Outcome o = check(item);
    INFO(item, "\n", o.text);
    CHECK(o.code == 3);
    has(o.text, "error: cut.blocks: \"cut/blocks.json\" was cut from other regions, joints or settings");
    has(o.text, "= cut again with talus cut, or undo the change");
  }
}

TEST_CASE("command: damaged blocks files are refused") {
  CHECK(check_changed([](auto&) {}).code == 0);
  const std::vector<std::function<void(nlohmann::json&)>> changes = {
      [](auto& j) {
        j = {1, 2};
      },
      [](auto& j) { j["talus_blocks"] = 1; },
      [](auto& j) { j.erase("cut"); },
      [](auto& j) { j["grid"] = 0; },
      [](auto& j) { j["points"][5][0] = "x"; },
      [](auto& j) { j["blocks"][3]["points"][0] = 1000000; },
      [](auto& j) { j["blocks"][3]["points"][0] = -1; },
      [](auto& j) { j["blocks"][3]["origins"][0] = 99; },
      [](auto& j) { j["blocks"][3]["region"] = 9; },
      [](auto& j) { j["blocks"][3]["opening"] = 9; },
  };
  for (const auto& change : changes) {
    const Outcome o = check_changed(change);
    CHECK(o.code == 3);
    has(o.text, "error: cut.blocks: \"b.json\" is no blocks file of talus");
    has(o.text, "= write it with talus cut");
  }
  const Folder f;
  write_file(f / "m.toml", kMixed);
  const std::string check = "$talus check m.toml --set cut.blocks=b.json";
  for (const char* make :
       {"head -c 900 cut/blocks.json > b.json", ": > b.json", "cp cut/blocks.csv b.json", "rm b.json"}) {
    const Outcome o =
        shell(f, fmt::format("$talus cut m.toml -o cut --force > /dev/null; {}; {}", make, check));
    CHECK(o.code != 0);
    has(o.text, "b.json");
  }
}

TEST_CASE("command: overrides reach scattered quantities and list entries by name or number") {
  const Folder f;
  write_file(f / "m.toml", kMixed);
  const auto blocks = [&](const std::string& item) {
    const Outcome o = shell(f, fmt::format("$talus cut m.toml -o out --force --set '{}'", item));
    INFO(item, "\n", o.text);
    CHECK(o.code == 0);
    has(read_text_file(f / "out/model.toml"), "# --set " + item);
    return nlohmann::json::parse(read_text_file(f / "out/blocks.json"))["blocks"].size();
  };
  const size_t as_written = blocks("joint_set.steep.spacing={ mean = \"6 m\", uniform = \"1 m\" }");
  CHECK(blocks("joint_set.steep.spacing={ exponential = \"2 m\" }") > as_written);
  CHECK(blocks("joint_set.steep.spacing=1 m") > as_written);
  CHECK(blocks("joint_set.0.spacing=1 m") == blocks("joint_set.steep.spacing=1 m"));
  CHECK(blocks("joint_set.steep.spacing.mean=2 m") > as_written);
  CHECK(blocks("opening.tunnel.rock=kept") == as_written + 1);
  CHECK(blocks("region.rock.polygon=[[0,0],[20,0],[20,30],[0,12]]") != as_written);
  const auto refused = [&](const std::string& item, const std::string& why) {
    const Outcome o = shell(f, fmt::format("$talus cut m.toml -o no --set '{}'", item));
    CHECK(o.code == 3);
    has(o.text, why);
    has(o.text, "from --set " + item);
  };
  refused("joint_set.steep.spacing=-1",
          "m.toml: error: joint_set.steep.spacing: -1 m is not allowed; must be > 0 m");
  refused("joint_set.step.spacing=1", "no joint_set is called \"step\"");
  refused("joint_set.steep.region=rok", "joint_set.steep.region: there is no region called \"rok\"");
  refused("opening.tunnel.width=1", "opening.tunnel.width: does not belong to shape = \"circle\"");
  CHECK(!fs::exists(f / "no"));
}

TEST_CASE("command: check counts cut blocks with the others") {
  const Folder f;
  write_file(f / "m.toml", kMixed);
  CHECK(shell(f, "$talus cut m.toml -o cut").code == 0);
  const auto cut = nlohmann::json::parse(read_text_file(f / "cut/cut.json"))["after"]["blocks"].get<int>();
  has(shell(f, "$talus check m.toml").text, fmt::format("blocks     {}; ", cut + 1));
  has(shell(f, "$talus check m.toml --set cut.blocks=cut/blocks.json").text,
      fmt::format("blocks     {}; ", cut + 1));
}

TEST_CASE("command: two sets of joints 3 mm apart are refused at once") {
  // 7e9 blocks in the tunnel example; each set alone is below the limit of traces
  const Folder f;
  const Outcome o = shell(f, fmt::format("timeout 10 $talus cut {} -o out --set 'joint_set.steep.spacing=3 "
                                         "mm' --set 'joint_set.flat.spacing=3 mm'",
                                         kTunnel));
  CHECK(o.code == 3);
}

TEST_CASE("command: joints that begin far away do not hang") {
  const Folder f;
  const Outcome o =
      shell(f, fmt::format("timeout 2 $talus cut {} -o out --set 'joint_set.steep.trace_length=5 m' --set "
                           "'joint_set.steep.start=1e10 m'",
                           kTunnel));
  CHECK((o.code == 0 || o.code == 3));
}

TEST_CASE("command: --force keeps the blocks file that the run reads") {
  const Folder f;
  write_file(f / "m.toml", kMixed);
  CHECK(shell(f, "$talus cut m.toml -o out").code == 0);
  shell(f, "$talus run m.toml -o out --force -q --set cut.blocks=out/blocks.json");
  CHECK(fs::exists(f / "out/blocks.json"));
}

TEST_CASE("command: a missing blocks file is told at its key") {
  const Folder f;
  write_file(f / "m.toml", "talus = 1\n[cut]\nblocks = \"b.json\"\n" + kMixed.substr(kMixed.find("[model]")));
  std::string text = read_text_file(f / "m.toml");
  write_file(f / "m.toml", text.erase(text.find("[cut]\nseed = 1\n"), 15));
  has(shell(f, "$talus check m.toml").text, "m.toml:3:1: error: cut.blocks: ");
}

TEST_CASE("command: a point moved in the blocks file is noticed") {
  CHECK(check_changed([](auto& j) {
          j["points"][5][1] = j["points"][5][1].template get<double>() + 0.3;
        }).code == 3);
}

TEST_CASE("command: a block twice in the blocks file is noticed") {
  CHECK(check_changed([](auto& j) { j["blocks"].push_back(j["blocks"][4]); }).code == 3);
}

TEST_CASE("command: a wrong part of a scattered override names --set") {
  const Folder f;
  write_file(f / "m.toml", kMixed);
  has(shell(f, "$talus check m.toml --set joint_set.steep.angle.mean=60").text,
      "from --set joint_set.steep.angle.mean=60");
}

}  // namespace test_cut_command
