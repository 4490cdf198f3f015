#pragma once
// Reads the sections that the cutter works from: regions, arches, openings, joint sets, faults, masonry,
// tessellations and [cut].

#include <set>
#include <string>

#include "talus/model/model.h"
#include "talus/schema/toml_source.h"

namespace talus {

/// Appends to `model` what the file gives. Materials and joints must have been read.
/// @param block_names  names already used by blocks and grids; grows
void read_cut_sections(const TomlSource& source, std::set<std::string>& block_names, Model& model,
                       Findings& findings);

}  // namespace talus
