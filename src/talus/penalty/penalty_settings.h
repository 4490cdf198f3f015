#pragma once
// What a stage of a model asks of steps of conventional DDA.

#include "talus/penalty/penalty_step.h"

namespace talus {

/// Stiffnesses, scheme and limits of a stage; static stages forget their velocities (dynamic factor 0).
PenaltySettings penalty_settings(const Scene& scene, const StageInput& stage);

}  // namespace talus
