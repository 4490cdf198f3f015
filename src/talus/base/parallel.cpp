#include "talus/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "talus/base/clock.h"
#include "talus/base/index.h"

namespace talus {

namespace {

// Processor time of the calling thread [s].
double thread_seconds() {
  timespec t{};
  return clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t) == 0
             ? static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec)
             : 0;
}

// Looks at a flag before a waiting thread lets others run: about twenty microseconds.
constexpr int kLooks = 2000;

class Waiting {
 public:
  bool is_long() const { return looks_ >= kLooks; }
  void look_again() {
    if (is_long()) return std::this_thread::yield();
    ++looks_;
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }

 private:
  int looks_ = 0;
};

}  // namespace

// One job at a time, whose items are claimed one by one by whoever is there. The caller can do all of them:
// no thread ever waits for one that has not come.
struct Workers::Team {
  // Throws std::system_error when the system starts no more threads.
  explicit Team(int threads) {
    try {
      for (int i = 1; i < threads; ++i) helpers.emplace_back([this] { stand_by(); });
    } catch (...) {
      dismiss();
      throw;
    }
  }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  ~Team() { dismiss(); }

  std::vector<std::thread> helpers;
  std::mutex calling;
  std::condition_variable called;
  std::atomic<uint64_t> calls{0};  // to stand by
  std::atomic<bool> over{false};

  std::atomic<uint64_t> round{0};  // odd: a job is open
  std::atomic<int> inside{0};      // helpers that may be looking at the job
  std::atomic<bool> standing_by{false}, leaving{false};
  const std::function<void(size_t)>* task = nullptr;
  size_t count = 0;
  std::atomic<size_t> next{0}, done{0};
  std::mutex failure_lock;
  std::exception_ptr failure;

  double shared = 0, waited = 0;    // of the caller [s]
  std::atomic<double> stood_by{0};  // of the helpers, processor time [s]

  void work() {
    for (size_t i = next.fetch_add(1); i < count; i = next.fetch_add(1)) {
      try {
        (*task)(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(failure_lock);
        if (!failure) failure = std::current_exception();
      }
      done.fetch_add(1);
    }
  }

  void help() {
    const double begin = thread_seconds();
    double busy = 0;
    Waiting waiting;
    while (!leaving) {
      const uint64_t now = round;
      if (now % 2 == 0) {
        waiting.look_again();
        continue;
      }
      inside.fetch_add(1);
      {
        const Timed timed(busy);
        if (round == now) work();
      }
      inside.fetch_sub(1);
      waiting = {};
      while (round == now && !leaving) waiting.look_again();
      waiting = {};
    }
    stood_by.fetch_add(std::max(0.0, thread_seconds() - begin - busy));
  }

  // The life of a helper. The next call is often near: it looks for a while before it sleeps.
  void stand_by() {
    for (uint64_t seen = 0;; seen = calls, help()) {
      for (Waiting near; calls == seen && !over && !near.is_long();) near.look_again();
      std::unique_lock<std::mutex> lock(calling);
      called.wait(lock, [&] { return calls != seen || over; });
      if (over) return;
    }
  }

  void call() {
    leaving = false;
    {
      const std::lock_guard<std::mutex> lock(calling);
      ++calls;
    }
    called.notify_all();
  }

  void dismiss() {
    leaving = true;
    {
      const std::lock_guard<std::mutex> lock(calling);
      over = true;
    }
    called.notify_all();
    for (std::thread& helper : helpers) helper.join();
  }

  void run(size_t items, const std::function<void(size_t)>& what) {
    const double begin = wall_now();
    task = &what, count = items, next = 0, done = 0, failure = nullptr;
    ++round;
    work();
    const double own_end = wall_now();
    for (Waiting waiting; done < count;) waiting.look_again();
    ++round;
    for (Waiting waiting; inside > 0;) waiting.look_again();
    const double end = wall_now();
    shared += end - begin, waited += end - own_end;
    if (failure) std::rethrow_exception(failure);
  }
};

int processors() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

Workers::Workers(int threads) {
  if (threads == 0) threads = processors();
  if (threads > 1) team_ = std::make_shared<Team>(threads);
}

double Workers::shared_seconds() const { return team_ ? team_->shared : 0; }

double Workers::idle_seconds() const { return team_ ? team_->waited + team_->stood_by : 0; }

int Workers::threads() const { return team_ ? count_of(team_->helpers) + 1 : 1; }

void Workers::together(const std::function<void()>& body) const {
  if (!team_ || team_->standing_by) return body();
  struct Standing {
    Team& team;
    explicit Standing(Team& t) : team(t) { team.standing_by = true, team.call(); }
    ~Standing() { team.leaving = true, team.standing_by = false; }
  } const helpers(*team_);
  body();
}

void Workers::run(size_t count, const std::function<void(size_t)>& task) const {
  if (!team_ || count <= 1) {
    for (size_t i = 0; i < count; ++i) task(i);
  } else if (team_->standing_by) {
    team_->run(count, task);
  } else {
    together([&] { team_->run(count, task); });
  }
}

}  // namespace talus
