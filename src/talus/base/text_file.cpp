#include "talus/base/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "talus/base/descriptor.h"
#include "talus/base/error.h"

namespace talus {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
  throw FileError(fmt::format("{}: {}", path.string(), why));
}

}  // namespace

bool is_there(const std::filesystem::path& path) {
  std::error_code ec;
  const bool there = std::filesystem::exists(path, ec);
  if (ec) refuse(path, fmt::format("cannot be read: {}", ec.message()));
  return there;
}

std::string read_text_file(const std::filesystem::path& path, size_t most) {
  // a pipe would be waited for
  const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (file < 0) refuse(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  struct stat there {};
  if (fstat(file, &there) != 0) refuse(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  if (const std::string kind = special_kind(there.st_mode); !kind.empty())
    refuse(path, fmt::format("is {}, not a file", kind));
  std::string text;
  text.reserve(std::min(static_cast<size_t>(there.st_size), most));
  // up to its end, wherever that is: some grow meanwhile, and those of /proc say that they have no size
  for (std::string part(1 << 16, '\0');;) {
    const ssize_t n = read(file, part.data(), part.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse(path, fmt::format("cannot be read: {}", std::strerror(errno)));
    if (n == 0) return text;
    text.append(part, 0, static_cast<size_t>(n));
    if (text.size() > most)
      refuse(path, fmt::format("is longer than {} MiB, the most that is read", most >> 20));
  }
}

}  // namespace talus
