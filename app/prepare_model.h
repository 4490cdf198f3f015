#pragma once
// The model of `talus run`, `check` and `safety`, read and warned of alike.

#include <string>
#include <vector>

#include "talus/talus.h"

namespace talus::app {

struct ModelArguments {
  std::string file;
  std::vector<std::string> overrides;  // KEY=VALUE
  bool strict = false;                 // warnings are errors
};

struct ModelRun {
  Findings findings;
  PreparedRun run;
};

/// Reads, cuts and checks the model; its warnings go to stderr. `cut`, when given, takes the cut of its
/// regions. Throws InputError, FileError.
ModelRun prepare_model(const ModelArguments& args, Cut* cut = nullptr);

}  // namespace talus::app
