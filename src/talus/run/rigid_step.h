#pragma once
// The step that is taken where no block deforms, and no frequency asks for one.

#include "talus/step/scene.h"

namespace talus {

/// Short against the fall through a block's own thickness, the way through a tenth of it, and the shortest
/// period of what shakes it (theory 2.4) [s]; infinite where nothing sets a time.
double rigid_step(const Scene& scene, const StageInput& stage);

}  // namespace talus
