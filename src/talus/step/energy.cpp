#include "talus/step/energy.h"

#include <algorithm>
#include <cmath>

#include "talus/rows/rows.h"

namespace talus {

double Energy::largest() const {
  double most = 0;
  for (const double term : {kinetic, strain, gravity}) most = std::max(most, std::abs(term));
  for (const double term : work.by) most = std::max(most, std::abs(term));
  return most;
}

double kinetic_energy(const BlockSet& blocks, const std::vector<BlockRate>& rate) {
  double sum = 0;
  for (int i = 0; i < blocks.count; ++i) {
    if (blocks.moves_freely(i)) sum += 0.5 * work(momentum(blocks, i, rate[i]), rate[i]);
  }
  return sum;
}

}  // namespace talus
