#pragma once
// Two stones side by side, the right one drawn from the left one: what tests of bolts in tension begin with.

#include <string>

namespace talus::test {

/// The model text from its first line to the support that draws; bolts, stages and the rest follow.
/// @param time, value  of the displacement to the right, as the inside of a list [s], [m]
inline std::string drawn_blocks(const std::string& time, const std::string& value) {
  return R"(talus = 1
[material.rock]
density = 2500
[history.draw]
time = [)" +
         time + "]\nvalue = [" + value + R"(]
[[block]]
name = "left"
polygon = [[-3, -1], [0, -1], [0, 1], [-3, 1]]
material = "rock"
kind = "fixed"
[[block]]
name = "right"
polygon = [[0, -1], [3, -1], [3, 1], [0, 1]]
material = "rock"
kind = "rigid"
[[support]]
name = "drawn"
edge = [[3, -1], [3, 1]]
x = { displacement = "draw" }
)";
}

}  // namespace talus::test
