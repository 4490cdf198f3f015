#include <fmt/format.h>

#include "talus/step/step.h"

namespace talus {

std::string row_name(const Scene& scene, const State& state, const StepWork& work, size_t row) {
  const PointRows& p = work.rows.points[row];
  const auto name = [&scene](int block) { return scene.blocks.name[static_cast<size_t>(block)]; };
  const RowOwner owner = work.rows.owner[row];
  const std::string kind = entry(owner.family).name;
  const auto at = [&](const std::string& what) {
    return fmt::format("{} {} at {}", kind, what, name(p.block_a));
  };
  const auto boundary = [&scene](int which) {
    return scene.model.boundaries[static_cast<size_t>(which)].name;
  };
  switch (owner.family) {
    case Family::kFace:
      break;
    case Family::kContact: {
      const ContactKey& k = state.contacts[owner.at()].key;
      return fmt::format("{} {} corner {} on {} edge {}", kind, name(k.block_a), k.vertex, name(k.block_b),
                         k.edge);
    }
    case Family::kSupport:
      return at(scene.model.supports[static_cast<size_t>(scene.supported[owner.at()].support)].name);
    case Family::kBoundary:
      return at(boundary(scene.boundaries.points[owner.at()].boundary));
    case Family::kTie:
      return at(boundary(scene.boundaries.ties[owner.at()].boundary));
    case Family::kBolt:
      return fmt::format("{} {} between {} and {}", kind,
                         scene.model.bolts[static_cast<size_t>(state.bolts[owner.at()].input)].name,
                         name(p.block_a), name(p.block_b));
  }
  return fmt::format("{} {} - {}", kind, name(p.block_a), name(p.block_b));
}

}  // namespace talus
