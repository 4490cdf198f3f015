#include "talus/base/json_depth.h"

#include <fmt/format.h>

#include <array>

#include "talus/base/error.h"

namespace talus {

const std::string& checked_json(const std::string& name, const std::string& text) {
  int depth = 0;
  bool quoted = false;
  std::array<size_t, kMostJsonDepth + 1> keys{};
  size_t looks = 0;  // a reader that keeps keys in their order looks through all before it adds one
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
      if (depth > 0) keys[depth] = 0;
    } else if (c == ':' && depth > 0) {
      looks += keys[depth]++;
      if (looks > kMostJsonLooks)
        throw FileError(fmt::format("{}: has more keys in one object than are read", name));
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return text;
}

}  // namespace talus
