#include "talus/run/rest_judge.h"

#include <algorithm>
#include <cmath>

#include "talus/run/steps_from_rest.h"

namespace talus {

namespace {

// Steps of a static stage between looks at its progress; what is left, as share of the look before, above
// which it stalls, and above which there is no progress at all; sharpest tolerance, as share of the solver's;
// looks in a row that stall before the solver is asked for more the first time, and without progress before
// it is told.
constexpr int64_t kRestLook = 250;
constexpr double kStalled = 0.9, kNoProgress = 0.98, kSharpest = 1e-4;
constexpr int kStalls = 2, kMostStuck = 4;

// What the solver leaves, as share of the unbalanced force, below which it is not what keeps a stage from
// rest.
constexpr double kSolverShare = 0.02;

}  // namespace

bool RestJudge::stalls(const StageInput& stage, const StepReport& report, bool relaxed, double left) {
  RestWatch& rest = state_.rest;
  // both together: while one of them falls, as the forces do while a large mass still swings slowly, the
  // solver is not what keeps the other
  const double now = std::sqrt(report.unbalanced * report.speed_left) / stage.unbalanced;
  // while forces are let go of, balance says nothing
  rest.best = !relaxed ? 0 : rest.best > 0 ? std::min(rest.best, now) : now;
  if (++rest.steps % kRestLook != 0) return false;
  look_ = std::move(latest_look_);
  latest_look_ = {state_.time, state_.displacement};
  const double progress = rest.before > 0 ? rest.best / rest.before : 0;
  const bool at_sharpest = rest.sharper <= kSharpest;
  rest.stuck = progress > (at_sharpest ? kNoProgress : kStalled) ? rest.stuck + 1 : 0;
  // one look is enough the second time: that the solver is what keeps it was found the first
  const bool by_solver =
      solver_leaves(scene_.blocks, report, work_.clock.dt) > kSolverShare * report.worst_force;
  if (!at_sharpest && by_solver && rest.stuck >= (rest.sharper < 1 ? 1 : kStalls)) {
    rest.sharper = std::max(kSharpest, 0.01 * rest.sharper);
    rest.stuck = 0;
  }
  rest.before = rest.best;
  rest.best = 0;
  if (!at_sharpest || rest.stuck < kMostStuck) return false;
  for (size_t k = 0; k < state_.rate.size(); ++k)
    if (norm(state_.rate[k].a) * left > StepsFromRest::kFarToGo * scene_.blocks.size[k]) return false;
  return true;
}

double RestJudge::speed_left(const StepReport& report, double steps_of_bound) const {
  const double longer = std::max(1.0, steps_of_bound);
  const double peak =
      std::max({state_.largest_kinetic, report.energy.moving, report.nudge / (longer * longer)});
  return peak > 0 ? std::sqrt(report.energy.moving / peak) : 0;
}

bool RestJudge::is_at_rest(const StageInput& stage, const StepReport& report) const {
  return report.unbalanced <= stage.unbalanced &&
         (report.speed_left <= stage.unbalanced || !state_.left_out.empty());  // its energy is theirs too
}

}  // namespace talus
