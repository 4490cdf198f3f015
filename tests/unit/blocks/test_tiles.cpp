// Tiles of blocks that lie together.

#include "support/relative.h"
#include "talus/blocks/tiles.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>

namespace test_tiles {

using namespace talus;

namespace {

std::vector<Vec2> grid(int columns, int rows, double step = 1) {
  std::vector<Vec2> places;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) places.push_back({step * i, step * j});
  return places;
}

}  // namespace

TEST_CASE("too few to be parted") {
  CHECK(tiles_of({}).empty());
  CHECK(tiles_of(grid(511, 1)).empty());
  CHECK(tiles_of(grid(512, 1)).size() == 512);
}

TEST_CASE("a square of 64 x 64 falls into rectangles of 8 x 16") {
  const std::vector<Vec2> places = grid(64, 64, 2.5);
  const std::vector<int> tile = tiles_of(places);
  REQUIRE(tile.size() == places.size());
  struct Extent {
    Vec2 low{1e9, 1e9}, high{-1e9, -1e9};
    int count = 0;
  };
  std::map<int, Extent> tiles;
  for (size_t i = 0; i < places.size(); ++i) {
    Extent& e = tiles[tile[i]];
    e.low = {std::min(e.low.x, places[i].x), std::min(e.low.y, places[i].y)};
    e.high = {std::max(e.high.x, places[i].x), std::max(e.high.y, places[i].y)};
    ++e.count;
  }
  CHECK(tiles.size() == 32);
  for (const auto& [index, e] : tiles) {
    CAPTURE(index);
    CHECK(e.count == 128);
    const Vec2 cells = (1 / 2.5) * (e.high - e.low) + Vec2{1, 1};
    CHECK(cells.x * cells.y == test::approx(128));
    CHECK(std::max(cells.x, cells.y) == test::approx(16));
    // the curve never jumps: where a tile ends the next one begins
    if (index == 0) continue;
    const Extent& before = tiles[index - 1];
    const Vec2 apart{std::max(e.low.x - before.high.x, before.low.x - e.high.x),
                     std::max(e.low.y - before.high.y, before.low.y - e.high.y)};
    CHECK(std::max(apart.x, apart.y) <= test::approx(2.5));
  }
}

TEST_CASE("sizes differ by one at most, the order of the places does not matter") {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> number(-3, 40);
  std::vector<Vec2> places(1234);
  for (Vec2& p : places) p = {number(engine), number(engine)};
  const std::vector<int> tile = tiles_of(places);
  std::map<int, int> count;
  for (const int t : tile) ++count[t];
  CHECK(count.size() == 10);
  CHECK(count.begin()->first == 0);
  CHECK(count.rbegin()->first == 9);
  for (const auto& [index, n] : count) CHECK((n == 123 || n == 124));

  std::vector<size_t> order(places.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), engine);
  std::vector<Vec2> shuffled;
  for (const size_t i : order) shuffled.push_back(places[i]);
  const std::vector<int> again = tiles_of(shuffled);
  for (size_t i = 0; i < order.size(); ++i) CHECK(again[i] == tile[order[i]]);
}

TEST_CASE("all at one place, or on a line") {
  CHECK(tiles_of(std::vector<Vec2>(600)).size() == 600);
  const std::vector<int> tile = tiles_of(grid(1280, 1));
  // one after the other along the line
  CHECK(std::is_sorted(tile.begin(), tile.end()));
  CHECK(tile.back() == 9);
}

}  // namespace test_tiles
