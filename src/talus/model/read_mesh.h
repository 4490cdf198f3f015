#pragma once
// Reads every [[mesh]]: meshes of Gmsh taken as blocks.

#include <set>
#include <string>

#include "talus/model/model.h"
#include "talus/schema/toml_source.h"

namespace talus {

/// Appends to `model` what the file gives. Materials and joints must have been read.
/// @param block_names  names already used by blocks and grids; grows by those of the meshes and their groups
/// @return the content of the mesh files, which belongs to the hash of the model
std::string read_mesh_sections(const TomlSource& source, std::set<std::string>& block_names, Model& model,
                               Findings& findings);

}  // namespace talus
