#include "signals.h"

#include <fmt/format.h>
#include <poll.h>
#include <semaphore.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <exception>

#include "talus/base/error.h"
#include "talus/base/unfinished.h"

namespace talus::app {

namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXCPU};

// A step that takes longer is not waited for; what comes after the last step may take so long.
constexpr auto kForStep = std::chrono::milliseconds(600);
constexpr auto kForEnd = std::chrono::seconds(20);

volatile std::sig_atomic_t asked_by = 0;
sem_t asking;

// nohup has a hang-up ignored, and it stays so; all else is ours to hear.
bool stays_ignored(int signal) {
  struct sigaction now {};
  return signal == SIGHUP && sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

using Handler = void (*)(int, siginfo_t*, void*);

void on_signals(Handler handler) {
  struct sigaction action {};
  action.sa_sigaction = handler;
  action.sa_flags = SA_RESTART | SA_SIGINFO;
  sigemptyset(&action.sa_mask);
  for (const int signal : kSignals)
    if (!stays_ignored(signal)) sigaction(signal, &action, nullptr);
}

// A pipe that this process itself has found without a reader, and that is not standard output: standard error
// as a rule, without which all goes on. The write fails, and whoever wrote is told.
bool is_of_no_matter(int signal, const siginfo_t* info) {
  if (signal != SIGPIPE || info->si_pid != getpid()) return false;
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return !(poll(&out, 1, 0) > 0 && (out.revents & POLLERR) != 0);
}

extern "C" void clean_up_and_end(int signal, siginfo_t* info, void*) {
  if (is_of_no_matter(signal, info)) return;
  talus::remove_unfinished();
  std::signal(signal, SIG_DFL);
  raise(signal);
}

extern "C" void ask_to_stop(int signal, siginfo_t* info, void*) {
  if (is_of_no_matter(signal, info)) return;
  const bool again = asked_by != 0;
  if (again && signal == SIGINT) _exit(kExitSignal + signal);
  if (again) return;  // a limit on processor time tells every second
  asked_by = signal;
  const int error = errno;
  sem_post(&asking);
  errno = error;
}

}  // namespace

void end_on_signals() { on_signals(clean_up_and_end); }

StopSignals::StopSignals() {
  asked_by = 0;
  sem_init(&asking, 0, 0);
  watcher_ = std::thread([this] { watch(); });
}

void StopSignals::begin() { on_signals(ask_to_stop); }

void StopSignals::listen(std::function<void()> end_now) {
  {
    const std::lock_guard lock(mutex_);
    end_now_ = std::move(end_now);
  }
  changed_.notify_all();
  begin();
}

StopSignals::~StopSignals() {
  end_on_signals();
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  sem_post(&asking);
  watcher_.join();
  sem_destroy(&asking);
}

int StopSignals::asked() const { return asked_by; }

int StopSignals::hear() {
  if (asked_by != 0 && !heard_) {
    const std::lock_guard lock(mutex_);
    heard_ = true;
    changed_.notify_all();
  }
  return asked_by;
}

void StopSignals::run_has_ended() {
  const std::lock_guard lock(mutex_);
  heard_ = true;
  changed_.notify_all();
}

void StopSignals::watch() {
  while (sem_wait(&asking) != 0) continue;
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return end_now_ || over_; });
    if (changed_.wait_for(lock, kForStep, [this] { return heard_ || over_; }))
      if (changed_.wait_for(lock, kForEnd, [this] { return over_; })) return;
  }
  try {
    end_now_();
  } catch (const Error& e) {
    std::fprintf(stderr, "talus: %s\n", e.what());
    _exit(e.code());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "talus: %s\n", e.what());
    _exit(kExitResources);
  }
  _exit(kExitSignal + asked_by);
}

}  // namespace talus::app
