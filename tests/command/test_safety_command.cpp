// talus safety as a user meets it: the table, the files, a folder that is not overwritten, a model without
// rest.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "support/command.h"
#include "talus/base/text_file.h"

namespace test_safety_command {

using namespace talus;
using namespace talus::test;

namespace {

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

}  // namespace test_safety_command
