#pragma once
// Reads vector files by a module of its own (libtalus_vector, built where GDAL is installed), loaded when it
// is first asked for: talus itself is built and runs without it.

#include <filesystem>
#include <string>

#include "talus/maps/drawing.h"

namespace talus::maps {

/// What the module offers, found by its name. Program and module are built together: the first three tell.
struct VectorModule {
  const char* version;                // kVersion of the build
  size_t drawing_size, feature_size;  // of the structs that it fills
  /// Reads `path`; on failure returns false with the reason in `error`.
  /// @param curve_step  [rad] of arcs between two points
  bool (*read)(const std::string& path, double curve_step, Drawing& drawing, std::string& error);
};

/// Reads the lines and points of a DXF, shapefile, GeoPackage or GeoJSON, in a process of its own with limits of
/// time and memory (ChildLimits): what crashes there is told.
/// @param curve_step  [rad] of arcs between two points
/// @throws FileError   the file cannot be opened or crashes the reader, or the module is not there (with what to
///                     install)
/// @throws InputError  the file is damaged or of another format
Drawing read_drawing(const std::filesystem::path& path, double curve_step);

}  // namespace talus::maps
