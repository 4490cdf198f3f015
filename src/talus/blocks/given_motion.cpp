#include "talus/blocks/given_motion.h"

#include <algorithm>
#include <cmath>

namespace talus {

double fastest_given(const Model& model, const Layout& layout, const BlockSet& blocks) {
  double fastest = 0;
  const auto follow = [&](const Motion& m) {
    if (m.history < 0) return;
    const History& h = model.histories[m.history];
    for (size_t i = 0; i < h.time.size(); ++i) {
      if (m.kind == Motion::kVelocity) fastest = std::max(fastest, std::abs(h.value[i]));
      if (m.kind == Motion::kDisplacement && i > 0)
        fastest = std::max(fastest, std::abs((h.value[i] - h.value[i - 1]) / (h.time[i] - h.time[i - 1])));
    }
  };
  for (size_t i = 0; i < layout.blocks.size(); ++i) {
    const BlockShape& b = layout.blocks[i];
    fastest = std::max(fastest, norm(b.velocity) + std::abs(b.spin) * blocks.radius[i]);
    follow(b.motion_x), follow(b.motion_y);
  }
  for (const SupportInput& s : model.supports) follow(s.x), follow(s.y);
  return fastest;
}

}  // namespace talus
