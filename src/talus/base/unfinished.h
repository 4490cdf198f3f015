#pragma once
// Files that mean nothing if the process ends now: removed by a signal handler, which may do little else.

#include <string>

namespace talus {

/// Notes a path for remove_unfinished() until the object ends. Does not remove the file itself.
class Unfinished {
 public:
  explicit Unfinished(const std::string& path);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

 private:
  int slot_ = -1;  // -1: all are taken, or the path is too long
};

/// Removes the files noted now. May be called in a signal handler.
void remove_unfinished() noexcept;

}  // namespace talus
