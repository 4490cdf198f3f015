#pragma once
// What a step costs on this machine, from first steps.

#include <vector>

#include "talus/run/run.h"

namespace talus {

struct StepCost {
  double seconds = 0;     // mean wall time of a step
  bool at_least = false;  // steps that the solver did not get through in the sweeps of a trial
};

/// Cost of a step of each stage, from steps taken on a copy for about `seconds` [s of wall time] in all: two
/// of each stage at least, of a limited number of sweeps. A stage is tried where the trial of the one before
/// ended, where contacts are about as many as at its end. A stage that ends at once has the mean of the
/// others; 0 when none could be measured.
std::vector<StepCost> time_steps(const PreparedRun& run, double seconds, int threads);

}  // namespace talus
