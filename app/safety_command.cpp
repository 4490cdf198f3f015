#include "safety_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>

#include "plot_blocks.h"
#include "talus/base/text_file.h"
#include "talus/output/text_table.h"
#include "talus/plot/figure.h"
#include "talus/talus.h"
#include "tell.h"

namespace talus::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kTrials = "safety.csv";
constexpr const char* kStates = "states";  // of trials that stood, until the search has ended

fs::path state_of(const fs::path& folder, const SafetyTrial& t) {
  return folder / kStates / fmt::format("{}_from_{}.state", t.factor, t.from);
}

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
      t.from = std::stod(row.at(10));
    } catch (const std::logic_error&) {  // a row that is no trial, or cut short: that trial is run again
      continue;
    }
    known.push_back(t);
  }
  return known;
}

// How far the block that came nearest to its limit has moved, over what was asked: the trials that stand, and where the
// first that fails goes off the figure.
plot::Figure displacement_figure(const Model& model, const SafetyResult& result) {
  const bool by_strength = model.safety.by == SafetyBy::kStrength;
  std::map<double, double> stood;  // of one factor the last
  if (!by_strength) stood[0] = 0;
  for (const SafetyTrial& t : result.trials) {
    const bool counted_from = by_strength && !model.safety.from_start && t.from == 0;
    if (t.stands && t.factor <= result.stands) stood[t.factor] = counted_from ? 0 : 1e3 * t.displacement;
  }
  plot::Figure figure;
  figure.title = "Displacement of the block that came nearest to its limit";
  figure.x_label = name_of(model.safety.by), figure.y_label = "displacement [mm]";
  plot::Curve stands{.label = "at rest", .x = {}, .y = {}};
  double most = 0;
  for (const auto& [factor, moved] : stood)
    stands.x.push_back(factor), stands.y.push_back(moved), most = std::max(most, moved);
  figure.curves = {stands};
  if (result.fails > 0 && !stood.empty()) {
    const double top = most > 0 ? 1.5 * most : 1;
    figure.curves.push_back({.label = "fails",
                             .x = {stands.x.back(), result.fails},
                             .y = {stands.y.back(), top},
                             .color = 1,
                             .style = plot::Style::kDashed});
    figure.y_max = top, figure.x_max = result.fails + 0.05 * (result.fails - stands.x.front());
  }
  return figure;
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
  if (!how.resume) fs::remove_all(root / kStates, ec);
  ResultFolder out(how.folder, force, ResultKind::kSafety);
  out.write("model.toml", model.text);
  fmt::print("  {:>9}  {:<6}  {:<18}  {:>9}  {:>8}  {:>10}  {:>10}  {}\n",
             model.safety.by == SafetyBy::kTilt           ? "tilt"
             : model.safety.by == SafetyBy::kAcceleration ? "share"
                                                          : "factor",
             "", "ended by", "time [s]", "steps", "unbalanced", "moved [m]", "block");
  settings.jobs = how.jobs;
  SafetyResult so_far;
  // should the search be broken off: what has been told, and what an earlier one knew beside it
  const auto keep_known = [&] {
    SafetyResult all = so_far;
    for (const SafetyTrial& k : settings.known)
      if (std::none_of(all.trials.begin(), all.trials.end(),
                       [&](const SafetyTrial& t) { return t.factor == k.factor && t.from == k.from; }))
        all.trials.push_back(k);
    out.write(kTrials, safety_csv(all));
  };
  if (how.resume) keep_known();
  settings.told = [&](const SafetyTrial& t) {
    so_far.trials.push_back(t);
    keep_known();
    fmt::print("{}", safety_line(t));
    std::fflush(stdout);
  };
  settings.save = [&](const SafetyTrial& t, const Archive& state) {
    const fs::path path = state_of(root, t);
    out.make_folder(kStates);
    write_archive(path, state);
  };
  settings.saved = [&](const SafetyTrial& t) -> std::optional<Archive> {
    if (!how.resume || !is_there(state_of(root, t))) return std::nullopt;
    return read_archive(state_of(root, t));
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
  fs::remove_all(root / kStates, ec);
  out.write(kTrials, safety_csv(result));
  out.write("safety.json", safety_json(model, result));
  out.note_picture("displacement");
  plot::write_figure(displacement_figure(model, result), root / "displacement");
  if (result.fails > 0) {
    BlockPlotArguments picture;
    picture.quantities = {"displacement"};
    picture.title = fmt::format("Mechanism at {} {:g}", name_of(model.safety.by), result.fails);
    out.note_picture("mechanism");
    plot_blocks(root / "fails", picture, root / "mechanism", true);
  }
  fmt::print(
      "{0}written to {1}: safety.csv, safety.json, displacement.svg{2}\ntalus report {1} makes a page of it\n",
      safety_text(model, result), how.folder,
      result.fails > 0
          ? ", mechanism.svg; stands/, fails/: the last trial that stands, the first that fails, for talus report and plot"
          : "");
  return kExitOk;
}

}  // namespace talus::app
