#pragma once
// `talus import`: sections of a model file from a drawing or map.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace talus::app {

struct ImportArguments {
  std::string file, attribute, unit = "auto", output, picture, snap = "0 m", shortest = "0 m",
                               curve_step = "10 deg";
  std::vector<std::string> uses;
  std::vector<double> origin;
};

void add_import_arguments(CLI::App& verb, ImportArguments& args);
int import_command(const ImportArguments& args);

}  // namespace talus::app
