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

int write_all(int descriptor, std::string_view bytes, size_t& done) {
  for (done = 0; done < bytes.size();) {
    const ssize_t n = write(descriptor, bytes.data() + done, bytes.size() - done);
    if (n > 0)
      done += n;
    else if (n == 0)
      return EIO;
    else if (errno != EINTR)
      return errno;
  }
  return 0;
}

std::string special_kind(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISLNK(mode)) return "a link";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return S_ISREG(mode) ? "" : "a device";
}

}  // namespace talus
