#include "talus/step/energy.h"

#include <algorithm>
#include <cmath>

#include "talus/rows/rows.h"

namespace talus {

double Energy::largest() const {
  double most = 0;
  for (const double term :
       {kinetic, strain, gravity, work.loads, work.supports, work.boundary, work.bonds, work.joints,
        work.contact_closing, work.friction, work.damping, work.bolts, work.implicit})
    most = std::max(most, std::abs(term));
  return most;
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
