// Saved states that are right but for one field: refused, or run; never a signal.

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>

#include "support/folder.h"
#include "support/shaken_bricks.h"
#include "talus/base/random.h"
#include "talus/talus.h"

namespace test_forged_state {

using namespace talus;
using namespace talus::test;
namespace fs = std::filesystem;

namespace {

// Ends a run after some steps, and keeps what it would have written.
class Short : public Observer {
 public:
  Short(Observer& next, int steps) : next_(next), left_(steps) {}
  void at(const Instant& i) override { next_.at(i); }
  void keep_state(const Standing& s, const State& state) override { next_.keep_state(s, state); }
  void fails(const Instant& i) override { next_.fails(i); }
  bool stop() override { return left_-- <= 0; }

 private:
  Observer& next_;
  int left_;
};

// A run that has got into its third stage, with its folder.
struct Saved {
  Folder folder;
  std::string model = bolted_bricks();
  fs::path state;

  PreparedRun prepare() const {
    Findings findings("m.toml", model);
    return prepare_run("m.toml", model, {"output.field_interval=10"}, findings);
  }

  Saved() {
    PreparedRun p = prepare();
    State s = start_state(p.scene);
    Recorder recorder(p.scene, ResultFolder(folder / "whole", false));
    Short some(recorder, 2400);
    const RunResult r = run_stages(p.scene, p.plans, s, some);
    REQUIRE(r.interrupted);
    REQUIRE(r.stages.size() == 3);
    recorder.finish(r);
    for (const auto& e : fs::directory_iterator(folder / "whole" / "saved"))
      if (e.path().filename().string().rfind("step_", 0) == 0) state = e.path().filename();
    REQUIRE(!state.empty());
  }
};

enum class End { kRan, kRefused, kSignal, kTooLong, kOther };

// Goes on from the archive in a process of its own.
End go_on(const Saved& saved, const Archive& archive) {
  const fs::path folder = saved.folder / "forged";
  fs::remove_all(folder);
  fs::copy(saved.folder / "whole", folder, fs::copy_options::recursive);
  write_archive(folder / "saved" / saved.state, archive);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    alarm(60);
    try {
      PreparedRun p = saved.prepare();
      SavedRun read = read_saved_run(folder / "saved" / saved.state, p);
      Recorder recorder(p.scene, ResultFolder::go_on(folder), read.archive);
      Short some(recorder, 15);
      const RunResult r = continue_stages(p.scene, p.plans, read.standing, read.state, some);
      recorder.finish(r);
      std::_Exit(0);
    } catch (const Error&) {
      std::_Exit(4);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s\n", e.what());
      std::_Exit(1);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGALRM ? End::kTooLong : End::kSignal;
  return WEXITSTATUS(status) == 0 ? End::kRan : WEXITSTATUS(status) == 4 ? End::kRefused : End::kOther;
}

enum class Forgery { kIndex, kSize, kNotFinite, kNegative, kLarge, kText };
constexpr Forgery kForgeries[] = {Forgery::kIndex,    Forgery::kSize,  Forgery::kNotFinite,
                                  Forgery::kNegative, Forgery::kLarge, Forgery::kText};

// One field of the archive made wrong; says which and how.
std::string forge(Forgery kind, Random& random, Archive& archive) {
  const auto any = [&random](size_t n) {
    return std::min(n - 1, static_cast<size_t>(random.uniform() * static_cast<double>(n)));
  };
  if (kind == Forgery::kText) {
    auto it = std::next(archive.texts.begin(), static_cast<long>(any(archive.texts.size())));
    const std::string values[] = {"", "x", std::string(100000, 'y'), "\xff\xfe\x01"};
    it->second = values[any(4)];
    return it->first;
  }
  auto it = archive.numbers.begin();
  do {
    it = std::next(archive.numbers.begin(), static_cast<long>(any(archive.numbers.size())));
  } while (it->second.empty() && kind != Forgery::kSize);
  std::vector<double>& list = it->second;
  if (kind == Forgery::kSize) {
    const size_t n = list.size();
    const size_t sizes[] = {n + 1, n == 0 ? 0 : n - 1, 2 * n, 0, n + 1000};
    list.resize(sizes[any(5)], list.empty() ? 0 : list[0]);
    return fmt::format("{} has {} values for {}", it->first, list.size(), n);
  }
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const std::map<Forgery, std::vector<double>> values{
      {Forgery::kIndex, {-2, -1, 0, 1, 3, 7, 30, 1e4, 32767, 2147483647, 2147483648.0, 1e15, 0.5}},
      {Forgery::kNotFinite, {std::nan(""), kEndless, -kEndless}},
      {Forgery::kNegative, {-1e-9, -1, -1e300, -0.0}},
      {Forgery::kLarge, {1e-300, 1e6, 1e30, 1e300}}};
  const std::vector<double>& choice = values.at(kind);
  const size_t at = any(list.size());
  list[at] = choice[any(choice.size())];
  return fmt::format("{}[{}] = {}", it->first, at, list[at]);
}

// Limits that a run may have without end, and the anchor of a contact that slides.
bool may_be_endless(const std::string& what) {
  for (const char* field : {"anchor", "rupture_strain", "limit", "yield", "most", "skin", "reach", "reuse",
                            "margin", "dt_bound", "dt_undamped"})
    if (what.find(field) != std::string::npos) return true;
  return false;
}

void forge_each(int count) {
  const Saved saved;
  const Archive right = read_archive(saved.folder / "whole" / "saved" / saved.state.string());
  REQUIRE(go_on(saved, right) == End::kRan);
  Random random(7);
  int ran = 0, refused = 0;
  for (const Forgery kind : kForgeries)
    for (int i = 0; i < count; ++i) {
      Archive wrong = right;
      const std::string what = forge(kind, random, wrong);
      INFO(what);
      const End end = go_on(saved, wrong);
      CHECK((end == End::kRan || end == End::kRefused));
      if (kind == Forgery::kNotFinite && !may_be_endless(what)) CHECK(end == End::kRefused);
      ran += end == End::kRan, refused += end == End::kRefused;
    }
  MESSAGE(ran, " states ran, ", refused, " were refused");
  CHECK(refused > 0);
}

}  // namespace

TEST_CASE("forged states: what would be found late is refused at once") {
  const Saved saved;
  const Archive right = read_archive(saved.folder / "whole" / "saved" / saved.state.string());
  const auto refused = [&](const char* what, const std::function<void(Archive&)>& forge) {
    INFO(what);
    Archive wrong = right;
    forge(wrong);
    CHECK(go_on(saved, wrong) == End::kRefused);
  };
  refused("a boundary that there is not sets the step",
          [](Archive& a) { a.numbers.at("run.stages.bound_column").back() = 0; });
  refused("the plan of a stage that is over",
          [](Archive& a) { a.numbers.at("run.stages.plan_steps")[0] += 1; });
  refused("displacements at the start without strains",
          [](Archive& a) { a.numbers.at("state.strain_part_start").clear(); });
  refused("a block that is excavated by then touches something", [&](Archive& a) {
    const auto prop = static_cast<double>(saved.prepare().scene.layout.blocks_called("prop")[0]);
    REQUIRE(!a.numbers.at("state.candidates.reach").empty());
    std::vector<double>& first = a.numbers.at("state.pairs.a");
    const auto &begin = a.numbers.at("state.pairs.begin"), &count = a.numbers.at("state.pairs.count");
    size_t p = 0;  // where the order of pairs stays
    while (p < first.size() && !(first[p] > prop && (p == 0 || first[p - 1] < prop))) ++p;
    REQUIRE(p < first.size());
    for (const char* side : {"block_a", "block_b"}) {
      std::vector<double>& block = a.numbers.at(std::string("state.patches.") + side);
      for (auto c = static_cast<size_t>(begin[p]); c < static_cast<size_t>(begin[p] + count[p]); ++c)
        if (block[c] == first[p]) block[c] = prop;
    }
    first[p] = prop;
  });
  refused("a table that ends in a number",
          [](Archive& a) { a.numbers.at("recorder.histories_csv")[0] -= 3; });
  refused("a table without title", [](Archive& a) { a.numbers.at("recorder.steps_csv")[0] = 0; });
}

TEST_CASE("states of runs that are stopped at the begin of a stage are taken up") {
  struct StopsAtStage : Observer {
    StopsAtStage(const Scene& s, int n) : scene(s), stage(n) {}
    void at(const Instant&) override {}
    void stage_begins(const Scene&, int now, const StagePlan&) override { reached = now == stage; }
    bool stop() override { return reached; }
    void keep_state(const Standing& standing, const State& state) override {
      archive = run_archive(scene, standing, state);
    }
    const Scene& scene;
    int stage;
    bool reached = false;
    Archive archive;
  };
  const std::string model = bolted_bricks();
  for (int stage = 0; stage < 3; ++stage) {
    Findings findings("m.toml", model);
    PreparedRun p = prepare_run("m.toml", model, {}, findings),
                fresh = prepare_run("m.toml", model, {}, findings);
    State state = start_state(p.scene);
    StopsAtStage observer(p.scene, stage);
    const RunResult r = run_stages(p.scene, p.plans, state, observer);
    REQUIRE(r.interrupted);
    REQUIRE(r.stages.size() == static_cast<size_t>(stage + 1));
    CHECK_NOTHROW(saved_run_of("state", observer.archive, fresh));
  }
}

TEST_CASE("forged states: refused or run, without a signal") { forge_each(25); }

TEST_SUITE("long: forged") {
  TEST_CASE("forged states: five hundred of each kind") { forge_each(500); }
}

}  // namespace test_forged_state
