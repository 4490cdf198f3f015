// The `talus` command: argument parsing and nothing else.

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "audit_command.h"
#include "check_command.h"
#include "command_pages.h"
#include "compare_command.h"
#include "cut_command.h"
#include "help.h"
#include "import_command.h"
#include "new_command.h"
#include "plot_command.h"
#include "prepare_model.h"
#include "record_command.h"
#include "replay_command.h"
#include "report_command.h"
#include "run_command.h"
#include "safety_command.h"
#include "signals.h"
#include "study_command.h"
#include "talus/base/memory_reserve.h"
#include "talus/base/text.h"
#include "talus/model/model_schema.h"
#include "talus/study/study.h"
#include "talus/talus.h"
#include "tell.h"
#include "verify_command.h"

namespace {

using talus::app::ModelArguments;

void add_model_arguments(CLI::App& verb, ModelArguments& args) {
  verb.add_option("MODEL", args.file, "model file (TOML)")->required();
  verb.add_option("--set", args.overrides,
                  "override a key, for example --set material.bar.young=\"1 GPa\"; --set new:KEY=VALUE "
                  "where the table is to be made (repeatable)")
      ->allow_extra_args(false);
}

void add_formulation(CLI::App& verb, ModelArguments& args) {
  verb.add_option_function<std::string>(
          "--formulation",
          [&args](const std::string& name) {
            args.overrides.push_back("model.formulation=\"" + name + "\"");
          },
          "contact_forces; for comparison penalty: conventional DDA, or as_printed: the paper's equations; as "
          "model.formulation")
      ->check(CLI::IsMember({"contact_forces", "penalty", "as_printed"}));
}

void add_strict(CLI::App& verb, ModelArguments& args) {
  verb.add_flag("--strict", args.strict, "take warnings of the model for errors");
}

// Ranges are written for numbers: nan is in all of them.
void check_finite(const CLI::App& app) {
  for (const CLI::App* verb : app.get_subcommands())
    for (const CLI::Option* option : verb->get_options()) {
      if (option->get_type_name().rfind("FLOAT", 0) != 0) continue;
      for (const std::string& value : option->results())
        if (!std::isfinite(std::strtod(value.c_str(), nullptr)))
          throw talus::Error(talus::kExitUsage,
                             fmt::format("{}: {} is no number that it could be", option->get_name(), value));
    }
}

int verb_of_line(int argc, char** argv) {
  CLI::App app(
      "talus: blocks that move, slip and break under dynamic load, with contact forces found exactly");
  app.set_version_flag("--version",
                       fmt::format("talus {} (model format {})", talus::kVersion, talus::kModelFormat));
  app.formatter(std::make_shared<talus::app::HelpFormatter>());
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 2 wrong command line, 3 wrong model, 4 file or disk, 5 numerical failure, 6 no balance: a mechanism, 7 no memory "
      "or threads, 8 not valid by its audit, 9 two results differ, 10 some runs of a study did not end, 128 + N ended by signal N (130: Ctrl-C).\nHelp on a verb: talus VERB "
      "--help");

  ModelArguments model;
  talus::app::RunArguments how;
  std::string folder;
  bool force = false, json = false;
  CLI::App* run_verb = app.add_subcommand("run", "run a model and write a folder of results");
  add_model_arguments(*run_verb, model);
  add_formulation(*run_verb, model);
  add_strict(*run_verb, model);
  talus::app::add_run_arguments(*run_verb, how);

  CLI::App* check_verb =
      app.add_subcommand("check", "check a model and predict its steps, memory and output; runs nothing");
  add_model_arguments(*check_verb, model);
  add_formulation(*check_verb, model);
  add_strict(*check_verb, model);
  check_verb->add_option("-o,--output", folder, "folder for a picture of the model, cut.png and cut.svg");
  check_verb->add_flag("--force", force, "replace the picture in that folder");
  bool open = false;
  const char* what_opens =
      "write section.html too, a page to look into the section with, and open it in a browser";
  check_verb->add_flag("--open", open, what_opens);
  check_verb->footer("Example: talus check examples/impact_bar/impact_bar.toml -o out/check");

  CLI::App* cut_verb = app.add_subcommand(
      "cut", "cut regions into blocks: statistics, picture and a blocks file; runs nothing");
  add_model_arguments(*cut_verb, model);
  cut_verb->add_option("-o,--output", folder, "folder for the results")->required();
  cut_verb->add_flag("--force", force, "replace the results in that folder");
  cut_verb->add_flag(
      "--open", open,
      "write section.html too, a page to look into the section with, and open it in a browser");
  cut_verb->footer("Example: talus cut examples/tunnel/tunnel.toml -o out/tunnel --open");

  talus::app::CompareArguments compare;
  CLI::App* compare_verb = app.add_subcommand(
      "compare",
      "how far two results are apart: histories, joints and the ledger, as a table and an exit code");
  talus::app::add_compare_arguments(*compare_verb, compare);

  talus::app::ImportArguments import;
  CLI::App* import_verb = app.add_subcommand(
      "import", "sections of a model file from a drawing or map (DXF, shapefile, GeoPackage, GeoJSON)");
  talus::app::add_import_arguments(*import_verb, import);

  CLI::App* safety_verb = app.add_subcommand(
      "safety",
      "seek what a model just bears: the factor of safety of its joints, or a load, tilt or acceleration raised until it fails");
  add_model_arguments(*safety_verb, model);
  add_strict(*safety_verb, model);
  talus::app::SafetyArguments safety;
  safety_verb->add_option("-o,--output", safety.folder, "folder for the results")->required();
  safety_verb->add_flag("--force", safety.force, "replace the results in that folder");
  safety_verb->add_flag("--resume", safety.resume, "go on with a search in that folder that was broken off");
  safety_verb->add_option("--threads", safety.threads, "threads inside a step, 0: as many as pay")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  safety_verb
      ->add_option("--jobs", safety.jobs,
                   "trials side by side where the interval is halved; the ladder goes rung by rung")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  safety_verb->footer("Example: talus safety examples/toppling/toppling.toml -o out/toppling");

  talus::app::StudyArguments study;
  CLI::App* study_verb =
      app.add_subcommand("study", "run a model many times, with keys that vary: tables, fragility, one page");
  talus::app::add_study_arguments(*study_verb, study);

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

  talus::app::ReplayArguments problem;
  CLI::App* replay_verb = app.add_subcommand(
      "replay", "solve the contact equations of one step again, with any solver, or by the choice of a run");
  talus::app::add_replay_arguments(*replay_verb, problem);

  CLI::App* schema_verb = app.add_subcommand("schema", "print every section and key of the model file");
  bool of_studies = false;
  schema_verb->add_flag("--json", json, "as JSON Schema, for editors");
  schema_verb->add_flag("--study", of_studies, "of the study file");

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
    talus::app::tell(
        "talus: unknown verb \"{}\"; {}\n", argv[1],
        near.empty() ? "there is " + talus::join_or(verbs) : fmt::format("did you mean \"{}\"?", near));
    return talus::kExitUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? talus::kExitOk : talus::kExitUsage;
  }
  check_finite(app);
  if (*run_verb) return talus::app::run_command(model, how);
  if (*check_verb) return talus::app::check_command(model, folder, force, open);
  if (*compare_verb) return talus::app::compare_command(compare);
  if (*cut_verb) return talus::app::cut_command(model.file, model.overrides, folder, force, open);
  if (*new_verb) return talus::app::new_command(start);
  if (*import_verb) return talus::app::import_command(import);
  if (*safety_verb) return talus::app::safety_command(model, safety);
  if (*study_verb) return talus::app::study_command(study);
  if (*replay_verb) return talus::app::replay_command(problem);
  if (*record_verb) return talus::app::record_command(record);
  if (*report_verb) return talus::app::report_command(report);
  if (*audit_verb) return talus::app::audit_command(folder, how.threads);
  if (*plot_verb) return talus::app::plot_command(plot);
  if (*verify_verb) return talus::app::verify_command(verify);
  if (*completion_verb || *man_verb) {
    fmt::print("{}", *man_verb ? talus::app::manual_page(app) : talus::app::completion_script(app, shell));
    return talus::kExitOk;
  }
  fmt::print("{}", of_studies ? talus::study::study_markdown()
                   : json     ? talus::model_json()
                              : talus::model_markdown());
  return talus::kExitOk;
}

// Descriptors 0 to 2 are there: else the first files that are opened would be taken for them, and progress
// would be written into a table of results. What was closed stays of no use: to read from an output, to write
// to an input.
void open_standard_descriptors() {
  for (const int number : {0, 1, 2}) {
    if (fcntl(number, F_GETFD) != -1 || errno != EBADF) continue;
    if (open("/dev/null", number == 0 ? O_WRONLY : O_RDONLY) != number) _exit(talus::kExitFile);
  }
}

// Why standard output failed, when printing told; 0: it did not.
int output_error = 0;

// What was printed has arrived; else says why not. A code that tells of something worse stays.
int with_output_checked(int code) {
  if (std::fflush(stdout) != 0 && output_error == 0) output_error = errno;
  if (std::ferror(stdout) == 0 && output_error == 0) return code;
  std::fprintf(stderr, "talus: standard output cannot be written%s%s\n", output_error != 0 ? ": " : "",
               output_error != 0 ? std::strerror(output_error) : "");
  return code == talus::kExitOk ? talus::kExitFile : code;
}

int code_of(int argc, char** argv) {
  try {
    return verb_of_line(argc, argv);
  } catch (const talus::Error& e) {
    talus::app::tell("{}{}\n", e.code() == talus::kExitInput ? "" : "talus: ", e.what());
    return e.code();
  } catch (const std::bad_alloc&) {
    talus::app::tell("talus: not enough memory; talus check predicts what a model needs\n");
    return talus::kExitResources;
  } catch (const std::length_error&) {
    talus::app::tell("talus: not enough memory: something would be larger than memory can be\n");
    return talus::kExitResources;
  } catch (const std::filesystem::filesystem_error& e) {
    talus::app::tell("talus: {}: {}\n", e.path1().string(), e.code().message());
    return talus::kExitFile;
  } catch (const std::system_error& e) {
    if (std::ferror(stdout)) {
      output_error = e.code().value();
      return talus::kExitOk;  // with_output_checked() judges it
    }
    if (e.code() != std::errc::resource_unavailable_try_again) throw;
    talus::app::tell(
        "talus: no more threads can be started: {}. Give --threads 1, or raise the limit of "
        "processes (ulimit -u)\n",
        e.code().message());
    return talus::kExitResources;
  }
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_descriptors();
  // factorisations allocate and release the same megabyte every step: keep it instead of asking the system
  // anew
  mallopt(M_MMAP_THRESHOLD, 1 << 28);
  mallopt(M_TRIM_THRESHOLD, 1 << 28);
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit shows as a write error with its own message
  talus::app::end_on_signals();
  try {
    constexpr size_t kReserve = size_t{16} << 20;  // [bytes]
    talus::keep_memory_reserve(kReserve);
    return with_output_checked(code_of(argc, argv));
  } catch (const std::bad_alloc&) {
    std::fputs("talus: not enough memory\n", stderr);
    return talus::kExitResources;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "talus: internal error: %s\n", e.what());
    return talus::kExitInternal;
  }
}
