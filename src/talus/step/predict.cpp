#include <algorithm>
#include <cmath>

#include "talus/step/chunks.h"
#include "talus/step/parts.h"

namespace talus {

namespace {

// Theory 4.12.
void kick_free_field(const Scene& scene, const StepSettings& settings, const std::vector<Vec2>& acceleration,
                     StepWork& work, State& state) {
  if (work.clock.dynamic) {
    std::optional<StepClock::ElasticWeights> elastic;
    if (settings.implicit) elastic = work.clock.elastic_weights(settings.damping_stiffness);
    kick_columns(scene.boundaries.free_field, scene.model.histories, work.clock, settings.damping_mass,
                 scene.model.inertia == Inertia::kLumped, elastic, acceleration, state, work.columns);
  } else {
    work.columns = {state.column_rate, state.column_displacement};
  }
}

// Share of the unbalanced force, set against the motion of the whole block in the metric of its mass: the
// same in every frame. Contact forces are those of the step before, as this step's are still unknown. It
// never turns a motion round: like friction it stops it at most (theory 4.4).
BlockForce local_damping_impulse(const Scheme& scheme, const StepWork& step, const State& state, size_t i) {
  const BlockRate& v = state.rate[i];
  const BlockForce moving = momentum(scheme.blocks, i, v);
  const double speed = std::sqrt(std::max(0.0, work(moving, v)));
  if (speed == 0) return {};
  const BlockForce unbalanced = step.forces[i] + state.row_force[i];
  const double push = std::sqrt(std::max(0.0, work(unbalanced, accelerate(scheme.blocks, i, unbalanced))));
  return -std::min(scheme.settings.damping_local * push * scheme.clock.dt_kick / speed, 1.0) * moving;
}

// `renew`: the mobility is not that of the step before (eq. 2.1).
void predict_block(const Scene& scene, const Scheme& scheme, size_t k, bool renew, StepWork& work,
                   State& state) {
  const BlockSet& blocks = scene.blocks;
  if (!blocks.moves_freely(k)) {
    if (renew) work.mobility[k] = {};
    return;
  }
  BlockForce& force = work.forces[k];
  force = is_weightless(work, state, k) ? BlockForce{} : given_force(scene, work, k);
  if (blocks.kind[k] == BlockKind::kDeformable) {
    work.elastic[k] = elastic_state(blocks.moduli[k], state.strain_part[k], initial_stress_of(state, k));
    force.Q += (-blocks.volume[k]) * work.elastic[k].stress;
  }
  if (!work.bolt_forces.empty()) force += work.bolt_forces[k];
  const bool implicit = scheme.implicit(k);
  const double share = scheme.share();
  if (implicit)
    work.mobility[k] = mobility_implicit(blocks, k, work.elastic[k].rotation, share, scheme.tangent_time2());
  else if (renew)
    work.mobility[k] = mobility_of(blocks, k, share);
  BlockRate& v = state.rate[k];
  BlockForce impulse = work.clock.dt_kick * force;
  if (scheme.settings.damping_local > 0)
    impulse += work.local_damping[k] = local_damping_impulse(scheme, work, state, k);
  if (scheme.explicitly_damped(k)) impulse += scheme.stiffness_damping(k, v, v);
  if (!implicit && share == 1) {
    v = v + accelerate(blocks, k, impulse);
    return;
  }
  // M_eff (v+ - v-) = impulse - what the terms of v+ in M_eff and of v- in the step's laws differ by
  impulse += (-2 * scheme.damping()) * momentum(blocks, k, v);
  if (implicit)
    impulse += BlockForce{
        {}, -(1 - scheme.elastic_weights().old) * scheme.tangent_time2() * scheme.tangent_force(k, v.G)};
  v = v + accelerate(work.mobility[k], impulse);
}

}  // namespace

void add_forces(const Scene& scene, const StepSettings& settings, StepWork& work, State& state) {
  const BlockSet& blocks = scene.blocks;
  const double time = work.clock.load_time();
  const std::vector<Vec2> acceleration = load_acceleration(scene.model, scene.loads, blocks.count, time);
  work.load.resize(acceleration.size());
  work.workers.for_chunks(work.load.size(), kChunkOfBlocks, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) work.load[k] = {blocks.mass[k] * acceleration[k], {}};
  });
  add_edge_and_point_loads(blocks, scene.model, scene.loads, state, time, work.load);
  work.workers.for_chunks(state.kept_force.size(), kChunkOfBlocks, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) work.load[k] += (1 - state.relaxed) * state.kept_force[k];
  });
  {
    const InPart part(work.profile, Profile::kBolts);
    balance_bolts(state);
    work.bolt_forces.assign(state.bolts.empty() ? 0 : work.load.size(), {});
    if (!state.bolts.empty()) add_bolt_forces(blocks, state, work.bolt_forces);
  }
  const InPart part(work.profile, Profile::kHeld);
  kick_free_field(scene, settings, acceleration, work, state);
}

void predict(const Scene& scene, const Scheme& scheme, StepWork& work, State& state) {
  const StepSettings& settings = scheme.settings;
  const size_t n = state.rate.size();
  work.forces.resize(n);
  work.elastic.resize(n);
  work.local_damping.resize(settings.damping_local > 0 ? n : 0);
  const bool renew = settings.implicit || work.mobility.size() != n || work.mobility_share != scheme.share();
  work.mobility.resize(n), work.rate_before.resize(n), work.rate_free.resize(n);
  work.workers.for_chunks(n, kChunkOfBlocks, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      work.rate_before[i] = state.rate[i];
      predict_block(scene, scheme, i, renew, work, state);
      work.rate_free[i] = state.rate[i];
    }
  });
  work.mobility_share = settings.implicit ? 0 : scheme.share();
  for (auto* rate : {&state.rate, &work.rate_free})
    drive_blocks(scene.blocks, scene.model, scene.layout, state, work.clock, *rate);
}

}  // namespace talus
