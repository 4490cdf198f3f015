#pragma once
// `talus run`: a model, or the rest of one, to a folder of results.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "prepare_model.h"

namespace talus::app {

struct RunArguments {
  std::string folder, from;
  std::string until;  // name of the last stage, "": all
  bool force = false, quiet = false, profile = false, watch = false;
  int64_t dump_step = -1;
  int threads = 0;  // 0: as many as pay
};

void add_run_arguments(CLI::App& verb, RunArguments& args);
int run_command(const ModelArguments& model, const RunArguments& args);

}  // namespace talus::app
