#include "talus/base/memory.h"

#include <fstream>
#include <limits>
#include <string>

namespace talus {

double available_memory() {
  std::ifstream in("/proc/meminfo");
  for (std::string line; std::getline(in, line);) {
    const std::string key = "MemAvailable:";
    if (line.compare(0, key.size(), key) == 0) return 1024 * std::stod(line.substr(key.size()));
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace talus
