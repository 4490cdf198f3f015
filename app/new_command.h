#pragma once
// `talus new`: a small commented model to begin with.

#include <CLI/CLI.hpp>
#include <string>

namespace talus::app {

struct NewArguments {
  std::string name, from = "slope";
  bool force = false;
};

void add_new_arguments(CLI::App& verb, NewArguments& args);
int new_command(const NewArguments& args);

}  // namespace talus::app
