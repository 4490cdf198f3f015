#pragma once
// `talus verify`: the verification cases on this machine, and what each reached.

#include <CLI/CLI.hpp>
#include <string>

namespace talus::app {

struct VerifyArguments {
  std::string cases;
  std::string formulation;  // of a further column, "" none
  bool markdown = false;
};

void add_verify_arguments(CLI::App& verb, VerifyArguments& args);
/// Exit code 0 when every case passed, 1 when one did not; another formulation may miss.
int verify_command(const VerifyArguments& args);

}  // namespace talus::app
