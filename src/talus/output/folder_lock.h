#pragma once
// One writer per folder.

#include <filesystem>
#include <string>

#include "talus/base/descriptor.h"
#include "talus/base/unfinished.h"

namespace talus {

/// While it exists, no other process takes the folder. The lock is a file in it, with process and host; the
/// system lets go of it when the process ends, in whatever way, so that one left behind is known as such.
class FolderLock {
 public:
  static constexpr const char* kName = "talus_lock.txt";

  /// Throws FileError naming process and host when the folder is in use, or may be (by a process of another
  /// host, on a file system that cannot tell).
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  /// Removes the file.
  ~FolderLock();

  /// What a process that has ended without removing its lock left in it, "" when there was none.
  const std::string& stale() const { return stale_; }

  /// Whether the folder still leads to the lock: false when somebody has removed or moved it.
  bool is_ours() const;

  /// Gives back the room on the disk that the file keeps, for a last word when the disk is full.
  void free_reserve();

 private:
  std::filesystem::path path_;
  Descriptor file_;
  Unfinished noted_;
  size_t size_ = 0;  // of its text
  std::string stale_;
};

/// Throws FileError: the folder is in use by `user`.
[[noreturn]] void fail_in_use(const std::filesystem::path& folder, const std::string& user);

/// Name of this machine.
std::string this_host();

/// Who writes into the folder now: "process 123 on host"; "" when nobody does.
std::string user_of_folder(const std::filesystem::path& folder);

}  // namespace talus
