#pragma once
// What the stages of a run cost on this machine, from first steps.

#include <vector>

#include "talus/run/run.h"

namespace talus {

/// Wall time of a stage.
struct StageCost {
  double step = 0;            // of a step, mean [s]; 0: none could be measured
  double low = 0, high = 0;   // of the stage [s]
  int64_t steps_to_rest = 0;  // a static stage that ended in the trial; 0: it has not, or is none
  bool ended = false;         // a dynamic stage that was over in the trial
  bool at_least = false;      // of its steps some took more sweeps than a trial allows
};

/// Cost of the stages, from steps taken on a copy as the run takes them, for about `seconds` [s of wall time] in all and two of each
/// stage at least. A stage is tried where the trial of the one before ended. A static stage that comes to its rest is known; of
/// another the steps taken are the low end, and those in which stages from rest have theirs, or else all that its
/// duration has, the high one. A dynamic stage is within a factor of 3 of its steps at the mean of those tried.
/// @param most_whole  blocks up to which the steps are those of the run; of more they have few sweeps, else the trial would take
///                    minutes
std::vector<StageCost> time_stages(const PreparedRun& run, double seconds, int threads, int most_whole);

}  // namespace talus
