#pragma once
// Hard contacts that close within a step, and blows between bodies whose joint has a restitution. Theory:
// docs/theory.md 4.7.

#include "talus/step/parts.h"

namespace talus {

/// Rows of hard contacts that are apart, or bear nothing and have a joint with a restitution, and close within the step at more
/// than what weight, or what presses their blocks, gives in one. @pre  the rows of the step are gathered
std::vector<size_t> closing_rows(const Scene& scene, const StepWork& work, const State& state);

/// Whether a block that deforms, held by no intact face, comes upon another at one of these rows, and their joint has no
/// restitution: what it rings by then is damped by alpha, and the less the shorter the step (theory 7.1).
bool rings(const Scene& scene, const StepWork& work, const State& state, const std::vector<size_t>& closing);

/// Finds the blows, wave by wave: what comes together is parted, what that sends into others in the next one. Bodies are
/// blocks and what is tied to them, and jump as rigid ones; `state.rate` gets the jumps.
void find_blows(const Scene& scene, StepWork& work, State& state);

/// The work of the blows, as bodies move before and after the kick (theory 8). @pre  the step is solved
RowSums tally_blows(const Scene& scene, StepWork& work, const State& state);

}  // namespace talus
