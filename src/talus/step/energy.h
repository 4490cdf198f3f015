#pragma once
// The energy ledger, closed at every step. Theory: docs/theory.md section 8.

#include "talus/blocks/state.h"

namespace talus {

/// Energies at a time step [J]. kinetic is 1/2 v- M v+ with the velocities half a step before and after: with
/// it central differences conserve energy exactly in linear motion. It may be negative in the one step of an
/// impact.
struct Energy {
  double kinetic = 0, strain = 0;
  double gravity = 0;    // work done by gravity since the start
  WorkDone work;         // by everything else
  double left_over = 0;  // kinetic + strain - at the start - gravity - work: what the ledger cannot explain

  /// Largest of all terms, the measure for left_over.
  double largest() const;
};

/// Kinetic, strain and gravity of freely moving blocks.
Energy energy_now(const BlockSet& blocks, Vec2 gravity, const State& state,
                  const std::vector<BlockRate>& before, const std::vector<BlockRate>& after);

}  // namespace talus
