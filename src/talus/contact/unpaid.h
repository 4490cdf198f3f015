#pragma once
// Energy that joints hold at the end of a step from rest without its forces knowing of it. Theory: docs/theory.md 14.2.

#include "talus/contact/patch_world.h"

namespace talus {

/// By how much the normal closures of joints that do not dilate hold more at the end of a step than its forces say [J].
/// @param then, end  patches with the forces of the step; as they lie at its end
double unpaid_energy(const PatchWorld& world, const State& then, const State& end);

}  // namespace talus
