#pragma once
// The parts of a kick, in the order of its recipe (step.cpp). Not for use outside step/.

#include "talus/step/scheme.h"
#include "talus/step/step_work.h"

namespace talus {

/// Forces of loads, of excavated rock that is not yet gone and of bars inside blocks, and the free field's
/// kick (theory 2.7, 4.12, 4.16, 4.21).
void add_forces(const Scene& scene, const StepSettings& settings, StepWork& work, State& state);

/// Weight, loads and what excavated rock still pushes [N], [N m].
inline BlockForce given_force(const Scene& scene, const StepWork& work, size_t k) {
  return BlockForce{scene.blocks.mass[k] * scene.model.gravity, {}} + work.load[k];
}

/// Whether a step from rest does not wait for a block (theory 14.5): nothing that is given acts on it.
inline bool is_weightless(const StepWork& work, const State& state, size_t k) {
  return work.clock.from_rest && state.is_left_out(k);
}

/// Weight, elastic force and mobility of each block, and its rates at the end of the kick as they would be
/// without rows (eq. 2.1), damping included.
void predict(const Scene& scene, const Scheme& scheme, StepWork& work, State& state);

/// Sums over rows.
struct RowSums {
  KickWork work;
  int closed = 0;
  double drift = 0;
  double closed_share = 0;  // the largest, and where
  int closed_row = -1;
  std::vector<std::pair<int, BlockForce>> on_driven;  // impulses on blocks that are driven

  RowSums& operator+=(const RowSums& o);
};

/// The work that row r does as it is solved (theory 8).
/// @param u  its relative velocity after the kick [m/s]
void tally_row(const BlockSet& blocks, const StepWork& work, const State& state, size_t r,
               const std::array<double, 2>& u, RowSums& sums);

/// What of that dashpots have taken is the work of damping.
/// @param impulse  what they bear [N s]
void tally_dashpots(const StepWork& work, size_t r, const std::array<double, 2>& u,
                    const std::array<double, 2>& impulse, RowSums& sums);

/// Puts the work of rows and blocks into the ledger (theory 8), and what is left out of balance into the
/// report; writes state.row_force.
void tally(const Scene& scene, const Scheme& scheme, const RowSums& rows, StepWork& work, State& state,
           StepReport& report);

}  // namespace talus
