#pragma once
// What is legal and almost surely a mistake: each a warning with its line, value, what is usual and what to
// do.

#include <string>
#include <vector>

#include "talus/model/findings.h"
#include "talus/run/plan.h"

namespace talus {

/// Sections nobody names, values outside what rock and masonry (steel, soil and ice among them) have, gravity
/// upwards, nothing that holds or drives the model, contacts without friction, blocks that cannot bend, steps
/// too long for a motion.
/// @param text, overrides  as the model of `scene` was read from
void check_plausible(const std::string& text, const std::vector<std::string>& overrides, const Scene& scene,
                     const std::vector<StagePlan>& plans, Findings& findings);

}  // namespace talus
