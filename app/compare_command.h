#pragma once
// `talus compare`: how far two results are apart.

#include <CLI/CLI.hpp>
#include <string>

namespace talus::app {

struct CompareArguments {
  std::string a, b;
  double rtol = -1, atol = -1;  // < 0: not given
};

void add_compare_arguments(CLI::App& verb, CompareArguments& args);
/// Prints the table. Returns kExitOk, or kExitDiffers where a tolerance was given and something is beyond it. Throws
/// FileError.
int compare_command(const CompareArguments& args);

}  // namespace talus::app
