#include "talus/base/json_depth.h"

#include <fmt/format.h>

#include "talus/base/error.h"

namespace talus {

const std::string& checked_json(const std::string& name, const std::string& text) {
  int depth = 0;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMostJsonDepth)
        throw FileError(fmt::format("{}: is nested more than {} deep", name, kMostJsonDepth));
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return text;
}

}  // namespace talus
