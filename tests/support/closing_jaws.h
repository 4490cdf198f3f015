#pragma once
// A rigid block between two jaws that close: when they touch it, there is no room for what the equations ask for.

#include <fmt/format.h>

#include <string>

namespace talus::test {

/// @param gap     of each jaw at the start [m]; they close at 5 cm/s
/// @param solver  the section [solver], "" for none
inline std::string closing_jaws(double gap, const std::string& solver = "") {
  std::string text = R"model(talus = 1
[material.r]
density = 2700
young = "5 GPa"
poisson = 0.25
[joint.f]
friction_angle = "35 deg"
[contact]
joint = "f"
[history.v]
time = [0, 10]
value = [0.05, 0.05]
[history.w]
time = [0, 10]
value = [-0.05, -0.05]
[[block]]
name = "between"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "r"
kind = "rigid"
[[stage]]
name = "close"
kind = "dynamic"
duration = "10 s"
time_step = "0.5 ms"
)model";
  const auto jaw = [&text](const char* name, double from, double to, const char* history) {
    text += fmt::format(
        "[[block]]\nname = \"{0}\"\npolygon = [[{1}, 0], [{2}, 0], [{2}, 1], [{1}, 1]]\nmaterial = \"r\"\n"
        "kind = \"driven\"\nmotion_x = {{ velocity = \"{3}\" }}\n",
        name, from, to, history);
  };
  jaw("left", -1, -gap, "v");
  jaw("right", 1 + gap, 2, "w");
  return text + solver;
}

}  // namespace talus::test
