// The audit as a user meets it: closing lines and exit code of talus run, summary.json, talus audit on the
// folder.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/command.h"
#include "talus/audit/read_results.h"
#include "talus/base/text_file.h"

namespace test_audit_command {

using namespace talus;
using namespace talus::test;
using nlohmann::json;

namespace {

// A driven block beside a fixed one, and a free one on the latter. `speed` of the first [m/s].
void write_model(const Folder& f, double speed, const std::string& more = "") {
  std::ofstream(f / "m.toml") << fmt::format(R"(talus = 1
[model]
gravity = [0, -9.81]
[material.r]
density = "2700 kg/m3"
[joint.f]
friction_angle = "35 deg"
[contact]
joint = "f"
[history.v]
time = [0, 10]
value = [{0}, {0}]
[[block]]
name = "ram"
polygon = [[-1, 0], [0, 0], [0, 1], [-1, 1]]
material = "r"
kind = "driven"
motion_x = {{ velocity = "v" }}
[[block]]
name = "wall"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "r"
kind = "fixed"
[[block]]
name = "stone"
polygon = [[0.5, 1], [0.9, 1], [0.9, 1.4], [0.5, 1.4]]
material = "r"
kind = "rigid"
[[stage]]
name = "go"
kind = "dynamic"
duration = "50 ms"
time_step = "1 ms"
[output]
field_interval = "10 ms"
{1}
)",
                                             speed, more);
}

json summary(const Folder& f) { return json::parse(read_text_file(f / "out/summary.json")); }

}  // namespace

TEST_CASE("command audit: a sound run is valid, by the run and by its folder") {
  const Folder f;
  write_model(f, 0);
  const Outcome run = shell(f, "$talus run m.toml -o out");
  CHECK(run.code == 0);
  has(run.text, "audit           valid; 6 frames and 50 steps looked at");
  CHECK(summary(f)["valid"] == true);
  CHECK(summary(f)["warnings"].empty());
  CHECK(summary(f)["audit"]["defects"].empty());
  const Outcome audit = shell(f, "$talus audit out");
  CHECK(audit.code == 0);
  has(audit.text, "out: 6 frames looked at, valid");
}

TEST_CASE("command audit: a run that is not valid ends with 8 and names pair, time and place") {
  const Folder f;
  write_model(f, 1);
  const Outcome run = shell(f, "$talus run m.toml -o out");
  CHECK(run.code == 8);
  has(run.text, "audit           NOT VALID");
  has(run.text, "overlap of prescribed blocks: \"ram\" and \"wall\" at t = 0.05 s, (0.025, 0.5)");
  has(run.text, "first \"ram\" and \"wall\" at t = 0.01 s");
  const json s = summary(f);
  CHECK(s["valid"] == false);
  CHECK(s["status"] == "finished");
  REQUIRE(s["audit"]["defects"].size() == 1);
  CHECK(s["audit"]["defects"][0]["kind"] == "prescribed_overlap");
  CHECK(s["audit"]["defects"][0]["blocks"] == json({"ram", "wall"}));
  CHECK(s["warnings"].size() == 1);
  // the folder says the same of its frames, with one thread as with two
  const Outcome audit = shell(f, "$talus audit out");
  CHECK(audit.code == 8);
  has(audit.text, "overlap of prescribed blocks: \"ram\" and \"wall\" at t = 0.05 s, (0.025, 0.5)");
  CHECK(shell(f, "$talus audit out --threads 2").text == audit.text);
}

TEST_CASE("command audit: with audit = false nothing is said of it, and the verb still says it") {
  const Folder f;
  write_model(f, 1, "audit = false");
  const Outcome run = shell(f, "$talus run m.toml -o out");
  CHECK(run.code == 0);
  has(run.text, "audit           none (output.audit = false)");
  CHECK(summary(f)["valid"].is_null());
  CHECK(shell(f, "$talus audit out").code == 8);
}

namespace {

void replace_in(const std::filesystem::path& file, const std::string& what, const std::string& by) {
  std::string text = read_text_file(file);
  const size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  std::ofstream(file) << text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE(
    "command audit: forces of elastic joints against the energy of overlaps, by the run and by its folder") {
  const Folder f;
  write_model(f, 0);
  replace_in(f / "m.toml", "friction_angle = \"35 deg\"",
             "friction_angle = \"35 deg\"\nnormal_stiffness = \"1 GPa/m\"\nshear_stiffness = \"1 GPa/m\"");
  CHECK(shell(f, "$talus run m.toml -o out").code == 0);
  const json s = summary(f);
  // the stone bounces into its joint: in the first frame it has not closed it yet
  const int64_t by_energy = s["audit"]["patches_by_energy"];
  CHECK(by_energy >= 4);
  CHECK(s["warnings"].empty());
  const audit::FolderAudit folder = audit::audit_folder(f / "out");
  CHECK(folder.report.patches_by_energy == by_energy);
  CHECK(folder.report.frames == s["audit"]["frames"]);
  CHECK(folder.report.lines(folder.names).empty());

  // forces 5 % above what the joint of the summary has
  replace_in(f / "out/summary.json", "\"normal_stiffness [Pa/m]\": 1000000000.0",
             "\"normal_stiffness [Pa/m]\": 950000000.0");
  const Outcome audit = shell(f, "$talus audit out");
  CHECK(audit.code == 8);
  has(audit.text, "force off the overlap's energy: \"wall\" and \"stone\"");

  // joints that give more than anything in the ledger
  replace_in(f / "out/summary.json", "950000000.0", "1000000000.0");
  CHECK(shell(f, "$talus audit out").code == 0);
  replace_in(f / "out/summary.json", "\"joint_work\": -", "\"joint_work\": 1000");
  std::string text = read_text_file(f / "out/summary.json");
  INFO(text.substr(text.find("joint_work"), 40));
  const Outcome work = shell(f, "$talus audit out");
  CHECK(work.code == 8);
  has(work.text, "work of elastic joints");
}

TEST_CASE("command audit: polygons at their own interval") {
  const Folder f;
  write_model(f, 0, "audit_interval = \"25 ms\"");
  has(shell(f, "$talus run m.toml -o out").text, "audit           valid; 3 frames and 50 steps looked at");
}

TEST_CASE("command audit: a folder without a run is refused") {
  const Folder f;
  const Outcome none = shell(f, "$talus audit nowhere");
  CHECK(none.code == 4);
  has(none.text, "there is no such folder");
  CHECK(shell(f, "mkdir empty && $talus audit empty").code == 4);
}

}  // namespace test_audit_command
