// What talus makes of result folders, and what it begins models from, as a user meets it: report, plot, new,
// verify, completion, man.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "support/command.h"
#include "talus/base/text_file.h"
#include "talus/output/csv.h"
#include "talus/output/files.h"
#include "talus/output/text_table.h"

namespace test_results_command {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

const std::string kBar = std::string(TALUS_SOURCE_DIR) + "/examples/impact_bar/impact_bar.toml";
const std::string kBolted = std::string(TALUS_SOURCE_DIR) + "/examples/bolted_slope/bolted_slope.toml";

size_t count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

}  // namespace

TEST_CASE("command report: one page with all data, the same bytes twice, from an old run too") {
  if (!page_was_built()) return;
  const Folder f;
  const std::string a = (f / "a").string(), b = (f / "b").string();
  REQUIRE(shell(f, fmt::format("$talus run {} -o {} -q --set output.field_interval=0.004", kBar, a)).code ==
          0);
  const Outcome first = shell(f, fmt::format("$talus report {}", a));
  CHECK(first.code == 0);
  has(first.text, "a: 9 of 9 frames, contact points of 9");
  const std::string page = read_text_file(fs::path(a) / "report.html");
  CHECK(count(page, "id=\"talus-index\"") == 1);
  CHECK(count(page, "talus: data") == 0);
  CHECK(page.find("src=") == std::string::npos);  // nothing from outside
  has(page, "uplot 1.6.32");
  has(page, "Permission is hereby granted");  // its notice

  CHECK(shell(f, fmt::format("$talus report {} -o {}/again.html", a, b)).code == 0);
  CHECK(read_text_file(fs::path(b) / "again.html") == page);

  // two runs, fewer frames
  const Outcome both = shell(f, fmt::format("$talus report {0} {0} --frames 4 -o {1}/both.html", a, b));
  CHECK(both.code == 0);
  has(both.text, "a: 4 of 9 frames (as asked for)");

  // an old run had no names of blocks; a killed one has no rows; one without frames has none
  fs::remove(fs::path(a) / "blocks.csv");
  fs::remove(fs::path(a) / "steps.csv");
  CHECK(shell(f, fmt::format("$talus report {}", a)).code == 0);
  fs::remove_all(fs::path(a) / "fields");
  has(shell(f, fmt::format("$talus report {}", a)).text, "0 of 0 frames");
}

TEST_CASE("command report: what is no report is replaced with --force alone") {
  if (!page_was_built()) return;
  const Folder f;
  const std::string run = (f / "run").string();
  REQUIRE(shell(f, fmt::format("$talus run {} -o {} -q", kBar, run)).code == 0);
  write_file(f / "thesis.html", "<html>years of work</html>");
  const Outcome o = shell(f, "$talus report run -o thesis.html");
  CHECK(o.code == 4);
  has(o.text, "is no report of talus; --force replaces it");
  has(read_text_file(f / "thesis.html"), "years of work");
  CHECK(shell(f, "$talus report run -o thesis.html --force").code == 0);
  CHECK(shell(f, "$talus report run -o thesis.html").code == 0);  // it is one by now
}

TEST_CASE("command report: of a study, whose table opens its runs") {
  if (!page_was_built()) return;
  const Folder f;
  write_file(f / "model.toml",
             read_text_file(std::string(TALUS_SOURCE_DIR) + "/tests/fixtures/sliding_stone.toml"));
  write_file(
      f / "study.toml",
      "talus_study = 1\nmodel = \"model.toml\"\n[[vary]]\nkey = \"variables.push\"\nvalues = [2, 8]\n");
  REQUIRE(shell(f, "$talus study study.toml -q -o out").code == 0);
  has(read_text_file(f / "out/study.html"), "<a href=\"runs/000001/\">1</a>");
  const Outcome o = shell(f, "$talus report out");
  CHECK(o.code == 0);
  has(o.text, "reports of 2 runs made");
  has(read_text_file(f / "out/study.html"), "<a href=\"runs/000001/report.html\">1</a>");
  CHECK(fs::exists(f / "out/runs/000001/report.html"));
  has(shell(f, "$talus report out out").text, "whose page stands alone");
  CHECK(shell(f, "$talus report out -o x.html").code == 2);
}

TEST_CASE("command report: wrong folders are told") {
  const Folder f;
  const Outcome none = shell(f, "$talus report /nowhere");
  CHECK(none.code == 4);
  if (page_was_built()) has(none.text, "/nowhere: there is no such folder");
  CHECK(shell(f, "$talus report").code == 2);
  CHECK(shell(f, "$talus report x --frames -1").code == 2);
  if (!page_was_built()) return;
  const std::string a = (f / "a").string();
  fs::create_directories(a);
  has(shell(f, fmt::format("$talus report {}", a)).text, "summary.json is missing");
  write_file(fs::path(a) / "summary.json", "{\"title\":");
  CHECK(shell(f, fmt::format("$talus report {}", a)).code == 4);
  write_file(fs::path(a) / "summary.json", "{}");
  has(shell(f, fmt::format("$talus report {}", a)).text, "is no summary of a run");

  const std::string b = (f / "b").string();
  REQUIRE(shell(f, fmt::format("$talus run {} -o {} -q", kBar, b)).code == 0);
  const fs::path frame = fs::path(b) / "fields" / "blocks_000001.vtu";
  const std::string whole = read_text_file(frame);
  write_file(frame, whole.substr(0, whole.size() / 2));
  const Outcome cut = shell(f, fmt::format("$talus report {}", b));
  CHECK(cut.code == 4);
  has(cut.text, "blocks_000001.vtu");
  CHECK_FALSE(fs::exists(fs::path(b) / "report.html"));
}

TEST_CASE("command run: the table of blocks, and the model in numbers") {
  const Folder f;
  const std::string a = (f / "a").string();
  REQUIRE(shell(f, fmt::format("$talus run {} -o {} -q", kBolted, a)).code == 0);
  const TextTable blocks = read_text_table(fs::path(a) / "blocks.csv");
  REQUIRE(blocks.rows.size() == 4);
  CHECK(blocks.rows[2] ==
        std::vector<std::string>{"2", "slab[1,0]", "deformable", "rock", "slab", "3", "3", "0.75"});
  CHECK(blocks.rows[0][2] == "fixed");
  const std::string summary = read_text_file(fs::path(a) / "summary.json");
  for (const char* part : {"\"density [kg/m3]\": 2600", "\"friction_angle [deg]\": 25",
                           "\"kind\": \"anchored\"", "\"contact_tolerance [m]\""})
    has(summary, part);
}

TEST_CASE("command plot: pictures of the blocks at chosen times") {
  const Folder f;
  const std::string a = (f / "a").string();
  REQUIRE(shell(f, fmt::format("$talus run {} -o {} -q", kBolted, a)).code == 0);
  const Outcome all = shell(f, fmt::format("$talus plot {}", a));
  CHECK(all.code == 0);
  for (const char* name : {"blocks_displacement.svg", "blocks_stress_minor.png", "joints_and_bolts.svg"}) {
    CHECK(fs::file_size(fs::path(a) / "plots" / name) > 2000);
  }
  const std::string stem = (f / "picture").string();
  const Outcome one = shell(
      f, fmt::format("$talus plot {} --blocks stress_yy --time 0.5 --window 0 0 4 2 --deformation 20 -o {}",
                     a, stem));
  CHECK(one.code == 0);
  CHECK(fs::exists(stem + ".svg"));
  CHECK(fs::exists(stem + ".png"));
  const Outcome four = shell(
      f, fmt::format("$talus plot {} --blocks velocity --blocks none --time 0.5 --time 1 -o {}", a, stem));
  CHECK(count(four.text, ".png") == 4);
  has(shell(f, fmt::format("$talus plot {} --blocks displacement --time 7", a)).text,
      "there is no frame at 7 s");
  CHECK(shell(f, fmt::format("$talus plot {} --blocks colour", a)).code == 2);
  CHECK(shell(f, fmt::format("$talus plot {} --time 1", a)).code == 2);
  CHECK(shell(f, fmt::format("$talus plot {} --blocks velocity -c head.velocity_x", a)).code == 2);
  fs::remove_all(fs::path(a) / "fields");
  const Outcome bare = shell(f, fmt::format("$talus plot {} --blocks velocity", a));
  CHECK(bare.code == 4);
  has(bare.text, "has no frames");
}

TEST_CASE("command new: every beginning runs as it is" * doctest::test_suite("optimised")) {
  const Folder f;
  for (const char* from : {"impact_bar", "slope", "tunnel", "wall", "blast"}) {
    CAPTURE(from);
    const std::string name = (f / from).string();
    const Outcome made = shell(f, fmt::format("$talus new {} --from {}", name, from));
    CHECK(made.code == 0);
    has(made.text, fmt::format("{}.toml", name));
    const Outcome check = shell(f, fmt::format("$talus check {}.toml", name));
    CHECK(check.code == 0);
    has(check.text, "no errors, 0 warnings");
    // the wall takes its time; its first stage says enough
    const std::string less = std::string(from) == "wall" ? "--set stage.shake.duration=0.1" : "";
    CHECK(shell(f, fmt::format("$talus run {0}.toml -o {0} -q {1}", name, less)).code == 0);
  }
  const std::string slope = (f / "slope.toml").string();
  // what its comment, README.md and docs/first_run.md ask the reader to change first
  has(read_text_file(slope), "try 27 deg");
  for (const char* angle : {"27 deg", "38 deg"}) {
    CAPTURE(angle);
    CHECK(
        shell(f, fmt::format("$talus run {} -o tried -q --force --set 'joint.bedding.friction_angle=\"{}\"'",
                             slope, angle))
            .code == 0);
  }
  const Outcome again = shell(f, fmt::format("$talus new {}", slope));
  CHECK(again.code == 4);
  has(again.text, "exists already");
  CHECK(shell(f, fmt::format("$talus new {} --force --from wall", slope)).code == 0);
  has(read_text_file(slope), "Dry wall");
  CHECK(shell(f, "$talus new x --from castle").code == 2);
}

// They run the verification cases, which the sanitizer build goes without.
TEST_SUITE_BEGIN("optimised");

TEST_CASE("command verify: a table of what the cases reach") {
  const Folder f;
  const Outcome o = shell(f, "$talus verify \"free fall\"");
  CHECK(o.code == 0);
  has(o.text, "computed");
  has(o.text, "every one within what is allowed");
  CHECK(shell(f, "$talus verify \"no such case\"").code == 2);
  // residuals without tolerance fail, and so does the verb
  CHECK(shell(f, "TALUS_TEST_TOLERANCE=0 $talus verify \"incline\"").code == 1);
}

TEST_CASE("command verify --formulation: a column beside the cases, by case, and what it cannot compute") {
  const Folder f;
  const Outcome o = shell(f, "$talus verify --formulation penalty \"A2a\"");
  CHECK(o.code == 0);  // what another formulation misses is no failure
  has(o.text, "by penalty");
  // both solvers of the case are one formulation: no row of the second is left out
  const size_t rows = count(o.text, "A2a energy left over"), none = count(o.text, " - ");
  CHECK(rows == 14);
  CHECK(none == 0);
  has(o.text, "0 not computed");
  const Outcome bolts = shell(f, "$talus verify --formulation penalty --markdown \"A8b\"");
  CHECK(bolts.code == 0);
  has(bolts.text, "| by penalty | error |");
  has(bolts.text, "- A8b anchored bolt across a sliding joint: bolt.rod: there are no bolts");
  CHECK(shell(f, "$talus verify --formulation springs").code == 2);
}

TEST_SUITE_END();

TEST_CASE("command verify: without its cases it says what builds them") {
  const Folder f;
  const Outcome o = shell(f, "mkdir bin && cp \"$talus\" bin/talus && bin/talus verify");
  CHECK(o.code == 4);
  has(o.text, "./run.sh --verify");
  CHECK(count(o.text, "\n") == 1);
}

TEST_CASE("command completion and man: made from the verbs") {
  const Folder f;
  const Outcome bash =
      shell(f,
            "$talus completion bash > c.bash && bash -c '. ./c.bash; COMP_WORDS=(talus rep); "
            "COMP_CWORD=1; _talus; echo ${COMPREPLY[*]}; COMP_WORDS=(talus run --thr); COMP_CWORD=2; "
            "_talus; echo ${COMPREPLY[*]}'");
  CHECK(bash.code == 0);
  has(bash.text, "report replay");
  has(bash.text, "--threads");
  has(shell(f, "$talus completion zsh").text, "bashcompinit");
  has(shell(f, "$talus completion fish").text, "-l threads");
  CHECK(shell(f, "$talus completion tcsh").code == 2);
  const Outcome man = shell(f, "$talus man");
  CHECK(man.code == 0);
  for (const char* part : {".TH TALUS 1", ".SH NAME", "\\fB\\-o, \\-\\-output\\fR", "factor of safety"})
    has(man.text, part);
}

}  // namespace test_results_command
