// talus compare: how far two results are apart.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>
#include <vector>

#include "support/command.h"
#include "talus/output/files.h"

namespace test_compare_command {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kExample = std::string(TALUS_SOURCE_DIR) + "/examples/conventional/conventional.toml";

// A folder with the least that a run leaves, one monitor, one stage.
void write_run(const Folder& f, const std::string& name, const std::string& rows, double begin, double end,
               const std::string& kind = "\"dynamic\"") {
  std::filesystem::create_directories(f / name);
  write_file(f / name / "model.toml", "talus = 1\n");
  write_file(
      f / name / "summary.json",
      fmt::format(
          "{{\"status\": \"finished\", \"stages\": [{{\"name\": \"go\", \"kind\": {}, \"begin [s]\": {}, "
          "\"end [s]\": {}}}]}}",
          kind, begin, end));
  write_file(f / name / "histories.csv", "t [s],dynamic_time [s],top.displacement_x [m]\n" + rows);
}

}  // namespace

TEST_CASE("command: compare says how far histories are apart, by hand") {
  const Folder f;
  // A: x = 0, 1, 2, 3 at 1, 2, 3, 4 s of its stage; B began 10 s later, and is 0.5 higher at 2.5 s, between rows
  write_run(f, "a", "0,0,0\n1,1,0\n2,2,1\n3,3,2\n4,4,3\n", 0, 4);
  write_run(f, "b", "10,0,9\n11,1,0\n12,2,1\n14,4,3.5\n", 10, 14);
  const Outcome o = shell(f, "$talus compare a b");
  CHECK(o.code == 0);
  // at 3 s B has 2.25 between its rows, at 4 s 3.5: 0.5 is the largest, rms sqrt((0.25^2 + 0.5^2) / 4) = 0.2795
  has(o.text, "history  go");
  has(o.text, "top.displacement_x [m]");
  has(o.text, " 0.5          4 ");
  has(o.text, "0.2795            3       17%");
  CHECK(shell(f, "$talus compare a b --atol 0.6").code == 0);
  CHECK(shell(f, "$talus compare a b --rtol 0.17").code == 0);
  const Outcome beyond = shell(f, "$talus compare a b --rtol 0.16");
  CHECK(beyond.code == 9);
  has(beyond.text, "BEYOND");
  has(beyond.text, "1 of 1 beyond");
  CHECK(shell(f, "$talus compare a a --rtol 0").code == 0);
}

TEST_CASE("command: compare of two paths sets balances at one time of the histories beside each other") {
  const Folder f;
  const std::string path = "\"static\", \"balances_of_path\": 3";
  // the ends are the same; in the middle B has 1.5 for 1, and a balance more, which A does not have
  write_run(f, "a", "0,0,0\n0.1,0,0\n0.2,1,1\n0.3,2,3\n", 0, 0.3, path);
  write_run(f, "b", "0,0,0\n0.1,0,0\n0.4,0.5,9\n0.6,1,1.5\n0.9,2,3\n", 0, 0.9, path);
  const Outcome o = shell(f, "$talus compare a b");
  has(o.text, " 0.5          1 ");
  has(o.text, "            3       17%");
}

TEST_CASE("command: compare of two formulations of one model") {
  const Folder f;
  REQUIRE(shell(f, fmt::format("$talus run {} -o penalty -q", kExample)).code == 0);
  REQUIRE(shell(f, fmt::format("$talus run {} -o forces -q --formulation contact_forces", kExample)).code ==
          0);
  const Outcome o = shell(f, "$talus compare forces penalty");
  CHECK(o.code == 0);
  has(o.text, "block.displacement_x [m]");
  has(o.text, "floor: normal forces added up [N]");
  has(o.text, "friction work [J]");
}

TEST_CASE("command: compare with wrong input") {
  const Folder f;
  write_run(f, "a", "0,0,0\n1,1,0\n", 0, 1);
  write_file(f / "file", "x");
  CHECK(shell(f, "$talus compare a").code == 2);
  CHECK(shell(f, "$talus compare a nowhere").code == 4);
  CHECK(shell(f, "$talus compare a file").code == 4);
  CHECK(shell(f, "$talus compare a a --rtol -1").code == 2);
  std::filesystem::create_directories(f / "other");
  write_file(f / "other/summary.json",
             "{\"status\": \"finished\", \"stages\": [{\"name\": \"rest\", \"kind\": \"static\"}]}");
  const Outcome o = shell(f, "$talus compare a other");
  CHECK(o.code == 9);
  has(o.text, "have nothing in common");
  CHECK(shell(f, "$talus compare a a --rtol wrong").code == 2);
  CHECK(shell(f, "$talus compare a a --rtol =1").code == 2);
  CHECK(shell(f, "$talus compare a a --rtol nan").code == 2);
  const Outcome unknown = shell(f, "$talus compare a a --rtol displacemnt=0.1");
  CHECK(unknown.code == 2);
  has(unknown.text, "displacemnt");
}

TEST_CASE("command: compare judges by quantity, unit and kind, the longest name that fits") {
  const Folder f;
  write_run(f, "a", "0,0,0\n1,1,0\n2,2,1\n3,3,2\n4,4,3\n", 0, 4);
  write_run(f, "b", "0,0,0\n1,1,0\n2,2,1\n3,3,2\n4,4,3.3\n", 0, 4);
  const auto code = [&](const std::string& how) { return shell(f, "$talus compare a b " + how).code; };
  CHECK(code("--rtol 0.09") == 9);
  CHECK(code("--rtol 0.09 --rtol displacement=0.11") == 0);
  CHECK(code("--rtol 0.09 --rtol displacement_x=0.11 --rtol displacement=0") == 0);
  CHECK(code("--rtol 0.11 --rtol m=0.01") == 9);
  CHECK(code("--rtol m=0.01 --atol m=0.3") == 0);
  CHECK(code("--rtol history=0.11") == 0);
  CHECK(code("--rtol 0 --atol displacement_x=0.31") == 0);
}

TEST_CASE("command: compare of runs of two models, and of one solved in two ways") {
  const Folder f;
  write_file(f / "m.toml",
             read_text_file(std::string(TALUS_SOURCE_DIR) + "/tests/fixtures/sliding_stone.toml"));
  const auto run = [&](const std::string& name, const std::string& more) {
    const Outcome o = shell(f, "$talus run m.toml -q -o " + name + more);
    INFO(o.text);
    REQUIRE(o.code == 0);
  };
  run("a", ""), run("step", " --set stage.go.time_step=0.25e-3"), run("push", " --set variables.push=4.001");
  run("wide", " --set 'block.floor.polygon=[[-5, -1], [51, -1], [51, 0], [-5, 0]]'");
  const Outcome step = shell(f, "$talus compare a step --rtol 0.01 --atol 1e-3 --atol m/s2=0.01");
  INFO(step.text);
  CHECK(step.code == 0);
  CHECK(shell(f, "$talus compare a push").code == 0);  // without a tolerance a note
  // the same model in other words
  run("words",
      " --set 'joint.face.friction_angle=\"0.5235987755982988 rad\"' --set joint.face.cohesion=0 --set 'material.m.density=\"2 t/m3\"' --set 'model.gravity=[\"0 m/s2\", -9.810]'");
  const Outcome words = shell(f, "$talus compare a words --rtol 1e-9 --atol 1e-9");
  INFO(words.text);
  CHECK(words.code == 0);
  run("cohesive", " --set 'joint.face.cohesion=\"1 kPa\"'");
  CHECK(shell(f, "$talus compare a cohesive --rtol 1 --atol 1e3").code == 9);
  const Outcome o = shell(f, "$talus compare a push --rtol 1 --atol 10");
  CHECK(o.code == 9);
  has(o.text, "ANOTHER MODEL: history.push.scale: 4 in a, 4.001 in push");
  CHECK(shell(f, "$talus compare a push --rtol 1 --atol 10 --other-model").code == 0);
  const Outcome wide = shell(f, "$talus compare a wide --rtol 1 --atol 10");
  CHECK(wide.code == 9);
  has(wide.text, "block 0 is another in wide");
}

TEST_CASE("command: compare of a run with itself, one side damaged in any way, is never passed") {
  const Folder f;
  REQUIRE(
      shell(
          f,
          fmt::format(
              "$talus run {}/examples/bolted_slope/bolted_slope.toml -q -o whole --set stage.shake.duration=0.1",
              TALUS_SOURCE_DIR))
          .code == 0);
  REQUIRE(shell(f, "cp -r whole other && $talus compare whole other --rtol 0").code == 0);
  std::vector<std::string> ways;
  for (const char* table :
       {"histories.csv", "steps.csv", "joints.csv", "slips.csv", "bolts.csv", "blocks.csv"}) {
    const auto way = [&](const std::string& line) { ways.push_back(fmt::format(fmt::runtime(line), table)); };
    way("rm {}");
    way(": > {}");
    way("sed -i '$d' {}");                  // fewer rows
    way("sed -i '2d' {}");                  // one in front
    way("cut -d, -f2- {0} > x; mv x {0}");  // a column less
    way("sed -i '1s/t/q/' {}");             // a title
    way("truncate -s -5 {}");               // a row that is cut off
    way("sed -i '$p' {}");                  // a row twice
    way("sed -i '2s/[1-9]/nan,/' {}");      // what is no number
  }
  for (const char* way : {"rm summary.json",
                          ": > summary.json",
                          "truncate -s 100 summary.json",
                          "sed -i 's/\"finished\"/\"failed\"/' summary.json",
                          "sed -i 's/\"finished\"/\"running\"/' summary.json",
                          "sed -i 's/\"valid\": true/\"valid\": false/' summary.json",
                          "sed -i 's/\"name\": \"shake\"/\"name\": \"quake\"/' summary.json",
                          "sed -i '0,/\"end .s.\": /s//\"end [s]\": 1/' summary.json",
                          "sed -i '/\"status\"/d' summary.json",
                          "echo '{}' > summary.json",
                          "echo '[1]' > summary.json",
                          "echo '{\"status\": \"finished\"}' > summary.json",
                          "rm model.toml",
                          "sed -i 's/25 deg/26 deg/' model.toml",
                          "rm monitors.csv",
                          "cp joints.csv histories.csv",
                          "cp histories.csv steps.csv",
                          "rm *.csv",
                          "rm -rf *",
                          "chmod 000 histories.csv; [ $(id -u) != 0 ] || rm histories.csv",
                          "rm histories.csv; mkdir histories.csv",
                          "rm histories.csv; ln -s /dev/null histories.csv",
                          "sed -i 's/^\\([^t]*\\)\\.\\([0-9]\\)/\\1.9\\2/' histories.csv"})
    ways.push_back(way);
  CHECK(ways.size() > 40);
  for (const std::string& way : ways)
    for (const bool first : {true, false}) {
      const Outcome o = shell(
          f,
          fmt::format(
              "chmod -R u+rwx other; rm -rf other; cp -r whole other; (cd other && {}) && ! diff -rq whole other > /dev/null || exit 77; $talus compare {} --rtol 1 --atol 1e30",
              way, first ? "other whole" : "whole other"));
      INFO(way, first ? " in the first" : " in the second", ": ", o.text);
      CHECK(o.code == 9);
    }
}

}  // namespace test_compare_command
