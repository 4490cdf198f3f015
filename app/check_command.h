#pragma once
// `talus check`: what a model is and what running it will cost.

#include <string>

#include "prepare_model.h"

namespace talus::app {

/// Prints blocks, steps, time, memory and output of the model; with a folder, draws it there, and with
/// `open` writes and opens the page of the section. Returns the exit code. Throws InputError, FileError.
int check_command(const ModelArguments& args, const std::string& folder, bool force, bool open);

}  // namespace talus::app
