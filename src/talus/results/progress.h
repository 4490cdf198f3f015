#pragma once
// What a user sees while a run goes on: one rewritten line on a terminal, plain lines otherwise.

#include <cstdio>

#include "talus/results/pace.h"
#include "talus/results/recorder.h"

namespace talus {

/// Passes every instant on to another observer and shows stage, time, steps per second, time to go and worst
/// error.
class Progress : public Observer {
 public:
  /// @param out       where lines go
  /// @param terminal  whether `out` is one: the line is then rewritten twice a second, else a line every 10 s
  Progress(Observer& next, std::FILE* out, bool terminal) : next_(next), out_(out), terminal_(terminal) {}

  void stage_begins(const Scene& scene, int stage, const StagePlan& plan) override;
  void stage_is_followed(const Scene& scene, int stage, const StagePlan& plan,
                         const std::string& why) override;
  void blocks_are_left_out(const Scene& scene, int stage, const std::string& who) override;
  void at(const Instant& instant) override;
  bool stop() override { return next_.stop(); }
  bool wants_state() override { return next_.wants_state(); }
  void fails(const Instant& instant) override { next_.fails(instant); }
  bool wants_copy() override { return next_.wants_copy(); }
  void hold_state(const Standing& standing, const State& state) override {
    next_.hold_state(standing, state);
  }
  void keep_state(const Standing& standing, const State& state) override {
    next_.keep_state(standing, state);
  }
  /// Ends a rewritten line.
  void finish();

 private:
  void show(const Instant& instant, double now);

  Observer& next_;
  std::FILE* out_;
  bool terminal_;
  double last_shown_ = 0, stage_wall_ = 0, worst_error_ = 0;
  Pace pace_;
  int64_t stage_step_ = 0;
  bool line_open_ = false;
};

/// Prints without fail: a run goes on when nobody can be told of it. ferror() of the stream keeps that.
void say(std::FILE* out, const std::string& text);

/// Closing lines of a run: what happened and how far to trust it.
std::string closing_text(const Scene& scene, const RunResult& result, const JointSummary& joints,
                         const BoltSummary& bolts, const std::string& folder,
                         const std::optional<audit::Report>& audit = std::nullopt);

}  // namespace talus
