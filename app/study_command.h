#pragma once
// `talus study`: one model many times, with keys that vary.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace talus::app {

struct StudyArguments {
  std::string file, folder;  // of the study; of its results
  int jobs = 0;              // 0: as many as there are processors
  std::string on;            // "": here; "slurm"
  std::string sbatch;        // options passed on
  bool dry = false, plan = false, quiet = false;
  int first = 0, count = 1;  // of task
  CLI::App *task = nullptr, *gather = nullptr;
};

void add_study_arguments(CLI::App& verb, StudyArguments& args);

/// Throws InputError, FileError; returns the exit code.
int study_command(const StudyArguments& args);

bool is_study_folder(const std::string& folder);
/// Makes the reports of its runs that have none, and its table and page anew, whose rows open them. Returns as study gather.
int report_of_study(const std::string& folder, const std::function<void(const std::string& run)>& make);

}  // namespace talus::app
