#include "run_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <optional>

#include "report_command.h"
#include "signals.h"
#include "talus/base/name.h"
#include "talus/base/text.h"
#include "talus/results/opened_run.h"
#include "talus/results/progress.h"
#include "talus/run/base_report.h"
#include "talus/run/resolution.h"
#include "tell.h"
#include "watch.h"

namespace talus::app {

namespace {

// Stops the run when a signal asks for it.
class StoppedBySignals : public Progress {
 public:
  StoppedBySignals(StopSignals& signals, Recorder& recorder, Observer& next, std::FILE* out, bool terminal)
      : Progress(next, out, terminal), signals_(signals) {
    signals_.listen([&recorder] { recorder.end_as_held(); });
  }
  bool stop() override { return signals_.hear() != 0 || Progress::stop(); }

 private:
  StopSignals& signals_;
};

// The command to look at each thing that a failed run has left.
std::string left_text(const Recorder::Left& left, const std::string& model, const std::string& folder) {
  std::string text;
  if (!left.step.empty())
    text += fmt::format("  talus replay {}/{}      (the contact equations of the step)\n", folder, left.step);
  const std::string time = left.frame ? fmt::format(" --time {:.9g}", *left.frame) : "";
  text += fmt::format("  talus plot {} --blocks velocity{}      (the instant, as a picture)\n", folder, time);
  if (!left.state.empty())
    text += fmt::format("  talus run {} --from {}/{}      (from the last good state, with --set as before)\n",
                        model, folder, left.state);
  return text;
}

struct Run {
  RunResult result;
  int signal = 0;  // that has interrupted it
};

Run run_recorded(PreparedRun& prepared, std::optional<SavedRun>& saved, const std::string& from,
                 Recorder& recorder, LivePage* live, StopSignals& signals, std::FILE* out,
                 const Workers& workers, bool branches) {
  Observer& first = live ? static_cast<Observer&>(*live) : recorder;
  StoppedBySignals progress(signals, recorder, first, out, isatty(fileno(out)) != 0);
  say(out, base_report(prepared.scene) + resolution_report(prepared.scene));
  State state = saved ? std::move(saved->state) : start_state(prepared.scene);
  if (saved)
    say(out, fmt::format("{} from {}: t = {:.6g} s, step {}\n", branches ? "branches off" : "goes on", from,
                         state.time, state.step));
  RunResult result =
      saved ? continue_stages(prepared.scene, prepared.plans, saved->standing, state, progress, workers)
            : run_stages(prepared.scene, prepared.plans, state, progress, workers);
  signals.run_has_ended();
  progress.finish();
  recorder.finish(result);
  if (live) live->finish();
  return {std::move(result), signals.asked()};
}

size_t known_stages_until(const Model& model, const std::string& name) {
  if (const size_t stages = stages_until(model, name); stages > 0) return stages;
  std::vector<std::string> names;
  for (const StageInput& stage : model.stages) names.push_back(stage.name);
  throw Error(kExitUsage,
              fmt::format("--until: there is no stage \"{}\"; there is {}", name, join_or(names)));
}

}  // namespace

void add_run_arguments(CLI::App& verb, RunArguments& args) {
  verb.add_option("-o,--output", args.folder, "folder for the results");
  verb.add_option(
      "--from", args.from,
      "go on from a saved state, FOLDER/saved/*.h5, in the folder it lies in; with -o, branch off into another, "
      "where what begins later may differ");
  verb.add_option("--until", args.until,
                  "end after this stage; its saved state is for branches and for going on");
  verb.add_flag("--force", args.force, "replace the results of an earlier run in that folder");
  verb.add_flag("-q,--quiet", args.quiet, "say nothing but errors");
  verb.add_option("--threads", args.threads,
                  "threads inside a step, 0: as many as pay; results are the same for any number")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  verb.add_flag(
      "--watch", args.watch,
      "write live.html into the folder every few seconds: the report so far, which a browser keeps up");
  verb.add_flag("--profile", args.profile, "print the share of each part of a step in the time of the run");
  verb.add_option("--dump-step", args.dump_step,
                  "also write the contact equations of this step, as step_N.json, for talus replay");
  verb.footer(
      "Example: talus run examples/impact_bar/impact_bar.toml -o out/bar --set grid.bar.cells=[20,1]");
}

int run_command(const ModelArguments& model, const RunArguments& args) {
  if (args.folder.empty() && args.from.empty())
    throw Error(kExitUsage, "run needs -o FOLDER for the results, or --from STATE to go on");
  const bool branches = !args.from.empty() && !args.folder.empty() && !lies_in(args.from, args.folder);
  if (args.force && !args.from.empty() && !branches)
    throw Error(kExitUsage, "--force replaces results and --from goes on with them: give one of them");
  if (args.from.empty() || branches) check_result_folder(args.folder, args.force);
  if (args.watch) (void)page_text();  // told before anything is run
  auto [findings, prepared] = prepare_model(model);
  if (!args.until.empty()) end_after(prepared, known_stages_until(prepared.scene.model, args.until));
  std::FILE* out = args.quiet ? std::fopen("/dev/null", "w") : stdout;
  if (!out) throw FileError("/dev/null: cannot be opened");
  std::function<StateBytes()> from;
  if (!args.from.empty()) from = [&args] { return StateBytes::read(args.from); };
  OpenedRun opened =
      open_run(prepared, branches || !from ? args.folder : folder_of_saved(args.from), from, !branches);
  std::optional<SavedRun>& saved = opened.saved;
  if (saved && saved->standing.result.stages.size() > prepared.plans.size())
    throw Error(kExitUsage,
                fmt::format("--until: stage \"{}\" had ended when that state was saved", args.until));
  // threads: after the state was read, by a copy of this process, which must have none; and before any result is
  // touched, since the system may refuse them
  const Workers workers(args.threads > 0 ? args.threads : threads_for(prepared.scene.blocks.count));
  StopSignals signals;
  if (!opened.folder) opened.folder.emplace(args.folder, args.force);
  if (const std::string stale = opened.folder->stale_lock(); !stale.empty()) tell("talus: note: {}\n", stale);
  const std::string name = opened.folder->path().string();
  signals.begin();
  const std::unique_ptr<Recorder> recorder =
      opened.record(prepared.scene, notes_of(model.overrides, findings));
  recorder->dump_step(args.dump_step);
  std::optional<LivePage> live;
  if (args.watch) {
    live.emplace(*recorder, name);
    say(out, fmt::format("to watch it, open {} in a browser\n", live->file().string()));
  }
  Run run;
  try {
    run = run_recorded(prepared, saved, args.from, *recorder, live ? &*live : nullptr, signals, out, workers,
                       branches);
  } catch (const std::bad_alloc&) {
    recorder->abandon("not enough memory");
    if (live) live->finish();
    throw;
  } catch (const std::exception& e) {
    recorder->abandon(e.what());
    if (live) live->finish();
    recorder->check_place();  // the cause, whatever failed first
    throw;
  }
  const RunResult& result = run.result;
  // a state may have come with texts of somebody else's
  say(out, shown_name(closing_text(prepared.scene, result, recorder->joints(), recorder->bolts(), name,
                                   recorder->audit()),
                      "\n"));
  if (args.profile) say(out, profile_text(result.profile, result.threads));
  if (!result.failure.empty())
    throw Error(result.mechanism ? kExitMechanism : kExitNumerical,
                fmt::format("{}\nresults up to then are in {}; to look at them:\n{}", result.failure, name,
                            left_text(recorder->left(), model.file, name)));
  if (result.interrupted) return kExitSignal + run.signal;
  const auto audit = recorder->audit();
  return audit && !audit->valid() ? kExitNotValid : kExitOk;
}

}  // namespace talus::app
