#include "talus/blocks/tiles.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "talus/base/index.h"
#include "talus/geometry/polygon.h"

namespace talus {

namespace {

// Most places of a tile: the motion of so many blocks takes half of the nearest memory of a processor, and the
// smaller tiles are, the fewer sweeps are needed (docs/decisions/0012-tiles.md). Fewest of all at which there are
// tiles.
constexpr int kTile = 128, kFewest = 4 * kTile;

// Cells along a side of the square: 2^kBits.
constexpr unsigned kBits = 16;

// How far along Hilbert's curve a cell is: from the quarters down, each turned so that it ends where the next
// begins.
uint64_t along_curve(uint32_t x, uint32_t y) {
  uint64_t at = 0;
  for (uint32_t half = 1U << (kBits - 1); half > 0; half /= 2) {
    const bool right = (x & half) != 0, upper = (y & half) != 0;
    at += uint64_t{half} * half * (right ? (upper ? 2 : 3) : (upper ? 1 : 0));
    x &= half - 1, y &= half - 1;
    if (upper) continue;
    if (right) x = half - 1 - x, y = half - 1 - y;
    std::swap(x, y);
  }
  return at;
}

}  // namespace

std::vector<int> tiles_of(const std::vector<Vec2>& places) {
  const int n = count_of(places);
  if (n < kFewest) return {};
  const auto [low, high] = bounding_box(places);
  const double side = std::max(high.x - low.x, high.y - low.y);
  const double cells = static_cast<double>((1U << kBits) - 1);
  const auto cell = [&](double from) { return static_cast<uint32_t>(side > 0 ? from / side * cells : 0); };
  std::vector<std::pair<uint64_t, int>> order(n);
  for (int i = 0; i < n; ++i)
    order[i] = {along_curve(cell(places[i].x - low.x), cell(places[i].y - low.y)), i};
  std::sort(order.begin(), order.end());
  const size_t tiles = (n + kTile - 1) / kTile;
  std::vector<int> tile(n);
  for (int k = 0; k < n; ++k) tile[order[k].second] = static_cast<int>(k * tiles / n);
  return tile;
}

}  // namespace talus
