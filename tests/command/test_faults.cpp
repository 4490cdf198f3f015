// The n-th write, rename, sync, open or allocation fails, n from 1 up: a plain error, nothing lost, nothing torn.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "support/command.h"
#include "support/record_text.h"
#include "support/results.h"
#include "support/shaken_bricks.h"
#include "talus/output/csv.h"
#include "talus/output/files.h"

#ifndef __SANITIZE_ADDRESS__  // which wants to be preloaded itself

namespace test_faults {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

std::string faulty(const std::string& kind, long n, const std::string& line) {
  return fmt::format("rm -f told; LD_PRELOAD='{}' TALUS_FAULT={}:{} TALUS_FAULT_TOLD=$PWD/told {}",
                     TALUS_FAULTS, kind, n, line);
}

struct Tried {
  int faults = 0, told = 0, unharmed = 0;
  int ended = 0;  // by a library that cannot do without memory
};

void no_files_left(const fs::path& folder) {
  std::error_code ec;
  for (const auto& e : fs::recursive_directory_iterator(folder, ec)) {
    INFO(e.path().string());
    CHECK(!is_unfinished_file(e.path()));
    CHECK(e.path().filename() != "talus_lock.txt");
  }
}

// One run with one fault, and what comes after it. False when there is no n-th call any more.
bool run_with_fault(const Folder& f, const std::string& run, const std::string& kind, long n,
                    const std::map<std::string, std::string>& whole, Tried& tried) {
  fs::remove_all(f / "out");
  const Outcome o = shell(f, faulty(kind, n, run + "-o out"));
  if (!fs::exists(f / "told")) return false;
  ++tried.faults;
  INFO(kind, " ", n, ": ", o.text);
  // the reader of JSON ends the process where it finds no memory to tidy up
  if (kind == "bare" && o.code == 134 && o.text.find("std::bad_alloc") != std::string::npos)
    return ++tried.ended > 0;
  CHECK((o.code == 0 || o.code == 4 || o.code == 7));
  if (o.code == 0) {  // what failed was not needed
    ++tried.unharmed;
    CHECK((results_in(f / "out") == whole));
    return true;
  }
  ++tried.told;
  no_files_left(f / "out");
  if (!fs::exists(f / "out/summary.json")) {  // nothing had begun
    CHECK(shell(f, run + "-o out" + (fs::exists(f / "out/talus_manifest.txt") ? " --force" : "")).code == 0);
    return true;
  }
  const auto summary = nlohmann::json::parse(content(f / "out/summary.json"), nullptr, false);
  REQUIRE(summary.is_object());
  CHECK(summary["status"] == "failed");
  if (fs::exists(f / "out/histories.csv"))
    CHECK(!read_csv(f / "out/histories.csv", LastLine::kMustEnd).cut_short);
  const Outcome read = shell(f, "$talus report out && $talus plot out");
  INFO(read.text);
  CHECK(read.code == 0);
  const std::string state = newest_state(f / "out");
  const Outcome on = shell(f, state.empty() ? run + "-o out --force" : run + "--from out/saved/" + state);
  INFO("then ", state, ": ", on.text);
  CHECK(on.code == 0);
  CHECK((results_in(f / "out") == whole));
  return true;
}

}  // namespace

TEST_CASE("faults: a sample, of a short run") {
  const Folder f;
  write_file(f / "bar.toml", content(TALUS_SOURCE_DIR "/examples/impact_bar/impact_bar.toml"));
  REQUIRE(shell(f, "$talus run bar.toml -q -o whole").code == 0);
  const auto whole = results_in(f / "whole");
  Tried tried;
  for (const char* kind : {"write", "rename", "sync", "open", "new"})
    for (long n = 1; run_with_fault(f, "$talus run bar.toml -q ", kind, n, whole, tried); n += 1 + n)
      continue;
  CHECK(tried.told > 15);
}

TEST_CASE("faults: a folder that is moved away before a file gets its name is the cause told") {
  const Folder f;
  write_file(f / "m.toml", kShakenBricks);
  int told = 0;
  for (long n = 1;; n += 1 + n / 4) {
    fs::remove_all(f / "out");
    fs::remove_all(f / "moved");
    const Outcome o = shell(f, faulty("moved", n, "$talus run m.toml -q -o out"));
    if (!fs::exists(f / "told")) break;
    INFO(n, ": ", o.text);
    CHECK(o.code == 4);
    CHECK(!fs::exists(f / "out"));
    // the first ones come while results begin
    told += o.text.find("out: has been moved away or removed") != std::string::npos ? 1 : 0;
  }
  CHECK(told > 3);
}

TEST_SUITE("long: faults") {
  TEST_CASE("faults in runs") {
    const Folder f;
    write_file(f / "bricks.toml", kShakenBricks);
    write_file(f / "bolts.toml", bolted_bricks());
    write_file(f / "tunnel.toml", content(TALUS_SOURCE_DIR "/examples/staged_tunnel/staged_tunnel.toml"));
    write_file(f / "bar.toml", content(TALUS_SOURCE_DIR "/examples/impact_bar/impact_bar.toml"));
    Tried tried;
    for (const char* model : {"bar", "bricks", "bolts", "tunnel"}) {
      const std::string run = fmt::format("$talus run {}.toml -q ", model);
      REQUIRE(shell(f, run + "-o whole").code == 0);
      const auto whole = results_in(f / "whole");
      // all of the first ones, then ever fewer of them
      for (const char* kind : {"write", "rename", "sync", "open", "new", "bare"})
        for (long n = 1; run_with_fault(f, run, kind, n, whole, tried); n += 1 + n / 5) continue;
      fs::remove_all(f / "whole");
    }
    MESSAGE(tried.faults, " faults: ", tried.told, " told, ", tried.unharmed, " did no harm, ", tried.ended,
            " ended in a library that found no memory where none was kept back");
    CHECK(tried.ended < 10);
    CHECK(tried.told > 200);
  }

  TEST_CASE("faults in reports, cuts and records") {
    const Folder f;
    write_file(f / "bricks.toml", kShakenBricks);
    REQUIRE(shell(f, "$talus run bricks.toml -q -o run").code == 0);
    std::string record = "t [s],a [m/s2]\n";
    for (int i = 0; i < 500; ++i) record += fmt::format("{},{}\n", 0.01 * i, i % 7 - 3);
    write_file(f / "r.csv", record);
    const std::string cut =
        fmt::format("$talus cut {}/examples/slope/slope.toml -o cut --force", TALUS_SOURCE_DIR);
    int told = 0;
    for (const std::string& line : {std::string("$talus report run"), std::string("$talus plot run"), cut,
                                    std::string("$talus record r.csv -o rec --force")})
      for (const char* kind : {"write", "rename", "sync", "open", "new", "bare"})
        for (long n = 1;; n += 1 + n / 4) {
          const Outcome o = shell(f, faulty(kind, n, line + " > /dev/null"));
          if (!fs::exists(f / "told")) break;
          INFO(line, " ", kind, " ", n, ": ", o.text);
          CHECK((o.code == 0 || o.code == 4 || o.code == 7));
          for (const char* folder : {"run", "cut", "rec"}) no_files_left(f / folder);
          told += o.code != 0;
        }
    MESSAGE(told, " faults told");
    CHECK(told > 100);
  }
}

}  // namespace test_faults

#endif
