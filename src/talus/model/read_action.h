#pragma once
// The sections that hold, bound and push blocks: [[support]], [[boundary]], [[load]].

#include "talus/model/model.h"
#include "talus/schema/toml_source.h"

namespace talus {

/// @pre  histories and materials of `model` have been read
void read_action_sections(const TomlSource& source, Model& model, Findings& findings);

}  // namespace talus
