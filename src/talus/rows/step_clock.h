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
  /// What dashpots of this damping time add to what alpha damps, which is that of a damping time of alpha dt: joints and blocks
  /// are damped by theirs whatever the step, as long as that is not longer [s]. None in steps from rest: they have no velocity.
  double dashpot_time(double damping_time) const {
    const double more = damping_time - alpha * dt;
    return from_rest || more < 0 ? 0 : more;
  }
  /// The same two of an elastic force with dashpots of this damping time beside it (eq. 4.1b).
  struct ElasticWeights {
    double position, old;
  };
  ElasticWeights elastic_weights(double damping_time) const {
    const double share = position_factor() * dashpot_time(damping_time) / (2 * dt),
                 all = 1 + (1 + alpha) * share;
    return {position_factor() / all, (old_share() - (1 - alpha) * share) / all};
  }
  /// Way of a point until the instant at which the law of its joint holds, and its velocity then, of those before and after
  /// the kick.
  double way_until(double before, double after) const {
    return dt / position_factor() * (after - old_share() * before);
  }
  double rate_then(double before, double after) const {
    return 0.5 * ((1 + alpha) * after + (1 - alpha) * before);
  }
};

}  // namespace talus
