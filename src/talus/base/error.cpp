#include "talus/base/error.h"

namespace talus {

void fail_assertion(const char* condition, const char* file, int line) {
  throw std::logic_error(std::string(condition) + " does not hold at " + file + ":" + std::to_string(line));
}

}  // namespace talus
