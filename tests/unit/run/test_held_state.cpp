// The state that a run holds in memory in case it fails: it moves on with the run.

#include <doctest/doctest.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "support/closing_jaws.h"
#include "support/folder.h"
#include "support/results.h"
#include "talus/talus.h"

namespace test_held_state {

using namespace talus;
using namespace talus::test;

namespace {

constexpr int64_t kWaits = 2000;  // steps; the jaws touch after 4000

// Lets a second pass at one step: holding a state of three blocks takes no fiftieth of it.
class Waits : public Observer {
 public:
  explicit Waits(Observer& next) : next_(next) {}
  void at(const Instant& i) override {
    if (i.state.step == kWaits) std::this_thread::sleep_for(std::chrono::seconds(1));
    next_.at(i);
  }
  bool wants_copy() override { return next_.wants_copy(); }
  void hold_state(const Standing& s, const State& state) override { next_.hold_state(s, state); }
  void fails(const Instant& i) override { next_.fails(i); }

 private:
  Observer& next_;
};

}  // namespace

TEST_CASE("a run that fails saves the state it held last") {
  const Folder folder;
  const std::string model = closing_jaws(0.1);
  Findings findings("m.toml", model);
  PreparedRun p = prepare_run("m.toml", model, {}, findings);
  State s = start_state(p.scene);
  Recorder recorder(p.scene, ResultFolder(folder / "out", false));
  Waits waits(recorder);
  const RunResult r = run_stages(p.scene, p.plans, s, waits);
  REQUIRE(!r.failure.empty());
  recorder.finish(r);
  const int step = std::atoi(newest_state(folder / "out").c_str() + 5);  // step_N.h5
  CHECK(step > kWaits);
  CHECK(step <= r.steps);
}

}  // namespace test_held_state
