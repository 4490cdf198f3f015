#include <algorithm>
#include <cmath>

#include "talus/contact/hard_contact.h"
#include "talus/step/chunks.h"
#include "talus/step/parts.h"

namespace talus {

namespace {

// Norm of a generalised force as a force on the block's mass, sqrt(m F M^-1 F) [N]; the same in every frame.
double force_norm(const BlockSet& b, size_t i, const BlockForce& force) {
  return std::sqrt(b.mass[i] * std::max(0.0, work(force, accelerate(b, i, force))));
}

// Work of an impulse, 1/2 p (v0 + v1): `late` of p v1 belongs to the interval after it, the rest to the one
// before.
struct ImpulseWork {
  double before = 0, after = 0;
};
// Theory 8.
ImpulseWork work_of(const BlockForce& impulse, const BlockRate& v0, const BlockRate& v1, double late) {
  const double later = late * work(impulse, v1);
  return {0.5 * (work(impulse, v0) + work(impulse, v1)) - later, later};
}
void add(KickWork& sum, Cause cause, const ImpulseWork& w) {
  sum.before[cause] += w.before, sum.after[cause] += w.after;
}

// Sums over the blocks of a chunk.
struct BlockSums {
  KickWork work;
  double gravity = 0, strain = 0;  // energies of the positions
  double kinetic = 0;              // before the kick, and what weight and elasticity did of it before now
  double mean = 0, both = 0;       // kinetic energy of the mean velocity, mean of those before and after
  double jump = 0;                 // of the energy that central differences conserve
  double worst = 0, forces = 0;    // unbalanced force, and force
  double nudge = 0;                // kinetic energy that the forces would give in half a step
  double jolt = 0;                 // largest change of a velocity
  int jolted = -1;
  int worst_block = -1;
  int moving = 0;

  BlockSums& operator+=(const BlockSums& o) {
    work.before += o.work.before, work.after += o.work.after;
    gravity += o.gravity, strain += o.strain, kinetic += o.kinetic, jump += o.jump;
    mean += o.mean, both += o.both;
    if (o.worst > worst) worst = o.worst, worst_block = o.worst_block;
    if (o.jolt > jolt) jolt = o.jolt, jolted = o.jolted;
    forces += o.forces, nudge += o.nudge, moving += o.moving;
    return *this;
  }
};

// Where the work of a point goes: along its normal, along its tangent.
std::array<Cause, 2> causes_of(Family family, const PointRows& p, const Impulse& impulse) {
  if (!is_joint(family) || !p.is_soft()) return entry(family).cause;
  return {p.is_soft(0) ? Cause::kJoints : Cause::kContactClosing,
          slides(p, impulse) ? Cause::kFriction : Cause::kJoints};
}

// Theory 4.8, 8.
void tally_block(const Scene& scene, const Scheme& scheme, const StepWork& step, size_t i, State& state,
                 BlockSums& s) {
  const BlockSet& blocks = scene.blocks;
  const BlockRate &v0 = step.rate_before[i], &v1 = state.rate[i];
  if (!blocks.moves_freely(i)) return;
  const double late = scheme.late_share(), kick = step.clock.dt_kick;
  if (const double jolt = norm(v1.a - v0.a); jolt > s.jolt) s.jolt = jolt, s.jolted = static_cast<int>(i);
  add(s.work, Cause::kLoads, work_of(kick * step.load[i], v0, v1, late));
  if (is_weightless(step, state, i))
    add(s.work, Cause::kDamping, work_of(-kick * given_force(scene, step, i), v0, v1, late));
  if (scheme.settings.damping_mass > 0) {
    const BlockForce viscous = (-scheme.settings.damping_mass * kick) * momentum(blocks, i, mean(v0, v1));
    add(s.work, Cause::kDamping, work_of(viscous, v0, v1, late));
  }
  if (scheme.settings.damping_local > 0)
    add(s.work, Cause::kDamping, work_of(step.local_damping[i], v0, v1, late));

  if (scheme.settings.damping_stiffness > 0 && blocks.kind[i] == BlockKind::kDeformable)
    add(s.work, Cause::kDamping,
        work_of(scheme.stiffness_damping(i, v0, scheme.implicit(i) ? v1 : v0), v0, v1, late));

  BlockForce force = step.forces[i];
  if (scheme.implicit(i)) {
    const BlockForce more{
        {}, (-scheme.alpha_time2()) * scheme.tangent_force(i, v1.G - step.clock.old_share() * v0.G)};
    add(s.work, Cause::kImplicit, work_of(more, v0, v1, late));
    // a step from rest ends in balance but for M v/dt; what stands at its begin is judged (theory 14.3)
    if (!step.clock.from_rest) force += (1 / kick) * more;
  }
  const BlockForce rows = (1 / kick) * scheme.impulse_for(i, v1 - step.rate_free[i]);
  state.row_force[i] = rows;
  const double unbalanced = force_norm(blocks, i, force + rows);
  if (unbalanced > s.worst && !state.is_left_out(i))
    s.worst = unbalanced, s.worst_block = static_cast<int>(i);
  const double acting = 0.5 * (force_norm(blocks, i, force) + force_norm(blocks, i, rows));
  s.forces += acting;
  s.nudge += 0.125 * kick * kick * acting * acting / blocks.mass[i];
  ++s.moving;

  s.gravity += blocks.mass[i] * dot(scene.model.gravity, state.displacement[i]);
  s.strain += blocks.volume[i] * step.elastic[i].density;
  const double energy_0 = 0.5 * work(momentum(blocks, i, v0), v0);
  s.kinetic += energy_0;
  // at the start v0 is the velocity of this instant, later that of half a step ago
  const BlockRate now = state.dt_before > 0 ? mean(v0, v1) : v0;
  s.mean += 0.5 * work(momentum(blocks, i, now), now);
  s.both += 0.5 * energy_0 + 0.25 * work(momentum(blocks, i, v1), v1);
  // weight and elastic resistance, whose energies are taken from the positions
  BlockForce own = kick * (step.forces[i] + (-1) * step.load[i]);
  if (!step.bolt_forces.empty()) {
    const BlockForce bars = kick * step.bolt_forces[i];
    add(s.work, Cause::kBolts, work_of(bars, v0, v1, late));
    own += (-1) * bars;
  }
  const double before = work_of(own, v0, v1, late).before;
  s.kinetic += before;
  s.jump += before - (1 - late) * work(own, v0);
}

}  // namespace

RowSums& RowSums::operator+=(const RowSums& o) {
  work.before += o.work.before, work.after += o.work.after;
  closed += o.closed, drift = std::max(drift, o.drift);
  if (o.closed_share > closed_share) closed_share = o.closed_share, closed_row = o.closed_row;
  on_driven.insert(on_driven.end(), o.on_driven.begin(), o.on_driven.end());
  return *this;
}

// Theory 8.
void tally_row(const BlockSet& blocks, const StepWork& step, const State& state, size_t r,
               const std::array<double, 2>& u, RowSums& s) {
  const PointRows& p = step.rows.points[r];
  const Impulse& impulse = step.rows.impulse[r];
  const RowOwner owner = step.rows.owner[r];
  const bool contact = owner.family == Family::kContact;
  if (contact) {
    const double gap = step.gaps[owner.at()];
    if (!p.is_soft(0)) s.drift = std::max(s.drift, -gap);
    const double closed = closed_share(blocks, state, p.block_a, p.block_b, gap, p.normal);
    if (closed > s.closed_share) s.closed_share = closed, s.closed_row = static_cast<int>(r);
  }
  if (impulse[0] == 0 && impulse[1] == 0) return;
  for (const auto& [block, sign] : {std::pair(p.block_a, 1.0), std::pair(p.block_b, -1.0)})
    if (block >= 0 && blocks.kind[block] == BlockKind::kDriven)
      s.on_driven.emplace_back(block, impulse_on(p, impulse, sign));
  const auto u0 = relative_velocity(p, step.rate_before);
  const std::array<Cause, 2> cause = causes_of(owner.family, p, impulse);
  for (size_t k = 0; k < 2; ++k) {
    s.work.before[cause[k]] += 0.5 * impulse[k] * u0[k];
    s.work.after[cause[k]] += 0.5 * impulse[k] * u[k];
  }
  s.closed += contact || (is_joint(owner.family) && p.is_soft());
}

// Theory 8.
void tally_dashpots(const StepWork& step, size_t r, const std::array<double, 2>& u,
                    const std::array<double, 2>& impulse, RowSums& s) {
  if (impulse[0] == 0 && impulse[1] == 0) return;
  const auto u0 = relative_velocity(step.rows.points[r], step.rate_before);
  for (size_t k = 0; k < 2; ++k)
    for (const auto& [cause, sign] : {std::pair(Cause::kDamping, 0.5), std::pair(Cause::kJoints, -0.5)}) {
      s.work.before[cause] += sign * impulse[k] * u0[k];
      s.work.after[cause] += sign * impulse[k] * u[k];
    }
}

void tally(const Scene& scene, const Scheme& scheme, const RowSums& rows, StepWork& work, State& state,
           StepReport& report) {
  work.work.before += rows.work.before, work.work.after += rows.work.after;
  report.closed = rows.closed;
  report.drift = rows.drift;
  report.closed_share = rows.closed_share, report.closed_row = rows.closed_row;
  // a driven block passes on the work that its drive does against the rows
  for (const auto& [block, impulse] : rows.on_driven) {
    add(work.work, Cause::kSupports,
        work_of(-1.0 * impulse, work.rate_before[block], state.rate[block], 0.5));
  }
  const BlockSums sums = work.workers.sum_chunks<BlockSums>(state.rate.size(), kChunkOfBlocks,
                                                            [&](size_t begin, size_t end, BlockSums& s) {
                                                              for (size_t i = begin; i < end; ++i)
                                                                tally_block(scene, scheme, work, i, state, s);
                                                            });
  work.work.before += sums.work.before, work.work.after += sums.work.after;
  report.worst_block = sums.worst_block, report.worst_force = sums.worst;
  report.unbalanced = sums.forces > 0 ? sums.worst / (sums.forces / sums.moving) : 0;
  report.nudge = sums.nudge;
  report.jolt = sums.jolt / work.clock.dt_kick, report.jolted = sums.jolted;

  Energy& e = report.energy;
  e.gravity = sums.gravity, e.strain = sums.strain;
  e.work = state.work;
  e.work += work.work.before;
  // kinetic energy half a step ago, and the part of this kick that came before now: 1/2 v- M v+ for equal
  // steps
  const double ledger = sums.kinetic + work.work.before.total();
  e.kinetic = sums.mean, e.moving = sums.both, e.between = ledger - e.kinetic;
  // with unequal steps the energy that central differences conserve jumps, of second order in them: no work
  state.energy_start += sums.jump;
  e.left_over = ledger + e.strain - state.energy_start - e.gravity - e.work.total();
}

}  // namespace talus
