#pragma once
// Angles are in radians everywhere; users write and read degrees.

#include <numbers>

namespace talus {

inline constexpr double kDegree = std::numbers::pi / 180;  // [rad]

}  // namespace talus
