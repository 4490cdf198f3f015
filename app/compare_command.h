#pragma once
// `talus compare`: how far two results are apart.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace talus::app {

struct CompareArguments {
  std::string a, b;
  std::vector<std::string> rtol, atol;  // NUMBER or QUANTITY=NUMBER
  bool other_model = false;
};

void add_compare_arguments(CLI::App& verb, CompareArguments& args);
/// Prints the table. Returns kExitOk, or kExitDiffers: a tolerance was given and something is beyond it, or a side is not whole,
/// failed or not valid, or has what the other has not. Throws FileError where there is no folder.
int compare_command(const CompareArguments& args);

}  // namespace talus::app
