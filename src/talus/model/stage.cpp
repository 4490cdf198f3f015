#include "talus/model/model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

namespace {

// First step of stages from rest [s], and how many of them the tractions of excavated rock last.
constexpr double kFirst = 0.02, kShares = 8;

}  // namespace

void StageInput::go_from_rest() {
  from_rest = implicit = true, from_rest_auto = elasticity_auto = false;
  damping_local = 0;
  if (std::isnan(time_step)) time_step = std::min(kFirst, duration);
  if (!excavate.empty() && relaxation.empty())
    relaxation = {{0, 0}, {std::min(kShares * time_step, duration), 1}};
}

void StageInput::go_from_rest_first() {
  may_follow = true, follow_implicit = implicit, follow_step = time_step;
  time_step = std::numeric_limits<double>::quiet_NaN();
  go_from_rest();
}

void StageInput::go_by_motion() {
  from_rest = may_follow = false;
  implicit = follow_implicit;
  damping_local = kStaticDamping;
  time_step = follow_step;
}

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
