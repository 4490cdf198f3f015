#include "talus/results/check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "talus/base/clock.h"
#include "talus/base/text.h"
#include "talus/results/prediction.h"
#include "talus/run/base_report.h"
#include "talus/run/resolution.h"
#include "talus/run/sliver_offer.h"
#include "talus/run/trial.h"

namespace talus {

namespace {

// Of taking all steps, by stages; writing and cutting are not in it.
std::string time_text(const PreparedRun& run) {
  constexpr double kTrial = 3,
                   kTold = 5;  // [s] what steps are taken for; a check whose trial takes longer says how long
  constexpr int kWhole = 5000;  // blocks up to which its steps are those of the run
  const double begin = wall_now();
  const std::vector<StageCost> cost = time_stages(run, kTrial, threads_for(run.scene.blocks.count), kWhole);
  const double taken = wall_now() - begin;
  double low = 0, high = 0;
  bool at_least = false;
  std::string stages;
  for (size_t i = 0; i < run.plans.size(); ++i) {
    const StageCost& c = cost[i];
    low += c.low, high += c.high, at_least = at_least || c.at_least;
    const std::string how =
        c.steps_to_rest > 0
            ? fmt::format("{} in {} steps to its rest", readable_seconds(c.low), c.steps_to_rest)
            : fmt::format("{} to {}, {} a step", readable_seconds(c.low), readable_seconds(c.high),
                          readable_seconds(c.step));
    stages += fmt::format("{}\"{}\" {}", i > 0 ? "; " : "", run.scene.model.stages[i].name, how);
  }
  if (!(high > 0)) return "";
  const std::string all = high > low
                              ? fmt::format("about {}, {} to {}", readable_seconds(std::sqrt(low * high)),
                                            readable_seconds(low), readable_seconds(high))
                              : "about " + readable_seconds(low);
  return fmt::format("  time       {} on this machine, by first steps{}: {}{}\n", all,
                     taken > kTold ? fmt::format(", which took {}", readable_seconds(taken)) : "", stages,
                     !at_least ? ""
                     : run.scene.blocks.count > kWhole
                         ? "; longer where the solver takes more sweeps than this trial allows"
                         : "; steps of the trial were not solved");
}

}  // namespace

std::string check_report(const std::string& file, int warnings, const PreparedRun& run, const Cut& cut) {
  const Prediction p = predict(run.scene, run.plans);
  std::string text = fmt::format("{}: no errors, {} warning{}\n", file, warnings, warnings == 1 ? "" : "s");
  text += fmt::format(
      "  blocks     {}; {} faces held together, {} contact points at the start, {} supported points{}\n",
      p.blocks, p.bond_faces, p.contacts, p.supported,
      p.boundary > 0 ? fmt::format(", {} points at boundaries", p.boundary) : "");
  text += base_report(run.scene) + resolution_report(run.scene);
  for (size_t i = 0; i < run.plans.size(); ++i) {
    const StagePlan& plan = run.plans[i];
    const StageInput& stage = run.scene.model.stages[i];
    const std::string bound =
        bound_name(run.scene, plan).empty()
            ? (stage.implicit ? "no stable limit: elasticity is implicit" : "no block deforms")
            : fmt::format("stable limit {:.4g} s, set by {}", plan.dt_bound, bound_name(run.scene, plan)) +
                  (plan.dt_bound < plan.dt_undamped
                       ? fmt::format("; {:.4g} s without damping_stiffness", plan.dt_undamped)
                       : "");
    text += fmt::format("  stage      \"{}\": {}{} steps of {:.4g} s ({})\n", stage.name,
                        stage.kind == StageKind::kStatic ? "at most " : "", plan.steps, plan.dt,
                        bound + damping_text(stage));
    if (plan.clamped > 0)
      text += fmt::format("             moment clamp: {} blocks, up to {:.3g} times\n", plan.clamped,
                          plan.largest_clamp);
  }
  const SliverTable& slivers = cut.slivers;
  if (slivers.needles + slivers.merged + slivers.deleted + slivers.kept > 0)
    text += fmt::format(
        "  slivers    {} needles without a joint of their own merged; {} merged, {} deleted, {} kept\n",
        slivers.needles, slivers.merged, slivers.deleted, slivers.kept);
  text += sliver_offer_text(sliver_offers(run, cut));
  text += fmt::format("  memory     about {}\n", readable_bytes(p.memory));
  text += time_text(run);
  const bool at_most = std::any_of(run.scene.model.stages.begin(), run.scene.model.stages.end(),
                                   [](const auto& s) { return s.kind == StageKind::kStatic; });
  const int joint = run.scene.model.default_joint;
  text +=
      fmt::format("  contact    {}\n", joint < 0 ? "pairs without a joint of their own are frictionless"
                                                 : fmt::format("joint \"{}\" between pairs without their own",
                                                               run.scene.model.joints[joint].name));
  if (const ContactGive& give = run.scene.give;
      give.stress > 0 && meets_hard(run.scene.layout, run.scene.laws))
    text += fmt::format(
        "             where they are hard they give by {:g} of a face under {:.3g} MPa ({}); a block of median\n"
        "             size yields {:.0f} times as much in the shortest step\n",
        kGiveClosure, give.stress / 1e6, give.cause, yields_more(run.scene, run.plans));
  text += fmt::format("  output     {}{}: {} rows of histories, {} rows of steps, {} frames\n",
                      at_most ? "at most " : "about ", readable_bytes(p.output), p.history_rows, p.step_rows,
                      p.frames);
  return text;
}

}  // namespace talus
