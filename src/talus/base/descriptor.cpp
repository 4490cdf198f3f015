#include "talus/base/descriptor.h"

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace talus {

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

int Descriptor::done() {
  if (number_ < 0) return 0;
  const int number = std::exchange(number_, -1);
  return close(number) == 0 ? 0 : errno;
}

std::string special_kind(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISLNK(mode)) return "a link";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return S_ISREG(mode) ? "" : "a device";
}

}  // namespace talus
