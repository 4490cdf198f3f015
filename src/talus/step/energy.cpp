#include "talus/step/energy.h"

#include <algorithm>
#include <cmath>

#include "talus/rows/rows.h"

namespace talus {

double Energy::largest() const {
  double most = 0;
  for (const double term : {kinetic, strain, gravity, work.loads, work.supports, work.bonds, work.joints,
                            work.contact_closing, work.friction, work.damping, work.implicit})
    most = std::max(most, std::abs(term));
  return most;
}

Energy energy_now(const BlockSet& blocks, Vec2 gravity, const State& state) {
  Energy e;
  for (int i = 0; i < blocks.count; ++i) {
    if (!blocks.moves_freely(i)) continue;
    const auto k = static_cast<size_t>(i);
    e.gravity += blocks.mass[k] * dot(gravity, state.displacement[k]);
    if (blocks.kind[k] == BlockKind::kDeformable)
      e.strain += blocks.volume[k] * strain_energy_density(blocks.moduli[k], state.strain_part[k]);
  }
  return e;
}

double kinetic_energy(const BlockSet& blocks, const std::vector<BlockRate>& rate) {
  double sum = 0;
  for (int i = 0; i < blocks.count; ++i) {
    const auto k = static_cast<size_t>(i);
    if (blocks.moves_freely(i)) sum += 0.5 * work(momentum(blocks, k, rate[k]), rate[k]);
  }
  return sum;
}

}  // namespace talus
