#pragma once
// Random rows between squares, for tests of solvers.

#include <cmath>
#include <random>

#include "talus/talus.h"

namespace talus::test {

/// `count` squares, every third one rigid, the first fixed.
inline BlockSet make_squares(int count) {
  Model model;
  model.materials.push_back({"m", 2000, 1e9, 0.2});
  Layout layout;
  for (int i = 0; i < count; ++i) {
    BlockShape b;
    b.name = "b" + std::to_string(i);
    b.group = i;
    const double x = 1.1 * i;
    b.polygon = {{x, 0}, {x + 1, 0}, {x + 1, 1}, {x, 1}};
    b.kind = i == 0 ? BlockKind::kFixed : i % 3 == 0 ? BlockKind::kRigid : BlockKind::kDeformable;
    layout.blocks.push_back(b);
    layout.groups.push_back(b.name);
  }
  return build_blocks(model, layout);
}

/// Two rows at a random place of two blocks, as ties.
inline PointRows random_point(std::mt19937& random, int blocks) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::uniform_int_distribution<int> any(0, blocks - 1);
  PointRows p;
  p.block_a = 1 + any(random) % (blocks - 1);
  do p.block_b = any(random) % 5 == 0 ? -1 : any(random);
  while (p.block_b == p.block_a);
  p.arm_a = {0.5 * unit(random), 0.5 * unit(random)};
  p.arm_b = {0.5 * unit(random), 0.5 * unit(random)};
  const double angle = 3.14 * unit(random);
  p.normal = {std::cos(angle), std::sin(angle)};
  p.row[0].bias = unit(random), p.row[1].bias = unit(random);
  return p;
}

inline std::vector<BlockRate> random_rates(std::mt19937& random, const BlockSet& blocks) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<BlockRate> rate(blocks.count);
  for (int i = 0; i < blocks.count; ++i) {
    auto& v = rate[i];
    if (!blocks.moves_freely(i)) continue;
    v.a = {unit(random), unit(random)};
    v.G = blocks.kind[i] == BlockKind::kRigid ? spin_matrix(unit(random))
                                              : Mat2{unit(random), unit(random), unit(random), unit(random)};
  }
  return rate;
}

}  // namespace talus::test
