#pragma once
// The time steps of a run, known before its first one.

#include <string>
#include <vector>

#include "talus/schema/findings.h"
#include "talus/step/scene.h"

namespace talus {

/// Lengths of the steps of a stage from rest: the first is so many times the shortest, the longest so many times
/// the first (theory 14.1).
inline constexpr int kMostShortened = 64, kMostLengthened = 64;

struct StagePlan {
  double dt = 0;           // [s]; the first of a stage from rest
  int64_t steps = 0;       // of a static stage: the most
  double dt_bound = 0;     // stable limit before any clamp [s]; infinite when no block deforms
  int bound_block = -1;    // the block that sets it
  int bound_column = -1;   // or the boundary whose free field does
  double dt_undamped = 0;  // the same without stiffness-proportional damping [s]
  double clamp_dt = 0;     // undamped step that clamped blocks must allow [s]
  int clamped = 0;         // blocks whose moments are raised
  double largest_clamp = 1;
  // of the damped motion that follows what does not come to rest in steps from rest; 0: none does
  double dt_follow = 0;      // [s]
  int64_t steps_follow = 0;  // at most
  double bound_follow = 0;   // stable limit [s]
  int balances = 0;          // of a stage along a path

  bool operator==(const StagePlan&) const = default;
};

/// Dynamic stages that leave it to the model: elasticity becomes implicit where a few slivers would set the step or deforming
/// blocks may meet, and all that shakes or pushes takes many such steps; blocks that are shaken so are damped, unless by more
/// of what shakes them than it may take (theory 4.9).
void choose_elasticity(Scene& scene);

/// What is told of stiffness-proportional damping behind a stage; nothing without.
std::string damping_text(const StageInput& stage);

/// Plans every stage of the scene. A step above the stable limit, or none where none can be derived, is a
/// finding.
std::vector<StagePlan> plan_stages(const Scene& scene, Findings& findings);

/// How many times as much a block of median mass yields to an impulse at a corner in the shortest step as a hard
/// contact gives; 0 without give or without free blocks.
double yields_more(const Scene& scene, const std::vector<StagePlan>& plans);

/// What sets the stable limit, by its name: "" when nothing does.
std::string bound_name(const Scene& scene, const StagePlan& plan);

}  // namespace talus
