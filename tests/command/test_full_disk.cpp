// A disk that is full at any point of a run: a file system in memory, as small as that. Mounting takes root.

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "support/command.h"
#include "support/results.h"
#include "talus/output/csv.h"
#include "talus/output/files.h"

namespace test_full_disk {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

struct Count {
  int full = 0, room = 0, from_state = 0, told_in_summary = 0;
};

// One run on a disk of so many kilobytes, then the rest of it with room.
void try_size(const Folder& f, const std::string& run, int kilobytes,
              const std::map<std::string, std::string>& whole, Count& count) {
  INFO(kilobytes, " kB");
  REQUIRE(shell(f, fmt::format("rm -rf disk/out && mount -o remount,size={}k disk", kilobytes)).code == 0);
  const Outcome o = shell(f, run + "-o disk/out");
  INFO(o.text);
  REQUIRE(shell(f, "mount -o remount,size=500m disk").code == 0);
  CHECK((o.code == 0 || o.code == 4));
  if (o.code == 0) {
    ++count.room;
    CHECK((results_in(f / "disk/out") == whole));
    return;
  }
  ++count.full;
  CHECK(o.text.find("No space left") != std::string::npos);
  const fs::path out = f / "disk/out";
  std::error_code ec;
  for (const auto& e : fs::recursive_directory_iterator(out, ec)) {
    INFO(e.path().string());
    CHECK(!is_unfinished_file(e.path()));
    CHECK(e.path().filename() != "talus_lock.txt");
  }
  if (!fs::exists(out / "summary.json")) return;  // there was no room for a single file
  const auto summary = nlohmann::json::parse(content(out / "summary.json"), nullptr, false);
  REQUIRE(summary.is_object());
  count.told_in_summary += summary.value("failure", "").find("No space left") != std::string::npos;
  if (fs::exists(out / "histories.csv"))
    CHECK(!read_csv(out / "histories.csv", LastLine::kMustEnd).cut_short);
  const Outcome read = shell(f, "$talus report disk/out && $talus plot disk/out");
  INFO(read.text);
  CHECK(read.code == 0);
  const std::string state = newest_state(out);
  count.from_state += !state.empty();
  const Outcome on =
      shell(f, run + (state.empty() ? "-o disk/out --force" : "--from disk/out/saved/" + state));
  INFO("then ", state, ": ", on.text);
  CHECK(on.code == 0);
  CHECK((results_in(out) == whole));
}

}  // namespace

TEST_SUITE("long: disk") {
  TEST_CASE("a disk that is full at two hundred points of a run") {
    const Folder f;
    if (shell(f, "mkdir disk && mount -t tmpfs -o size=500m tmpfs disk").code != 0) {
      MESSAGE("skipped: mounting a small disk takes root");
      return;
    }
    struct Unmount {
      const Folder& folder;
      ~Unmount() { shell(folder, "umount disk"); }
    } unmount{f};
    write_file(f / "m.toml", content(TALUS_SOURCE_DIR "/examples/staged_tunnel/staged_tunnel.toml"));
    const std::string run = "$talus run m.toml -q --set output.save_interval=0.1 ";
    REQUIRE(shell(f, run + "-o disk/out").code == 0);
    const auto whole = results_in(f / "disk/out");
    double bytes = 0;
    for (const auto& e : fs::recursive_directory_iterator(f / "disk/out"))
      if (e.is_regular_file()) bytes += static_cast<double>((e.file_size() + 4095) / 4096 * 4096);
    const char* asked = std::getenv("TALUS_POINTS");
    const int points = asked ? std::atoi(asked) : 200;
    Count count;
    for (int i = 0; i < points; ++i)
      try_size(f, run, 80 + static_cast<int>((1.1 * bytes / 1024 - 80) * i / points), whole, count);
    MESSAGE(points, " sizes of the disk: ", count.full, " too small, ", count.told_in_summary,
            " told in summary.json, ", count.from_state, " gone on from a state, ", count.room,
            " large enough");
    CHECK(count.told_in_summary > count.full / 2);
  }
}

}  // namespace test_full_disk
