#include "talus/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

namespace talus {

namespace {

// Looks at a flag before a waiting thread lets others run: about twenty microseconds.
constexpr int kLooks = 2000;

class Waiting {
 public:
  void look_again() {
    if (++looks_ < kLooks) {
#if defined(__x86_64__) || defined(__i386__)
      __builtin_ia32_pause();
#endif
      return;
    }
    std::this_thread::yield();
  }

 private:
  int looks_ = 0;
};

}  // namespace

// One job at a time, whose items are claimed one by one by whoever is there. The caller can do all of them:
// no thread ever waits for one that has not come.
struct Workers::Team {
  // the library starts no more threads than the machine has processors unless it is told to: a run asked for
  // four threads on two processors gets four
  explicit Team(int threads)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads)), arena(threads) {}

  tbb::global_control limit;
  tbb::task_arena arena;

  std::atomic<uint64_t> round{0};  // odd: a job is open
  std::atomic<int> inside{0};      // helpers that may be looking at the job
  std::atomic<bool> standing_by{false}, leaving{false};
  const std::function<void(size_t)>* task = nullptr;
  size_t count = 0;
  std::atomic<size_t> next{0}, done{0};
  std::mutex failure_lock;
  std::exception_ptr failure;

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
    Waiting waiting;
    while (!leaving) {
      const uint64_t now = round;
      if (now % 2 == 0) {
        waiting.look_again();
        continue;
      }
      inside.fetch_add(1);
      if (round == now) work();
      inside.fetch_sub(1);
      waiting = {};
      while (round == now && !leaving) waiting.look_again();
      waiting = {};
    }
  }

  void run(size_t items, const std::function<void(size_t)>& what) {
    task = &what, count = items, next = 0, done = 0, failure = nullptr;
    ++round;
    work();
    for (Waiting waiting; done < count;) waiting.look_again();
    ++round;
    for (Waiting waiting; inside > 0;) waiting.look_again();
    if (failure) std::rethrow_exception(failure);
  }
};

Workers::Workers(int threads) {
  if (threads == 0) threads = tbb::info::default_concurrency();
  if (threads > 1) team_ = std::make_shared<Team>(threads);
}

int Workers::threads() const { return team_ ? team_->arena.max_concurrency() : 1; }

void Workers::together(const std::function<void()>& body) const {
  if (!team_ || team_->standing_by) return body();
  Team& team = *team_;
  team.arena.execute([&] {
    team.leaving = false;
    team.standing_by = true;
    tbb::task_group helpers;
    for (int i = 1; i < threads(); ++i) helpers.run([&team] { team.help(); });
    std::exception_ptr failure;
    try {
      body();
    } catch (...) {
      failure = std::current_exception();
    }
    team.leaving = true;
    helpers.wait();  // those that never came look in, see that all is done, and go
    team.standing_by = false;
    if (failure) std::rethrow_exception(failure);
  });
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
