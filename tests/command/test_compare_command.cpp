// talus compare: how far two results are apart.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>

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
  CHECK(o.code == 4);
  has(o.text, "have nothing in common");
}

}  // namespace test_compare_command
