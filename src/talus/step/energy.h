#pragma once
// The energy ledger, closed at every step. Theory: docs/theory.md section 8.

#include "talus/blocks/state.h"

namespace talus {

/// Energies at a time step [J]. kinetic is 1/2 v M v of the mean velocity of the kick. Kinetic and `between`
/// together are the kinetic energy half a step ago plus the work of this kick that came before now; with
/// equal steps 1/2 v- M v+, which central differences conserve exactly, with the strain energy, in linear
/// motion.
struct Energy {
  double kinetic = 0, strain = 0;
  double between = 0;  // at most 0 with equal steps: what velocities half a step before and after differ by
  double gravity = 0;  // work done by gravity since the start
  WorkDone work;       // by everything else
  double moving = 0;   // mean of the kinetic energies before and after the kick: chatter shows here
  double left_over =
      0;  // kinetic + between + strain - at the start - gravity - work: what the ledger cannot explain

  /// Largest of all terms, the measure for left_over.
  double largest() const;
};

/// Kinetic energy of freely moving blocks at these rates [J].
double kinetic_energy(const BlockSet& blocks, const std::vector<BlockRate>& rate);

}  // namespace talus
