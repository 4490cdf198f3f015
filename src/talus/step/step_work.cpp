#include "talus/step/step_work.h"

#include <fmt/format.h>

#include "talus/base/error.h"

namespace talus {

BlockRate rate_now(const StepWork& work, const State& state, size_t i) {
  TALUS_ASSERT(work.rate_before.size() == state.rate.size() && i < state.rate.size());
  // conventional DDA: velocities are those of the instant
  if (!state.carried_stress.empty()) return state.rate[i];
  return state.dt_before > 0 ? mean(work.rate_before[i], state.rate[i]) : work.rate_before[i];
}

RowKinds row_kinds(const Scene& scene, const StepWork& work) {
  return {hard_ties(work.rows, work.workers), joints_give(scene.laws), !work.clock.dynamic,
          work.clock.from_rest};
}

std::string row_name(const Scene& scene, const State& state, const StepWork& work, size_t row) {
  const PointRows& p = work.rows.points[row];
  const auto name = [&scene](int block) { return scene.blocks.name[block]; };
  const RowOwner owner = work.rows.owner[row];
  const std::string kind = entry(owner.family).name;
  const auto at = [&](const std::string& what) {
    return fmt::format("{} {} at {}", kind, what, name(p.block_a));
  };
  const auto boundary = [&scene](int which) { return scene.model.boundaries[which].name; };
  switch (owner.family) {
    case Family::kFace:
      break;
    case Family::kContact: {
      if (scene.by_patches()) {
        const Patch& c = state.patches[owner.at() / 2];
        return fmt::format("{} {} side {} on {} side {}", kind, name(c.block_a), c.side_a, name(c.block_b),
                           c.side_b);
      }
      const ContactKey& k = state.contacts[owner.at()].key;
      return fmt::format("{} {} corner {} on {} edge {}", kind, name(k.block_a), k.vertex, name(k.block_b),
                         k.edge);
    }
    case Family::kSupport:
      return at(scene.model.supports[scene.supported[owner.at()].support].name);
    case Family::kBoundary:
      return at(boundary(scene.boundaries.points[owner.at()].boundary));
    case Family::kTie:
      return at(boundary(scene.boundaries.ties[owner.at()].boundary));
    case Family::kBolt:
      return fmt::format("{} {} between {} and {}", kind,
                         scene.model.bolts[state.bolts[owner.at()].input].name, name(p.block_a),
                         name(p.block_b));
  }
  return fmt::format("{} {} - {}", kind, name(p.block_a), name(p.block_b));
}

}  // namespace talus
