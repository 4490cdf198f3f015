#pragma once
// What a new stage changes in scene and state: blocks taken out, properties, what acts.
// Theory: docs/theory.md 2.7.

#include "talus/step/step_work.h"

namespace talus {

/// Makes the scene of stage `stage` from that of the stage before (of the first: from build_scene): excavated
/// blocks become kRemoved, changed properties and kinds hold, and points of supports, boundaries and loads
/// are active or not. Inertias are unclamped afterwards.
void change_scene(int stage, Scene& scene);

/// Whether any stage changes blocks or their properties.
bool blocks_change(const Model& model);

/// Which blocks stage `stage` takes out [count].
std::vector<char> excavated_blocks(const Scene& scene, int stage);

/// Forces of some blocks on all others, from the rows of a kick [count] [N], [N m].
std::vector<BlockForce> forces_of_blocks(const StepWork& work, const std::vector<char>& blocks);

/// Fits a state to the scene of a new stage: blocks that no longer move stand still, moduli change at
/// constant stress, new supports hold their points where they are.
/// @param before  blocks and supported points of the stage before
void adapt_state(const BlockSet& before, const std::vector<SupportedPoint>& supported_before,
                 const Scene& scene, State& state);

/// Takes their motion from all blocks; its energy goes to the ledger as damping.
void stop_motion(const Scene& scene, State& state);

/// Kinetic and strain energy less the work of gravity, as the ledger counts them between two steps [J]: what
/// a change of the scene adds to it is no work.
double ledger_energy(const Scene& scene, const State& state);

}  // namespace talus
