#include "talus/run/safety_watch.h"

#include <algorithm>
#include <cmath>

#include "talus/base/rank.h"

namespace talus {

namespace {

// Way at which a block has failed, as share of its size or, where that is larger, the median block's; and at
// most, as share of its own: a wedge in solid rock falls by less than the rock is large.
constexpr double kFailed = 0.1, kFarthest = 0.5;

// A block still moves when it is faster than this share of its mean speed so far.
constexpr double kStillMoves = 0.1;

// Needles, which do not vote: below these shares of the median block's area or thickness.
constexpr double kNeedleArea = 1e-4, kNeedleThickness = 2e-3;

bool can_move(BlockKind kind) { return kind == BlockKind::kDeformable || kind == BlockKind::kRigid; }

// of two the smaller: a wedge in solid rock is no crumb
double lower_median(const std::vector<double>& v) {
  return v.empty() ? 0 : value_at_rank(v, (v.size() - 1) / 2);
}

}  // namespace

Electorate::Electorate(const Scene& scene) : votes(scene.blocks.size.size(), false) {
  const BlockSet& b = scene.blocks;
  std::vector<double> size, thickness;
  for (size_t k = 0; k < votes.size(); ++k)
    if (can_move(b.kind[k])) size.push_back(b.size[k]), thickness.push_back(b.thinness[k]);
  const double median_size = lower_median(size), median_thickness = lower_median(thickness);
  const double told = scene.model.safety.displacement;
  for (size_t k = 0; k < votes.size(); ++k) {
    const double area = b.size[k] * b.size[k];
    const bool is_needle =
        area < kNeedleArea * median_size * median_size || b.thinness[k] < kNeedleThickness * median_thickness;
    votes[k] = can_move(b.kind[k]) && (!is_needle || !std::isnan(told));
    limit.push_back(!std::isnan(told)
                        ? told
                        : std::min(kFailed * std::max(b.size[k], median_size), kFarthest * b.size[k]));
  }
  may_rest_beyond = std::isnan(told);
}

void Watch::stage_begins(const Scene& scene, int stage, const StagePlan& plan) {
  if (second_) second_->stage_begins(scene, stage, plan);
}

// What steps from rest have not held within the limit has failed, wherever it may come to rest then.
void Watch::stage_is_followed(const Scene& scene, int stage, const StagePlan& plan, const std::string& why) {
  fell_ = fell_ || beyond_;
  if (second_) second_->stage_is_followed(scene, stage, plan, why);
}

void Watch::at(const Instant& i) {
  look(i);
  if (second_) second_->at(i);
}

void Watch::fails(const Instant& i) {
  if (second_) second_->fails(i);
}

bool Watch::only_needles_move(double unbalanced) const {
  return !failed() && speed_left_ <= unbalanced && (worst_ < 0 || !electorate_.votes[worst_]);
}

void Watch::look(const Instant& i) {
  if (i.stage_start)
    start_ = since_.empty() ? i.state.displacement : since_, begin_ = i.state.time, peak_ = 0;
  // what a path moves is no failure: on it that is told by a balance that is not found
  if (i.scene.model.stages[i.stage].path > 0) return;
  // steps from rest count as one time each: their lengths are but a measure of how little inertia holds
  const bool from_rest = i.scene.model.stages[i.stage].from_rest;
  const double elapsed = from_rest ? static_cast<double>(i.steps_before + 1) : i.state.time - begin_,
               unit = from_rest ? i.work.clock.dt : 1;
  double share = 0, moving = 0;
  failed_ = false;
  for (size_t k = 0; k < start_.size(); ++k) {
    if (!electorate_.votes[k]) continue;
    const double moved = norm(i.state.displacement[k] - start_[k]), speed = norm(i.state.rate[k].a);
    moving += 0.5 * scene_.blocks.mass[k] * speed * speed;
    if (moved > share * electorate_.limit[k]) {
      share = moved / electorate_.limit[k];
      farthest_ = moved, block_ = k;
    }
    failed_ = failed_ || (moved > electorate_.limit[k] &&
                          (!electorate_.may_rest_beyond || speed * unit * elapsed > kStillMoves * moved));
  }
  fell_ =
      fell_ || (failed_ && from_rest);  // the last instant is one more step, and may find a balance far off
  peak_ = std::max(peak_, moving);
  speed_left_ = peak_ > 0 ? std::sqrt(moving / peak_) : 0;
  worst_ = i.report.worst_block;
  beyond_ = share > 1;
}

}  // namespace talus
