#pragma once
// Work that may end the process, such as a library's on a file from anywhere, in a process of its own.

#include <cstddef>
#include <functional>
#include <string>

namespace talus {

struct ChildLimits {
  int seconds = 300;                // of time, on the clock and of the processor
  size_t memory = size_t{4} << 30;  // [bytes], beside what this process has
};

/// The bytes that `work` gives, done in a copy of this process. `work` must not throw, change anything outside,
/// or wait for other threads. Throws FileError when the copy ends in any other way: "WHAT: reading it ...".
/// @pre  this process has no other thread: what one has locked stays locked in the copy for ever
std::string work_in_child(const std::string& what, const std::function<std::string()>& work,
                          const ChildLimits& limits = {});

}  // namespace talus
