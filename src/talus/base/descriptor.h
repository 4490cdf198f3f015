#pragma once
// Open files of the operating system.

#include <sys/stat.h>

#include <string>
#include <string_view>

namespace talus {

/// A descriptor that is closed when it goes out of use.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor() { done(); }
  operator int() const { return number_; }
  /// Closes now: some file systems tell only then that nothing was kept. 0 or an error number.
  int done();

 private:
  int number_;
};

/// Writes all bytes where the descriptor stands, going on where a signal interrupted. 0 or an error number;
/// `done` is how many bytes were written.
int write_all(int descriptor, std::string_view bytes, size_t& done);

/// "a folder", "a link", "a pipe", "a socket", "a device"; "" for a regular file.
std::string special_kind(mode_t mode);

}  // namespace talus
