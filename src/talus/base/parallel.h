#pragma once
// Threads inside a step. Work is cut into chunks that do not depend on the number of threads, so that sums
// taken chunk by chunk have the same bits for any number of them.

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace talus {

/// Processors that this process may use, at least 1.
int processors();

/// A team of threads. Copies share it; a team of one runs everything in the caller.
class Workers {
 public:
  /// @param threads  including the caller; 0 = as many as the machine has processors
  /// Throws std::system_error when the system starts no more threads.
  explicit Workers(int threads = 1);

  int threads() const;

  /// Wall time so far in which all threads had work [s]; 0 for a team of one.
  double shared_seconds() const;
  /// Processor time so far of threads that stood by or waited for others [s]: no work.
  double idle_seconds() const;

  /// Runs `body` in the caller while the other threads stand by for the calls of run() in it: these then
  /// begin within a microsecond, where waking threads would take as long as the work of one colour.
  void together(const std::function<void()>& body) const;

  /// task(i) for every i in [0, count), each once, on any thread; returns when all are done. An exception of
  /// a task is passed on. Not to be called from within a task, nor by two callers at once.
  void run(size_t count, const std::function<void(size_t)>& task) const;

  /// f(begin, end) over [0, n) in chunks of `grain` items.
  template <class F>
  void for_chunks(size_t n, size_t grain, F f) const {
    if (n == 0) return;
    const size_t chunks = (n + grain - 1) / grain;
    const auto chunk = [&](size_t c) { f(c * grain, (c + 1) * grain < n ? (c + 1) * grain : n); };
    if (chunks <= 1 || threads() == 1)
      for (size_t c = 0; c < chunks; ++c) chunk(c);
    else
      run(chunks, chunk);
  }

  /// The same with a result of each chunk, `f(begin, end, result)`, added up with += in the order of chunks.
  template <class T, class F>
  T sum_chunks(size_t n, size_t grain, F f) const {
    if (n == 0) return {};
    std::vector<T> part((n + grain - 1) / grain);
    for_chunks(n, grain, [&](size_t begin, size_t end) { f(begin, end, part[begin / grain]); });
    T sum{};
    for (const T& p : part) sum += p;
    return sum;
  }

 private:
  struct Team;
  std::shared_ptr<Team> team_;  // null: one thread
};

}  // namespace talus
