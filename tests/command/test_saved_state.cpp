// Runs that are stopped or killed go on from a saved state, and come to the same bits.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "support/closing_jaws.h"
#include "support/command.h"
#include "support/relative.h"
#include "support/results.h"
#include "support/shaken_bricks.h"
#include "talus/base/clock.h"
#include "talus/base/random.h"
#include "talus/base/text_file.h"
#include "talus/output/archive.h"

namespace test_saved_state {

using namespace talus;
using namespace talus::test;

namespace fs = std::filesystem;

namespace {

const std::string& kModel = kShakenBricks;
std::string bolted_model() { return bolted_bricks(); }

void write_model(const Folder& folder, const std::string& text = kModel) {
  std::ofstream(folder / "model.toml") << text;
}

void same(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
  for (const auto& [name, text] : a) {
    INFO(name);
    REQUIRE(b.count(name));
    CHECK((text == b.at(name)));
  }
  CHECK(a.size() == b.size());
}

std::vector<fs::path> saved_in(const fs::path& folder) {
  std::vector<fs::path> list;
  std::error_code ec;
  for (const auto& entry : fs::directory_iterator(folder / "saved", ec))
    if (entry.path().extension() == ".h5") list.push_back(entry.path());
  std::sort(list.begin(), list.end(), [](const fs::path& a, const fs::path& b) {
    return fs::last_write_time(a) < fs::last_write_time(b);
  });
  return list;
}

// Runs model.toml, then goes on from every state saved on the way. The results of the whole run.
std::map<std::string, std::string> goes_on_from_each_state(const Folder& folder) {
  REQUIRE(shell(folder, "$talus run model.toml -o whole -q").code == 0);
  const auto whole = results_in(folder / "whole");
  const auto states = saved_in(folder / "whole");
  REQUIRE(states.size() >= 2);  // ends of stages, and in between
  for (const fs::path& state : states) {
    INFO(state.filename().string());
    fs::remove_all(folder / "again");
    fs::copy(folder / "whole", folder / "again", fs::copy_options::recursive);
    const Outcome o = shell(
        folder, fmt::format("$talus run model.toml --from again/saved/{} -q", state.filename().string()));
    INFO(o.text);
    CHECK(o.code == 0);
    same(whole, results_in(folder / "again"));
  }
  return whole;
}

}  // namespace

TEST_CASE("command run --from: every saved state leads to the same bits") {
  Folder folder;
  write_model(folder);
  goes_on_from_each_state(folder);
}

TEST_CASE("command run --from: the same bits from within static stages whose steps begin at rest") {
  Folder folder;
  std::string text = kModel;
  const std::string found = "integration = \"dynamic\"\n", other = "integration = \"implicit\"\n";
  for (size_t at = 0; (at = text.find(found, at)) != std::string::npos; at += other.size())
    text.replace(at, found.size(), other);
  const auto replace = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("save_interval = \"20 ms\"", "save_interval = \"1 us\"");
  replace("duration = \"0.2 s\"", "duration = \"2 ms\"");
  write_model(folder, text);
  goes_on_from_each_state(folder);
}

TEST_CASE("command run --from: the same bits with bolts and joints that weaken" *
          doctest::test_suite("optimised")) {
  Folder folder;
  write_model(folder, bolted_model());
  const auto whole = goes_on_from_each_state(folder);
  // what the states have to keep does happen
  has(whole.at("bolts.csv"), "yielded");
  has(whole.at("bolts.csv"), "ruptured");
  has(whole.at("joints.csv"), "slipped");
  has(whole.at("joints.csv"), "open");
  CHECK(whole.count("fields/bolts.pvd"));
  CHECK(whole.at("summary.json").find("\"bond_faces_broken\": 0,") == std::string::npos);
  const std::string from = " --from again/saved/stage_02.h5";
  const auto refused = [&](const std::string& file) {
    fs::remove_all(folder / "again");
    fs::copy(folder / "whole", folder / "again", fs::copy_options::recursive);
    std::ofstream(folder / "again" / file) << "short\n";
    const Outcome o = shell(folder, "$talus run model.toml" + from);
    CHECK(o.code == 4);
    has(o.text, file);
    has(o.text, "cannot be continued");
  };
  refused("joints.csv");
  refused("slips.csv");
  refused("bolts.csv");
}

TEST_CASE("command run: killed at fifty random moments, results can be read and the run goes on") {
  // a smaller wall, shaken for less: a seventh of a second
  std::string text = kModel;
  const auto put = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("cells = [4, 6]", "cells = [2, 2]");
  put("duration = \"0.2 s\"", "duration = \"0.05 s\"");
  put("field_interval = \"20 ms\"", "field_interval = \"5 ms\"");
  put("save_interval = \"20 ms\"", "save_interval = \"10 ms\"");
  Folder folder;
  write_model(folder, text);
  const double begin = wall_now();
  REQUIRE(shell(folder, "$talus run model.toml -o whole -q").code == 0);
  double length = wall_now() - begin;  // [s] of wall time
  const auto whole = results_in(folder / "whole");

  // A run that was killed goes on from its last state, is killed again, and so on until one comes to its
  // end, with the results of the run that was left alone.
  constexpr int kKilled = 137;
#ifdef __SANITIZE_ADDRESS__  // whose runs take ten times as long
  constexpr int kKills = 10;
#else
  constexpr int kKills = 50;
#endif
  Random random(7);
  int kills = 0, gone_on = 0, ended = 0;
  std::string from;
  for (int tries = 0; kills < kKills && tries < 500; ++tries) {
    const std::string line =
        "$talus run model.toml -q " + (from.empty() ? "-o killed --force" : "--from " + from);
    const double started = wall_now();
    const Outcome o = shell(
        folder, fmt::format("{} & p=$!; sleep {:.4f}; kill -9 $p; wait $p", line, length * random.uniform()));
    INFO(line, "\n", o.text);
    REQUIRE((o.code == kKilled || o.code == 0));
    gone_on += !from.empty();
    kills += o.code == kKilled;
    if (o.code == 0) {
      same(whole, results_in(folder / "killed"));
      ++ended;
      if (from.empty()) length = wall_now() - started;  // the machine may be busier or idler by now
    } else {
      check_begins_as(folder / "killed", whole);
    }
    const auto states = saved_in(folder / "killed");
    from = o.code == 0 || states.empty() ? "" : "killed/saved/" + states.back().filename().string();
    if (from.empty()) fs::remove_all(folder / "killed");
  }
  if (!from.empty()) {
    REQUIRE(shell(folder, "$talus run model.toml -q --from " + from).code == 0);
    same(whole, results_in(folder / "killed"));
  }
  CHECK(kills == kKills);
  CHECK(gone_on >= kKills / 5);
  CHECK(ended >= 1);
  MESSAGE(kills, " kills, ", gone_on, " runs went on from a saved state, ", ended, " came to their end");
}

TEST_CASE("command run: a wedge that slides is a mechanism, and a stone that falls is followed") {
  const auto model = [](const std::string& stone) {
    return "talus = 1\n[model]\ngravity = [0, -10]\n[material.m]\ndensity = 2500\n"
           "[joint.plane]\nfriction_angle = \"30 deg\"\n[contact]\njoint = \"plane\"\n"
           "[[block]]\nname = \"base\"\npolygon = [[-9, -9], [9, -9], [9, 9]]\nmaterial = \"m\"\nkind = "
           "\"fixed\"\n[[block]]\nname = \"stone\"\npolygon = " +
           stone +
           "\nmaterial = \"m\"\nkind = \"rigid\"\n"
           "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 1\n";
  };
  Folder folder;
  write_model(folder, model("[[0, 0], [4, 4], [2, 4]]"));
  const Outcome o = shell(folder, "$talus run model.toml -o out");
  INFO(o.text);
  CHECK(o.code == 6);
  has(o.text,
      "static stage \"rest\" finds no balance: a mechanism. 1 block, 4 m2 (100 % of what can move), slides, on joint \"plane\"; farthest \"stone\"");
  has(o.text, "along (-0.71, -0.71)");
  CHECK(fs::exists(folder / "out/blocks_end.svg"));
  write_model(folder, model("[[0, 2], [1, 2], [1, 3], [0, 3]]"));
  const Outcome falls = shell(folder, "$talus run model.toml -o falls");
  INFO(falls.text);
  CHECK(falls.code == 5);  // in a second it does not come to rest
  has(falls.text, "no balance near: 1 block, 1 m2 (100 % of what can move), falls; farthest \"stone\"");
  has(falls.text, "followed by damped motion");
  const auto summary = nlohmann::json::parse(read_text_file(folder / "falls/summary.json"));
  CHECK(summary["stages"][0]["steps_from_rest"] > 1);
  CHECK(summary["stages"][0]["followed_from [s]"] > 0);
}

TEST_CASE(
    "command run: a crumb that falls is named, not waited for, and a run goes on with the same bits behind it") {
  Folder folder;
  write_model(
      folder,
      "talus = 1\n[model]\ngravity = [0, -10]\n[material.m]\ndensity = 2500\n[joint.j]\n"
      "friction_angle = \"30 deg\"\nnormal_stiffness = 1e9\nshear_stiffness = 1e9\n[contact]\njoint = \"j\"\n"
      "[[block]]\nname = \"base\"\npolygon = [[-9, -9], [9, -9], [9, 0], [-9, 0]]\nmaterial = \"m\"\n"
      "kind = \"fixed\"\n[[block]]\nname = \"tower\"\npolygon = [[-4, 0], [-2, 0], [-2, 3], [-4, 3]]\n"
      "material = \"m\"\nkind = \"rigid\"\n[[block]]\nname = \"crumb\"\n"
      "polygon = [[4, 6], [4.1, 6], [4.1, 6.1], [4, 6.1]]\nmaterial = \"m\"\nkind = \"rigid\"\n"
      "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 5\n"
      "[[stage]]\nname = \"fall\"\nkind = \"dynamic\"\nduration = 0.1\ntime_step = 0.01\n"
      "[output]\nsave_interval = \"1 ms\"\n");
  const Outcome o = shell(folder, "$talus run model.toml -o out");
  INFO(o.text);
  CHECK(o.code == 0);
  has(o.text, "rest: not waited for: 1 block, 0.01 m2 (0.166 % of what can move), falls; farthest \"crumb\"");
  has(o.text, "  not waited for  stage \"rest\": 1 block, 0.01 m2");
  const auto stage = nlohmann::json::parse(read_text_file(folder / "out/summary.json"))["stages"][0];
  CHECK(stage["at_rest"] == true);
  CHECK(stage["left_out_share"].get<double>() == approx(0.01 / 6.01));
  const Outcome waits =
      shell(folder,
            "$talus run model.toml -o waits --set stage.rest.strict_rest=true --set output.save_interval=5");
  has(waits.text, "followed by damped motion");
  const Outcome on = shell(folder, "$talus run model.toml --from out/saved/stage_01.h5 -o on");
  INFO(on.text);
  CHECK(on.code == 0);
  CHECK(read_text_file(folder / "on/blocks_end.svg") == read_text_file(folder / "out/blocks_end.svg"));
}

TEST_CASE("command run --from: the same bits from within the motion that follows steps from rest") {
  Folder folder;
  write_model(
      folder,
      "talus = 1\n[model]\ngravity = [0, -10]\n[material.m]\ndensity = 2500\nyoung = \"30 GPa\"\n"
      "poisson = 0\n[joint.j]\nfriction_angle = \"30 deg\"\nnormal_stiffness = \"20 GPa/m\"\n"
      "shear_stiffness = \"20 GPa/m\"\n[contact]\njoint = \"j\"\n"
      "[[block]]\nname = \"floor\"\npolygon = [[-1, -1], [1, -1], [1, 0], [-1, 0]]\nmaterial = \"m\"\n"
      "kind = \"fixed\"\n[[block]]\nname = \"stone\"\npolygon = [[0, 0.09], [0.1, 0.09], [0.1, 0.19], [0, 0.19]]\n"
      "material = \"m\"\n[output]\nsave_interval = \"20 ms\"\n"
      "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 0.6\nunbalanced = 1e-3\n");
  goes_on_from_each_state(folder);
  const auto summary = nlohmann::json::parse(read_text_file(folder / "whole/summary.json"));
  const auto& stage = summary["stages"][0];
  CHECK(stage["followed_because"] != "");
  // of more steps than its way from rest could have had, which are 64 to 20 ms
  CHECK(stage["steps"].get<int>() - stage["steps_from_rest"].get<int>() > 64 * 30);
}

TEST_CASE("command run: a run that fails leaves its last good state, from which it comes to the same end") {
  Folder folder;
  write_model(folder, closing_jaws(0.1));
  const Outcome o = shell(folder, "$talus run model.toml -o whole -q");
  INFO(o.text);
  CHECK(o.code == 5);
  const auto states = saved_in(folder / "whole");
  REQUIRE(states.size() == 1);
  const std::string name = states[0].filename().string();
  const int step = std::atoi(name.c_str() + 5);
  CHECK(step <= 4000);  // the jaws touch after 2 s; a run of milliseconds may hold its start alone
  const auto whole = results_in(folder / "whole");
  CHECK(shell(folder, "$talus run model.toml --from whole/saved/" + name + " -q").code == 5);
  same(whole, results_in(folder / "whole"));
}

TEST_CASE("command run --from: copies of states that the user has made stay") {
  Folder folder;
  write_model(folder);
  REQUIRE(shell(folder, "$talus run model.toml -o r -q").code == 0);
  REQUIRE(shell(folder, "cd r/saved && cp stage_01.h5 step_1.h5 && cp stage_01.h5 step_00mine.h5").code == 0);
  CHECK(shell(folder, "$talus run model.toml --from r/saved/stage_01.h5 -q").code == 0);
  CHECK(fs::exists(folder / "r/saved/step_1.h5"));
  CHECK(fs::exists(folder / "r/saved/step_00mine.h5"));
}

TEST_CASE("command run --from: what cannot go on is refused") {
  Folder folder;
  write_model(folder);
  REQUIRE(shell(folder, "$talus run model.toml -o r -q").code == 0);
  const auto refused = [&folder](const std::string& line, int code, const std::string& piece) {
    const Outcome o = shell(folder, line);
    INFO(line);
    CHECK(o.code == code);
    has(o.text, piece);
  };
  const std::string from = " --from r/saved/stage_02.h5";
  refused("$talus run model.toml", 2, "-o FOLDER");
  refused("$talus run model.toml --from r/saved/no.h5", 4, "there is no such file");
  refused("$talus run model.toml --set stage.shake.duration=0.3" + from, 3,
          "--set stage.shake.duration: 0.3, was not given");
  std::string text = kModel;
  text.replace(text.find("2500"), 4, "2600");
  write_model(folder, text);
  refused("$talus run model.toml" + from, 3, "material.rock.density: 2600, was 2500");
  write_model(folder, kModel + "# a word\n");
  refused("$talus run model.toml" + from, 3, "comments");
  write_model(folder);
  refused("cp r/saved/stage_02.h5 . && $talus run model.toml --from stage_02.h5", 4, "does not lie in");
  refused(
      "head -c 5000 r/saved/stage_02.h5 > r/saved/short.h5; $talus run model.toml --from r/saved/short.h5", 4,
      "cut short");
  refused("echo nothing > r/saved/text.h5; $talus run model.toml --from r/saved/text.h5", 4,
          "another program has written it");
  // numbers that no run leaves: a pair of a block with itself
  Archive forged = read_archive(folder / "r/saved/stage_02.h5");
  std::vector<double>& pairs = forged.numbers.at("state.pairs.b");
  REQUIRE(!pairs.empty());
  pairs[0] = forged.numbers.at("state.pairs.a")[0];
  write_archive(folder / "r/saved/forged.h5", forged);
  refused("$talus run model.toml --from r/saved/forged.h5", 4, "the saved state is damaged: blocks");
  // 4 kB in the middle of the file: single bytes may lie in room that HDF5 has left between its tables
  refused(
      "cp r/saved/stage_02.h5 r/saved/bad.h5; s=$(stat -c %s r/saved/bad.h5); head -c 4096 /dev/zero | tr "
      "'\\0' U | dd of=r/saved/bad.h5 bs=1 seek=$((s/2)) conv=notrunc 2>/dev/null; $talus run model.toml "
      "--from r/saved/bad.h5",
      4, "no saved state that can be used");
  refused("head -c 100 r/steps.csv > s; cp s r/steps.csv; $talus run model.toml" + from, 4,
          "cannot be continued");
}

}  // namespace test_saved_state
