#include "talus/base/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "talus/base/descriptor.h"
#include "talus/base/error.h"
#include "talus/base/text.h"

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

namespace {

// Up to its end, wherever that is: some grow meanwhile, and those of /proc say that they have no size.
template <class Take>
void read_parts(const std::filesystem::path& path, const Take& take) {
  // a pipe would be waited for
  const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (file < 0) refuse(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  struct stat there {};
  if (fstat(file, &there) != 0) refuse(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  if (const std::string kind = special_kind(there.st_mode); !kind.empty())
    refuse(path, fmt::format("is {}, not a file", kind));
  for (std::string part(1 << 16, '\0');;) {
    const ssize_t n = read(file, part.data(), part.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse(path, fmt::format("cannot be read: {}", std::strerror(errno)));
    if (n == 0) return;
    take(std::string_view(part).substr(0, n));
  }
}

}  // namespace

std::string read_text_file(const std::filesystem::path& path, size_t most) {
  std::string text;
  std::error_code ec;
  if (const auto size = std::filesystem::file_size(path, ec); !ec)
    text.reserve(std::min(static_cast<size_t>(size), most));
  read_parts(path, [&](std::string_view part) {
    text += part;
    if (text.size() > most)
      refuse(path, fmt::format("is longer than {} MiB, the most that is read", most >> 20));
  });
  return text;
}

std::string file_hash(const std::filesystem::path& path) {
  TextHash hash;
  read_parts(path, [&hash](std::string_view part) { hash.add(part); });
  return hash.text();
}

}  // namespace talus
