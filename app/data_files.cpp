#include "data_files.h"

namespace talus::app {

std::filesystem::path data_file(const std::string& name) {
  std::error_code ec;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", ec).parent_path();
  return (program / "../share/talus" / name).lexically_normal();
}

}  // namespace talus::app
