// talus study: a small model many times.

#include <doctest/doctest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "support/command.h"
#include "support/results.h"

namespace test_study_command {

using namespace talus;
using namespace talus::test;

namespace {

const std::string kModel =
    read_text_file(std::string(TALUS_SOURCE_DIR) + "/tests/fixtures/sliding_stone.toml");

const char* kStudy = R"(talus_study = 1
title = "Sliding <stone>"
model = "model.toml"
[answers]
way = "stone.displacement_x.greatest"
[[vary]]
key = "variables.phi"
values = ["10 deg", "20 deg", "30 deg"]
[[vary]]
key = "variables.push"
values = [2, 4, 8]
[failure]
when = "way > 0.1"
[fragility]
over = "push"
)";

void write(const Folder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name) << text;
}

// results.csv without times, hosts and messages.
std::string numbers_of(const Folder& folder, const std::string& out) {
  const TextTable table = read_text_table(folder / (out + "/results.csv"));
  std::string text;
  for (const auto& row : table.rows) {
    for (size_t c = 0; c + 3 < row.size(); ++c) text += row[c] + ",";
    text += "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("command study: a table of runs whose numbers are those of the formula, and of runs by hand") {
  const Folder folder;
  write(folder, "model.toml", kModel), write(folder, "study.toml", kStudy);
  const Outcome dry = shell(folder, "$talus study study.toml -o out --dry-run");
  CHECK(dry.code == 0);
  has(dry.text, "9 runs of model.toml, 2 blocks each");
  CHECK(!std::filesystem::exists(folder / "out"));
  const Outcome all = shell(folder, "$talus study study.toml -o out");
  INFO(all.text);
  REQUIRE(all.code == 0);
  has(all.text, "9 runs: 9 finished\n");
  const TextTable table = read_text_table(folder / "out/results.csv");
  REQUIRE(table.rows.size() == 9);
  for (const auto& row : table.rows) {
    const double phi = std::stod(row[1]) * std::acos(-1) / 180, push = std::stod(row[2]),
                 way = std::stod(row[5]);
    // a = push - g tan(phi), for 0.5 s; the push grows over the first millisecond
    const double expected = std::max(0.0, 0.125 * (push - 9.81 * std::tan(phi)));
    INFO(row[1], " deg, ", push);
    CHECK(std::abs(way - expected) <= 0.02 * expected + 1e-6);
    CHECK(row[4] == (way > 0.1 ? "1" : "0"));
  }
  // the static stage was made once for each angle, and each run is the bits of one by hand
  size_t parents = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out/parents"))
    parents += entry.is_directory();
  CHECK(parents == 3);
  CHECK(shell(folder,
              "$talus run model.toml -q -o hand --set 'variables.phi=\"20 deg\"' --set variables.push=8")
            .code == 0);
  const auto frames = [&](const std::string& run) {
    const std::string text = content(folder / (run + "/histories.csv"));
    return text.substr(text.rfind('\n', text.size() - 2));  // the last row
  };
  CHECK(frames("out/runs/000005") == frames("hand"));
  has(content(folder / "out/study.html"), "Sliding &lt;stone&gt;");
  has(content(folder / "out/study.html"), "<a href=\"runs/000008/\">8</a>");
  CHECK(std::filesystem::exists(folder / "out/figures/fragility.svg"));
  CHECK(std::filesystem::exists(folder / "out/figures/way_over_phi.svg"));
  CHECK(std::filesystem::exists(folder / "out/figures/incremental_way.png"));
  // without sharing the same numbers
  write(folder, "alone.toml", "share_static = false\n" + std::string(kStudy));
  CHECK(shell(folder, "$talus study alone.toml -q -o alone --jobs 1").code == 0);
  CHECK(numbers_of(folder, "alone") == numbers_of(folder, "out"));
  // answers may change afterwards
  std::string changed = kStudy;
  changed.replace(changed.find("way > 0.1"), 9, "way > 0.5");
  write(folder, "out/study.toml", changed);
  CHECK(shell(folder, "$talus study gather out").code == 0);
  CHECK(numbers_of(folder, "out") != numbers_of(folder, "alone"));
}

TEST_CASE(
    "command study: killed on the way, it goes on with what is missing, and the table is that of an unbroken one") {
  const Folder folder;
  write(folder, "model.toml", kModel), write(folder, "study.toml", kStudy);
  CHECK(shell(folder, "$talus study study.toml -q -o whole").code == 0);
  // its processes die with it, as when a machine goes down
  for (int k = 0; k < 4; ++k)
    shell(
        folder,
        fmt::format(
            "setsid sh -c '$talus study study.toml -q -o broken --jobs 2 & echo $$ > group; wait' & sleep 0.{}5; kill -9 -$(cat group); wait",
            k + 1));
  const Outcome rest = shell(folder, "$talus study study.toml -o broken");
  INFO(rest.text);
  CHECK(rest.code == 0);
  CHECK(numbers_of(folder, "broken") == numbers_of(folder, "whole"));
  CHECK(std::filesystem::is_empty(folder / "broken/work"));
  // again: nothing is run
  const auto when = std::filesystem::last_write_time(folder / "broken/runs/000003/run.json");
  CHECK(shell(folder, "$talus study study.toml -q -o broken").code == 0);
  CHECK(std::filesystem::last_write_time(folder / "broken/runs/000003/run.json") == when);
  // a signal ends it and its runs: nine of a fifth of a second and more each, heard after the first
  write(folder, "slow.toml", "set = [\"stage.go.time_step=0.01 ms\"]\n" + std::string(kStudy));
  const Outcome stopped = shell(
      folder,
      "$talus study slow.toml -o stopped --jobs 1 & n=0; while [ $n -lt 600 ] && [ ! -e stopped/runs/000000 ]; do sleep 0.05; n=$((n + 1)); done; kill -INT $!; wait $!");
  INFO(stopped.text);
  CHECK(stopped.code == 130);
  CHECK(!std::filesystem::exists(folder / "stopped/runs/000008"));
  CHECK(std::filesystem::is_empty(folder / "stopped/work"));
}

TEST_CASE("command study: runs end with their study, however that ends") {
  const Folder folder;
  write(folder, "model.toml", kModel),
      write(folder, "study.toml", "set = [\"stage.go.duration=2000 s\"]\n" + std::string(kStudy));
  const std::string runs = fmt::format("pgrep -f ' [r]un .*{}out/work' > /dev/null", (folder / "").string());
  const Outcome o = shell(
      folder,
      "$talus study study.toml -q -o $PWD/out --jobs 2 & p=$!; n=0; until " + runs +
          " && [ -e out/parents ] && ls out/work | grep -q '^00' || [ $n -gt 600 ]; do sleep 0.05; n=$((n + 1)); done; "
          "kill -9 $p; wait $p; sleep 0.5; " +
          runs + " && echo orphans; true");
  INFO(o.text);
  CHECK(o.text.find("orphans") == std::string::npos);
  CHECK(!std::filesystem::is_empty(folder / "out/work"));  // what they had begun
}

TEST_CASE("command study: what is refused is a row that says so") {
  const Folder folder;
  std::string model = kModel;
  model.replace(model.find("polygon = [[0, 0], [1, 0]"), 25, "polygon = [[0, \"$dip\"], [1, 0]");
  model.replace(model.find("push = 4"), 8, "push = 4\ndip = 0");
  write(folder, "model.toml", model);
  std::string study = kStudy;
  study.replace(study.find("[2, 4, 8]"), 9, "[2, 4]");
  // a stone whose corner is far in the floor: refused
  write(folder, "study.toml", study + "[[vary]]\nkey = \"variables.dip\"\nvalues = [0, 2]\n");
  const Outcome all = shell(folder, "$talus study study.toml -o out");
  INFO(all.text);
  CHECK(all.code == 0);
  has(all.text, "6 finished, 6 refused");
  const TextTable table = read_text_table(folder / "out/results.csv");
  CHECK(table.rows[1][4] == "refused");
  CHECK(table.rows[1][5].empty());
  has(table.rows[1].back(), "error");
}

TEST_CASE("command study: single tasks and gather, as batch systems call them, by a stand-in of sbatch too") {
  const Folder folder;
  write(folder, "model.toml", kModel), write(folder, "study.toml", kStudy);
  CHECK(shell(folder, "$talus study study.toml -q -o whole").code == 0);
  CHECK(shell(folder, "$talus study study.toml -o tasks --plan").code == 0);
  for (int k = 0; k < 9; k += 2) CHECK(shell(folder, fmt::format("$talus study task tasks {}", k)).code == 0);
  const Outcome part = shell(folder, "$talus study gather tasks");
  CHECK(part.code == 10);
  has(part.text, "5 finished, 4 not done");
  CHECK(shell(folder, "$talus study task tasks 0 --count 100").code == 0);
  CHECK(shell(folder, "$talus study gather tasks").code == 0);
  CHECK(numbers_of(folder, "tasks") == numbers_of(folder, "whole"));
  CHECK(shell(folder, "$talus study task tasks 9").code == 2);
  CHECK(shell(folder, "$talus study task nowhere 0").code == 4);

  // sbatch reads the array from the script and runs its elements, two of them at once; scontrol knows the limit
  std::filesystem::create_directories(folder / "bin");
  write(folder, "bin/scontrol", "#!/bin/sh\necho 'MaxArraySize            = 4'\n");
  write(folder, "bin/sbatch",
        "#!/bin/sh\nwhile [ $# -gt 1 ]; do echo \"$1\" >> \"$(dirname \"$0\")/options\"; shift; done\n"
        "last=$(sed -n 's/^#SBATCH --array=0-//p' \"$1\")\n"
        "for i in $(seq 0 \"$last\"); do SLURM_ARRAY_TASK_ID=$i sh \"$1\" & done\nwait\necho 4711\n");
  for (const char* name : {"bin/scontrol", "bin/sbatch"})
    std::filesystem::permissions(folder / name, std::filesystem::perms::owner_all);
  const Outcome slurm = shell(
      folder,
      "PATH=$PWD/bin:$PATH $talus study study.toml -o slurm --on slurm --sbatch '--partition=long --time=1:00'");
  INFO(slurm.text);
  CHECK(slurm.code == 0);
  has(slurm.text, "job 4711: 9 runs in 3 array elements of 3");
  has(content(folder / "bin/options"), "--partition=long");
  CHECK(shell(folder, "$talus study gather slurm").code == 0);
  CHECK(numbers_of(folder, "slurm") == numbers_of(folder, "whole"));
}

TEST_CASE("command study: more values in the same folder, and what was there keeps its bits") {
  const Folder folder;
  write(folder, "model.toml", kModel), write(folder, "study.toml", kStudy);
  CHECK(shell(folder, "$talus study study.toml -q -o out").code == 0);
  const std::string before = numbers_of(folder, "out"),
                    bits = content(folder / "out/runs/000004/histories.csv");
  const auto when = std::filesystem::last_write_time(folder / "out/runs/000004/run.json");
  const auto with = [&](const std::string& pushes) {
    std::string text = kStudy;
    return text.replace(text.find("[2, 4, 8]"), 9, pushes);
  };
  // one value more in the midst, and a second angle
  std::string more = with("[2, 4, 5, 8]");
  more.replace(more.find("\"20 deg\","), 9, "\"20 deg\", \"15 deg\",");
  write(folder, "more.toml", more);
  const Outcome o = shell(folder, "$talus study more.toml -o out");
  INFO(o.text);
  CHECK(o.code == 0);
  has(o.text, "16 runs: 16 finished");
  CHECK(numbers_of(folder, "out").substr(0, before.size()) == before);
  CHECK(content(folder / "out/runs/000004/histories.csv") == bits);
  CHECK(std::filesystem::last_write_time(folder / "out/runs/000004/run.json") == when);
  // rows are those of a study that had them from the start
  CHECK(shell(folder, "$talus study more.toml -q -o fresh").code == 0);
  const auto rows = [&](const std::string& name) {
    std::set<std::string> out;
    std::istringstream in(numbers_of(folder, name));
    for (std::string row; std::getline(in, row);) out.insert(row.substr(row.find(',')));
    return out;
  };
  CHECK(rows("out").size() == 16);
  CHECK(rows("out") == rows("fresh"));
  const Outcome fewer = shell(folder, "$talus study study.toml -o out");
  CHECK(fewer.code == 3);
  has(fewer.text, "is no run of the study file any more");
  // gathered by a study file of more runs than the folder has
  write(folder, "out/study.toml", with("[2, 4, 5, 8, 9]"));
  const Outcome unknown = shell(folder, "$talus study gather out");
  CHECK(unknown.code == 3);
  has(unknown.text, "the folder holds 16: put back what was taken away");
  // what is not in the folder yet waits for talus study
  std::string ahead = more;
  ahead.replace(ahead.find("[2, 4, 5, 8]"), 12, "[2, 4, 5, 8, 9]");
  write(folder, "out/study.toml", ahead);
  const Outcome early = shell(folder, "$talus study gather out");
  CHECK(early.code == 0);
  has(early.text, "4 runs of the study file are not in out yet");
  // keys in another order are the same runs
  const size_t first = more.find("[[vary]]"), second = more.find("[[vary]]", first + 1),
               after = more.find("[failure]");
  write(folder, "turned.toml",
        more.substr(0, first) + more.substr(second, after - second) + more.substr(first, second - first) +
            more.substr(after));
  CHECK(shell(folder, "$talus study turned.toml -o out").code == 0);
  has(content(folder / "out/results.csv"), "run,push,phi [deg]");
}

TEST_CASE("command study: answers have units, and what a script of Slurm cannot name is refused") {
  const Folder folder;
  std::string study = kStudy;
  study.replace(study.find("[[vary]]"), 0,
                "share = { formula = \"way / 2\", unit = \"m\" }\nplain = \"2 * way\"\n");
  write(folder, "model.toml", kModel), write(folder, "study.toml", study);
  CHECK(shell(folder, "$talus study study.toml -q -o out").code == 0);
  const TextTable table = read_text_table(folder / "out/results.csv");
  CHECK(table.find("way [m]") > 0);
  CHECK(table.find("share [m]") > 0);
  CHECK(table.find("plain") > 0);
  study.replace(study.find("unit = \"m\""), 10, "unit = \"mm\"");
  write(folder, "wrong.toml", study);
  const Outcome wrong = shell(folder, "$talus study wrong.toml -o no");
  CHECK(wrong.code == 3);
  has(wrong.text, "\"mm\" is no unit of SI");
  std::filesystem::create_directories(folder / "bin");
  write(folder, "bin/sbatch",
        "#!/bin/sh\ncp \"$(eval echo \\${$#})\" \"$(dirname \"$0\")/script\"\necho 7\n");
  std::filesystem::permissions(folder / "bin/sbatch", std::filesystem::perms::owner_all);
  write(folder, "study.toml", kStudy);
  CHECK(shell(folder, "PATH=$PWD/bin:$PATH $talus study study.toml -o 'a b%c' --on slurm").code == 0);
  has(content(folder / "bin/script"), "#SBATCH --output=\"");
  has(content(folder / "bin/script"), "/a b%%c/");
  has(content(folder / "bin/script"), "/slurm-%A_%a.txt\"\n");
  const Outcome name = shell(folder, "PATH=$PWD/bin:$PATH $talus study study.toml -o 'a\"b' --on slurm");
  CHECK(name.code == 4);
  has(name.text, "cannot name it");
}

TEST_CASE("command study: wrong input is told before anything is run or written") {
  const Folder folder;
  write(folder, "model.toml", kModel), write(folder, "study.toml", kStudy);
  const auto refused = [&](const std::string& from, const std::string& to, int code,
                           const std::string& part) {
    std::string text = kStudy;
    text.replace(text.find(from), from.size(), to);
    write(folder, "wrong.toml", text);
    const Outcome o = shell(folder, "$talus study wrong.toml -o out");
    INFO(o.text);
    CHECK(o.code == code);
    has(o.text, part);
    CHECK(!std::filesystem::exists(folder / "out"));
  };
  refused("model.toml", "modell.toml", 4, "modell.toml");
  refused("variables.phi", "variables.pi", 3, "used by nothing");
  refused("stone.displacement_x.greatest", "ston.displacement_x.greatest", 3,
          "did you mean \"stone.displacement_x.greatest\"");
  refused("way > 0.1", "way >", 3, "failure.failure.when");
  refused("\"10 deg\"", "\"100 deg\"", 3, "friction_angle");
  refused("\"20 deg\", \"30 deg\"]", "\"20 deg\", \"30 m\"]", 3, "more than one unit");
  refused("[2, 4, 8]", "[2, 4, \"8 m\"]", 3, "more than one unit");
  refused("\"30 deg\"]", "\"-30 deg\"]", 3, "must be >= 0");
  refused("stone.displacement_x.greatest", "stone.displacement_x.max", 3,
          "stone.displacement_x has at_end, at_start, greatest");
  refused("over = \"push\"", "over = \"pull\"", 3, "there is phi or push");
  refused(
      "[failure]",
      "[[vary]]\nkey = \"stage.go.duration\"\nvalues = [\"0.1 s\", \"0.2 s\"]\n[[vary]]\nname = \"other\"\n"
      "key = \"stage.1.duration\"\nvalues = [\"0.3 s\", \"0.4 s\"]\n[failure]",
      3, "changes nothing");
  // a folder with a study file of one's own, and nothing else, is none of a study
  std::filesystem::create_directories(folder / "mine");
  write(folder, "mine/study.toml", "# mine\n");
  CHECK(shell(folder, "$talus study study.toml -o mine").code == 4);
  CHECK(content(folder / "mine/study.toml") == "# mine\n");
  // a long list is one value
  write(
      folder, "long.toml",
      "talus_study = 1\nmodel = \"model.toml\"\n[[vary]]\nkey = \"block.floor.polygon\"\n"
      "values = [[[-5, -1], [50, -1], [50, 0], [40, 0], [30, 0], [20, 0], [10, 0], [5, 0], [-5, 0]], [[-5, -1], [51, -1], [51, 0], [-5, 0]]]\n");
  CHECK(shell(folder, "$talus study long.toml -o no --dry-run").code == 0);
  CHECK(shell(folder, "$talus study study.toml").code == 2);
  CHECK(shell(folder, "$talus study study.toml -q -o out").code == 0);
  write(folder, "model.toml", kModel + "# changed\n");
  const Outcome other = shell(folder, "$talus study study.toml -o out");
  CHECK(other.code == 3);
  has(other.text, "model.toml is not what it was for the runs that this folder was begun with");
  CHECK(shell(folder, "$talus study task out 0").code == 3);
  CHECK(shell(folder, "$talus study gather out").code == 3);
  CHECK(shell(folder, "$talus study study.toml -o .").code == 4);
}

TEST_CASE("command run --until: ends after a stage, and going on from there has the bits of a whole run") {
  const Folder folder;
  write(folder, "model.toml", kModel);
  CHECK(shell(folder, "$talus run model.toml -q -o whole").code == 0);
  CHECK(shell(folder, "$talus run model.toml -q -o half --until rest").code == 0);
  CHECK(std::filesystem::exists(folder / "half/saved/stage_01.h5"));
  CHECK(!std::filesystem::exists(folder / "half/saved/stage_02.h5"));
  CHECK(shell(folder, "$talus run model.toml -q --from half/saved/stage_01.h5").code == 0);
  auto whole = results_in(folder / "whole"), half = results_in(folder / "half");
  CHECK(whole.at("histories.csv") == half.at("histories.csv"));
  CHECK(whole.at("monitors.csv") == half.at("monitors.csv"));
  CHECK(whole.at("steps.csv") == half.at("steps.csv"));
  const Outcome wrong = shell(folder, "$talus run model.toml -o no --until nowhere");
  CHECK(wrong.code == 2);
  has(wrong.text, "there is no stage \"nowhere\"; there is rest or go");
}

}  // namespace test_study_command
