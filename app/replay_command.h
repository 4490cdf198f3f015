#pragma once
// `talus replay`: the contact equations of one step again.

#include <CLI/CLI.hpp>
#include <string>

namespace talus::app {

struct ReplayArguments {
  std::string file, method = "newton";
  double tolerance = 1e-9;  // [m]
};

void add_replay_arguments(CLI::App& verb, ReplayArguments& args);
int replay_command(const ReplayArguments& args);

}  // namespace talus::app
