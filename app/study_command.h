#pragma once
// `talus study`: one model many times, with keys that vary.

#include <CLI/CLI.hpp>
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

}  // namespace talus::app
