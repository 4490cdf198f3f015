#pragma once
// One explicit step of central differences with the contact forces as unknowns, in two halves: kick() finds
// the forces of this instant and the velocities after it, drift() moves the blocks. Theory: docs/theory.md
// section 4.

#include "talus/contact/unpaid.h"
#include "talus/step/step_work.h"

namespace talus {

/// Forces at state.time and rates after it, for a step of length dt. Updates rates, row forces and contacts.
StepReport kick(const Scene& scene, const StepSettings& settings, double dt, StepWork& work, State& state);

/// What the end of a step from rest has that its forces did not know of (theory 14.2).
struct Unseen {
  // how deep hard parts are in each other that were not in touch; share of the smaller block, largest
  double deep = 0;
  double unpaid = 0;  // energy that elastic joints hold more than by the forces of the step [J]
};

/// By a search of contacts at the end of the step.
/// @param state, report  after kick()
Unseen unseen(const Scene& scene, double time_end, StepWork& work, const State& state, StepReport report);

/// Moves the blocks with the rates of the kick, for as long as its clock says, to `time_end`; breaks faces.
/// Throws NumericalError naming time and block when a block is inverted or its motion is not finite.
void drift(const Scene& scene, double time_end, StepWork& work, State& state, StepReport& report);

}  // namespace talus
