// A run in pieces has the bits of the whole one, however it is cut; where it pauses, is stopped or fails.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstring>

#include "support/model_text.h"
#include "support/run_case.h"
#include "talus/run/saved_state.h"

namespace test_staged_run {

using namespace talus;
using namespace talus::test;

namespace {

// A heap of two blocks comes to rest, one is taken away, and the other falls and slides.
std::string heap(const std::string& rest) {
  std::string text = friction_model({0, -10}, 20, 0.2, 0.002);
  const size_t stages = text.find("[[stage]]");
  text = text.substr(0, stages) + block_text("ground", {{-1, -1}, {3, -1}, {3, 0}, {-1, 0}}, "fixed") +
         block_text("prop", {{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}}, "rigid") +
         block_text("load", {{0.2, 0.5}, {1.2, 0.5}, {1.2, 1.5}, {0.2, 1.5}}, "rigid", "velocity = [0, 0]") +
         text.substr(stages);
  return text.insert(text.find("[[stage]]"),
                     fmt::format("[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 5\n{}\n", rest)) +
         "excavate = [\"prop\"]\n";
}

struct Driven {
  PreparedRun prepared;
  State state;
  RunResult result;
  std::vector<std::string> seen;  // every instant, bit by bit
  int64_t kept = 0;               // states between stages or at a stop
};

class Looker : public Observer {
 public:
  explicit Looker(Driven& driven) : driven_(driven) {}
  void stage_begins(const Scene&, int stage, const StagePlan&) override {
    driven_.seen.push_back(fmt::format("stage {}", stage));
  }
  void at(const Instant& now) override {
    std::string line =
        fmt::format("{:a} {} {} {} {}", now.state.time, now.state.step, now.stage, now.stage_start, now.last);
    for (const Vec2 d : now.state.displacement) line += fmt::format(" {:a} {:a}", d.x, d.y);
    driven_.seen.push_back(line);
  }
  void keep_state(const Standing&, const State&) override { ++driven_.kept; }

 private:
  Driven& driven_;
};

Driven drive(const std::string& text, const std::function<void(StagedRun&)>& how) {
  Driven d;
  Findings findings("model.toml", text);
  d.prepared = prepare_run("model.toml", text, {}, findings);
  d.state = start_state(d.prepared.scene);
  Looker looker(d);
  StagedRun run(d.prepared.scene, d.prepared.plans, d.state, looker);
  how(run);
  d.result = run.result();
  return d;
}

void to_the_end(StagedRun& run) { CHECK_FALSE(run.advance({})); }

}  // namespace

TEST_CASE("a run in pieces has the bits of the whole") {
  // damped, from rest to rest, and by the penalty method
  for (const std::string& text :
       {heap("damping_local = 0.7\ntime_step = 0.002"), heap("integration = \"implicit\""),
        heap("time_step = 0.002") + "[penalty]\n"}) {
    std::string model = text;
    if (model.find("[penalty]") != std::string::npos)
      model.replace(model.find("[model]\n"), 8, "[model]\nformulation = \"penalty\"\n");
    INFO(model);
    const Driven whole = drive(model, to_the_end);
    REQUIRE(whole.result.failure.empty());
    REQUIRE(whole.result.stages.size() == 2);
    for (const int64_t steps : {1, 7, 1000000}) {
      const Driven parts = drive(model, [&](StagedRun& run) {
        Pause pause;
        pause.steps = steps;
        while (run.advance(pause)) CHECK_FALSE(run.over());
        CHECK(run.over());
        CHECK_FALSE(run.advance(pause));
      });
      CHECK(parts.seen == whole.seen);
      CHECK(parts.kept == whole.kept);
      CHECK(parts.result.steps == whole.result.steps);
      CHECK(parts.result.energy.left_over == whole.result.energy.left_over);
    }
  }
}

TEST_CASE("a run pauses at a number of steps, at a time and between stages") {
  drive(heap("damping_local = 0.7\ntime_step = 0.002"), [&](StagedRun& run) {
    CHECK(run.advance({.steps = 0}));
    CHECK(run.result().stages.size() == 1);
    CHECK(run.result().stages[0].steps == 0);
    CHECK(run.advance({.steps = 2}));
    CHECK(run.result().stages[0].steps == 2);
    CHECK(run.advance({.stage_end = true}));
    CHECK(run.standing().between);
    CHECK(run.result().stages.size() == 1);
    CHECK(run.result().stages[0].at_rest);
    const double begin = run.result().stages[0].end;
    CHECK(run.advance({.time = begin + 0.05}));
    CHECK(run.result().stages[1].steps == 25);  // of 2 ms, though their sum is not round
    CHECK(run.advance({.time = begin + 0.051}));
    CHECK(run.result().stages[1].steps == 26);
    CHECK(run.advance({.time = 0}));  // that has been
    CHECK(run.result().stages[1].steps == 26);
    CHECK_FALSE(run.advance({.stage_end = true}));  // none follows
    CHECK(run.result().stages[1].steps == 100);
  });
}

TEST_CASE("a run that is stopped ends like one that its observer stops, and goes on from there") {
  const std::string text = heap("damping_local = 0.7\ntime_step = 0.002");
  const Driven whole = drive(text, to_the_end);
  std::optional<Standing> standing;
  Driven half = drive(text, [&](StagedRun& run) {
    CHECK(run.advance({.stage_end = true}));
    CHECK(run.advance({.steps = 30}));
    standing = run.standing();
    run.stop();
    CHECK(run.over());
    run.stop();  // once more does nothing
  });
  CHECK(half.result.interrupted);
  CHECK(half.kept == 2);
  CHECK(half.seen.back().find(" true 0x") != std::string::npos);
  Findings findings("model.toml", text);
  PreparedRun again = prepare_run("model.toml", text, {}, findings);
  Looker looker(half);
  StagedRun run(again.scene, again.plans, half.state, looker, Workers(), &*standing);
  to_the_end(run);
  CHECK(half.seen.back() == whole.seen.back());
  // one that is stopped before its first step has shown where it began
  const Driven none = drive(text, [](StagedRun& r) { r.stop(); });
  CHECK(none.result.interrupted);
  CHECK(none.seen.size() == 2);
}

TEST_CASE("a run that fails is over, and says why") {
  std::string text = heap("damping_local = 0.7\ntime_step = 0.002");
  text.replace(text.find("duration = 5"), 12, "duration = 0.02");  // too short to come to rest
  text.replace(text.find("velocity = [0, 0]"), 17, "velocity = [0, 3]");
  const Driven failed = drive(text, [](StagedRun& run) {
    while (run.advance({.steps = 3})) CHECK(run.result().failure.empty());
  });
  CHECK(failed.result.failure.find("did not come to rest") != std::string::npos);
  CHECK(failed.result.stages.size() == 1);
}

}  // namespace test_staged_run
