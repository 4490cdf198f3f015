#pragma once
// Other programs, whose output goes into a file.

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Starts a program: by its path, or by its name where PATH finds it. What it says, also of errors, goes into `log`.
/// Throws FileError when it cannot be started.
pid_t spawn(const std::vector<std::string>& words, const std::filesystem::path& log);

}  // namespace talus
