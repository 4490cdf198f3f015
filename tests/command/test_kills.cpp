// Runs that are killed at any moment: what they leave can be read, and they go on to the same bits. How many kills,
// and of which examples, TALUS_KILLS says; a sample is tried by ./test.sh long.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <vector>

#include "support/command.h"
#include "support/results.h"
#include "support/shaken_bricks.h"
#include "talus/base/clock.h"
#include "talus/base/random.h"
#include "talus/output/files.h"

namespace test_kills {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

// A model of some seconds of work, with states and frames often enough to be met by a kill.
struct Example {
  std::string name, model, changes;
  double share;  // of the kills
};

// 5,042 bricks, shaken for 60 steps.
std::string many_bricks() {
  std::string text = kShakenBricks;
  const auto change = [&text](const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
  };
  change("cells = [4, 6]", "cells = [71, 71]");
  change("duration = \"0.2 s\"", "duration = \"1.8 ms\"");
  change("field_interval = \"20 ms\"", "field_interval = \"0.3 ms\"");
  change("time_step = \"0.1 ms\"", "time_step = \"30 us\"");
  const size_t first = text.find("[[stage]]"), last = text.rfind("[[stage]]");
  return text.erase(first, last - first);
}

std::vector<Example> examples() {
  const auto file = [](const std::string& name) {
    return content(fmt::format("{0}/examples/{1}/{1}.toml", TALUS_SOURCE_DIR, name));
  };
  const std::string often = " --set output.save_interval=0.05 --set output.field_interval=0.02";
  return {{"staged_tunnel", file("staged_tunnel"), often, 0.25},
          {"bolted_tunnel", file("bolted_tunnel"), often, 0.25},
          {"pile", file("pile"), often, 0.2},
          {"dominoes", file("dominoes"), often, 0.2},
          {"many bricks", many_bricks(), " --set output.save_interval=0.2", 0.1}};
}

struct Count {
  int kills = 0, read = 0, gone_on = 0, ended = 0, same = 0;
};

// Kills a run of the example at random moments, again and again from where it stood, until it ends; then anew.
void kill_example(const Example& e, int kills, uint64_t seed, Count& count) {
  const Folder f;
  write_file(f / "m.toml", e.model);
  const std::string run = fmt::format("$talus run m.toml -q{} ", e.changes);
  const double begin = wall_now();
  const Outcome first = shell(f, run + "-o whole");
  REQUIRE((first.code == 0 || first.code == 8));
  const double took = wall_now() - begin;
  const auto whole = results_in(f / "whole");
  Random random(seed);
  std::string from;
  for (int done = 0; done < kills;) {
    const double wait = random.uniform() * took * (from.empty() ? 0.8 : 0.5);
    const std::string how = from.empty() ? "-o out" : "--from out/saved/" + from;
    const Outcome o =
        shell(f, fmt::format("{}{} & p=$!; sleep {:.4f}; kill -KILL $p; wait $p", run, how, wait));
    INFO(how, " after ", wait, " s");
    INFO(o.text);
    REQUIRE((o.code == 137 || o.code == 0 || o.code == 8));
    if (!from.empty()) ++count.gone_on;
    if (o.code != 137) {  // it was quicker
      ++count.ended;
      const auto now = results_in(f / "out");
      const bool all = now == whole;
      count.same += all;
      CHECK(all);
      for (const auto& [name, text] : whole)
        if (!now.count(name) || now.at(name) != text) MESSAGE("differs: ", name);
      fs::remove_all(f / "out");
      from.clear();
      continue;
    }
    ++done, ++count.kills;
    if (!fs::exists(f / "out/summary.json")) {  // before it had any results
      CHECK(!fs::exists(f / "out/histories.csv"));
      fs::remove_all(f / "out");
      from.clear();
      continue;
    }
    check_begins_as(f / "out", whole);
    const Outcome read =
        shell(f, "$talus report out > r.txt 2>&1 && $talus plot out > p.txt 2>&1 || cat r.txt p.txt");
    INFO(read.text);
    count.read += read.text.empty();
    CHECK(read.text.empty());
    from = newest_state(f / "out");
    if (from.empty()) fs::remove_all(f / "out");
  }
  if (!from.empty()) {
    const Outcome last = shell(f, run + "--from out/saved/" + from);
    INFO(last.text);
    CHECK((last.code == 0 || last.code == 8));
    ++count.ended;
    const bool all = results_in(f / "out") == whole;
    count.same += all;
    CHECK(all);
  }
}

}  // namespace

TEST_SUITE("long: kills") {
  TEST_CASE("kills at random moments: readable, and the same bits in the end") {
    const char* asked = std::getenv("TALUS_KILLS");
    const int kills = asked ? std::atoi(asked) : 100;
    const char* drawn = std::getenv("TALUS_SEED");
    Count count;
    for (const Example& e : examples())
      kill_example(e, static_cast<int>(e.share * kills),
                   stream_seed(drawn ? std::strtoull(drawn, nullptr, 10) : 1, e.name), count);
    MESSAGE(count.kills, " kills, ", count.read, " folders read by report and plot, ", count.gone_on,
            " runs went on, ", count.same, " of ", count.ended, " ends with the same bits");
  }
}

}  // namespace test_kills
