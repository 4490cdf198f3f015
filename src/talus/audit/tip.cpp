#include "talus/audit/tip.h"

#include <algorithm>
#include <cmath>

#include "talus/audit/shapes.h"

namespace talus::audit {

bool has_side(const Polygon& block, Vec2 way, const Pressed& at) {
  for (size_t e = 0; e < block.size(); ++e) {
    const Vec2 to = block[(e + 1) % block.size()], side = to - block[e];
    const double length = norm(side);
    if (length > 0 && dot(turn_right(side), way) > 0 && std::abs(dot(side, way)) <= kOffSide * length &&
        distance_to_segment(at.place, block[e], to) <= at.depth)
      return true;
  }
  return false;
}

double through_covered(const Polygon& block, const std::vector<Third>& thirds, Vec2 way, const Pressed& at) {
  const double reach = 2 * at.depth + at.length;
  bool any_covered = false;
  double off = 1;
  for (size_t e = 0; e < block.size(); ++e) {
    const Vec2 from = block[e], side = block[(e + 1) % block.size()] - from;
    const double length = norm(side);
    const Vec2 outward = length > 0 ? turn_right(side) / length : Vec2{};
    if (dot(outward, way) <= kOffSide || distance_to_segment(at.place, from, from + side) > reach) continue;
    // just before the side, off its ends by what is in touch there
    const auto covered = [&](Vec2 place, double shift) {
      const double end = std::min(at.depth, 0.5 * length);
      const double along = std::clamp(dot(side, place - from) / length + shift, end, length - end);
      const Vec2 x = from + (along / length) * side;
      return std::any_of(thirds.begin(), thirds.end(), [&](const Third& t) {
        return depth_in(*t.polygon, x + (at.depth + t.closure) * outward) > 0;
      });
    };
    if (covered(at.place, 0) && covered(at.middle, 0) && covered(at.place, -reach) &&
        covered(at.place, reach))
      any_covered = true;
    else
      off = std::min(off, std::abs(cross(outward, way)));
  }
  return any_covered && off > kOffSide ? off : 0;
}

}  // namespace talus::audit
