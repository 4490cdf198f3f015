#pragma once
// One explicit step of central differences with the contact forces as unknowns, in two halves: kick() finds
// the forces of this instant and the velocities after it, drift() moves the blocks. Theory: docs/theory.md
// section 4.

#include "talus/step/step_work.h"

namespace talus {

/// Forces at state.time and rates after it, for a step of length dt. Updates rates, row forces and contacts.
StepReport kick(const Scene& scene, const StepSettings& settings, double dt, StepWork& work, State& state);

/// What the end of a step from rest has that its forces did not know of, by a search of contacts there; `stored`: by how much
/// it has become more in the step.
/// @param state, report  after kick()
Unseen unseen(const Scene& scene, double time_end, StepWork& work, const State& state, StepReport report);

/// Moves the blocks with the rates of the kick, for as long as its clock says, to `time_end`; breaks faces.
/// Throws NumericalError naming time and block when a block is inverted or its motion is not finite.
void drift(const Scene& scene, double time_end, StepWork& work, State& state, StepReport& report);

}  // namespace talus
