// The `talus` command: argument parsing and nothing else.

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>

#include "audit_command.h"
#include "check_command.h"
#include "command_pages.h"
#include "cut_command.h"
#include "import_command.h"
#include "new_command.h"
#include "plot_command.h"
#include "prepare_model.h"
#include "record_command.h"
#include "report_command.h"
#include "safety_command.h"
#include "talus/base/text.h"
#include "talus/model/schema.h"
#include "talus/run/base_report.h"
#include "talus/run/problem_file.h"
#include "talus/run/progress.h"
#include "talus/run/resolution.h"
#include "talus/talus.h"
#include "verify_command.h"

namespace {

volatile std::sig_atomic_t stop_requested = 0;
extern "C" void request_stop(int) { stop_requested = 1; }

using talus::app::ModelArguments;

void add_model_arguments(CLI::App& verb, ModelArguments& args) {
  verb.add_option("MODEL", args.file, "model file (TOML)")->required();
  verb.add_option("--set", args.overrides,
                  "override a key, for example --set material.bar.young=\"1 GPa\"; --set new:KEY=VALUE "
                  "where the table is to be made (repeatable)")
      ->allow_extra_args(false);
}

void add_strict(CLI::App& verb, ModelArguments& args) {
  verb.add_flag("--strict", args.strict, "take warnings of the model for errors");
}

struct RunArguments {
  std::string folder, from;
  bool force = false, quiet = false, profile = false;
  int64_t dump_step = -1;
  int threads = 0;  // 0: as many as pay
};

int run(const ModelArguments& args, const RunArguments& how) {
  const auto& [output, from, force, quiet, profile, dump_step, threads] = how;
  if (from.empty()) talus::check_result_folder(output, force);
  auto [findings, prepared] = talus::app::prepare_model(args);
  talus::SavedRun saved;
  const std::string folder = from.empty() ? output : talus::folder_of_saved(from, output);
  if (!from.empty())
    saved = talus::read_saved_run(from, prepared.scene);
  else
    talus::open_result_folder(folder, force);

  std::optional<talus::Recorder> recorder;
  if (from.empty())
    recorder.emplace(prepared.scene, folder);
  else
    recorder.emplace(prepared.scene, folder, saved.archive);
  recorder->dump_step(dump_step);
  talus::State state = from.empty() ? talus::start_state(prepared.scene) : std::move(saved.state);
  std::FILE* out = quiet ? std::fopen("/dev/null", "w") : stdout;
  talus::Progress progress(*recorder, out, isatty(fileno(out)) != 0);
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  progress.stop_when(&stop_requested);
  fmt::print(out, "{}{}", talus::base_report(prepared.scene), talus::resolution_report(prepared.scene));
  const talus::Workers workers(threads > 0 ? threads : talus::threads_for(prepared.scene.blocks.count));
  if (!from.empty())
    fmt::print(out, "goes on from {}: t = {:.6g} s, step {}\n", from, state.time, state.step);
  const talus::RunResult result =
      from.empty()
          ? talus::run_stages(prepared.scene, prepared.plans, state, progress, workers)
          : talus::continue_stages(prepared.scene, prepared.plans, saved.standing, state, progress, workers);
  progress.finish();
  recorder->finish(result, args.overrides, findings);
  fmt::print(out, "{}",
             talus::closing_text(prepared.scene, result, recorder->joints(), folder, recorder->audit()));
  if (profile) fmt::print(out, "{}", talus::profile_text(result.profile, result.threads, result.steps));
  if (!result.failure.empty())
    throw talus::NumericalError(result.failure + fmt::format("\nresults up to then are in {}", folder));
  if (result.interrupted) return talus::kExitInterrupted;
  const auto audit = recorder->audit();
  return audit && !audit->valid() ? talus::kExitNotValid : talus::kExitOk;
}

int replay(const std::string& file, const std::string& method, double tolerance) {
  talus::SolverInput options;
  options.method = talus::solver_called(method);
  options.second_solver = options.method == talus::SolverKind::kAuto;  // one that is named is seen alone
  const talus::Replay r = talus::replay_problem(file, options, tolerance);
  fmt::print("{}: {} points on {} blocks, {} islands (largest {})\n", file, r.points, r.blocks,
             r.solved.report.islands, r.solved.report.largest_island);
  fmt::print("  {:<14} {} iterations, contact error {:.3e} m{}\n", talus::name_of(r.solved.method),
             r.solved.report.iterations, r.solved.error.worst,
             r.solved.second_solver ? "; the first solver failed" : "");
  double normal = 0, shear = 0;
  for (const talus::Impulse& p : r.rows.impulse) normal += p[0], shear += std::abs(p[1]);
  fmt::print("  impulses       normal {:.12g} N s in all, tangential {:.12g} N s in magnitude\n", normal,
             shear);
  return r.solved.error.worst <= tolerance ? talus::kExitOk : talus::kExitNumerical;
}

int run_command(int argc, char** argv) {
  CLI::App app(
      "talus: blocks that move, slip and break under dynamic load, with contact forces found exactly");
  app.set_version_flag("--version",
                       fmt::format("talus {} (model format {})", talus::kVersion, talus::kModelFormat));
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 2 wrong command line, 3 wrong model, 4 file or disk, 5 numerical failure, 8 not "
      "valid by its audit, 130 interrupted.\nHelp on a verb: talus VERB --help");

  ModelArguments model;
  RunArguments how;
  std::string folder;
  bool force = false, json = false;
  CLI::App* run_verb = app.add_subcommand("run", "run a model and write a folder of results");
  add_model_arguments(*run_verb, model);
  add_strict(*run_verb, model);
  CLI::Option* output = run_verb->add_option("-o,--output", how.folder, "folder for the results");
  CLI::Option* from = run_verb->add_option(
      "--from", how.from, "go on from a saved state, FOLDER/saved/*.h5, in the folder it lies in");
  run_verb->add_flag("--force", how.force, "replace the results of an earlier run in that folder");
  run_verb->add_flag("-q,--quiet", how.quiet, "say nothing but errors");
  run_verb
      ->add_option("--threads", how.threads,
                   "threads inside a step, 0: as many as pay; results are the same for any number")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  run_verb->add_flag("--profile", how.profile,
                     "print the share of each part of a step in the time of the run");
  run_verb->add_option("--dump-step", how.dump_step,
                       "also write the contact equations of this step, as step_N.json, for talus replay");
  run_verb->footer(
      "Example: talus run examples/impact_bar/impact_bar.toml -o out/bar --set grid.bar.cells=[20,1]");

  CLI::App* check_verb =
      app.add_subcommand("check", "check a model and predict its steps, memory and output; runs nothing");
  add_model_arguments(*check_verb, model);
  add_strict(*check_verb, model);
  check_verb->add_option("-o,--output", folder, "folder for a picture of the model, cut.png and cut.svg");
  check_verb->add_flag("--force", force, "replace the picture in that folder");
  check_verb->footer("Example: talus check examples/impact_bar/impact_bar.toml -o out/check");

  CLI::App* cut_verb = app.add_subcommand(
      "cut", "cut regions into blocks: statistics, picture and a blocks file; runs nothing");
  add_model_arguments(*cut_verb, model);
  cut_verb->add_option("-o,--output", folder, "folder for the results")->required();
  cut_verb->add_flag("--force", force, "replace the results in that folder");
  cut_verb->footer("Example: talus cut examples/tunnel/tunnel.toml -o out/tunnel");

  talus::app::ImportArguments import;
  CLI::App* import_verb = app.add_subcommand(
      "import", "sections of a model file from a drawing or map (DXF, shapefile, GeoPackage, GeoJSON)");
  talus::app::add_import_arguments(*import_verb, import);

  CLI::App* safety_verb = app.add_subcommand(
      "safety", "seek the factor of safety: joint strength divided by a factor until the model fails");
  add_model_arguments(*safety_verb, model);
  add_strict(*safety_verb, model);
  safety_verb->add_option("-o,--output", folder, "folder for the results")->required();
  safety_verb->add_flag("--force", force, "replace the results in that folder");
  safety_verb->add_option("--threads", how.threads, "threads inside a step, 0: as many as pay")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  safety_verb->footer("Example: talus safety examples/toppling/toppling.toml -o out/toppling");

  talus::app::NewArguments start;
  CLI::App* new_verb = app.add_subcommand("new", "write a small commented model that runs as it is");
  talus::app::add_new_arguments(*new_verb, start);

  talus::app::PlotArguments plot;
  CLI::App* plot_verb = app.add_subcommand(
      "plot", "draw histories, or pictures of the blocks, of result folders as SVG and PNG");
  talus::app::add_plot_arguments(*plot_verb, plot);

  talus::app::ReportArguments report;
  CLI::App* report_verb = app.add_subcommand(
      "report", "make one HTML page of a run: pictures in motion, charts, tables; opens in any browser");
  talus::app::add_report_arguments(*report_verb, report);

  CLI::App* audit_verb = app.add_subcommand(
      "audit", "look over the frames of a run: overlaps and forces against the polygons of the blocks");
  audit_verb->add_option("DIR", folder, "result folder of talus run")->required();
  audit_verb->add_option("--threads", how.threads, "threads, 0: as many as the machine has")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  audit_verb->footer("Example: talus audit out/impact_bar/run      (exit code 8: not valid)");

  talus::app::RecordArguments record;
  CLI::App* record_verb = app.add_subcommand(
      "record",
      "make a strong-motion record, or a synthetic motion, ready for a model: measures, figures, CSV");
  talus::app::add_record_arguments(*record_verb, record);

  std::string problem, method = "newton";
  double tolerance = 1e-9;
  CLI::App* replay_verb = app.add_subcommand(
      "replay", "solve the contact equations of one step again, with any solver, or by the choice of a run");
  replay_verb->add_option("FILE", problem, "step_N.json from a result folder")->required();
  replay_verb->add_option("--method", method, "solver")
      ->check(CLI::IsMember(std::vector<std::string>(talus::kSolverName.begin(), talus::kSolverName.end())))
      ->capture_default_str();
  replay_verb->add_option("--tolerance", tolerance, "largest contact error [m]")
      ->check([](const std::string& text) { return std::atof(text.c_str()) > 0 ? "" : "must be > 0"; })
      ->capture_default_str();
  replay_verb->footer(
      "Example: talus run model.toml -o out/m --dump-step 100 && talus replay out/m/step_100.json --method "
      "gauss_seidel");

  CLI::App* schema_verb = app.add_subcommand("schema", "print every section and key of the model file");
  schema_verb->add_flag("--json", json, "as JSON Schema, for editors");

  schema_verb->footer("Example: talus schema | less");

  talus::app::VerifyArguments verify;
  CLI::App* verify_verb = app.add_subcommand(
      "verify", "run the verification cases on this machine: computed, exact, error, allowed");
  talus::app::add_verify_arguments(*verify_verb, verify);

  std::string shell;
  CLI::App* completion_verb =
      app.add_subcommand("completion", "print what completes this command in a shell");
  completion_verb->add_option("SHELL", shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion_verb->footer(
      "Example: talus completion bash > ~/.local/share/bash-completion/completions/talus");

  CLI::App* man_verb = app.add_subcommand("man", "print the manual page");
  man_verb->footer("Example: talus man | man -l -");

  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    verbs.push_back(verb->get_name());
  if (argc > 1 && argv[1][0] != '-' && std::find(verbs.begin(), verbs.end(), argv[1]) == verbs.end()) {
    const std::string near = talus::closest_name(argv[1], verbs);
    fmt::print(
        stderr, "talus: unknown verb \"{}\"; {}\n", argv[1],
        near.empty() ? "there is " + talus::join_or(verbs) : fmt::format("did you mean \"{}\"?", near));
    return talus::kExitUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? talus::kExitOk : talus::kExitUsage;
  }
  if (*run_verb && output->count() + from->count() == 0) {
    fmt::print(stderr, "talus: run needs -o FOLDER for the results, or --from STATE to go on\n");
    return talus::kExitUsage;
  }
  if (*run_verb) return run(model, how);
  if (*check_verb) return talus::app::check_command(model, folder, force);
  if (*cut_verb) return talus::app::cut_command(model.file, model.overrides, folder, force);
  if (*new_verb) return talus::app::new_command(start);
  if (*import_verb) return talus::app::import_command(import);
  if (*safety_verb) return talus::app::safety_command(model, folder, force, how.threads);
  if (*replay_verb) return replay(problem, method, tolerance);
  if (*record_verb) return talus::app::record_command(record);
  if (*report_verb) return talus::app::report_command(report);
  if (*audit_verb) return talus::app::audit_command(folder, how.threads);
  if (*plot_verb) return talus::app::plot_command(plot);
  if (*verify_verb) return talus::app::verify_command(verify);
  if (*completion_verb || *man_verb) {
    fmt::print("{}", *man_verb ? talus::app::manual_page(app) : talus::app::completion_script(app, shell));
    return talus::kExitOk;
  }
  fmt::print("{}", json ? talus::schema_json() : talus::schema_markdown());
  return talus::kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  // factorisations allocate and release the same megabyte every step: keep it instead of asking the system
  // anew
  mallopt(M_MMAP_THRESHOLD, 1 << 28);
  mallopt(M_TRIM_THRESHOLD, 1 << 28);
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit shows as a write error with its own message
  try {
    return run_command(argc, argv);
  } catch (const talus::Error& e) {
    fmt::print(stderr, "{}{}\n", e.code() == talus::kExitInput ? "" : "talus: ", e.what());
    return e.code();
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "talus: not enough memory; talus check predicts what a model needs\n");
    return talus::kExitNumerical;
  } catch (const std::exception& e) {
    fmt::print(stderr, "talus: internal error: {}\n", e.what());
    return talus::kExitInternal;
  }
}
