// Runs that branch off from the saved state of another one.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <set>

#include "support/command.h"
#include "support/results.h"
#include "support/shaken_bricks.h"
#include "talus/output/archive.h"

namespace test_branch {

using namespace talus;
using namespace talus::test;

namespace fs = std::filesystem;

namespace {

void write_model(const Folder& folder, const std::string& text, const std::string& name = "model.toml") {
  std::ofstream(folder / name) << text;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  REQUIRE(text.find(what) != std::string::npos);
  return text.replace(text.find(what), what.size(), by);
}

// Its rows are the last ones of the whole run's table.
void check_ends_as(const std::string& table, const std::string& whole) {
  const size_t begin = table.find('\n') + 1;
  CHECK((table.substr(0, begin) == whole.substr(0, begin)));
  REQUIRE(table.size() > begin);
  const std::string rows = table.substr(begin);
  REQUIRE(whole.size() > rows.size());
  CHECK((whole.compare(whole.size() - rows.size(), rows.size(), rows) == 0));
}

// The state in which two runs ended, number by number; what each notes of itself, and clocks, left out.
void same_end(const fs::path& a, const fs::path& b) {
  const Archive x = read_archive(a / "saved/stage_03.h5"), y = read_archive(b / "saved/stage_03.h5");
  size_t compared = 0;
  for (const auto& [name, numbers] : x.numbers) {
    if (name.rfind("state.", 0) != 0) continue;
    INFO(name);
    REQUIRE(y.numbers.count(name));
    const std::vector<double>& others = y.numbers.at(name);
    REQUIRE(numbers.size() == others.size());
    // bit by bit: places of what slid are no numbers
    CHECK(std::memcmp(numbers.data(), others.data(), numbers.size() * sizeof(double)) == 0);
    ++compared;
  }
  CHECK(compared > 50);
}

}  // namespace

TEST_CASE("command run --from -o: a branch with nothing changed has the bits of the unbroken run" *
          doctest::test_suite("optimised")) {
  Folder folder;
  write_model(folder, kShakenBricks);
  REQUIRE(shell(folder, "$talus run model.toml -o whole -q").code == 0);
  const auto whole = results_in(folder / "whole");
  std::set<std::string> states;
  for (const auto& entry : fs::directory_iterator(folder / "whole/saved"))
    states.insert(entry.path().filename().string());
  REQUIRE(states.size() >= 4);  // three ends of stages, and in between
  for (const std::string& state : states) {
    INFO(state);
    const Outcome o =
        shell(folder, fmt::format("$talus run model.toml --from whole/saved/{} -o b --force", state));
    INFO(o.text);
    CHECK(o.code == 0);
    has(o.text, "branches off from whole/saved/" + state);
    if (state != "stage_03.h5") {
      same_end(folder / "whole", folder / "b");
      for (const char* table : {"histories.csv", "steps.csv"})
        check_ends_as(content(folder / "b" / table), whole.at(table));
    }
    const std::string summary = content(folder / "b/summary.json");
    has(summary, "\"branch\": {");
    has(summary, "\"differs\": []");
    for (const char* file : {"blocks.csv", "blocks_start.svg", "blocks_end.svg", "fields/blocks.pvd"})
      CHECK(fs::exists(folder / "b" / file));
  }
  // the parent is read only
  CHECK((results_in(folder / "whole") == whole));
}

TEST_CASE(
    "command run --from -o: what begins later may differ, with the bits of a run that differs from the start") {
  Folder folder;
  write_model(folder, kShakenBricks);
  REQUIRE(shell(folder, "$talus run model.toml -o parent -q").code == 0);
  std::string text = replaced(kShakenBricks, "0.4*sin(40*t)", "0.6*sin(30*t)");
  text = replaced(text, "duration = \"0.2 s\"", "duration = \"0.25 s\"\ndamping_mass = 2");
  text = replaced(text, "[[monitor]]\nname = \"width\"",
                  "[[monitor]]\nname = \"edge\"\npoint = [0.1, 2.9]\n[[monitor]]\nname = \"width\"");
  text +=
      "[[load]]\nname = \"gust\"\nedge = [[0, 0], [0, 3]]\npressure = \"1 kPa\"\nstages = [\"shake\"]\n"
      "[[change]]\nstage = \"shake\"\njoint = \"face\"\nfriction_angle = \"25 deg\"\n"
      "[[stage]]\nname = \"after\"\nkind = \"dynamic\"\nduration = \"10 ms\"\ntime_step = \"0.1 ms\"\n";
  write_model(folder, text, "other.toml");
  REQUIRE(shell(folder, "$talus run other.toml -o whole -q").code == 0);
  const Outcome o = shell(folder, "$talus run other.toml --from parent/saved/stage_02.h5 -o b");
  INFO(o.text);
  CHECK(o.code == 0);
  same_end(folder / "whole", folder / "b");
  CHECK(content(folder / "b/blocks_end.svg") == content(folder / "whole/blocks_end.svg"));
  const std::string summary = content(folder / "b/summary.json");
  for (const char* key :
       {"history.shake.expression: '0.6*sin(30*t)", "stage.shake.damping_mass: 2, was not given",
        "monitor.edge.point", "load.gust.pressure", "change.0.friction_angle", "stage.after.duration"})
    has(summary, key);
  has(summary, "\"stage\": \"dig\"");
}

TEST_CASE(
    "command run --from -o: what says how the state came to be is refused by key, and nothing is written") {
  Folder folder;
  write_model(folder, kShakenBricks);
  REQUIRE(shell(folder, "$talus run model.toml -o parent -q").code == 0);
  const auto parent = results_in(folder / "parent");
  std::string step;
  for (const auto& entry : fs::directory_iterator(folder / "parent/saved"))
    if (entry.path().filename().string().rfind("step_", 0) == 0) step = entry.path().filename().string();
  REQUIRE(!step.empty());
  const auto refused = [&](const std::string& text, const std::string& state, const std::string& piece) {
    write_model(folder, text, "other.toml");
    const Outcome o = shell(folder, fmt::format("$talus run other.toml --from parent/saved/{} -o b", state));
    INFO(o.text);
    CHECK(o.code == 3);
    has(o.text, piece);
    CHECK(!fs::exists(folder / "b"));
  };
  const std::string at_rest = "stage_02.h5",
                    gust = "[[load]]\nname = \"gust\"\nedge = [[0, 0], [0, 3]]\npressure = \"1 kPa\"\n";
  refused(replaced(kShakenBricks, "2500", "2600"), at_rest, "material.rock.density: 2600, was 2500");
  refused(replaced(kShakenBricks, "\"20 kPa\"", "\"10 kPa\""), at_rest,
          "joint.face.cohesion: '10 kPa', was '20 kPa'");
  refused(replaced(kShakenBricks,
                   "name = \"rest\"\nkind = \"static\"\nintegration = \"dynamic\"\nduration = \"1 s\"",
                   "name = \"rest\"\nkind = \"static\"\nintegration = \"dynamic\"\nduration = \"2 s\""),
          at_rest, "stage.rest.duration");
  refused(replaced(kShakenBricks, "\"10 ms\", 1]", "\"20 ms\", 1]"), at_rest, "stage.dig.relaxation");
  refused(replaced(kShakenBricks, "name = \"dig\"", "name = \"digs\""), at_rest,
          "stage.dig: is not stage 2 any more");
  refused(kShakenBricks + gust, at_rest, "load.gust.edge");
  refused(kShakenBricks + gust + "stages = [\"dig\", \"shake\"]\n", at_rest, "load.gust.pressure");
  refused(kShakenBricks + "[[change]]\nstage = \"dig\"\njoint = \"face\"\nfriction_angle = \"25 deg\"\n",
          at_rest, "change.0.friction_angle");
  refused(replaced(kShakenBricks, "0.4*sin(40*t)*(t<0.1?t/0.1:1)", "0.4*cos(40*t)"), at_rest,
          "history.shake: begins at");
  refused(replaced(kShakenBricks, "0.4*sin(40*t)", "0.6*sin(40*t)"), step, "history.shake.expression");
  refused(replaced(kShakenBricks, "cells = [4, 6]", "cells = [4, 5]"), at_rest, "grid.wall.cells");
  CHECK((results_in(folder / "parent") == parent));

  // bolts that are there know the others by their number
  Folder bolted;
  write_model(bolted, bolted_bricks());
  REQUIRE(shell(bolted, "$talus run model.toml -o parent -q").code == 0);
  write_model(bolted, replaced(bolted_bricks(), "from = [2.3, 3]", "from = [2.4, 3]"), "other.toml");
  const Outcome o = shell(bolted, "$talus run other.toml --from parent/saved/stage_01.h5 -o b");
  CHECK(o.code == 3);
  has(o.text, "bolt.pin.from");
}

TEST_CASE("command run --from -o: wrong use of a branch") {
  Folder folder;
  write_model(folder, kShakenBricks);
  REQUIRE(shell(folder, "$talus run model.toml -o parent -q").code == 0);
  const std::string line = "$talus run model.toml --from parent/saved/stage_02.h5 -o ";
  const auto refused = [&](const std::string& command, int code, const std::string& piece) {
    const Outcome o = shell(folder, command);
    INFO(command);
    INFO(o.text);
    CHECK(o.code == code);
    has(o.text, piece);
  };
  refused("$talus run model.toml --from parent/saved/no.h5 -o b", 4, "no.h5");
  refused("echo nothing > t.h5; $talus run model.toml --from t.h5 -o b", 4, "another program has written it");
  refused("head -c 5000 parent/saved/stage_02.h5 > s.h5; $talus run model.toml --from s.h5 -o b", 4,
          "cut short");
  refused("$talus run model.toml --from parent/saved/stage_02.h5 -o parent --force", 2, "give one of them");
  CHECK(!fs::exists(folder / "b"));
  refused("mkdir b; echo mine > b/notes.txt; " + line + "b", 4, "b");
  CHECK(fs::exists(folder / "b/notes.txt"));
  CHECK(shell(folder, line + "c -q").code == 0);
  refused(line + "c", 4, "--force");
  CHECK(shell(folder, line + "c -q --force").code == 0);
  // a copy of a state anywhere is as good as the state
  CHECK(shell(folder, "cp parent/saved/stage_02.h5 . && $talus run model.toml --from stage_02.h5 -o d -q")
            .code == 0);
  // a branch of a branch, and one that goes on where it was
  CHECK(shell(folder, "$talus run model.toml --from c/saved/stage_03.h5 -o e -q").code == 0);
  CHECK(shell(folder, "$talus run model.toml --from c/saved/stage_03.h5 -q").code == 0);
  const Outcome o = shell(folder, "$talus report c && $talus plot c && $talus audit c");
  INFO(o.text);
  CHECK(o.code == 0);
}

}  // namespace test_branch
