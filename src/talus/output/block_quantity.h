#pragma once
// What blocks of a frame may be coloured by, for pictures and for the report. The page of the report knows
// them by the same names (web/src/quantities.js).

#include <array>
#include <cmath>

#include "talus/base/vec2.h"

namespace talus {

struct BlockQuantity {
  const char* name;
  const char* title;
  const char* unit;
  bool signed_values;
};

inline constexpr std::array<BlockQuantity, 12> kBlockQuantities{
    {{"displacement", "displacement", "m", false},
     {"displacement_x", "displacement x", "m", true},
     {"displacement_y", "displacement y", "m", true},
     {"velocity", "velocity", "m/s", false},
     {"velocity_x", "velocity x", "m/s", true},
     {"velocity_y", "velocity y", "m/s", true},
     {"stress_xx", "stress xx (tension > 0)", "Pa", true},
     {"stress_yy", "stress yy (tension > 0)", "Pa", true},
     {"stress_xy", "stress xy", "Pa", true},
     {"stress_major", "largest principal stress (tension > 0)", "Pa", true},
     {"stress_minor", "least principal stress (tension > 0)", "Pa", true},
     {"shear_most", "largest shear stress", "Pa", false}}};

/// All of them for one block, in the order of kBlockQuantities.
/// @param u  displacement [m]; @param v  velocity [m/s]; @param s  Cauchy stress, tension > 0 [Pa]
inline std::array<double, kBlockQuantities.size()> block_quantities_of(Vec2 u, Vec2 v, const Mat2& s) {
  const double mean = 0.5 * (s.xx + s.yy), radius = std::hypot(0.5 * (s.xx - s.yy), s.xy);
  return {norm(u), u.x, u.y, norm(v), v.x, v.y, s.xx, s.yy, s.xy, mean + radius, mean - radius, radius};
}

}  // namespace talus
