#pragma once
// Reads a model file into plain structs. What needs no geometry of the cut blocks is checked here.

#include <filesystem>
#include <string>
#include <vector>

#include "talus/model/model.h"
#include "talus/schema/findings.h"

namespace talus {

/// Reads a model from `text`. Everything wrong goes to `findings`; the model is usable only without errors.
/// @param file       name for messages
/// @param overrides  "path=value" each, as with --set
Model read_model(const std::string& file, const std::string& text, const std::vector<std::string>& overrides,
                 Findings& findings);

}  // namespace talus
