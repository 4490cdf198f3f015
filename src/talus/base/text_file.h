#pragma once
// Reading a whole file as text.

#include <cstddef>
#include <filesystem>
#include <string>

namespace talus {

/// Largest file that is read as text [bytes].
inline constexpr size_t kMostText = size_t{4} << 30;
/// Largest list of results [bytes].
inline constexpr size_t kMostResultList = size_t{256} << 20;

/// Whether there is something at the path. Throws FileError when that cannot be seen, as in a folder that may not
/// be read.
bool is_there(const std::filesystem::path& path);

/// Reads a whole regular file. Throws FileError naming the path and the cause: there is none, it is a folder,
/// a pipe or a device (which may have no end), or longer than `most` bytes.
std::string read_text_file(const std::filesystem::path& path, size_t most = kMostText);

/// text_hash() of a whole regular file, of any size. Throws FileError as read_text_file().
std::string file_hash(const std::filesystem::path& path);

}  // namespace talus
