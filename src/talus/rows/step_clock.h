#pragma once
// The one clock of a step: over which times its velocities and impulses act, how what depends on both of its
// ends is weighted, and where the histories stand. Theory: docs/theory.md 2.1, 2.2 and 4.6.

namespace talus {

struct StepClock {
  double dt = 0;            // over which the velocities act: the length of the step [s]
  double dt_kick = 0;       // over which the impulses act: from half a step ago to half a step ahead [s]
  double alpha = 0.2;       // damping of compliant rows and of implicit elasticity
  double history_time = 0;  // of the histories at the start of the step [s]
  double history_dt = 0;    // by which they go on: dt in dynamic stages, 0 where they stand still [s]
  bool dynamic = true;      // in true time, waves run; false: static
  bool from_rest = false;   // nothing moves before the step nor after it

  double history_end() const { return history_time + history_dt; }
  /// Where the histories of loads stand: a step from rest is in balance with those of its end.
  double load_time() const { return from_rest ? history_end() : history_time; }
  /// Factor 4 / (1 + alpha)^2 on the position.
  double position_factor() const { return 4 / ((1 + alpha) * (1 + alpha)); }
  /// Share r^2 of the velocity before the kick, r = (1 - alpha) / (1 + alpha).
  double old_share() const {
    const double r = (1 - alpha) / (1 + alpha);
    return r * r;
  }
};

}  // namespace talus
