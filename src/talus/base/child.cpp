#include "talus/base/child.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>

#include "talus/base/clock.h"
#include "talus/base/descriptor.h"
#include "talus/base/error.h"

namespace talus {

namespace {

constexpr int kNoMemory = 70, kThrown = 71;

// The sanitizers keep shadows of all memory there could be.
constexpr bool kWatched =
#if defined(__SANITIZE_ADDRESS__)
    true;
#else
    false;
#endif

// Fuzzers learn nothing from what another process does.
constexpr bool kInOneProcess =
#if defined(TALUS_IN_ONE_PROCESS)
    true;
#else
    false;
#endif

void limit(__rlimit_resource resource, rlim_t most) {
  const rlimit both{most, most};
  setrlimit(resource, &both);
}

// What this process has mapped [bytes]: a large model's copy has that before it begins.
size_t address_space() {
  std::ifstream in("/proc/self/statm");
  size_t pages = 0;
  return in >> pages ? pages * static_cast<size_t>(sysconf(_SC_PAGESIZE)) : 0;
}

[[noreturn]] void be_child(int out, const std::function<std::string()>& work, const ChildLimits& limits) {
  // what nohup has ignored stays so
  struct sigaction hang_up {};
  const bool ignored = sigaction(SIGHUP, nullptr, &hang_up) == 0 && hang_up.sa_handler == SIG_IGN;
  for (const int signal : {SIGINT, SIGTERM, SIGXCPU, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL})
    std::signal(signal, SIG_DFL);
  if (!ignored) std::signal(SIGHUP, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);
  // nothing of the parent is kept open, no lock of a folder above all, and nothing outlives it
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (out > 3) close_range(3, static_cast<unsigned>(out) - 1, 0);
  close_range(static_cast<unsigned>(out) + 1, ~0u, 0);
  const auto seconds = static_cast<rlim_t>(limits.seconds);
  const rlimit processor{seconds, seconds + 5};  // at the first one SIGXCPU, at the second SIGKILL
  setrlimit(RLIMIT_CPU, &processor);
  limit(RLIMIT_CORE, 0);
  if (!kWatched) limit(RLIMIT_AS, static_cast<rlim_t>(address_space() + limits.memory));
  try {
    const std::string bytes = work();
    size_t done = 0;
    _exit(write_all(out, bytes, done) == 0 ? 0 : kThrown);
  } catch (const std::bad_alloc&) {
    _exit(kNoMemory);
  } catch (...) {
    _exit(kThrown);
  }
}

// Reads up to the end; false when time is over.
bool read_up_to(int in, double end, std::string& bytes) {
  std::array<char, 1 << 16> part;
  for (;;) {
    const double left = end - wall_now();
    pollfd ready{in, POLLIN, 0};
    const int some = left > 0 ? poll(&ready, 1, static_cast<int>(1e3 * left) + 1) : 0;
    if (some < 0 && errno == EINTR) continue;
    if (some <= 0) return false;
    const ssize_t n = read(in, part.data(), part.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return true;
    bytes.append(part.data(), n);
  }
}

std::string reason_of(int status, bool late, const ChildLimits& limits) {
  const std::string memory = fmt::format("reading it took more than {} MiB of memory", limits.memory >> 20);
  const std::string time = fmt::format("reading it took more than {} s", limits.seconds);
  if (late) return time;
  if (WIFEXITED(status)) return WEXITSTATUS(status) == kNoMemory ? memory : "reading it failed";
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU) return time;
  if (signal == SIGKILL)
    return "the process that reads it was killed, as the system does when memory is short";
  return fmt::format("the library that reads it has crashed ({})", strsignal(signal));
}

}  // namespace

std::string work_in_child(const std::string& what, const std::function<std::string()>& work,
                          const ChildLimits& limits) {
  if (kInOneProcess) return work();
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0)
    throw FileError(fmt::format("{}: cannot be read: {}", what, std::strerror(errno)));
  Descriptor in(ends[0]), out(ends[1]);
  const pid_t child = fork();
  if (child < 0) throw FileError(fmt::format("{}: cannot be read: {}", what, std::strerror(errno)));
  if (child == 0) be_child(out, work, limits);
  out.done();
  std::string bytes;
  const bool late = !read_up_to(in, wall_now() + limits.seconds, bytes);
  if (late) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (!late && WIFEXITED(status) && WEXITSTATUS(status) == 0) return bytes;
  throw FileError(fmt::format("{}: {}", what, reason_of(status, late, limits)));
}

}  // namespace talus
