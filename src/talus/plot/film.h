#pragma once
// A film of pictures by ffmpeg, where the machine has it. Not for use outside plot/.

#include <filesystem>
#include <string>
#include <vector>

namespace talus::plot {

/// Throws FileError when there is no ffmpeg or it fails, with what it said.
/// @param frames   bytes of PNG files of one size
/// @param seconds  that each is shown
void write_film(const std::vector<std::string>& frames, double seconds, const std::filesystem::path& path);

}  // namespace talus::plot
