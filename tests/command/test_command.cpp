// The talus command as a user meets it: exit codes, messages, result files, interruption, full disk.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "support/command.h"
#include "support/relative.h"
#include "talus/base/text_file.h"
#include "talus/output/csv.h"
#include "talus/output/files.h"

namespace test_command {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

const std::string kBar = std::string(TALUS_SOURCE_DIR) + "/examples/impact_bar/impact_bar.toml";

}  // namespace

TEST_CASE("command: help, version and wrong usage") {
  const Folder f;
  CHECK(shell(f, "$talus --help").code == 0);
  for (const char* verb : {"run", "check", "cut", "import", "safety", "audit", "new", "plot", "report",
                           "record", "replay", "schema", "verify", "completion", "man"}) {
    const Outcome o = shell(f, fmt::format("$talus {} --help", verb));
    CHECK(o.code == 0);
    has(o.text, "Example: talus");
    for (const char* raw : {"TEXT", "FLOAT", "INT:", "UINT", "NONNEGATIVE", "POSITIVE"})
      CHECK_MESSAGE(o.text.find(raw) == std::string::npos, verb << " shows " << raw);
  }
  has(shell(f, "$talus plot --help").text, "--time-unit s|ms");
  has(shell(f, "$talus plot --help").text, "one of displacement, displacement_x");
  has(shell(f, "$talus --version").text, "model format 1");
  CHECK(shell(f, "$talus").code == 2);
  CHECK(shell(f, "$talus rum x").code == 2);
  CHECK(shell(f, "$talus run").code == 2);
}

TEST_CASE("command: completion offers verbs, options and the values of an option") {
  const Folder f;
  const Outcome o = shell(
      f,
      "$talus completion bash > c.sh && bash -c '. ./c.sh; "
      "try() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); COMPREPLY=(); _talus; echo \"${COMPREPLY[*]}\"; }; "
      "try talus comp; try talus plot --bl; try talus plot d --blocks stress_m; try talus completion z'");
  CHECK(o.code == 0);
  has(o.text, "completion\n--blocks\nstress_major stress_minor\nzsh\n");
}

TEST_CASE("command: a result folder runs again as it lies, with files, and says what was set") {
  const Folder f;
  fs::create_directories(f / "in/data");
  write_file(f / "in/data/push.txt", "0\n1\n1\n");
  write_file(
      f / "in/model.toml",
      "talus = 1\n[material.m]\ndensity = 2000\n[[block]]\nname = \"b\"\npolygon = [[0, 0], [1, 0], [1, 1], [0, 1]]\n"
      "material = \"m\"\nkind = \"rigid\"\n[history.push]\nfile = \"data/push.txt\"\ndt = \"0.1 s\"\nunit = \"m/s2\"\n"
      "[[load]]\nname = \"l\"\nacceleration_x = \"push\"\n[[stage]]\nname = \"go\"\nkind = \"dynamic\"\nduration = \"0.2 s\"\n"
      "time_step = \"10 ms\"\n[[monitor]]\nname = \"b\"\ncentroid = \"b\"\n");
  const Outcome first = shell(f, "$talus run in/model.toml -o out/deep/first --set material.m.density=2500");
  CHECK(first.code == 0);
  has(first.text, "histories (their clock stands in static stages) from 0 s");
  const std::string kept = read_text_file(f / "out/deep/first/model.toml");
  CHECK(kept.rfind("folder = \"../../../in", 0) == 0);
  has(kept, "# --set material.m.density=2500");
  CHECK(shell(f, "$talus run out/deep/first/model.toml -o again -q --set material.m.density=2500").code == 0);
  CHECK(read_text_file(f / "out/deep/first/histories.csv") == read_text_file(f / "again/histories.csv"));
}

TEST_CASE("command: run --watch leaves the page of the run, which does not load itself any more") {
  const Folder f;
  const Outcome o = shell(f, fmt::format("$talus run {} -o out --watch", kBar));
  if (o.text.find("the page of the report was not built") != std::string::npos) return;
  CHECK(o.code == 0);
  has(o.text, "to watch it, open");
  CHECK(read_text_file(f / "out/live.html").find("talus-index") != std::string::npos);
  CHECK(read_text_file(f / "out/talus_manifest.txt").find("live.html") != std::string::npos);
  // the tables of a run that is watched are those of one that is not
  CHECK(shell(f, fmt::format("$talus run {} -o plain -q", kBar)).code == 0);
  for (const char* table : {"histories.csv", "steps.csv", "monitors.csv"})
    CHECK(read_text_file(f / "out" / table) == read_text_file(f / "plain" / table));
}

TEST_CASE("command: check predicts and runs nothing") {
  const Folder f;
  const Outcome o = shell(f, fmt::format("$talus check {}", kBar));
  CHECK(o.code == 0);
  for (const char* part : {"no errors", "11; 9 faces held together", "135 steps", "stable limit 0.0004743 s",
                           "memory", "output"})
    has(o.text, part);
  size_t files = 0;
  for ([[maybe_unused]] const auto& e : fs::directory_iterator(f / "")) ++files;
  CHECK(files == 1);  // the log of this test
}

TEST_CASE("command: check -o draws the model, and replaces no file of others") {
  const Folder f;
  CHECK(shell(f, fmt::format("$talus check {} -o out", kBar)).code == 0);
  CHECK(fs::exists(f / "out" / "cut.png"));
  CHECK(fs::exists(f / "out" / "cut.svg"));
  CHECK(!fs::exists(f / "out" / "summary.json"));
  const Outcome again = shell(f, fmt::format("$talus check {} -o out", kBar));
  CHECK(again.code == 4);
  has(again.text, "--force");
  CHECK(shell(f, fmt::format("$talus check {} -o out --force", kBar)).code == 0);
  fs::remove(f / "out" / "talus_manifest.txt");
  fs::remove(f / "out" / "cut.png");
  CHECK(shell(f, fmt::format("$talus check {} -o out --force", kBar)).code ==
        4);  // now it could be anybody's
}

TEST_CASE("command: a run writes every result file, and refuses to overwrite") {
  const Folder f;
  const std::string out = (f / "out").string();
  const Outcome o = shell(f, fmt::format("$talus run {} -o {}", kBar, out));
  CHECK(o.code == 0);
  for (const char* part : {"stage 1/1 \"impact\"", "finished: 11 blocks", "contact error", "energy ledger"})
    has(o.text, part);
  CHECK(o.text.find('\r') == std::string::npos);  // plain lines where there is no terminal

  CHECK(read_text_file(fs::path(out) / "model.toml") == read_text_file(kBar));
  const auto summary = nlohmann::json::parse(read_text_file(fs::path(out) / "summary.json"));
  CHECK(summary["status"] == "finished");
  CHECK(summary["blocks"]["all"] == 11);
  CHECK(summary["stages"][0]["steps"] == 135);
  CHECK(summary["stages"][0]["dt_bound_block"].get<std::string>().rfind("bar[", 0) == 0);
  CHECK(summary["solver"]["failed_steps"] == 0);
  CHECK(summary["solver"]["loose_steps"] == 0);
  CHECK(summary["energy_closure"].get<double>() < 1e-12);
  const CsvTable histories = read_csv(fs::path(out) / "histories.csv"),
                 steps = read_csv(fs::path(out) / "steps.csv");
  CHECK(histories.columns[0] == "t [s]");
  CHECK(histories.rows() == 136);
  CHECK(steps.rows() == 136);
  std::set<std::string> names(histories.columns.begin(), histories.columns.end());
  CHECK(names.size() == histories.columns.size());
  CHECK(fs::exists(fs::path(out) / "fields/blocks.pvd"));
  CHECK(fs::exists(fs::path(out) / "fields/blocks_000032.vtu"));
  CHECK(fs::exists(fs::path(out) / "fields/contacts_000000.vtp"));
  for (const auto& e : fs::recursive_directory_iterator(out)) CHECK(e.path().extension() != ".part");

  const Outcome again = shell(f, fmt::format("$talus run {} -o {}", kBar, out));
  CHECK(again.code == 4);
  has(again.text, "exists already; nothing was run");
  CHECK(shell(f, fmt::format("$talus run {} -o {} --force -q", kBar, out)).text == "");
  // --force removes results, never anything else
  CHECK(shell(f, fmt::format("mkdir {0}/mine && echo x > {0}/mine/x && $talus run {1} -o {0}/mine --force",
                             (f / "").string(), kBar))
            .code == 4);
  CHECK(fs::exists(f / "mine/x"));
}

TEST_CASE("command: two runs give the same bits") {
  const Folder f;
  const auto run = [&](const char* name) {
    CHECK(shell(f, fmt::format("$talus run {} -o {}", kBar, (f / name).string())).code == 0);
    return read_text_file(f / name / "histories.csv") + read_text_file(f / name / "steps.csv") +
           read_text_file(f / name / "fields/contacts_000032.vtp");
  };
  CHECK(run("a") == run("b"));
}

TEST_CASE("command: overrides change the run and are recorded") {
  const Folder f;
  const std::string out = (f / "out").string();
  CHECK(
      shell(f, fmt::format("$talus run {} -o {} --set grid.bar.cells=[20,1] --set 'material.bar.young=4 MPa'",
                           kBar, out))
          .code == 0);
  const auto summary = nlohmann::json::parse(read_text_file(fs::path(out) / "summary.json"));
  CHECK(summary["blocks"]["all"] == 21);
  CHECK(summary["overrides"][1] == "material.bar.young=4 MPa");
  has(read_text_file(fs::path(out) / "model.toml"), "# --set grid.bar.cells=[20,1]");
}

TEST_CASE("command: wrong model exits 3 and creates nothing") {
  const Folder f;
  write_file(f / "m.toml", "talus = 1\n[[blok]]\n");
  const Outcome o =
      shell(f, fmt::format("$talus run {} -o {}", (f / "m.toml").string(), (f / "out").string()));
  CHECK(o.code == 3);
  has(o.text, "m.toml:2:3: error: blok: unknown section");
  has(o.text, "did you mean \"block\"?");
  CHECK(!fs::exists(f / "out"));
  CHECK(shell(f, fmt::format("$talus check {}", (f / "m.toml").string())).code == 3);
}

TEST_CASE("command: unreadable input, folder instead of file, unwritable output exit 4") {
  const Folder f;
  const Outcome missing = shell(f, "$talus check nothing.toml");
  CHECK(missing.code == 4);
  has(missing.text, "nothing.toml: cannot be read: No such file or directory");
  CHECK(shell(f, "$talus check /").code == 4);
  write_file(f / "file", "x");
  CHECK(shell(f, fmt::format("$talus run {} -o {}", kBar, (f / "file").string())).code == 4);
  CHECK(shell(f, fmt::format("$talus run {} -o {}", kBar, (f / "file/below").string())).code == 4);
}

TEST_CASE("command: a full disk is told, with its file, and exits 4") {
  // a limit on the size of files stands for the disk: the write fails in the same place
  const Folder f;
  const Outcome o = shell(f, fmt::format("ulimit -f 16; $talus run {} -o {}", kBar, (f / "out").string()));
  CHECK(o.code == 4);
  has(o.text, "cannot be written: File too large");
}

TEST_CASE("command: numbers that leave the finite exit 5 with time and block") {
  const Folder f;
  write_file(f / "m.toml", R"(talus = 1
[material.m]
density = 1e-300
[[block]]
name = "b"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "m"
kind = "rigid"
[history.h]
time = [0, 1]
value = [0, 1e305]
[[support]]
name = "s"
point = [0.5, 0.5]
x = { velocity = "h" }
[[stage]]
name = "go"
kind = "dynamic"
duration = 1e8
time_step = 1e7
)");
  const Outcome o =
      shell(f, fmt::format("$talus run {} -o {}", (f / "m.toml").string(), (f / "out").string()));
  CHECK(o.code == 5);
  has(o.text, "t = ");
  has(o.text, "results up to then are in");
  CHECK(nlohmann::json::parse(read_text_file(f / "out" / "summary.json"))["status"] == "failed");
}

TEST_CASE("command: Ctrl-C ends a run with valid results and exit code 130") {
  const Folder f;
  const std::string out = (f / "out").string();
  // a run of minutes, interrupted as soon as it has written its first frame
  const Outcome o =
      shell(f, fmt::format("$talus run {0} -o {1} --set 'stage.impact.duration=1000 s' --set "
                           "'output.steps_interval=1 s' --set 'output.history_interval=10 ms' "
                           "--set 'output.field_interval=0 s' & pid=$!; while [ ! -e {1}/fields/blocks.pvd "
                           "]; do sleep 0.05; done; sleep 0.3; kill -INT $pid; wait $pid",
                           kBar, out));
  CHECK(o.code == 130);
  has(o.text, "interrupted; the results up to then are valid");
  const auto summary = nlohmann::json::parse(read_text_file(fs::path(out) / "summary.json"));
  CHECK(summary["status"] == "interrupted");
  const CsvTable histories = read_csv(fs::path(out) / "histories.csv");
  CHECK(histories.rows() > 2);
  CHECK(histories.values[0].back() == approx(summary["stages"][0]["end [s]"].get<double>()));
}

TEST_CASE("command: plot draws a column, several runs, and names what is missing") {
  const Folder f;
  const std::string out = (f / "out").string();
  CHECK(shell(f, fmt::format("$talus run {} -o {} -q", kBar, out)).code == 0);
  CHECK(
      shell(f, fmt::format(
                   "$talus plot {0} {0} -c impact.mean_normal_force -l one -l two -o {0}/two --time-unit ms",
                   out))
          .code == 0);
  CHECK(fs::file_size(out + "/two.png") > 5000);
  has(read_text_file(out + "/two.svg"), "<svg");
  const auto overlay = [&](const std::string& columns) {
    return shell(f, fmt::format("$talus plot {} {}", out, columns));
  };
  const std::string pair = "-c impact.mean_normal_force -c impact.normal_force";
  const Outcome mixed = overlay(pair + " -o " + out + "/pair");
  CHECK(mixed.code == 2);
  has(mixed.text, "different quantities");
  has(overlay(pair).text, "several columns in one figure need -o");
  CHECK(overlay("-c impact.force_x -c impact.force_x -o " + out + "/pair").code == 0);
  CHECK(fs::file_size(out + "/pair.png") > 5000);
  const Outcome no_stage = overlay("-c impact.force_x --stage nothing -o " + out + "/stage");
  CHECK(no_stage.code == 2);
  CHECK(overlay("-c impact.force_x --stage impact -o " + out + "/stage.png").code == 0);
  CHECK(fs::file_size(out + "/stage.png") > 5000);
  CHECK(fs::exists(out + "/stage.svg"));
  CHECK(overlay("-c impact.force_x -x impact.normal_force -o " + out + "/over").code == 0);
  CHECK(fs::file_size(out + "/over.png") > 5000);
  CHECK(read_text_file(out + "/over.svg") != read_text_file(out + "/stage.svg"));
  CHECK(overlay("-x impact.normal_force").code == 2);
  has(overlay("-c impact.force_x -x impact.nothing").text, "there is no column \"impact.nothing\"");
  has(no_stage.text, "has no stage \"nothing\"; there is");
  const Outcome all = shell(f, fmt::format("$talus plot {}", out));
  CHECK(all.code == 0);
  CHECK(fs::exists(out + "/plots/impact.normal_force.svg"));
  const Outcome wrong = shell(f, fmt::format("$talus plot {} -c impact.nothing -o {}/x", out, out));
  CHECK(wrong.code == 4);
  has(wrong.text,
      "there is no column \"impact.nothing\"; there is t [s], dynamic_time [s], impact.force_x [N]");
  has(shell(f, "$talus plot nowhere").text, "nowhere: there is no such folder");
}

TEST_CASE("command: one step is dumped and replayed by either solver") {
  const Folder f;
  const std::string out = (f / "out").string();
  CHECK(shell(f, fmt::format("$talus run {} -o {} -q --dump-step 20", kBar, out)).code == 0);
  const Outcome newton = shell(f, fmt::format("$talus replay {}/step_20.json", out)),
                sweeps = shell(
                    f, fmt::format("$talus replay {}/step_20.json --method gauss_seidel --tolerance 1e-12",
                                   out));
  CHECK(newton.code == 0);
  CHECK(sweeps.code == 0);
  const auto normal = [](const Outcome& o) { return std::stod(o.text.substr(o.text.find("normal ") + 7)); };
  CHECK(normal(sweeps) == approx(normal(newton)).epsilon(1e-6));  // the bar's rows are independent: unique
  const Outcome wrong = shell(f, fmt::format("$talus replay {}/summary.json", out));
  CHECK(wrong.code == 4);
  has(wrong.text, "is no step written by talus run --dump-step");
  const Outcome hopeless = shell(f, fmt::format("$talus replay {}/step_20.json --tolerance 0", out));
  CHECK(hopeless.code == 2);
  has(hopeless.text, "--tolerance: must be > 0");
  const auto refused = [&](const std::string& edit, const std::string& message) {
    CAPTURE(edit);
    const Outcome o =
        shell(f, fmt::format("sed '{1}' {0}/step_20.json > {0}/edited.json; $talus replay {0}/edited.json",
                             out, edit));
    CHECK(o.code == 4);
    has(o.text, message);
  };
  refused("s/\"dt .s.\": .*/\"dt [s]\": 0,/", "its time step is not positive");
  for (const char* tile : {"0", "-1", "2000000000"})  // of one block only, and none at all
    refused(fmt::format("0,/\"mobility\"/s//\"tile\": {}, &/", tile),
            "the tiles of its blocks are not one of each, from 0 up");
  for (const char* block : {"1e72", "3000000000", "0.5"})
    refused(fmt::format("s/\"a\": [0-9]*/\"a\": {}/", block), "stands where a whole number belongs");
}

TEST_CASE("command: a failed step is named, written and can be replayed") {
  const Folder f;
  const std::string out = (f / "out").string();
  const Outcome o = shell(
      f, fmt::format("$talus run {} -o {} --set solver.tolerance=1e-30 --set solver.limit=1e-30", kBar, out));
  CHECK(o.code == 5);
  has(o.text, "the contact equations were not solved");
  has(o.text, "worst at");
  CHECK(fs::exists(out + "/step_0.json"));
}

}  // namespace test_command
