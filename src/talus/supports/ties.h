#pragma once
// Sides of a model of level ground, tied to each other at equal heights: what happens on the one happens on
// the other. Theory: docs/theory.md 4.14.

#include <array>
#include <vector>

#include "talus/blocks/state.h"
#include "talus/cut/selection.h"
#include "talus/rows/rows.h"
#include "talus/rows/step_clock.h"

namespace talus {

/// Heights within this share of a side's height are the same.
inline constexpr double kHeightShare = 1e-6;

/// Material points of the two sides that move alike.
struct TiePoint {
  int boundary = -1;  // of the model
  int block_a = -1, block_b = -1;
  Vec2 arm_a, arm_b;   // reference arms [m]
  bool active = true;  // in this stage
};

/// Ends of all edges of either side with the points of equal height on the other one, each pair once. Sides
/// that do not face each other are told to `findings`.
std::vector<TiePoint> tie_sides(const Model& model, const Layout& layout, const BlockSet& blocks,
                                int boundary, const std::vector<SelectedEdge>& side,
                                const std::vector<SelectedEdge>& opposite, Findings& findings);

/// Two hard rows for each tie, along x and along -y.
void add_tie_rows(const BlockSet& blocks, const std::vector<TiePoint>& ties, const State& state,
                  const StepClock& clock, RowSet& rows);

}  // namespace talus
