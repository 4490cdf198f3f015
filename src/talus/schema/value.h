#pragma once
// What the value of a key can be, once it is read: in SI.

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "talus/base/vec2.h"
#include "talus/schema/scattered.h"

namespace talus {

struct MotionText {
  enum Kind { kFree, kFixed, kVelocity, kDisplacement } kind = kFixed;
  std::string history;
};

using Value = std::variant<bool, int64_t, double, std::string, Vec2, std::array<int, 2>, std::vector<Vec2>,
                           std::vector<std::vector<Vec2>>, std::vector<double>, std::vector<std::string>,
                           MotionText, Scattered, Strewn>;

}  // namespace talus
