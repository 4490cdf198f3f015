#pragma once
// Sections that nothing in the file names: almost surely a name mistyped elsewhere.

#include "talus/model/model.h"
#include "talus/schema/findings.h"
#include "talus/schema/toml_source.h"

namespace talus {

/// Warns of every [material.NAME], [joint.NAME], [history.NAME] and [bolt_type.NAME] whose name no text of
/// the file and no group of a mesh is.
void check_names_used(const TomlSource& source, const Model& model, Findings& findings);

}  // namespace talus
