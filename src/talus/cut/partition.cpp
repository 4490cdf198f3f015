#include "talus/cut/partition.h"

#include <fmt/format.h>

namespace talus {

Cut::Cut() = default;
Cut::Cut(const Cut&) = default;
Cut::Cut(Cut&&) noexcept = default;
Cut& Cut::operator=(const Cut&) = default;
Cut& Cut::operator=(Cut&&) noexcept = default;
Cut::~Cut() = default;

Polygon Cut::polygon(const CutBlock& block) const {
  Polygon out;
  out.reserve(block.point.size());
  for (const int p : block.point) out.push_back(point[p]);
  return out;
}

std::string Cut::name(const CutBlock& block) const {
  const std::string& group = block.opening >= 0 ? openings[block.opening] : regions[block.region].name;
  return fmt::format("{}[{}]", group, block.id);
}

}  // namespace talus
