// Studies on a disk that fails, and studies that are killed: the same table or a run that is not done, never another table.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include "support/command.h"
#include "talus/base/random.h"
#include "talus/output/files.h"
#include "talus/output/text_table.h"

#ifndef __SANITIZE_ADDRESS__  // which wants to be preloaded itself

namespace test_study_faults {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

// Six short runs in two groups that share their static stage; half of them are damaged.
const char* kStudy = R"(talus_study = 1
model = "model.toml"
[answers]
way = "stone.displacement_x.greatest"
[[vary]]
key = "variables.phi"
values = ["10 deg", "20 deg"]
[[vary]]
key = "variables.push"
values = [2, 4, 8]
[failure]
when = "way > 0.1"
invalid = "failed"
[fragility]
over = "push"
)";

void write_study(const Folder& f, bool shared) {
  write_file(f / "model.toml",
             read_text_file(std::string(TALUS_SOURCE_DIR) + "/tests/fixtures/sliding_stone.toml"));
  write_file(f / "study.toml", (shared ? "" : "share_static = false\n") + std::string(kStudy));
}

// Rows without time, host and message.
std::map<std::string, std::string> table_of(const fs::path& folder) {
  const TextTable table = read_text_table(folder / "results.csv");
  std::map<std::string, std::string> rows;
  for (const auto& row : table.rows)
    for (size_t c = 1; c + 3 < row.size(); ++c) rows[row[0]] += row[c] + ",";
  return rows;
}

// A table that was written on the way: each row is that of an unbroken study, or not done.
int rows_not_done(const fs::path& folder, const std::map<std::string, std::string>& whole) {
  int not_done = 0;
  const auto rows = table_of(folder);
  CHECK(rows.size() == whole.size());
  for (const auto& [number, row] : rows) {
    if (row.find(",not done,,,") != std::string::npos)
      ++not_done;
    else
      CHECK(row == whole.at(number));
  }
  return not_done;
}

struct Count {
  int faults = 0, at_once = 0, not_done = 0, stopped = 0, again = 0;
};

// A study with one fault; then the same command until it is done.
bool study_with_fault(const Folder& f, const std::string& kind, long n,
                      const std::map<std::string, std::string>& whole, Count& count) {
  const std::string study = "$talus study study.toml -q -o out --jobs 2";
  fs::remove_all(f / "out");
  write_file(f / "count", std::string(8, '\0'));
  const Outcome o =
      shell(f, fmt::format("rm -f told; LD_PRELOAD='{}' TALUS_FAULT={}:{} TALUS_FAULT_TOLD=$PWD/told "
                           "TALUS_FAULT_COUNT=$PWD/count {}",
                           TALUS_FAULTS, kind, n, study));
  if (!fs::exists(f / "told")) return false;
  ++count.faults;
  INFO(kind, " ", n, ": ", o.code, " ", o.text);
  CHECK((o.code == 0 || o.code == 4 || o.code == 7 || o.code == 10));
  ++(o.code == 0 ? count.at_once : o.code == 10 ? count.not_done : count.stopped);
  if (fs::exists(f / "out/results.csv")) {
    const int not_done = rows_not_done(f / "out", whole);
    CHECK((not_done == 0 || o.code != 0));
    CHECK((not_done > 0 || o.code != 10));
  } else {
    CHECK(o.code != 0);
  }
  const Outcome rest = shell(f, study);
  INFO("then: ", rest.code, " ", rest.text);
  CHECK(rest.code == 0);
  CHECK((table_of(f / "out") == whole));
  CHECK(fs::is_empty(f / "out/work"));
  return true;
}

// A branch that fails is made once more as a run of its own: where nothing is shared a fault leaves a run that is not done.
void with_faults(const std::vector<std::string>& kinds, double growth, bool shared) {
  const Folder f;
  write_study(f, shared);
  REQUIRE(shell(f, "$talus study study.toml -q -o whole").code == 0);
  const auto whole = table_of(f / "whole");
  const std::string curve = read_text_file(f / "whole/fragility.csv");
  Count count;
  for (const std::string& kind : kinds)
    for (long n = 1; study_with_fault(f, kind, n, whole, count);
         n += 1 + static_cast<long>(growth * static_cast<double>(n))) {
      CHECK(read_text_file(f / "out/fragility.csv") == curve);
      if (kind == "every" && n > 300) break;
    }
  MESSAGE(count.faults, " faults: ", count.at_once, " did no harm, ", count.not_done, " left runs not done, ",
          count.stopped, " stopped the study");
  CHECK((shared || count.not_done > 0));
  CHECK(count.stopped > 0);
}

// Kills whichever process makes a write of random number - a study, its runs, a task - again and again, until each study
// is done; then another one from its start.
void with_kills(int kills, uint64_t seed) {
  const Folder f;
  write_study(f, seed % 2 == 0);
  REQUIRE(shell(f, "$talus study study.toml -q -o whole").code == 0);
  const auto whole = table_of(f / "whole");
  Random random(seed);
  int killed = 0, studies = 0, masters = 0;
  while (killed < kills) {
    fs::remove_all(f / "out");
    for (int tries = 0;; ++tries) {
      const int n = 1 + static_cast<int>(random.uniform() * 120), k = static_cast<int>(random.uniform() * 6);
      const bool begun = fs::exists(f / "out/study.json"), task = begun && random.uniform() < 0.4;
      const std::string verb = task ? fmt::format("$talus study task $PWD/out {} --count {}", k, 6 - k)
                                    : "$talus study study.toml -q -o $PWD/out --jobs 2";
      write_file(f / "count", std::string(8, '\0'));
      const Outcome o =
          shell(f, fmt::format("rm -f told; LD_PRELOAD='{}' TALUS_FAULT=kill:{} TALUS_FAULT_TOLD=$PWD/told "
                               "TALUS_FAULT_COUNT=$PWD/count {}",
                               TALUS_FAULTS, n, verb));
      INFO("seed ", seed, ", study ", studies, ", try ", tries, ": ", verb, ", write ", n, ": ", o.code, " ",
           o.text);
      if (fs::exists(f / "told")) ++killed;
      masters += o.code == 137;
      CHECK((o.code == 0 || o.code == 10 || o.code == 137));
      // runs end with their master
      const std::string runs = fmt::format("pgrep -f ' [r]un .*{}out/work'", (f / "").string());
      const Outcome orphans =
          shell(f, fmt::format("for i in $(seq 50); do {} > /dev/null || exit 1; sleep 0.1; done", runs));
      CHECK(orphans.code == 1);
      if (fs::exists(f / "out/results.csv")) rows_not_done(f / "out", whole);
      if (o.code == 0 && !task) break;
    }
    ++studies;
    CHECK((table_of(f / "out") == whole));
    CHECK(read_text_file(f / "out/fragility.csv") == read_text_file(f / "whole/fragility.csv"));
    CHECK(fs::is_empty(f / "out/work"));
  }
  MESSAGE("seed ", seed, ": ", killed, " processes killed, ", masters, " of them studies or tasks; ", studies,
          " studies ended with the same table");
}

}  // namespace

TEST_CASE("study faults: killed at random writes, a study ends with the same table") { with_kills(6, 1); }

TEST_CASE("study faults: a sample of writes that fail, in any process") {
  with_faults({"write"}, 0.6, false);
}

TEST_SUITE("long: study_faults") {
  TEST_CASE("study faults: each write, rename, sync and open that fails, and each n-th write") {
    for (const bool shared : {false, true})
      with_faults({"write", "rename", "sync", "open", "every"}, 0.04, shared);
  }

  TEST_CASE("study faults: 500 kills of studies, runs and tasks at random writes") {
    const char* drawn = std::getenv("TALUS_SEED");
    const uint64_t seed = drawn ? std::strtoull(drawn, nullptr, 10) : 1;
    for (uint64_t k = 0; k < 2; ++k) with_kills(250, seed + k);
  }
}

}  // namespace test_study_faults

#endif
