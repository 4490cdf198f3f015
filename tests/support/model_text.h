#pragma once
// Sections of model texts that many tests write.

#include <fmt/format.h>

#include <string>

#include "talus/geometry/polygon.h"

namespace talus::test {

inline std::string point_text(Vec2 p) { return fmt::format("[{:.17g}, {:.17g}]", p.x, p.y); }

inline std::string polygon_text(const Polygon& polygon) {
  std::string list;
  for (const Vec2 p : polygon) list += (list.empty() ? "" : ", ") + point_text(p);
  return "[" + list + "]";
}

/// A block of the material "m". @param more  further keys
inline std::string block_text(const std::string& name, const Polygon& polygon, const std::string& kind,
                              const std::string& more = "") {
  return fmt::format("[[block]]\nname = \"{}\"\npolygon = {}\nmaterial = \"m\"\nkind = \"{}\"\n{}\n", name,
                     polygon_text(polygon), kind, more);
}

/// Begins a model of blocks of the material "m", 2600 kg/m3, whose joints have one friction angle [deg], with one dynamic
/// stage "run".
inline std::string friction_model(Vec2 gravity, double friction, double duration, double time_step) {
  return fmt::format(R"(talus = 1
[model]
gravity = {}
[material.m]
density = 2600
[joint.face]
friction_angle = "{:.17g} deg"
[contact]
joint = "face"
[[stage]]
name = "run"
kind = "dynamic"
duration = {:.17g}
time_step = {:.17g}
)",
                     point_text(gravity), friction, duration, time_step);
}

}  // namespace talus::test
