#pragma once
// What goes on where a static stage finds no balance. Theory: docs/theory.md 14.4.

#include <string>

#include "talus/step/scene.h"

namespace talus {

/// Of all blocks that can move those of this share of their area are a mechanism of the whole; less is a crumb.
inline constexpr double kMechanismShare = 0.01;

/// Blocks of that share of the area go at least so fast, as share of their size [1/s].
double pace_of_many(const BlockSet& blocks, const State& state);

/// The blocks that went on together in a step from rest, and what they slid on.
struct Mechanism {
  std::vector<int> members;         // blocks, in order
  double area = 0, share = 0;       // [m2], of all blocks that can move
  int farthest = -1;                // the block that went farthest
  Vec2 direction;                   // of its way, unit
  bool slides = false;              // the others bear more than a hundredth of their weight
  std::vector<std::string> joints;  // on which they slip against the others, by name, each once

  /// "12 blocks, 3.4 m2 (5 % of what can move), ...": who, which way, on what.
  std::string text(const Scene& scene, const State& state) const;
};

/// @param state  after a step from rest: its rates are the way of that step
Mechanism find_mechanism(const Scene& scene, const State& state);

}  // namespace talus
