#include "data_files.h"

#include "talus/base/program.h"

namespace talus::app {

std::filesystem::path data_file(const std::string& name) {
  return (program_folder() / "../share/talus" / name).lexically_normal();
}

}  // namespace talus::app
