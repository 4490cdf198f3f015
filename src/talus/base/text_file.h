#pragma once
// Reading a whole file as text.

#include <filesystem>
#include <string>

namespace talus {

/// Reads a whole text file. Throws FileError naming the path and the cause.
std::string read_text_file(const std::filesystem::path& path);

}  // namespace talus
