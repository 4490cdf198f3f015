#pragma once
// Picture of maps before and after their lines were cleaned, with a mark where anything was changed.

#include <filesystem>

#include "talus/maps/sections.h"

namespace talus::plot {

/// Draws joints and faults as they were drawn at the left, as they were cleaned at the right, both in true
/// proportion, and writes `stem` + ".svg" and ".png". Marks and their counts stand below. Throws
/// std::runtime_error when a file cannot be drawn, FileError when it cannot be written.
void write_map_picture(const maps::MapReport& report, const std::filesystem::path& stem);

}  // namespace talus::plot
