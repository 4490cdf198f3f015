#pragma once
// What rows of hard contacts have in common, whatever found them. Theory: docs/theory.md 3.3, 4.10.

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/blocks/state.h"

namespace talus {

/// Bias of a hard normal row: it may close the gap and not more; an overlap is pushed back except for the slop (theory 4,
/// table of rows) [m/s].
inline double hard_gap_bias(double gap, double slop, double dt) {
  if (gap >= 0) return gap / dt;
  return std::min(gap + 0.5 * slop, 0.0) / dt;
}

/// What of a distance lies beyond half the slop. Contacts that stick redundantly, as two corners at one place do, have
/// anchors that differ by what was left of the errors of earlier steps; no motion brings both home, and forces would grow
/// without end over it (theory 4.10).
inline double beyond_slop(double off, double slop) {
  if (std::abs(off) <= 0.5 * slop) return 0;
  return off > 0 ? off - 0.5 * slop : off + 0.5 * slop;
}

/// What an overlap that a hard contact was born with loses in a step: a thousandth of it, at most this share of the
/// smaller block. Pushed out at once it would leave with the speed of overlap over time step.
inline constexpr double kPushedOut = 1e-3, kMostPushedOut = 1e-7;

/// What is left of it and forgotten, as share of the smaller block.
inline constexpr double kLeastAllowed = 1e-12;

/// What is left after a step of the overlap that a contact may keep.
/// @param closed  how far it is closed [m]
/// @param size    of the smaller block [m]
inline void push_out(double closed, double size, double& allowed) {
  if (allowed <= 0) return;
  allowed = std::min(allowed, closed);
  allowed -= std::min(kPushedOut * allowed, kMostPushedOut * size);
  if (!(allowed > kLeastAllowed * size)) allowed = 0;
}

/// Mean thickness of a block: its area over its extent across `normal` [m].
inline double thickness_along(const BlockSet& blocks, const State& state, int block, Vec2 normal) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (int v = 0; v < blocks.vertex_count(block); ++v) {
    const Vec2 X = blocks.corner({block, v});
    const double at = cross(normal, X + state.strain_part[block] * X);
    least = std::min(least, at), most = std::max(most, at);
  }
  return blocks.size[block] * blocks.size[block] / (most - least);
}

/// Overlaps below this share of the thinner block are not measured against it.
inline constexpr double kDeepNoticed = 0.01;

/// Overlap of a contact as share of the mean thickness, along the normal, of the thinner block.
inline double closed_share(const BlockSet& blocks, const State& state, int a, int b, double gap,
                           Vec2 normal) {
  double share = 0;
  if (gap >= 0) return share;
  for (const int block : {a, b})
    if (-gap > kDeepNoticed * blocks.thinness[block])
      share = std::max(share, -gap / thickness_along(blocks, state, block, normal));
  return share;
}

}  // namespace talus
