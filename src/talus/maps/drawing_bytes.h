#pragma once
// A drawing as bytes, to be handed from one process to another on the same machine.

#include <string>

#include "talus/maps/drawing.h"

namespace talus::maps {

std::string bytes_of(const Drawing& drawing);

/// Throws std::runtime_error when the bytes are no drawing.
Drawing drawing_of(const std::string& bytes);

}  // namespace talus::maps
