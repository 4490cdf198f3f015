#pragma once
// `talus safety`: factor of safety of a model by reduction of joint strength.

#include <string>

#include "prepare_model.h"

namespace talus::app {

/// Runs the trials, prints each, writes safety.csv, safety.json and model.toml. Returns the exit code.
int safety_command(const ModelArguments& args, const std::string& folder, bool force, int threads);

}  // namespace talus::app
