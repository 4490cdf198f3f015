// talus safety as a user meets it: the table, the files, a folder that is not overwritten, a model without
// rest.

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/command.h"
#include "talus/base/text_file.h"
#include "talus/output/files.h"

namespace test_safety_command {

using namespace talus;
using namespace talus::test;

namespace {

std::vector<std::string> split(const std::string& row) {
  std::vector<std::string> out;
  std::stringstream in(row);
  for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
  return out;
}

const std::string kToppling = std::string(TALUS_SOURCE_DIR) + "/examples/toppling/toppling.toml";

}  // namespace

TEST_CASE("command: safety prints its trials and writes them") {
  const Folder f;
  const std::string safety = fmt::format("$talus safety {} --set safety.tolerance=0.2 -o s", kToppling);
  const Outcome o = shell(f, safety);
  CHECK(o.code == 0);
  has(o.text, "factor of safety: 1.");
  has(o.text, "stands");
  const auto json = nlohmann::json::parse(read_text_file((f / "s/safety.json").string()));
  CHECK(json["status"] == "found");
  CHECK(json["fails_at"].get<double>() - json["stands_at"].get<double>() <= 0.2);
  const std::string csv = read_text_file((f / "s/safety.csv").string());
  CHECK(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')) == json["trials"].size() + 1);
  CHECK(shell(f, safety).code == 4);  // exists already
  CHECK(shell(f, safety + " --force").code == 0);
  const Outcome dynamic =
      shell(f, fmt::format("$talus safety {} --set stage.stand.kind=dynamic -o d", kToppling));
  CHECK(dynamic.code == 3);
  has(dynamic.text, "the first stage is not static");
}

TEST_CASE("command: safety by acceleration keeps the mechanism, and goes on after a kill" *
          doctest::test_suite("optimised")) {
  const Folder f;
  const std::string model = std::string(TALUS_SOURCE_DIR) + "/examples/pushed_wall/pushed_wall.toml";
  const Outcome o = shell(f, fmt::format("$talus safety {} --set safety.tolerance=0.01 -o s", model));
  INFO(o.text);
  CHECK(o.code == 0);
  has(o.text, "acceleration [g]: 0.6");
  const auto json = nlohmann::json::parse(read_text_file((f / "s/safety.json").string()));
  CHECK(json["by"] == "acceleration");
  // a wall of 33 blocks, on the ground
  for (const char* trial : {"stands", "fails"}) {
    const auto summary =
        nlohmann::json::parse(read_text_file((f / fmt::format("s/{}/summary.json", trial)).string()));
    CHECK(summary["blocks"]["all"] == 34);
    // blocks that went a tenth of their size: none of the wall that stands, what the trial was ended for of the other
    CHECK((summary["moved"]["blocks"].get<int>() > 0) == (std::string(trial) == "fails"));
    CHECK(summary["status"] == (std::string(trial) == "stands" ? "finished" : "interrupted"));
  }
  CHECK(std::filesystem::file_size(f / "s/mechanism.svg") > 5000);
  has(read_text_file((f / "s/mechanism.svg").string()), "<svg");
  CHECK(shell(f, "$talus report s/fails").code == 0);
  // the page of the search
  CHECK(shell(f, "$talus report s").code == 0);
  const std::string page = read_text_file((f / "s/report.html").string());
  for (const char* part :
       {"acceleration [g]: 0.6", "What acts", "stand", "data:image/svg+xml;base64,", "displacement limit"})
    has(page, part);
  has(page, "<td>0.50000</td><td>0.25000</td><td class=\"text\">stands</td>");
  has(shell(f, "$talus report s s/fails").text, "whose page stands alone");
  write_file((f / "s/safety.json").string(), "{\"by\": 1}");
  has(shell(f, "$talus report s").text, "safety.json: is no result of this talus safety");

  // broken off: the table of trials is there, and the search comes to the same
  shell(
      f,
      fmt::format(
          "$talus safety {} --set safety.tolerance=0.0001 -o k & n=0; while [ $n -lt 600 ] && [ \"$(cat k/safety.csv 2>/dev/null | wc -l)\" -lt 3 ]; do sleep 0.05; n=$((n + 1)); done; kill -9 $!; wait",
          model));
  const std::string begun = read_text_file((f / "k/safety.csv").string());
  CHECK(std::count(begun.begin(), begun.end(), '\n') >= 2);
  CHECK(shell(f, fmt::format("$talus safety {} --set safety.tolerance=0.0001 -o whole --threads 1", model))
            .code == 0);
  const std::string whole = read_text_file((f / "whole/safety.csv").string());
  CHECK(!std::filesystem::exists(f / "whole/states"));
  REQUIRE(!std::filesystem::exists(f / "k/safety.json"));  // or the search was quicker than the kill
  has(shell(f, "$talus report k").text, "has not ended; go on with it by talus safety MODEL -o k --resume");
  // a trial that stood is taken from its row and its state, and run again where that has gone
  const size_t row = begun.find('\n') + 1, end = begun.find('\n', row);
  std::vector<std::string> cells = split(begun.substr(row, end - row));
  REQUIRE(cells.at(1) == "1");
  cells[5] = "424242";
  const auto marked = [&](const std::string& csv) {
    return csv.substr(0, row) + fmt::format("{}", fmt::join(cells, ",")) + csv.substr(end);
  };
  std::filesystem::copy(f / "k", f / "none", std::filesystem::copy_options::recursive);
  std::filesystem::remove_all(f / "none/states");
  const auto resumed = [&](const std::string& folder) {
    write_file((f / folder / "safety.csv").string(), marked(begun));
    const Outcome again =
        shell(f, fmt::format("$talus safety {} --set safety.tolerance=0.0001 -o {} --resume", model, folder));
    INFO(again.text);
    CHECK(again.code == 0);
    CHECK(!std::filesystem::exists(f / folder / "states"));
    return read_text_file((f / folder / "safety.csv").string());
  };
  CHECK(resumed("k") == marked(whole));
  CHECK(resumed("none") == whole);
  has(shell(f, fmt::format("$talus safety {} -o k --resume", model)).text, "of another model");
  has(shell(f, fmt::format("$talus safety {} -o new --resume", model)).text,
      "there is no search to go on with");
}

TEST_CASE("command: safety with wrong keys is told before anything is run") {
  const Folder f;
  const std::string model = std::string(TALUS_SOURCE_DIR) + "/examples/pushed_wall/pushed_wall.toml";
  const auto refused = [&](const std::string& set, const std::string& part) {
    const Outcome o = shell(f, fmt::format("$talus safety {} {} -o s", model, set));
    CHECK(o.code == 3);
    has(o.text, part);
    CHECK(!std::filesystem::exists(f / "s"));
  };
  refused("--set safety.by=load", "safety.load: is missing");
  refused("--set safety.by=load --set safety.load=push", "there is no load called \"push\"");
  refused("--set safety.load=push", "by = \"load\" alone");
  refused("--set safety.by=tilt --set safety.highest=95", "90 degrees");
  refused("--set 'model.gravity=[0, 0]'", "turns gravity, and there is none");
  refused("--set 'safety.joints=[\"dry\"]'", "belongs to by = \"strength\"");
  refused("--set safety.by=push", "must be strength, load, tilt or acceleration");
}

}  // namespace test_safety_command
