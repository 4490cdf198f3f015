#pragma once
// Blows between bodies whose joint has a restitution: jumps of velocity before the forces of a step. Theory:
// docs/theory.md 4.7.

#include <vector>

#include "talus/step/step_work.h"

namespace talus {

/// Finds the blows of a step, wave by wave: what comes together is parted, what that sends into others in the next
/// one. Bodies are blocks and what is tied to them, and jump as rigid ones.
/// @pre  the rows of the step are gathered; dynamic stages only
/// @return  rates after them, impulses and work; none: no waves
Blows find_blows(const Scene& scene, StepWork& work, const State& state);

/// Adds them to what the contacts of the step carry. @pre  the step is in the ledger
void remember_blows(const Blows& blows, RowSet& rows, State& state);

}  // namespace talus
