#pragma once
// [penalty], and what cannot be computed by penalty springs.

#include "talus/model/model.h"
#include "talus/schema/toml_source.h"

namespace talus {

/// @pre  all other sections of `model` have been read
void read_penalty_section(const TomlSource& source, Model& model, Findings& findings);

}  // namespace talus
