#pragma once
// `talus safety`: factor of safety of a model by reduction of joint strength.

#include <string>
#include <vector>

namespace talus::app {

/// Runs the trials, prints each, writes safety.csv, safety.json and model.toml. Returns the exit code.
int safety_command(const std::string& file, const std::vector<std::string>& overrides,
                   const std::string& folder, bool force, int threads, bool strict);

}  // namespace talus::app
