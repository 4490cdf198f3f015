#pragma once
// Other programs, whose output goes into a file.

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Whether a program is killed when this process ends in any way, or outlives it.
enum class Life { kOwn, kOfParent };

/// Starts a program: by its path, or by its name where PATH finds it. What it says, also of errors, goes into `log`.
/// Throws FileError when it cannot be started.
/// @param life  kOfParent: of the thread that calls, which has to stay
pid_t spawn(const std::vector<std::string>& words, const std::filesystem::path& log, Life life = Life::kOwn);

/// Path of the program that this process runs. Throws FileError.
std::string own_program();

}  // namespace talus
