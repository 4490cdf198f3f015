#pragma once
// What is legal and almost surely a mistake: each a warning with its line, value, what is usual and what to
// do.

#include <vector>

#include "talus/run/plan.h"
#include "talus/schema/findings.h"

namespace talus {

/// What drives and what holds the model, strength between blocks that share no face, contacts without
/// friction, blocks that cannot bend, steps too long for a motion, histories in static stages only, motions
/// that begin or stop away from zero, last too long or shake too hard, outputs rarer than stages, blocks held
/// over next to nothing, joints that weight closes. (Values that no material has, and names nothing uses, the
/// reader warns of.)
void check_plausible(const Scene& scene, const std::vector<StagePlan>& plans, Findings& findings);

}  // namespace talus
