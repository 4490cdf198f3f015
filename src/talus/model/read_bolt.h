#pragma once
// The sections of rock bolts: [bolt_type.NAME], [[bolt]], [[bolt_pattern]].

#include "talus/model/model.h"
#include "talus/schema/toml_source.h"

namespace talus {

/// @pre  openings and stages of `model` have been read
void read_bolt_sections(const TomlSource& source, Model& model, Findings& findings);

}  // namespace talus
