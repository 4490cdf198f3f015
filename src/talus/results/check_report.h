#pragma once
// What `talus check` tells of a model without errors: blocks, stages and their steps, slivers, memory, time, output.

#include <string>

#include "talus/run/run.h"

namespace talus {

/// Takes steps on a copy for about three seconds, to tell what all of them will take.
/// @param file, warnings  name of the model, and how many warnings it has
std::string check_report(const std::string& file, int warnings, const PreparedRun& run, const Cut& cut);

}  // namespace talus
