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

}  // namespace talus::test
