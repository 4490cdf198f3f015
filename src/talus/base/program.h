#pragma once
// Where the running program lies: its data, modules and tests are found from there, in a build as when
// installed.

#include <filesystem>

namespace talus {

/// Folder of the program; empty where the system does not tell.
inline std::filesystem::path program_folder() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
}

}  // namespace talus
