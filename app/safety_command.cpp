#include "safety_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "plot_blocks.h"
#include "talus/base/text_file.h"
#include "talus/output/text_table.h"
#include "talus/talus.h"
#include "tell.h"

namespace talus::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kTrials = "safety.csv";

// The trials of a search of the same model that was broken off.
std::vector<SafetyTrial> known_trials(const fs::path& folder, const Model& model) {
  if (!is_there(folder / kTrials) || !is_there(folder / "model.toml"))
    throw FileError(fmt::format("{}: there is no search to go on with; leave out --resume", folder.string()));
  if (read_text_file(folder / "model.toml") != model.text)
    throw FileError(
        fmt::format("{}: the search there is of another model, or of other --set", folder.string()));
  std::vector<SafetyTrial> known;
  for (const auto& row : read_text_table(folder / kTrials).rows) {
    SafetyTrial t;
    try {
      t.factor = std::stod(row.at(0)), t.stands = row.at(1) == "1", t.outcome = row.at(2),
      t.stage = row.at(3);
      t.time = std::stod(row.at(4)), t.steps = std::stoll(row.at(5)), t.unbalanced = std::stod(row.at(6));
      t.displacement = std::stod(row.at(7)), t.block = row.at(8), t.closure = std::stod(row.at(9));
    } catch (const std::logic_error&) {  // a row that is no trial, or cut short: that trial is run again
      continue;
    }
    known.push_back(t);
  }
  return known;
}

}  // namespace

int safety_command(const ModelArguments& args, const SafetyArguments& how) {
  const bool force = how.force || how.resume;
  check_result_folder(how.folder, force, ResultKind::kSafety);
  const PreparedRun prepared = prepare_model(args).run;
  const Model& model = prepared.scene.model;
  check_safety(prepared);
  SafetySettings settings;
  if (how.resume) settings.known = known_trials(how.folder, model);
  // before anything is touched: the system may refuse them
  const Workers workers(how.threads > 0 ? how.threads : threads_for(prepared.scene.blocks.count));
  const fs::path root = how.folder;
  std::error_code ec;
  if (force)
    for (const char* part : {"stands", "fails"}) fs::remove_all(root / part, ec);
  ResultFolder out(how.folder, force, ResultKind::kSafety);
  out.write("model.toml", model.text);
  fmt::print("  {:>9}  {:<6}  {:<18}  {:>9}  {:>8}  {:>10}  {:>10}  {}\n",
             model.safety.by == SafetyBy::kTilt           ? "tilt"
             : model.safety.by == SafetyBy::kAcceleration ? "share"
                                                          : "factor",
             "", "ended by", "time [s]", "steps", "unbalanced", "moved [m]", "block");
  settings.jobs = how.jobs;
  SafetyResult so_far;
  settings.told = [&](const SafetyTrial& t) {
    so_far.trials.push_back(t);
    out.write(kTrials, safety_csv(so_far));  // what is known, should the search be broken off
    fmt::print("{}", safety_line(t));
    std::fflush(stdout);
  };
  settings.keeper = [&](const Scene& scene, const SafetyTrial& t) {
    RunNotes notes;
    notes.overrides = args.overrides;
    notes.warnings.push_back(fmt::format("safety: this is the trial at {} {:g}, which {}",
                                         name_of(model.safety.by), t.factor, t.stands ? "stands" : "fails"));
    return std::make_unique<Recorder>(scene, ResultFolder(root / (t.stands ? "stands" : "fails"), true),
                                      notes);
  };
  settings.kept = [](Observer& keeper, const RunResult& result) {
    static_cast<Recorder&>(keeper).finish(result);
  };
  const SafetyResult result = seek_safety(prepared, workers, settings);
  out.write(kTrials, safety_csv(result));
  out.write("safety.json", safety_json(model, result));
  if (result.fails > 0) {
    BlockPlotArguments picture;
    picture.quantities = {"displacement"};
    picture.title = fmt::format("Mechanism at {} {:g}", name_of(model.safety.by), result.fails);
    out.note_picture("mechanism");
    plot_blocks(root / "fails", picture, root / "mechanism", true);
  }
  fmt::print(
      "{}written to {}: safety.csv, safety.json{}\n", safety_text(model, result), how.folder,
      result.fails > 0
          ? ", mechanism.svg; stands/, fails/: the last trial that stands, the first that fails, for talus report and plot"
          : "");
  return kExitOk;
}

}  // namespace talus::app
