#include "check_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "browser.h"
#include "report_command.h"
#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/plot/cut_picture.h"
#include "talus/report/section_page.h"
#include "talus/results/prediction.h"
#include "talus/run/base_report.h"
#include "talus/run/resolution.h"
#include "talus/run/trial.h"
#include "talus/talus.h"

namespace talus::app {
namespace {

// Of taking all steps, by stages; writing and cutting are not in it.
void print_time(const PreparedRun& run) {
  constexpr double kTrial = 0.6;  // [s]
  const std::vector<StepCost> cost = time_steps(run, kTrial, threads_for(run.scene.blocks.count));
  double sum = 0;
  bool at_most = false, at_least = false;
  std::string stages;
  for (size_t i = 0; i < run.plans.size(); ++i) {
    const bool is_static = run.scene.model.stages[i].kind == StageKind::kStatic;
    const double seconds = cost[i].seconds * static_cast<double>(run.plans[i].steps);
    sum += seconds, at_most = at_most || is_static, at_least = at_least || cost[i].at_least;
    stages += fmt::format("{}\"{}\" {}{} ({} a step)", i > 0 ? ", " : "", run.scene.model.stages[i].name,
                          is_static ? "at most " : "", readable_seconds(seconds),
                          readable_seconds(cost[i].seconds));
  }
  if (sum > 0)
    fmt::print("  time       {}{} on this machine, by first steps: {}{}\n",
               at_most ? "at most about " : "about ", readable_seconds(sum), stages,
               at_least ? "; longer where the solver takes more sweeps than this trial allows" : "");
}

}  // namespace

int check_command(const ModelArguments& args, const std::string& folder, bool force, bool open) {
  if (open && folder.empty())
    throw Error(kExitUsage, "--open: the page needs a folder to be written to: give it by -o DIR");
  const std::string page = open ? page_text() : "";
  if (!folder.empty()) check_result_folder(folder, force, ResultKind::kPicture);
  Cut cut;
  const auto& [findings, run] = prepare_model(args, &cut);
  const Prediction p = predict(run.scene, run.plans);
  fmt::print("{}: no errors, {} warning{}\n", args.file, findings.warning_count(),
             findings.warning_count() == 1 ? "" : "s");
  fmt::print(
      "  blocks     {}; {} faces held together, {} contact points at the start, {} supported points{}\n",
      p.blocks, p.bond_faces, p.contacts, p.supported,
      p.boundary > 0 ? fmt::format(", {} points at boundaries", p.boundary) : "");
  fmt::print("{}{}", base_report(run.scene), resolution_report(run.scene));
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
    fmt::print("  stage      \"{}\": {}{} steps of {:.4g} s ({})\n", stage.name,
               stage.kind == StageKind::kStatic ? "at most " : "", plan.steps, plan.dt, bound);
    if (plan.clamped > 0)
      fmt::print("             moment clamp: {} blocks, up to {:.3g} times\n", plan.clamped,
                 plan.largest_clamp);
  }
  const SliverTable& slivers = cut.slivers;
  if (slivers.needles + slivers.merged + slivers.deleted + slivers.kept > 0)
    fmt::print(
        "  slivers    {} needles without a joint of their own merged; {} merged, {} deleted, {} kept\n",
        slivers.needles, slivers.merged, slivers.deleted, slivers.kept);
  fmt::print("{}", sliver_offer_text(sliver_offers(run, cut)));
  fmt::print("  memory     about {}\n", readable_bytes(p.memory));
  print_time(run);
  const bool at_most = std::any_of(run.scene.model.stages.begin(), run.scene.model.stages.end(),
                                   [](const auto& s) { return s.kind == StageKind::kStatic; });
  const int joint = run.scene.model.default_joint;
  fmt::print("  contact    {}\n", joint < 0
                                      ? "pairs without a joint of their own are frictionless"
                                      : fmt::format("joint \"{}\" between pairs without their own",
                                                    run.scene.model.joints[static_cast<size_t>(joint)].name));
  if (const ContactGive& give = run.scene.give;
      give.stress > 0 && meets_hard(run.scene.layout, run.scene.laws))
    fmt::print(
        "             where they are hard they give by {:g} of a face under {:.3g} MPa ({}); a block of median\n"
        "             size yields {:.0f} times as much in the shortest step\n",
        kGiveClosure, give.stress / 1e6, give.cause, yields_more(run.scene, run.plans));
  fmt::print("  output     {}{}: {} rows of histories, {} rows of steps, {} frames\n",
             at_most ? "at most " : "about ", readable_bytes(p.output), p.history_rows, p.step_rows,
             p.frames);
  if (!folder.empty()) {
    ResultFolder out(folder, force, ResultKind::kPicture);
    const auto stem = out.note_picture("cut");
    plot::write_cut_picture(run.scene.model, cut, run.scene.layout, stem);
    fmt::print("  picture    {0}.png, {0}.svg: blocks, joints and what acts on them\n", stem.string());
    if (open) {
      out.write("section.html", report::section_page(page, run.scene.model, cut, run.scene.layout, ""));
      show_section_page(out.path() / "section.html");
    }
  }
  return kExitOk;
}

}  // namespace talus::app
