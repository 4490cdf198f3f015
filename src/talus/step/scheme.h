#pragma once
// What a step's scheme makes of each block: which elasticity is implicit, what damping takes. Not for use
// outside step/. Theory: docs/theory.md 4.3, 4.5, 4.9.

#include "talus/step/step_work.h"

namespace talus {

struct Scheme {
  const BlockSet& blocks;
  const StepSettings& settings;
  const StepClock& clock;
  const std::vector<ElasticState>& elastic;  // of this instant

  /// Half the share of its momentum that mass-proportional damping takes of a block in the step (theory 4.3).
  double damping() const { return 0.5 * settings.damping_mass * clock.dt_kick; }
  /// Factor on the inverse mass that comes of it.
  double share() const { return 1 / (1 + damping()); }
  /// Share of a kick that belongs to the step after it: half, unless the step length changes; all of it at
  /// the start.
  double late_share() const { return 0.5 * clock.dt / clock.dt_kick; }

  bool implicit(size_t i) const { return settings.implicit && blocks.kind[i] == BlockKind::kDeformable; }
  /// Stiffness-proportional damping is of the rates before the kick where elasticity is explicit, one with it where it is
  /// implicit.
  bool explicitly_damped(size_t i) const {
    return settings.damping_stiffness > 0 && !settings.implicit && blocks.kind[i] == BlockKind::kDeformable;
  }

  /// Block-implicit elasticity with dashpots (theory 4.9): the force is -V [P + K (dt/k) (G+ - r^2 G-)], the alpha family of 4.6.
  StepClock::ElasticWeights elastic_weights() const {
    return clock.elastic_weights(settings.damping_stiffness);
  }
  /// Factor on K in the mass of the step [s2]; of all, and of the alpha family alone.
  double tangent_time2() const { return clock.dt * clock.dt_kick / elastic_weights().position; }
  double alpha_time2() const { return clock.dt * clock.dt_kick / clock.position_factor(); }

  /// V K : G, the elastic tangent in the frame turned with the block.
  Mat2 tangent_force(size_t i, const Mat2& G) const {  // theory 4.9
    const Mat2 r = rotation(elastic[i].rotation), e = transpose(r) * G;
    const PlaneModuli& c = blocks.moduli[i];
    const double shear = c.c33 * (e.xy + e.yx);
    return blocks.volume[i] *
           (r * Mat2{c.c11 * e.xx + c.c12 * e.yy, shear, shear, c.c12 * e.xx + c.c11 * e.yy});
  }
  /// Impulse of stiffness-proportional damping (theory 4.5, 4.9). @param after  rates; with explicit elasticity those before
  BlockForce stiffness_damping(size_t i, const BlockRate& before, const BlockRate& after) const {
    const double time =
        implicit(i) ? clock.dashpot_time(settings.damping_stiffness) : settings.damping_stiffness;
    const double a = implicit(i) ? clock.alpha : 0;
    return {{}, (-0.5 * time * clock.dt_kick) * tangent_force(i, (1 - a) * before.G + (1 + a) * after.G)};
  }
  /// Impulse that gives a block this change of its rates: the effective mass times it.
  BlockForce impulse_for(size_t i, const BlockRate& change) const {
    BlockForce impulse = (1 + damping()) * momentum(blocks, i, change);
    if (implicit(i)) impulse += BlockForce{{}, tangent_time2() * tangent_force(i, change.G)};
    return impulse;
  }
};

}  // namespace talus
