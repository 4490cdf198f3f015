#include "talus/model/model.h"

namespace talus {

double StageInput::relaxed_at(double t, double before) const {
  if (relaxation.empty()) return before;
  if (t <= relaxation.front().x) return relaxation.front().y;
  for (size_t i = 1; i < relaxation.size(); ++i) {
    const Vec2 a = relaxation[i - 1], b = relaxation[i];
    if (t < b.x) return a.y + (t - a.x) / (b.x - a.x) * (b.y - a.y);
  }
  return relaxation.back().y;
}

}  // namespace talus
