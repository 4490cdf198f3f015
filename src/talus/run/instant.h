#pragma once
// What observers of a run are shown at every time step.

#include "talus/run/plan.h"
#include "talus/step/step.h"

namespace talus {

struct Standing;

struct Instant {
  const Scene& scene;
  const State& state;    // positions at state.time, rates half a step later
  const StepWork& work;  // rows, impulses, velocities at this instant
  const StepReport& report;
  const StagePlan& plan;
  double advance = 0;  // [s] by which time goes on; less than the step, work.clock.dt, in long ones from rest
  int stage = 0;
  bool stage_start = false;
  bool last = false;         // no step follows
  int64_t steps_before = 0;  // of this stage, also before a run went on from a saved state
  bool on_the_way = false;   // to the next balance of a path: no row of a table, no frame
};

/// Receives the instants of a run in order.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void stage_begins(const Scene&, int /*stage*/, const StagePlan&) {}
  /// A stage goes on by damped motion, as its steps from rest found no balance.
  virtual void stage_is_followed(const Scene&, int /*stage*/, const StagePlan&, const std::string& /*why*/) {}
  /// A stage in steps from rest waits for some blocks no longer, as they fall or slide on.
  virtual void blocks_are_left_out(const Scene&, int /*stage*/, const std::string& /*who*/) {}
  virtual void at(const Instant& instant) = 0;
  /// Shown the instant at which numerical trouble ends the run, after at() and before anything moved on.
  virtual void fails(const Instant& /*instant*/) {}
  /// Asked before every step; true ends the run after the present instant.
  virtual bool stop() { return false; }
  /// Asked before every step; true: keep_state() follows.
  virtual bool wants_state() { return false; }
  /// Asked before every step; true: hold_state() follows.
  virtual bool wants_copy() { return false; }
  /// Shown where the run could go on from, to be held in case the next steps fail.
  virtual void hold_state(const Standing& /*standing*/, const State& /*state*/) {}
  /// Shown where the run could go on from: when wanted, after every stage, and before a run that is stopped
  /// ends.
  virtual void keep_state(const Standing& /*standing*/, const State& /*state*/) {}
};

}  // namespace talus
