#include "talus/output/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "talus/base/descriptor.h"
#include "talus/base/error.h"
#include "talus/base/unfinished.h"

namespace talus {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kUnfinishedBegin = ".talus-", kUnfinishedEnd = ".part";

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// A file of a name that no other has, whatever the process or the thread.
std::pair<int, fs::path> open_unfinished(const fs::path& folder) {
  static std::atomic<unsigned> count{0};
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    const fs::path path =
        folder / fmt::format("{}{}-{}{}", kUnfinishedBegin, getpid(), count++, kUnfinishedEnd);
    const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0 || errno != EEXIST) return {file, path};
  }
  return {-1, {}};
}

// 0 or an error number.
int fill(int number, std::string_view content, const struct stat* older, Reach reach) {
  Descriptor file(number);
  size_t done = 0;
  if (const int error = write_all(file, content, done); error != 0) return error;
  if (older && fchmod(file, older->st_mode & 07777) != 0) return errno;
  if (reach == Reach::kDisk && fsync(file) != 0) return errno;
  return file.done();
}

}  // namespace

void fail_file(const fs::path& path, const std::string& doing, int error) {
  const std::string cause = error != 0 ? std::strerror(error) : "unknown cause";
  const bool full = error == ENOSPC || error == EDQUOT;
  throw FileError(fmt::format("{}: cannot be {}: {}{}", path.string(), doing, cause,
                              full ? "; free some space and run again" : ""));
}

std::string unfit_target(const fs::path& path) {
  struct stat there {};
  return lstat(path.c_str(), &there) == 0 ? special_kind(there.st_mode) : "";
}

void check_continued(const fs::path& path, int64_t size) {
  struct stat there {};
  if (lstat(path.c_str(), &there) != 0) fail_file(path, "continued", errno);
  if (const std::string kind = special_kind(there.st_mode); !kind.empty())
    throw FileError(
        fmt::format("{}: is {}: going on would write into what is behind it", path.string(), kind));
  if (access(path.c_str(), W_OK) != 0) fail_file(path, "continued", errno);
  if (there.st_nlink > 1)
    throw FileError(fmt::format(
        "{}: is the same file under {} names (hard links): going on would change all. Copy it first",
        path.string(), there.st_nlink));
  if (size < 0 || there.st_size < size)
    throw FileError(
        fmt::format("{}: has {} bytes, and had {} when the state was saved: it cannot be continued",
                    path.string(), there.st_size, size));
  const Descriptor file(open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
  char last = '\n';
  if (file < 0 || (size > 0 && pread(file, &last, 1, size - 1) != 1)) fail_file(path, "read", errno);
  if (last != '\n')
    throw FileError(
        fmt::format("{}: has no row that ends at its byte {}, where one ended when the state was saved: it "
                    "cannot be continued",
                    path.string(), size));
}

void check_written(const fs::path& path, int64_t size, const struct stat* ours) {
  struct stat there {};
  const auto lost = [&path](const std::string& what) {
    throw FileError(fmt::format("{}: {} while results were written beside it", path.string(), what));
  };
  if (lstat(path.c_str(), &there) != 0) lost("has been removed");
  if (ours && (there.st_ino != ours->st_ino || there.st_dev != ours->st_dev))
    lost("has been replaced by another file");
  if (there.st_size != size)
    lost(fmt::format("has {} bytes, {} were written: it was changed", there.st_size, size));
}

void write_file(const fs::path& path, std::string_view content, Reach reach) {
  struct stat there {};
  const bool older = lstat(path.c_str(), &there) == 0;
  if (const std::string kind = older ? special_kind(there.st_mode) : ""; !kind.empty())
    throw FileError(
        fmt::format("{}: is {}; only a regular file is replaced, so nothing was written. Give another name",
                    path.string(), kind));
  const auto [file, part] = open_unfinished(folder_of(path));
  if (file < 0) fail_file(path, "written", errno);
  const Unfinished noted(part.string());
  if (const int error = fill(file, content, older ? &there : nullptr, reach); error != 0) {
    unlink(part.c_str());
    fail_file(path, "written", error);
  }
  if (rename(part.c_str(), path.c_str()) != 0) {
    const int error = errno;
    unlink(part.c_str());
    fail_file(path, "renamed into place", error);
  }
  if (reach == Reach::kDisk) sync_folder(folder_of(path));
}

void sync_folder(const fs::path& folder) {
  const Descriptor file(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // some network file systems cannot, and need not
  if (file < 0 || (fsync(file) != 0 && errno != EINVAL)) fail_file(folder, "brought to the disk", errno);
}

void sync_files_of(const fs::path& folder) {
  const Descriptor file(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (file < 0 || syncfs(file) != 0) fail_file(folder, "brought to the disk", errno);
}

bool is_being_written(const fs::path& unfinished) {
  const std::string name = unfinished.filename().string();
  const char* number = name.c_str() + kUnfinishedBegin.size();
  long process = 0;
  std::from_chars(number, name.c_str() + name.size(), process);
  return process > 0 && (kill(static_cast<pid_t>(process), 0) == 0 || errno == EPERM);
}

bool is_unfinished_file(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.size() > kUnfinishedBegin.size() + kUnfinishedEnd.size() &&
         name.compare(0, kUnfinishedBegin.size(), kUnfinishedBegin) == 0 &&
         name.compare(name.size() - kUnfinishedEnd.size(), std::string::npos, kUnfinishedEnd) == 0;
}

}  // namespace talus
