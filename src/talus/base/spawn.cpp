#include "talus/base/spawn.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "talus/base/error.h"

namespace talus {

pid_t spawn(const std::vector<std::string>& words, const std::filesystem::path& log, Life life) {
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const int in = open("/dev/null", O_RDONLY | O_CLOEXEC),
            out = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666), error = errno;
  int told[2] = {-1, -1};  // an error number, of a copy that does not become the program
  const auto fail = [&](int cause) {
    for (const int file : {in, out, told[0], told[1]})
      if (file >= 0) close(file);
    throw FileError(words[0] + ": cannot be started: " + std::generic_category().message(cause));
  };
  if (in < 0 || out < 0) fail(error);
  if (pipe2(told, O_CLOEXEC) != 0) fail(errno);
  const pid_t parent = getpid(), process = fork();
  if (process < 0) fail(errno);
  if (process == 0) {  // what may be called between fork and exec, and no more
    if (life == Life::kOfParent && (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent)) _exit(1);
    if (dup2(in, 0) >= 0 && dup2(out, 1) >= 0 && dup2(out, 2) >= 0) execvp(argv[0], argv.data());
    const int cause = errno;
    _exit(write(told[1], &cause, sizeof cause) > 0 ? 1 : 2);
  }
  close(told[1]);
  told[1] = -1;
  int cause = 0;
  ssize_t got = 0;
  while ((got = read(told[0], &cause, sizeof cause)) < 0 && errno == EINTR) continue;
  if (got == sizeof cause) {
    (void)waitpid(process, nullptr, 0);
    fail(cause);
  }
  for (const int file : {in, out, told[0]}) close(file);
  return process;
}

std::string own_program() {
  std::error_code ec;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", ec);
  if (ec) throw FileError("/proc/self/exe: cannot be read: " + ec.message());
  return self.string();
}

}  // namespace talus
