#pragma once
// Files that tests put down, and what is said where one cannot be used.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

#include "talus/base/error.h"

namespace talus::test {

inline void put(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// Entries of a folder, without those of folders in it.
inline auto count_in(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
}

/// Text of the FileError that `action` must throw.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError& e) {
    CHECK(e.code() == kExitFile);
    return e.what();
  }
  FAIL("no FileError");
  return "";
}

inline bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace talus::test
