#pragma once
// One explicit step of central differences with the contact forces as unknowns, in two halves: kick() finds
// the forces of this instant and the velocities after it, drift() moves the blocks. Theory: docs/theory.md
// section 4.

#include "talus/step/step_work.h"

namespace talus {

/// Forces at state.time and rates after it, for a step of length dt. Updates rates, row forces and contacts.
StepReport kick(const Scene& scene, const StepSettings& settings, double dt, StepWork& work, State& state);

/// How deep hard blocks are in each other at the end of a step from rest that were not in touch before, and were not seen
/// coming, as share of the smaller block, largest.
/// @param state, report  after kick()
double unseen_overlap(const Scene& scene, double time_end, StepWork& work, const State& state,
                      StepReport report);

/// Moves the blocks with the rates of the kick, for as long as its clock says, to `time_end`; breaks faces.
/// Throws NumericalError naming time and block when a block is inverted or its motion is not finite.
void drift(const Scene& scene, double time_end, StepWork& work, State& state, StepReport& report);

}  // namespace talus
