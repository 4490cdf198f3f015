#include <fmt/format.h>

#include <atomic>

#include "talus/base/clock.h"
#include "talus/base/error.h"
#include "talus/step/chunks.h"
#include "talus/step/step.h"

namespace talus {

namespace {

// Moves block k; false when the result is no block any more (eq. 2.1).
bool drift_block(const BlockSet& blocks, double dt, size_t k, State& state) {
  const BlockRate& v = state.rate[k];
  if (!is_finite(v.a) || !is_finite(v.G)) return false;
  state.displacement[k] += dt * v.a;
  if (blocks.kind[k] == BlockKind::kDeformable) {
    state.strain_part[k] += dt * v.G;
    return det(kIdentity + state.strain_part[k]) > 0;
  }
  // the spin matrix acts on the turned arm: nothing to update
  state.angle[k] += dt * v.G.yx;
  state.strain_part[k] = rotation_minus_identity(state.angle[k]);
  return true;
}

// Nothing goes on from a step of backward Euler: its rates only tell the next how far to look. Its forces act
// over all of the way, but that of implicit elasticity, which grows from nothing; v M v is lost (theory 14.6).
void settle_work(const StepWork& work, const StepReport& report, State& state) {
  WorkDone more = work.work.after;
  more[Cause::kImplicit] = 0;
  state.work += more;
  state.work[Cause::kDamping] -= 4 * report.energy.moving;
}

}  // namespace

void drift(const Scene& scene, double time_end, StepWork& work, State& state, StepReport& report) {
  TALUS_ASSERT(work.rate_before.size() == state.rate.size() && time_end >= state.time);
  const InPart part(work.profile, Profile::kBlocks);
  const BlockSet& blocks = scene.blocks;
  const double dt = work.clock.dt;
  std::atomic<size_t> bad{state.rate.size()};
  work.workers.for_chunks(state.rate.size(), kChunkOfBlocks, [&](size_t begin, size_t end) {
    for (size_t k = begin; k < end; ++k) {
      if (drift_block(blocks, dt, k, state)) continue;
      for (size_t least = bad; k < least && !bad.compare_exchange_weak(least, k);) {
      }
    }
  });
  if (bad < state.rate.size()) {
    const size_t k = bad;
    const BlockRate& v = state.rate[k];
    if (!is_finite(v.a) || !is_finite(v.G))
      throw NumericalError(fmt::format(
          "the motion of block \"{}\" is not finite at t = {:.9g} s, step {}; worst contact row: {}",
          blocks.name[k], state.time, state.step, report.worst));
    throw NumericalError(
        fmt::format("block \"{}\" turned inside out (det F = {:.3g}) at t = {:.9g} s, step {}",
                    blocks.name[k], det(kIdentity + state.strain_part[k]), time_end, state.step));
  }
  for (size_t i = 0; work.clock.dynamic && i < state.column_rate.size(); ++i)
    state.column_displacement[i] += dt * state.column_rate[i];
  state.work += work.work.before;
  state.work += work.work.after;
  if (work.clock.from_rest) settle_work(work, report, state);
  report.broken_faces = update_bonds(blocks, scene.bonds, scene.laws, dt, work.workers, state);
  state.time = time_end;
  state.history_time = work.clock.history_end();
  state.dt_before = work.clock.from_rest ? 0 : dt;
  ++state.step;
}

}  // namespace talus
