#include "talus/run/steps_from_rest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/run/mechanism.h"
#include "talus/run/path.h"
#include "talus/run/plan.h"

namespace talus {

namespace {

// How far blocks of a pair may move against each other in a step, as share of the smaller; how far a block may go, as share
// of its size.
constexpr double kMostApproach = 0.05, kMostWay = 10;

// How deep hard blocks may be in each other that nobody saw coming, as share of the smaller: what pushes them out does work
// that no contact has taken.
constexpr double kMostUnseen = 1e-6;

// Energy of elastic joints at the end of a step that its forces do not know of, as share of the largest term of the ledger: a
// corner that goes in finds a wider face than its first row had. Joints that hold more than was done on them give it back.
// A step may leave what the audit allows in all.
constexpr double kMostUnpaid = 1e-3;

// Steps in a row that have to go without halving before one is longer, and what that count begins at after one beyond the
// first length that was halved: what was too long is not asked for again at once.
constexpr int kWhole = 2, kAfterHalving = -2;

// Way of a block in the step that tells a balance of a path, as share of the way there: what its row is off by.
constexpr double kSettled = 1e-3;

}  // namespace

RestWatch StepsFromRest::first_look(double length) {
  RestWatch rest;
  rest.length = length, rest.whole = kWhole;
  return rest;
}

void StepsFromRest::go_on(double goal, double first, int64_t steps) {
  const RestWatch before = state_.rest;
  RestWatch& rest = state_.rest = first_look(before.length);
  rest.whole = before.whole, rest.balances = before.balances;
  rest.begin = state_.time, rest.begin_steps = steps;
  rest.pace = (goal - state_.history_time) / std::max(rest.length, first);
  state_.largest_kinetic = 0;
}

// Where blocks come together by more than their contact points were sought ahead the step is taken again, looking as far as
// they went; where that does not help, it was not solved to the tolerance or they go too far it is taken with half the length
// (theory 14.2). The shortest may be loose: by then all solvers have tried.
std::optional<StepReport> StepsFromRest::kick(const StageStand& at, StepSettings& settings, double& /*dt*/,
                                              double& advance) {
  const StageInput& stage = at.stage;
  const double first = at.plan.dt;
  const double shortest = first / kMostShortened;
  const State before = state_;
  double length = state_.rest.length;
  bool looked = false, halved = false;
  settings.near_expected = false;
  for (;;) {
    advance = std::min(length, first);
    // what acts at the end of the step; sums of lengths are round-off short of the times meant
    const double end = (state_.time - at.begin + advance) * (1 + 1e-12);
    state_.relaxed = stage.relaxed_at(end, state_.relaxed);
    settings.by_all = length <= shortest;
    StepSettings with_path = settings;
    with_path.history_dt = history_dt(at.goal, length);
    StepReport report = talus::kick(scene_, with_path, length, work_, state_);
    const Approach approach =
        approach_of(scene_.bonds, scene_.blocks, state_, state_.rate, length, work_.workers);
    way_ = longest_way(length, 0);
    const bool solved = !report.failed && !(report.loose && length > shortest);
    const bool near = solved && !is_far(approach) && approach.of_margin <= 1;
    const AtEnd found =
        near && length > shortest ? at_end(state_.time + advance, report) : AtEnd::kAsForcesSay;
    if (near && found == AtEnd::kAsForcesSay) {
      state_.rest.length = length;
      state_.rest.gone +=
          longest_way(length, prescribed_way(scene_, state_.history_time, work_.clock.history_end()));
      state_.rest.gone_many += length * pace_of_many(scene_.blocks, state_);
      state_.rest.moved += way_;
      state_.rest.whole = !halved ? state_.rest.whole + 1 : length < first ? 0 : kAfterHalving;
      return report;
    }
    looked = solved && !is_far(approach) && found != AtEnd::kTooFar && !looked;
    if (!looked && length <= shortest) {
      if (stage.may_follow) {
        why_not_ = report.failed ? "a step from rest was not solved" : way_text(approach);
        state_ = before;
        return std::nullopt;
      }
      if (report.failed) return report;
      throw NumericalError(too_far(stage, approach, length));
    }
    restore(before, looked);
    settings.near_expected = looked;
    if (!looked) length *= 0.5, halved = true;
  }
}

// By a search of contacts; the shortest step is not asked, as none can be taken for it (theory 14.2).
StepsFromRest::AtEnd StepsFromRest::at_end(double time_end, const StepReport& report) {
  try {
    const Unseen u = unseen(scene_, time_end, work_, state_, report);
    // with the motion of this step, which the ledger books at its end
    const double largest = std::max(report.energy.largest(), 2 * kinetic_energy(scene_.blocks, state_.rate));
    if (u.unpaid > kMostUnpaid * largest) return AtEnd::kTooFar;
    return u.deep > kMostUnseen ? AtEnd::kUnseen : AtEnd::kAsForcesSay;
  } catch (const NumericalError&) {  // a block would be turned inside out
    return AtEnd::kTooFar;
  }
}

// `expect`: what the try came to is what the next will: rates, by which it looks ahead, and forces of supports, of which
// blocks that they hold fast say nothing.
void StepsFromRest::restore(const State& before, bool expect) {
  if (!expect) {
    state_ = before;
    return;
  }
  std::vector<BlockRate> rate = std::move(state_.rate);
  const std::array found{std::move(state_.supports), std::move(state_.boundaries), std::move(state_.ties)};
  state_ = before;
  state_.rate = std::move(rate);
  const std::array held{&state_.supports, &state_.boundaries, &state_.ties};
  for (size_t i = 0; i < held.size(); ++i)
    for (size_t k = 0; k < held[i]->size(); ++k) (*held[i])[k].force = found[i][k].force;
}

void StepsFromRest::lengthen(double first, bool relaxed) {
  RestWatch& rest = state_.rest;
  if (rest.whole < kWhole) return;
  rest.length = std::max(rest.length, std::min(2 * rest.length, relaxed ? kMostLengthened * first : first));
}

bool StepsFromRest::is_far(const Approach& approach) const {
  return !(approach.of_size <= kMostApproach) || !(way_ <= kMostWay);
}

bool StepsFromRest::stands(bool on_path) const {
  if (!on_path) return way_ <= kFarToGo;
  return work_.clock.history_dt == 0 &&
         way_ <= std::max(kSettled * state_.rest.moved, scene_.model.solver.tolerance);
}

void StepsFromRest::arrive(double goal) {
  constexpr double kRoundOff = 1e-12;
  if (std::abs(goal - state_.history_time) <= kRoundOff * std::abs(goal)) state_.history_time = goal;
}

// Eq. 14.2.
double StepsFromRest::history_dt(double goal, double length) const {
  const double left = goal - state_.history_time, share = state_.rest.pace * length;
  return share >= left ? left : share;
}

// Of what is not left out; `less` of it was asked for [m].
double StepsFromRest::longest_way(double length, double less) const {
  double most = 0;
  for (int k = 0; k < count_of(state_.rate); ++k)
    if (!state_.is_left_out(k))
      most = std::max(most, (length * norm(state_.rate[k].a) - less) / scene_.blocks.size[k]);
  return most;
}

std::string StepsFromRest::way_text(const Approach& approach) const {
  if (!(approach.smaller >= 0 && approach.of_size > kMostApproach))
    return fmt::format("a block goes {:.2g} times its size", way_);
  const int k = approach.smaller, b = approach.larger;
  const Vec2 at = scene_.blocks.centroid[k] + state_.displacement[k];
  return fmt::format("block \"{}\" at ({:.4g}, {:.4g}) moves against \"{}\" by {:.2g} of its size",
                     scene_.blocks.name[k], at.x, at.y, scene_.blocks.name[b], approach.of_size);
}

std::string StepsFromRest::too_far(const StageInput& stage, const Approach& approach, double length) const {
  return fmt::format(
      "step {} at t = {:.9g} s: {}, also in a step of {:.3g} s: something falls, slides or is squeezed out. {}",
      state_.step, state_.time, way_text(approach), length,
      stage.path > 0
          ? fmt::format("The histories of its path are at {:.6g} s: histories.csv has the balances before it",
                        state_.history_time)
          : "integration = \"dynamic\" follows it");
}

}  // namespace talus
