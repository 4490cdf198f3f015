#pragma once
// Files that cases read: examples, meshes. Where the cases are installed they lie in share/talus, as in the sources.

#include <filesystem>
#include <string>

#include "talus/base/program.h"

namespace talus::test {

/// @param name  from the root of the sources, "examples/arch/arch.toml"
inline std::string source_file(const std::string& name) {
  const auto installed = (program_folder() / "../../share/talus" / name).lexically_normal();
  std::error_code ignored;
  return std::filesystem::exists(installed, ignored) ? installed.string() : TALUS_SOURCE_DIR "/" + name;
}

}  // namespace talus::test
