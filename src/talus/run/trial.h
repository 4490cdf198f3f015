#pragma once
// What a step costs on this machine, from first steps.

#include <vector>

#include "talus/run/run.h"

namespace talus {

/// Mean wall time of a step of each stage [s], from steps of it taken on a copy for about `seconds` in all
/// (two steps of each at least). Stages are tried from the start of the run, not from the end of the stage
/// before: contacts are about as many, and a stage that shakes is as cheap as it will be. A stage that ends
/// at once has the mean of the others; 0 when none could be measured.
std::vector<double> time_steps(const PreparedRun& run, double seconds, int threads);

}  // namespace talus
