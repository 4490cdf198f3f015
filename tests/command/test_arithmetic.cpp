// The same bits where the mathematics library has the same, and a word where it has not.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "support/command.h"
#include "talus/output/files.h"

namespace test_arithmetic {

using namespace talus;
using namespace talus::test;

TEST_CASE(
    "command: runs by two codes of the mathematics library have the same bits where its digests are the same") {
  const Folder f;
  write_file(
      f / "m.toml",
      "talus = 1\n[material.m]\ndensity = 2000\n[history.v]\n"
      "expression = \"sin(9.2639999999999993 + t) + exp(-t) + tan(t)\"\nduration = \"1 s\"\nsamples = 10000\n"
      "[[block]]\nname = \"g\"\npolygon = [[-3, -1], [5, -1], [5, 0], [-3, 0]]\nmaterial = \"m\"\nkind = \"driven\"\n"
      "motion_x = { velocity = \"v\" }\n[[stage]]\nname = \"s\"\nkind = \"dynamic\"\nduration = \"0.2 s\"\n"
      "time_step = \"0.1 ms\"\n[output]\nhistory_interval = 0\n[[monitor]]\nname = \"m\"\npoint = [0.6, -0.1]\n");
  const auto digest = [&f](const std::string& name) {
    const std::string text = read_text_file(f / (name + "/summary.json"));
    return nlohmann::json::parse(text)["arithmetic"].get<std::string>();
  };
  const auto histories = [&f](const std::string& name) {
    return read_text_file(f / (name + "/histories.csv"));
  };
  CHECK(shell(f, "$talus run m.toml -q -o a && $talus run m.toml -q -o b --threads 2").code == 0);
  CHECK(digest("a") == digest("b"));
  CHECK(histories("a") == histories("b"));
  // as on a processor without fused sums, where glibc can be told to take it for one
  const std::string without = "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-AVX2,-FMA_Usable,-AVX2_Usable ";
  CHECK(shell(f, without + "$talus run m.toml -q -o other").code == 0);
  const bool same = digest("a") == digest("other");
  CHECK((histories("a") == histories("other")) == same);
  const Outcome o = shell(f, "$talus compare a other --rtol 1e-10 --atol 1e-12");
  INFO(o.text);
  CHECK(o.code == 0);
  CHECK((o.text.find("two mathematics libraries") != std::string::npos) == !same);
  if (same) MESSAGE("one code alone: this processor or library has no other");
}

}  // namespace test_arithmetic
