// What ends a run from outside, what is in its way, and what it leaves: docs/reliability.md says what holds.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "support/closing_jaws.h"
#include "support/command.h"
#include "support/record_text.h"
#include "support/shaken_bricks.h"
#include "talus/output/csv.h"
#include "talus/output/files.h"

namespace test_reliability {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

std::string status_of(const fs::path& folder) {
  const auto summary = nlohmann::json::parse(content(folder / "summary.json"), nullptr, false);
  return summary.is_object() ? summary.value("status", "") : "no summary";
}

void write_long_model(const Folder& f) {
  std::string text = kShakenBricks;
  const std::string was = "duration = \"0.2 s\"";
  text.replace(text.find(was), was.size(), "duration = \"60 s\"");
  write_file(f / "long.toml", text);
}

// No force is the right one, and the solver may seek it for hours, or for so many sweeps.
std::string endless_step(int sweeps = 10000000) {
  return closing_jaws(
      1e-3,
      fmt::format("[solver]\nmethod = \"gauss_seidel\"\nmax_sweeps = {}\nsecond_solver = false\n", sweeps));
}

// Results whose frames and histories take long to read.
void write_long_results(const Folder& f) {
  write_file(f / "m.toml", kShakenBricks);
  REQUIRE(shell(f, "$talus run m.toml -o r -q && $talus report r").code == 0);
  for (const auto& [name, end] : {std::pair("blocks", "vtu"), std::pair("contacts", "vtp")}) {
    std::string list =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
        "byte_order=\"LittleEndian\">\n<Collection>\n";
    for (int i = 0; i < 300000; ++i)
      list += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}_000001.{}\"/>\n",
                          1e-6 * i, name, end);
    write_file(f / fmt::format("r/fields/{}.pvd", name), list + "</Collection>\n</VTKFile>\n");
  }
  const std::string histories = content(f / "r/histories.csv");
  const size_t head = histories.find('\n') + 1;
  const std::string row = histories.substr(head, histories.find('\n', head) + 1 - head);
  std::string table = histories.substr(0, head);
  for (int i = 0; i < 1000000; ++i) table += row;
  write_file(f / "r/histories.csv", table);
}

// A shell line that starts the run in the background and waits until it has written something.
const std::string kStart =
    "$talus run long.toml -o out > said.txt 2>&1 & p=$!; "
    "for i in $(seq 200); do [ -s out/steps.csv ] && break; sleep 0.05; done; ";

}  // namespace

TEST_CASE("reliability: signals end a run as Ctrl-C does, with their exit codes, and it goes on") {
  const Folder f;
  write_long_model(f);
  for (const auto& [name, code] : {std::pair("INT", 130), std::pair("TERM", 143), std::pair("HUP", 129),
                                   std::pair("XCPU", 152), std::pair("PIPE", 141)}) {
    INFO(name);
    const Outcome o = shell(f, fmt::format("{}sleep 0.2; kill -{} $p; wait $p", kStart, name));
    CHECK(o.code == code);
    CHECK(status_of(f / "out") == "interrupted");
    CHECK(!fs::exists(f / "out/talus_lock.txt"));
    const Outcome on =
        shell(f,
              "$talus run long.toml --from out/saved/$(ls out/saved | grep step | tail -1) -q & "
              "p=$!; sleep 0.3; kill -TERM $p; wait $p");
    INFO(on.text);
    CHECK(on.code == 143);
    CHECK(shell(f, "$talus report out && $talus plot out").code == 0);
    fs::remove_all(f / "out");
  }
}

TEST_CASE("reliability: a hang-up that nohup has ignored stays so") {
  const Folder f;
  write_long_model(f);
  const Outcome o =
      shell(f,
            "nohup $talus run long.toml -o out > said.txt 2>&1 & p=$!; for i in $(seq 200); do "
            "[ -s out/steps.csv ] && break; sleep 0.05; done; kill -HUP $p; sleep 0.3; kill -0 $p && "
            "echo lives; kill -TERM $p; wait $p");
  has(o.text, "lives");
  CHECK(o.code == 143);
}

TEST_CASE("reliability: a signal inside an endless step is heard, and the state before it saved") {
  const Folder f;
  write_file(f / "endless.toml", endless_step());
  const std::string start = "$talus run endless.toml -o out -q & p=$!; sleep 1.5; ";
  const Outcome o = shell(f, start +
                                 "b=$(date +%s%N); kill -TERM $p; wait $p; c=$?; e=$(date +%s%N); echo "
                                 "took $(( (e - b) / 1000000 )); exit $c");
  CHECK(o.code == 143);
  const size_t at = o.text.find("took ");
  REQUIRE(at != std::string::npos);
  CHECK(std::stoi(o.text.substr(at + 5)) < 1500);  // 0.6 s of patience, and a loaded machine
  CHECK(status_of(f / "out") == "interrupted");
  CHECK(!fs::exists(f / "out/talus_lock.txt"));
  REQUIRE(fs::exists(f / "out/saved"));
  CHECK(!fs::is_empty(f / "out/saved"));
  CHECK(shell(f, "$talus report out && $talus plot out").code == 0);
  // a second Ctrl-C does not wait for that
  fs::remove_all(f / "out");
  const Outcome twice = shell(f, start + "kill -INT $p; kill -INT $p; wait $p");
  CHECK(twice.code == 130);
}

TEST_CASE("reliability: a long cut, report or audit ends at once and leaves nothing unfinished") {
  const Folder f;
  write_long_results(f);
  const std::string before = content(f / "r/report.html");
  const std::string fine = "--set joint_set.bedding.spacing=0.1 --set joint_set.cross.spacing=0.1";
  for (const std::string& line :
       {fmt::format("$talus cut {}/examples/slope/slope.toml -o cut {}", TALUS_SOURCE_DIR, fine),
        std::string("$talus report r"), std::string("$talus audit r")}) {
    INFO(line);
    const Outcome o =
        shell(f, line +
                     " > said.txt & p=$!; sleep 0.7; b=$(date +%s%N); kill -TERM $p; wait $p; c=$?; "
                     "e=$(date +%s%N); echo took $(( (e - b) / 1000000 )); exit $c");
    CHECK(o.code == 143);
    const size_t at = o.text.find("took ");
    REQUIRE(at != std::string::npos);
    CHECK(std::stoi(o.text.substr(at + 5)) < 1000);
  }
  for (const auto& e : fs::recursive_directory_iterator(f.path())) {
    INFO(e.path().string());
    CHECK(!is_unfinished_file(e.path()));
    CHECK(e.path().filename() != "talus_lock.txt");
  }
  CHECK((content(f / "r/report.html") == before));
}

TEST_CASE("reliability: one run per folder") {
  const Folder f;
  write_long_model(f);
  const Outcome o =
      shell(f, kStart +
                   "for i in $(seq 400); do [ -s out/saved/stage_01.h5 ] && break; sleep 0.05; done; "
                   "$talus run long.toml -o out; echo A$?; $talus run long.toml -o out --force; echo B$?; "
                   "$talus cut long.toml -o out --force; echo C$?; "
                   "$talus run long.toml --from out/saved/stage_01.h5; echo D$?; "
                   "kill -KILL $p; wait $p; ls out");
  for (const char* code : {"A4", "B4", "C4", "D4"}) has(o.text, code);
  has(o.text, "is in use: process ");
  has(o.text, "talus_lock.txt");
  const Outcome after =
      shell(f,
            "$talus run long.toml --from out/saved/stage_01.h5 -q 2> said & p=$!; "
            "for i in $(seq 400); do grep -q 'taken over' said && break; sleep 0.05; done; sleep 0.2; "
            "kill -INT $p; wait $p; c=$?; cat said; exit $c");
  CHECK(after.code == 130);
  has(after.text, "has ended without letting go of this folder; it is taken over");
  CHECK(!fs::exists(f / "out/talus_lock.txt"));
  CHECK(shell(f, "$talus run long.toml -o out --force --from out/saved/stage_01.h5").code == 2);
}

TEST_CASE("reliability: standard streams that are full, closed or gone") {
  const Folder f;
  write_file(f / "m.toml", kShakenBricks);
  SUBCASE("full") {
    const Outcome o = shell(f, "$talus run m.toml -o out > /dev/full");
    CHECK(o.code == 4);
    has(o.text, "standard output cannot be written: No space left");
    CHECK(status_of(f / "out") == "finished");  // nobody could be told of it
    for (const char* line : {"schema", "schema --json", "man", "check m.toml", "plot out", "report out",
                             "--help", "--version", "completion bash"})
      CHECK_MESSAGE(shell(f, fmt::format("$talus {} > /dev/full", line)).code == 4, line);
  }
  SUBCASE("closed: no file is taken for it") {
    for (const char* closed : {">&-", "2>&-", "<&-", "<&- >&- 2>&-"}) {
      INFO(closed);
      fs::remove_all(f / "out");
      const Outcome o = shell(f, fmt::format("$talus run m.toml -o out {}", closed));
      CHECK(o.code ==
            (std::string(closed).find(" >&-") != std::string::npos || std::string(closed) == ">&-" ? 4 : 0));
      CHECK(status_of(f / "out") == "finished");
      const CsvTable table = read_csv(f / "out/histories.csv", LastLine::kMustEnd);
      CHECK(table.rows() > 100);
      CHECK(content(f / "out/histories.csv").find("stage ") == std::string::npos);
    }
  }
  SUBCASE("a pipe whose reader has gone: the usual end") {
    const Outcome o = shell(f, "($talus schema; echo \"code $?\" >&2) | true");
    has(o.text, "code 141");
    write_long_model(f);
    const Outcome run = shell(f, "($talus run long.toml -o out; echo \"code $?\" >&2) | head -1");
    has(run.text, "code 141");
    CHECK(status_of(f / "out") == "interrupted");
  }
  SUBCASE("- is standard output where a verb prints one file") {
    CHECK(shell(f, "$talus run m.toml -o out -q && $talus report out -o - > page.html").code == 0);
    CHECK(shell(f, "$talus report out -q > /dev/null").code == 2);
    CHECK(content(f / "page.html").find("</html>") != std::string::npos);
    CHECK(shell(f, "$talus new - --from wall > w.toml && $talus check w.toml").code == 0);
  }
}

TEST_CASE("reliability: a standard error that cannot be written changes nothing else") {
  const Folder f;
  write_file(f / "wrong.toml", "talus = 1\n[model]\ngravty = 1\n");
  for (const char* away : {" 2>/dev/full", " 2>&-"}) {
    INFO(away);
    CHECK(shell(f, fmt::format("$talus check wrong.toml{}", away)).code == 3);
    CHECK(shell(f, fmt::format("$talus check no.toml{}", away)).code == 4);
    CHECK(shell(f, fmt::format("$talus dance{}", away)).code == 2);
  }
  // the note on a lock that was left behind
  write_file(f / "m.toml", kShakenBricks);
  write_long_model(f);
  shell(f, kStart + "kill -9 $p; wait $p");
  REQUIRE(fs::exists(f / "out/talus_lock.txt"));
  CHECK(shell(f, "$talus run m.toml -o out --force -q 2>/dev/full").code == 0);
  CHECK(status_of(f / "out") == "finished");
}

TEST_CASE("reliability: a standard error whose reader has gone changes nothing else") {
  const Folder f;
  write_file(f / "m.toml", kShakenBricks);
  // the reader of the pipe has ended before anything is written
  const auto without_reader = [&f](const std::string& line) {
    shell(f, fmt::format("rm -f code; ( sleep 0.2; {}; echo $? > code ) 2>&1 >out.txt | true; "
                         "while [ ! -s code ]; do sleep 0.05; done",
                         line));
    return content(f / "code");
  };
  CHECK(without_reader("$talus check none.toml") == "4\n");
  CHECK(without_reader("$talus dance") == "2\n");
  CHECK(without_reader("$talus run m.toml -q -o o --set 'stage.shake.duration=\"1 ms\"'") == "0\n");
  CHECK(status_of(f / "o") == "finished");
}

TEST_CASE("reliability: a folder that is moved away from under a run") {
  const Folder f;
  write_long_model(f);
  // the name of the first one's folder leads to the second one's at once
  const Outcome o =
      shell(f,
            "mkdir a b; ln -s a here; ln -s b there; "
            "$talus run long.toml -o here -q --set output.save_interval=0.05 2>first.txt & p=$!; "
            "$talus run long.toml -o b -q & q=$!; "
            "while [ ! -e a/saved/stage_01.h5 ] || [ ! -e b/steps.csv ]; do sleep 0.05; done; "
            "mv -T there here; wait $p; echo first $?; "
            "$talus run long.toml -o b -q --force; echo third $?; kill -TERM $q; wait $q; "
            "echo second $?");
  INFO(o.text);
  has(content(f / "first.txt"), "has been moved away or removed");
  has(o.text, "first 4");
  has(o.text, "third 4");  // the second lives, and its lock stands
  has(o.text, "second 143");
  CHECK(status_of(f / "b") == "interrupted");
}

TEST_CASE("reliability: files that vanish or shrink under a run are its failure") {
  const Folder f;
  write_long_model(f);
  const auto told = [&](const std::string& damage, const std::string& part) {
    // held while it is damaged; ended by a signal: what it wrote is looked at then, too
    const Outcome o = shell(
        f,
        "rm -rf r; $talus run long.toml -o r -q 2>told.txt & p=$!; while [ ! -e r/saved/stage_01.h5 ] || [ ! -s r/steps.csv ]; "
        "do sleep 0.05; done; kill -STOP $p; (cd r && " +
            damage + "); kill -CONT $p; kill -TERM $p; wait $p");
    const std::string text = content(f / "told.txt");
    INFO(damage, ": ", o.code, " ", text);
    CHECK(o.code == 4);
    has(text, part);
    CHECK(status_of(f / "r") == "failed");
  };
  told("rm histories.csv", "histories.csv: has been removed");
  told("cp steps.csv x && mv x steps.csv", "steps.csv: has been replaced");
  told("truncate -s 0 blocks_start.svg", "blocks_start.svg: has 0 bytes");
  told("rm blocks.csv", "blocks.csv: has been removed");
  told("rm fields/blocks_000000.vtu", "blocks_000000.vtu: has been removed");
}

TEST_CASE("reliability: the audit refuses results that somebody has forged") {
  const Folder f;
  write_file(f / "m.toml", kShakenBricks);
  REQUIRE(shell(f, "$talus run m.toml -o r -q").code != 4);
  const auto refused = [&f](const std::string& forge, const std::string& told) {
    INFO(forge);
    REQUIRE(shell(f, "rm -rf o && cp -r r o && cd o && " + forge).code == 0);
    const Outcome o = shell(f, "$talus audit o");
    INFO(o.text);
    CHECK(o.code == 4);
    has(o.text, told);
  };
  refused("sed -i 's/\"failed_steps\": 0/\"failed_steps\": \"x\"/' summary.json", "summary.json");
  refused("rm fields/contacts.pvd", "contacts.pvd: is missing");
  refused("sed -i '1s/failed steps/steps failed/' steps.csv", "steps.csv: ");
  REQUIRE(shell(f, "rm -rf o && cp -r r o && truncate -s 400 o/fields/blocks.pvd").code == 0);
  has(shell(f, "$talus audit o").text, "blocks.pvd: has no end");
}

TEST_CASE("reliability: a signal just after the start") {
  const Folder f;
  write_long_model(f);
  for (const char* seen : {"summary.json", "histories.csv", "fields/blocks.pvd"}) {
    INFO(seen);
    const Outcome o =
        shell(f, fmt::format("$talus run long.toml -o out -q & p=$!; while ! [ -e out/{} ]; do :; done; "
                             "kill -TERM $p; wait $p",
                             seen));
    CHECK(o.code == 143);
    CHECK(status_of(f / "out") == "interrupted");
    CHECK(!fs::exists(f / "out/talus_lock.txt"));
    fs::remove_all(f / "out");
  }
}

TEST_CASE("reliability: what is in the way of results is seen before any of the old ones is touched") {
  const Folder f;
  write_file(f / "m.toml", kShakenBricks);
  REQUIRE(shell(f, "$talus run m.toml -o right -q").code == 0);
  const auto refused = [&f](const std::string& hindrance, const std::string& line) {
    INFO(hindrance, " ", line);
    REQUIRE(shell(f, "rm -rf out && cp -r right out").code == 0);
    const std::string histories = content(f / "out/histories.csv");
    REQUIRE(shell(f, hindrance).code == 0);
    const Outcome o = shell(f, line);
    CHECK(o.code == 4);
    has(o.text, "nothing was changed");
    CHECK((content(f / "out/histories.csv") == histories));
  };
  for (const char* line :
       {"$talus run m.toml -o out --force -q", "$talus run m.toml --from out/saved/stage_01.h5 -q"}) {
    refused("rm -f out/joints.csv && mkdir out/joints.csv", line);
    refused("rm out/fields/blocks.pvd && mkdir out/fields/blocks.pvd", line);
    refused("rm out/summary.json && mkfifo out/summary.json", line);
  }
  for (const char* line :
       {"$talus run m.toml -o out --force -q", "$talus run m.toml --from out/saved/stage_01.h5 -q"}) {
    // what only the manifest or a number names, and folders that are links
    refused("rm -rf f && mv out/fields f && ln -s ../f out/fields", line);
    refused("rm out/fields/blocks_000001.vtu && mkdir out/fields/blocks_000001.vtu", line);
    refused("rm out/fields/blocks_000001.vtu && mkfifo out/fields/blocks_000001.vtu", line);
    refused("rm -rf f && mv out/talus_manifest.txt f && ln -s ../f out/talus_manifest.txt", line);
    refused("rm -rf f && mkdir out/saved/stage_09.h5", line);
  }
  refused("rm -rf f s && mv out/summary.json s && ln -s ../s out/summary.json",
          "$talus run m.toml --from out/saved/stage_01.h5 -q");
  // reports and figures are made to be replaced, results, lock and manifest are not
  REQUIRE(shell(f, "rm -rf out && $talus run m.toml -o out -q && ln -s out/fields ff").code == 0);
  const std::string manifest = content(f / "out/talus_manifest.txt");
  for (const char* line :
       {"$talus report out -o out/talus_manifest.txt", "$talus report out -o ff/blocks.pvd",
        "$talus report out -o out/talus_lock.txt", "$talus plot out --blocks velocity -o out/blocks_end",
        "$talus new out/model --force"}) {
    const Outcome o = shell(f, line);
    INFO(line, ": ", o.text);
    CHECK(o.code == 4);
    has(o.text, "is one of the results");
  }
  CHECK((content(f / "out/talus_manifest.txt") == manifest));
  REQUIRE(
      shell(f, "rm -rf out/plots && mkdir p && echo mine > p/blocks_displacement.svg && ln -s ../p out/plots")
          .code == 0);
  has(shell(f, "$talus plot out").text, "is a link");
  CHECK((content(f / "p/blocks_displacement.svg") == "mine\n"));
  // and of what else may write there
  const Outcome report = shell(f, "$talus report out -o out/histories.csv");
  CHECK(report.code == 4);
  has(report.text, "is one of the results");
  write_file(f / "map.geojson", R"({"type":"FeatureCollection","features":[]})");
  CHECK(shell(f, "$talus import map.geojson -o ./map.geojson").code == 2);
  CHECK(
      shell(f, "rm -r out/fields; rm -f s; $talus run m.toml -o new -q; rm -r new/fields; $talus report new")
          .text.find("there is no motion to show") != std::string::npos);
  CHECK(shell(f, "$talus new ..").code == 2);
}

TEST_CASE("reliability: a disk that is full while a state is saved") {
  // no file longer than 64 kB: the tables fit, the state does not
  const Folder f;
  std::string text = kShakenBricks;
  text.replace(text.find("cells = [4, 6]"), 14, "cells = [8, 12]");
  write_file(f / "m.toml", text);
  const Outcome o = shell(f, "bash -c 'ulimit -f 128; exec $0 run m.toml -o out -q' $talus");
  CHECK(o.code == 4);
  has(o.text, "cannot be written: File too large");
  const auto summary = nlohmann::json::parse(content(f / "out/summary.json"));
  CHECK(summary["status"] == "failed");
  has(summary["failure"].get<std::string>(), "File too large");
  for (const auto& e : fs::recursive_directory_iterator(f / "out")) CHECK(!is_unfinished_file(e.path()));
  CHECK(shell(f, "$talus report out && $talus plot out").code == 0);
  CHECK(shell(f, "$talus run m.toml -o out -q --force").code != 4);
}

TEST_CASE("reliability: a failed run names the commands to look at it, and they work") {
  const Folder f;
  write_file(f / "m.toml", endless_step(50));
  const Outcome o = shell(f, "$talus run m.toml -o out -q");
  CHECK(o.code == 5);
  CHECK(status_of(f / "out") == "failed");
  int commands = 0;
  for (size_t at = o.text.find("\n  talus "); at != std::string::npos;
       at = o.text.find("\n  talus ", at + 1)) {
    std::string line = o.text.substr(at + 9, o.text.find("      (", at) - at - 9);
    INFO(line);
    const int code = shell(f, "$talus " + line).code;
    CHECK((code == 0 || code == 5));  // the step fails again, as it should
    ++commands;
  }
  CHECK(commands == 3);
}

TEST_CASE(
    "reliability: names that would leave the folder are refused, those of a hostile folder stay inside") {
  const Folder f;
  for (const char* name : {"/abs/path", "../x", "a\\\\b", "=1+1", "a\\rb", "a\\u0000b", " a"}) {
    std::string text = kShakenBricks;
    text.replace(text.find("name = \"top\""), 12, fmt::format("name = \"{}\"", name));
    write_file(f / "m.toml", text);
    const Outcome o = shell(f, "$talus check m.toml");
    INFO(name);
    CHECK(o.code == 3);
    has(o.text, "is no name: ");
    CHECK(o.text.find('\0') == std::string::npos);
  }
  // titles and keys are no names: they are shown
  write_file(f / "m.toml", "talus = 1\n[model]\n\"x\\ny\\u009b\" = 1\n");
  const Outcome shown = shell(f, "$talus check m.toml");
  CHECK(shown.code == 3);
  has(shown.text, "model.x\\x0ay\\u009b: unknown key");
  // a folder that somebody else has made
  write_file(f / "m.toml", kShakenBricks);
  REQUIRE(shell(f, "$talus run m.toml -o out -q").code == 0);
  write_file(f / "out/histories.csv",
             "t [s],../../escaped.velocity_x [m/s],/tmp/talus_escaped [m]\n0,1,2\n1,2,3\n");
  CHECK(shell(f, "$talus plot out").code == 0);
  CHECK(!fs::exists(f / "escaped.velocity_x.svg"));
  CHECK(!fs::exists("/tmp/talus_escaped.svg"));
  CHECK(fs::exists(f / "out/plots/%2E.%2F..%2Fescaped.velocity_x.svg"));
}

TEST_CASE("reliability: outputs replace regular files only") {
  const Folder f;
  write_file(f / "m.toml", kShakenBricks);
  REQUIRE(shell(f, "$talus run m.toml -o out -q").code == 0);
  write_file(f / "precious", "x");
  const Outcome pipe = shell(f, "mkfifo pipe; $talus report out -o pipe");
  CHECK(pipe.code == 4);
  has(pipe.text, "pipe: is a pipe; only a regular file is replaced");
  CHECK(fs::is_fifo(f / "pipe"));
  CHECK(shell(f, "ln -s precious link; $talus report out -o link").code == 4);
  // --from writes into no other file than its own
  CHECK(shell(f,
              "mv out/histories.csv h; ln -s ../h out/histories.csv; $talus run m.toml --from "
              "out/saved/stage_01.h5 -q")
            .code == 4);
  CHECK(content(f / "h").size() > 1000);
  CHECK(content(f / "precious") == "x");
}

TEST_CASE("reliability: crafted texts are refused within seconds") {
  const Folder f;
  const auto refused = [&f](const std::string& line, int code, const std::string& piece) {
    INFO(line);
    const Outcome o = shell(f, "timeout 60 " + line);
    CHECK(o.code == code);
    has(o.text, piece);
    CHECK(o.text.size() < 20000);
  };
  std::string dots = "a";
  for (int i = 0; i < 40000; ++i) dots += ".a";
  write_file(f / "header.toml", "talus = 1\n[" + dots + "]\nx = 1\n");
  refused("$talus check header.toml", 3, "a key has more than 20 parts");
  write_file(f / "dotted.toml", "talus = 1\n" + dots + " = 1\n");
  refused("$talus check dotted.toml", 3, "a key has more than 20 parts");
  write_file(f / "quoted.toml", "talus = 1\n[model]\ntitle = \"\"\"" + dots + "\"\"\"\n");
  refused("$talus check quoted.toml", 3, "the file has no [[stage]]");  // a text may hold dots
  write_file(f / "key.toml", "talus = 1\n" + std::string(10000000, 'k') + " = 1\n");
  refused("$talus check key.toml", 3, "(10000000 characters)");
  std::string sections = "talus = 1\n";
  for (int i = 0; i < 300000; ++i) sections += fmt::format("[blok{}]\nx = 1\n", i);
  write_file(f / "sections.toml", sections);
  refused("$talus check sections.toml", 3, "and 299");
  refused("$talus check /dev/zero", 4, "/dev/zero: is a device, not a file");
  refused("bash -c 'mkfifo fifo; $0 check fifo' $talus", 4, "fifo: is a pipe, not a file");
  refused("$talus check .", 4, "is a folder, not a file");
  // results
  fs::create_directories(f / "out");
  write_file(f / "out/histories.csv", "t [s],a [m]\n0,1\n1,2\n");
  write_file(f / "out/summary.json", std::string(100000, '[') + std::string(100000, ']'));
  refused("$talus report out", 4, "is nested more than 100 deep");
  refused("$talus plot out --stage s", 4, "is nested more than 100 deep");
  refused("$talus audit out", 4, "is nested more than 100 deep");
  refused("$talus replay out/summary.json", 4, "is nested more than 100 deep");
  write_file(f / "out/summary.json", R"({"status": "finished", "stages": 5, "blocks": [], "model": 7})");
  refused("$talus report out", 4, "something else than talus writes");
  refused("$talus audit out", 4, "cannot be read");
}

TEST_CASE("reliability: thousands of blocks in one place are refused within seconds") {
  const Folder f;
  std::string text = "talus = 1\n[material.rock]\ndensity = 2500\nyoung = \"1 GPa\"\npoisson = 0.2\n";
  for (int i = 0; i < 4000; ++i)
    text += fmt::format(
        "[[block]]\nname = \"b{}\"\nmaterial = \"rock\"\npolygon = [[0, 0], [1, 0], [0, 1]]\n", i);
  write_file(f / "m.toml", text);
  const Outcome o = shell(f, "timeout 20 $talus check m.toml");
  CHECK(o.code == 3);
  has(o.text, "overlaps \"b0\"");
}

TEST_CASE("reliability: a record whose numbers overflow is refused, and nothing is written") {
  const Folder f;
  std::string text = "t [s],a [m/s2]\n";
  for (int i = 0; i < 300; ++i) text += fmt::format("{},{}\n", 0.01 * i, i % 2 == 0 ? 1e308 : -1e308);
  write_file(f / "big.csv", text);
  for (const char* how : {"", " --raw"}) {
    const Outcome o = shell(f, fmt::format("$talus record big.csv -o out{}", how));
    CHECK(o.code == 3);
    has(o.text, "is not finite");
    CHECK(!fs::exists(f / "out"));
  }
}

#ifndef __SANITIZE_ADDRESS__  // which takes room for shadows of all memory
TEST_CASE(
    "reliability: threads that cannot be started are told before anything is written, or in the summary") {
  const Folder f;
  write_file(f / "m.toml", kShakenBricks);
  int told = 0;
  for (int n = 1;; ++n) {
    fs::remove_all(f / "out");
    const Outcome o =
        shell(f, fmt::format("rm -f told; LD_PRELOAD='{}' TALUS_FAULT=thread:{} "
                             "TALUS_FAULT_TOLD=$PWD/told $talus run m.toml -o out -q --threads 4",
                             TALUS_FAULTS, n));
    if (!fs::exists(f / "told")) break;
    INFO(n, ": ", o.text);
    CHECK(o.code == 7);
    has(o.text, "no more threads can be started");
    CHECK((!fs::exists(f / "out") || status_of(f / "out") == "failed"));
    ++told;
  }
  CHECK(told == 4);  // three helpers, and the one that waits for signals
}

TEST_CASE("reliability: a saved state is as long as its header says, or not read") {
  const Folder f;
  write_file(f / "m.toml", kShakenBricks);
  REQUIRE(shell(f, "$talus run m.toml -o r -q").code != 4);
  // four terabytes of nothing: more than memory
  REQUIRE(
      shell(f, "truncate -s 4T r/saved/stage_01.h5 2>/dev/null || truncate -s 4G r/saved/stage_01.h5").code ==
      0);
  const Outcome o = shell(f, "ulimit -v 2000000; $talus run m.toml --from r/saved/stage_01.h5");
  CHECK(o.code == 4);
  has(o.text, "its header says");
}

TEST_CASE("reliability: no memory is an exit code of its own") {
  const Folder f;
  std::string text = kShakenBricks;
  text.replace(text.find("cells = [4, 6]"), 14, "cells = [400, 600]");
  write_file(f / "m.toml", text);
  const Outcome o = shell(f, "bash -c 'ulimit -v 400000; exec $0 run m.toml -o out -q' $talus");
  CHECK(o.code == 7);
  has(o.text, "not enough memory");
}
#endif

}  // namespace test_reliability
