#pragma once
// Reads [maps] and every [[map]] of a model file.

#include <string>
#include <vector>

#include "talus/model/map_input.h"
#include "talus/schema/findings.h"
#include "talus/schema/toml_source.h"

namespace talus {

/// Whether the file has a [[map]] or [maps].
bool has_maps(const TomlSource& source);

/// What the file asks of maps; everything wrong goes to `findings`.
MapsInput read_maps(const TomlSource& source, Findings& findings);

}  // namespace talus
