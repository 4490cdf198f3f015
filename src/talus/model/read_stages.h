#pragma once
// The sections that say what happens when: [in_situ], [[stage]], [[change]].

#include "talus/model/model.h"
#include "talus/schema/toml_source.h"

namespace talus {

/// @pre  materials, joints and masonry of `model` have been read
void read_stage_sections(const TomlSource& source, Model& model, Findings& findings);

}  // namespace talus
