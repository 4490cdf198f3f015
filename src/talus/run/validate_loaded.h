#pragma once
// What a state that comes from a file must keep, beyond the promises of every state: a run that goes on from it
// takes its numbers for its own.

#include "talus/run/run.h"

namespace talus {

/// Throws std::logic_error naming the broken promise: numbers that are not finite (but for limits without end
/// and anchors of sliding contacts), lengths, stiffnesses and strengths below 0, joints, bolts and stages that
/// are not the model's.
/// @pre validate(state, prepared.scene.blocks)
void validate_loaded(const Standing& standing, const State& state, const PreparedRun& prepared);

}  // namespace talus
