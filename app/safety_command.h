#pragma once
// `talus safety`: what a model just bears.

#include <string>

#include "prepare_model.h"

namespace talus::app {

struct SafetyArguments {
  std::string folder;
  bool force = false, resume = false;
  int threads = 0, jobs = 1;
};

/// Throws InputError, FileError, NumericalError; returns the exit code.
int safety_command(const ModelArguments& args, const SafetyArguments& how);

}  // namespace talus::app
