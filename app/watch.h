#pragma once
// `talus run --watch`: the report of a run that goes on, written anew every few seconds.

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "talus/run/instant.h"

namespace talus::app {

/// Hands everything on, and has live.html of the folder written in between, by a process of `talus report` beside the run,
/// whose memory and steps stay its own: at most every kEvery seconds, and in at most a twentieth of the time. The page
/// reloads itself while the run goes on.
class LivePage : public Observer {
 public:
  LivePage(Observer& next, std::filesystem::path folder);

  void stage_is_followed(const Scene& scene, int stage, const StagePlan& plan,
                         const std::string& why) override {
    next_.stage_is_followed(scene, stage, plan, why);
  }
  void blocks_are_left_out(const Scene& scene, int stage, const std::string& who) override {
    next_.blocks_are_left_out(scene, stage, who);
  }
  void stage_begins(const Scene& scene, int stage, const StagePlan& plan) override {
    next_.stage_begins(scene, stage, plan);
  }
  void at(const Instant& instant) override;
  void fails(const Instant& instant) override { next_.fails(instant); }
  bool stop() override { return next_.stop(); }
  bool wants_state() override { return next_.wants_state(); }
  bool wants_copy() override { return next_.wants_copy(); }
  void hold_state(const Standing& standing, const State& state) override {
    next_.hold_state(standing, state);
  }
  void keep_state(const Standing& standing, const State& state) override {
    next_.keep_state(standing, state);
  }

  /// The page of the run that has ended, which does not reload. Never throws: what went wrong is told once.
  void finish();
  std::filesystem::path file() const { return folder_ / "live.html"; }

 private:
  void begin(double reload);
  void look(bool wait);
  void tell_once(const std::string& why);

  Observer& next_;
  std::filesystem::path folder_;
  double next_at_ = 0, begun_ = 0;  // wall time [s]
  pid_t writer_ = 0;                // 0: none at work
  int steps_ = 0;
  bool told_ = false;
};

}  // namespace talus::app
