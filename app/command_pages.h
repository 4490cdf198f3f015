#pragma once
// The command line described for shells and for man, made from its own definition so that they never differ.

#include <CLI/CLI.hpp>
#include <string>

namespace talus::app {

/// Script that completes verbs, options and file names. @param shell  bash, zsh or fish
std::string completion_script(const CLI::App& app, const std::string& shell);

/// The manual page talus(1), in roff.
std::string manual_page(const CLI::App& app);

}  // namespace talus::app
