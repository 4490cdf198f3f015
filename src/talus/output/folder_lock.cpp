#include "talus/output/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <thread>

#include "talus/base/error.h"
#include "talus/base/text_file.h"
#include "talus/output/files.h"

namespace talus {

namespace fs = std::filesystem;

namespace {

constexpr off_t kReserve = 1 << 16;   // [bytes]
constexpr size_t kLongest = 1 << 17;  // of a lock file

struct Holder {
  long process = 0;
  std::string host;
  long long begun = 0;  // of the process, in ticks since the machine started

  std::string text() const { return fmt::format("process {} on {}", process, host); }
};

// When a process began, a number no other process of this id has; -1: there is none.
long long begin_of(long process) {
  std::ifstream in(fmt::format("/proc/{}/stat", process));
  std::string text;
  std::getline(in, text);
  const size_t name = text.rfind(')');  // what is before may hold blanks
  if (name == std::string::npos) return -1;
  std::istringstream rest(text.substr(name + 1));
  std::string word;
  long long begun = -1;
  for (int i = 3; i < 22 && rest >> word; ++i) continue;
  return rest >> begun ? begun : -1;
}

std::string text_of(const Holder& h) {
  return fmt::format(
      "process {}\nhost {}\nbegun {}\n"
      "A run writes into this folder; the file goes when it ends. After a kill it stays, and means nothing.\n",
      h.process, h.host, h.begun);
}

std::optional<Holder> read_holder(const fs::path& path) {
  std::error_code ec;
  if (!fs::exists(path, ec)) return std::nullopt;
  std::istringstream in(read_text_file(path, kLongest));
  Holder h;
  std::string key;
  if (!(in >> key >> h.process) || key != "process" || !(in >> key >> h.host) || key != "host" ||
      !(in >> key >> h.begun) || key != "begun" || h.process <= 0)
    return std::nullopt;
  return h;
}

bool lives(const Holder& h) {
  if (h.host != this_host()) return true;  // as far as can be told
  const long long begun = begin_of(h.process);
  return begun >= 0 && begun == h.begun;
}

enum class Grip { kOurs, kTaken, kUnknown };

// The lock of the system on an open file; kUnknown: this file system has none.
Grip grip(int file) {
  if (flock(file, LOCK_EX | LOCK_NB) == 0) return Grip::kOurs;
  return errno == EWOULDBLOCK ? Grip::kTaken : Grip::kUnknown;
}

// Whether the file that a path leads to now is the open one.
bool same_file(int file, const fs::path& path) {
  struct stat a {
  }, b{};
  return fstat(file, &a) == 0 && lstat(path.c_str(), &b) == 0 && a.st_ino == b.st_ino && a.st_dev == b.st_dev;
}

Descriptor open_lock(const fs::path& path) {
  if (const std::string kind = unfit_target(path); !kind.empty())
    throw FileError(fmt::format("{}: is {}, where the lock of the folder should be", path.string(), kind));
  constexpr int kTries = 100;  // another process may remove its file between our opening and locking it
  for (int i = 0; i < kTries; ++i) {
    Descriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666));
    if (file < 0) fail_file(path, "written", errno);
    const Grip held = grip(file);
    if (!same_file(file, path)) continue;
    const std::optional<Holder> holder = read_holder(path);
    const std::string who = holder ? holder->text() : "another process";
    // somebody who only looks whether the folder is in use holds it for a moment
    if (held == Grip::kTaken && holder && !lives(*holder) && i + 1 < kTries) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      continue;
    }
    if (held == Grip::kTaken) fail_in_use(path.parent_path(), who);
    if (holder && holder->host != this_host())
      throw FileError(
          fmt::format("{}: says that {} writes into this folder, which cannot be seen from here. When that "
                      "process has ended, remove the file",
                      path.string(), who));
    if (held == Grip::kUnknown && holder && lives(*holder)) fail_in_use(path.parent_path(), who);
    return file;
  }
  throw FileError(fmt::format("{}: cannot be locked: others come and go", path.string()));
}

}  // namespace

std::string this_host() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "unknown";
}

FolderLock::FolderLock(const fs::path& folder)
    : path_(folder / kName), file_(open_lock(path_)), noted_(path_.string()) {
  if (const auto holder = read_holder(path_)) stale_ = holder->text();
  const long process = getpid();
  const std::string text = text_of({process, this_host(), begin_of(process)});
  size_ = text.size();
  size_t done = 0;
  if (ftruncate(file_, 0) != 0) fail_file(path_, "written", errno);
  if (const int error = write_all(file_, text, done); error != 0) {
    unlink(path_.c_str());
    fail_file(path_, "written", error);
  }
  // no room for it: then there is none for results either, and that will be said
  (void)posix_fallocate(file_, static_cast<off_t>(size_), kReserve);
}

FolderLock::~FolderLock() {
  if (is_ours()) unlink(path_.c_str());
}

// Some network drives number their files anew: then its text tells.
bool FolderLock::is_ours() const {
  if (same_file(file_, path_)) return true;
  try {
    const auto holder = read_holder(path_);
    return holder && holder->process == getpid() && holder->host == this_host();
  } catch (const std::exception&) {
    return false;
  }
}

void FolderLock::free_reserve() {
  (void)(ftruncate(file_, static_cast<off_t>(size_)) == 0);  // then the last word may find no room
}

void fail_in_use(const fs::path& folder, const std::string& user) {
  throw FileError(
      fmt::format("{}: is in use: {} writes into it. Wait until it has ended, or give another folder",
                  folder.string(), user));
}

std::string user_of_folder(const fs::path& folder) {
  const fs::path path = folder / FolderLock::kName;
  const Descriptor file(open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (file < 0) return "";
  const std::optional<Holder> holder = read_holder(path);
  const Grip held = grip(file);
  const bool taken = held == Grip::kTaken || (held == Grip::kUnknown && holder && lives(*holder));
  if (!taken) return "";
  return holder ? holder->text() : "another process";
}

}  // namespace talus
