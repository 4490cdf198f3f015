#include "talus/run/unrest.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "talus/base/index.h"
#include "talus/base/rank.h"
#include "talus/run/steps_from_rest.h"

namespace talus {

std::string Unrest::text(const StageInput& stage, double elapsed, int64_t steps,
                         const std::string& on_path) const {
  std::string where;
  if (last.worst_block >= 0) {
    const int k = last.worst_block;
    const Vec2 at = scene.blocks.centroid[k] + state.displacement[k], v = state.rate[k].a;
    where = fmt::format(" The largest is on block \"{}\" at ({:.4g}, {:.4g}): {:.3g} N; it {}.",
                        scene.blocks.name[k], at.x, at.y, last.worst_force,
                        stage.from_rest ? fmt::format("went {:.3g} m in the last step", step * norm(v))
                                        : fmt::format("moves at ({:.3g}, {:.3g}) m/s", v.x, v.y));
  }
  const std::string velocity =
      stage.from_rest ? "" : fmt::format(", and {:.3g} of the velocity is left", last.speed_left);
  return fmt::format(
      "static stage \"{}\" did not come to rest in {:g} s ({} steps){}: the largest unbalanced force is "
      "{:.3g} of the mean{}; asked for is {:g}.{} {}",
      stage.name, elapsed, steps, on_path, last.unbalanced, velocity, stage.unbalanced, where,
      stage.path > 0
          ? fmt::format("Give stage.{0}.increments more, or stage.{0}.duration, which is for each balance; "
                        "histories.csv has the balances before it",
                        stage.name)
          : why_no_rest(stage, elapsed));
}

// What keeps a stage from resting, and the key to change.
std::string Unrest::why_no_rest(const StageInput& stage, double elapsed) const {
  if (scene.model.formulation == Formulation::kPenalty)
    return fmt::format(
        "By conventional DDA a static stage forgets its velocities at every step: a longer stage.{}.duration or time_step "
        "brings it further; what slides or falls never rests (blocks_end.svg)",
        stage.name);
  const double floor = solver_leaves(scene.blocks, last, dt);
  if (floor > 0.5 * last.worst_force)
    return fmt::format(
        "That is what the solver leaves: an error of {:.2g} m in a step of {:.2g} s is a force of {:.2g} "
        "N there. Give the joints a stiffness, a smaller solver.tolerance with more solver.max_sweeps, or "
        "a larger stage.{}.unbalanced",
        last.error.worst, dt, floor, stage.name);
  const double left = stage.duration - elapsed;
  double farthest = 0;
  for (size_t k = 0; k < state.rate.size(); ++k)
    farthest =
        std::max(farthest, norm(state.rate[k].a) * std::max(left, stage.duration) / scene.blocks.size[k]);
  const bool stays = !goes_anywhere(std::max(left, stage.duration));
  const int fastest = fastest_block();
  // forces of the others are in balance: it is the one that swings
  if (farthest > StepsFromRest::kFarToGo && stays && fastest >= 0 &&
      (last.unbalanced <= 2 * stage.unbalanced || last.worst_block == fastest))
    return chatter(stage, fastest);
  if (farthest > StepsFromRest::kFarToGo && !stays)
    return fmt::format(
        "Something slides or falls: at the speeds of now a block goes {:.2g} times its size in the "
        "duration of the stage. Look at blocks_end.svg and slips.csv; if it is on its way to rest, give "
        "stage.{}.duration more",
        farthest, stage.name);
  return fmt::format(
      "Blocks ring against each other without going anywhere. Give stage.{0}.elasticity = \"implicit\" or "
      "some contact.alpha, or a larger stage.{0}.unbalanced",
      stage.name);
}

// Whether some block, at the pace it had since the last look, gets anywhere in `time`: what chatters is fast and stays.
bool Unrest::goes_anywhere(double time) const {
  const double since = state.time - look.time;
  if (look.place.size() != state.displacement.size() || since <= 0) return true;
  for (size_t k = 0; k < look.place.size(); ++k)
    if (norm(state.displacement[k] - look.place[k]) * time / since >
        StepsFromRest::kFarToGo * scene.blocks.size[k])
      return true;
  return false;
}

// The block that moves at most of its size a second; -1: none is free.
int Unrest::fastest_block() const {
  int fastest = -1;
  double most = -1;
  for (int k = 0; k < count_of(state.rate); ++k) {
    if (!scene.blocks.moves_freely(k)) continue;
    const double pace = norm(state.rate[k].a) / scene.blocks.size[k];
    if (pace > most) most = pace, fastest = k;
  }
  return fastest;
}

// A block keeps a stage from rest though nothing goes anywhere.
std::string Unrest::chatter(const StageInput& stage, size_t fastest) const {
  std::vector<double> areas;
  for (int k = 0; k < count_of(state.rate); ++k)
    if (scene.blocks.moves_freely(k)) areas.push_back(scene.blocks.size[k] * scene.blocks.size[k]);
  const double area = scene.blocks.size[fastest] * scene.blocks.size[fastest];
  const Vec2 at = scene.blocks.centroid[fastest] + state.displacement[fastest];
  return fmt::format(
      "Block \"{}\" ({:.3g} m2, the median is {:.3g}) chatters at ({:.4g}, {:.4g}), with {:.2g} m/s, and since t = {:.4g} s no block "
      "has gone anywhere: more duration will not help. Give stage.{}.integration = \"implicit\" (from rest to rest), a "
      "shorter time_step, or move the joints that make so small a block",
      scene.blocks.name[fastest], area, median(std::move(areas)), at.x, at.y, norm(state.rate[fastest].a),
      look.time, stage.name);
}

double solver_leaves(const BlockSet& blocks, const StepReport& report, double dt) {
  if (report.worst_block < 0) return 0;
  return blocks.mass[report.worst_block] * report.error.worst / (dt * dt);
}

}  // namespace talus
