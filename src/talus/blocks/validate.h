#pragma once
// Promises that blocks and states keep whatever the model is: only our own mistakes break them.

#include "talus/blocks/state.h"

namespace talus {

/// Throws std::logic_error naming the broken promise and where: arrays of one length, outlines
/// counter-clockwise around their centroids, masses and moments positive and finite.
void validate(const BlockSet& blocks);

/// The same of a state of these blocks: arrays of one length, pairs in order with their contacts side by
/// side, every index one of something that is there. Motions may be anything: that they stay finite is up to the
/// model, and told by the run.
void validate(const State& state, const BlockSet& blocks);

}  // namespace talus
