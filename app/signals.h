#pragma once
// What ends the process from outside: Ctrl-C, kill, a closed terminal or pipe, a limit on processor time.

#include <atomic>
#include <condition_variable>
#include <csignal>
#include <functional>
#include <mutex>
#include <thread>

namespace talus::app {

/// For verbs that save nothing: a signal removes files that were not finished, and ends the process at once.
void end_on_signals();

/// For a run: while it exists the first signal asks the run to stop, which it does between two steps. Where
/// that takes long, because a step does, `end_now` is called in a thread of its own and the process ends. A
/// second Ctrl-C ends it at once.
class StopSignals {
 public:
  /// @param end_now  saves what there is to save; the process ends when it returns
  explicit StopSignals(std::function<void()> end_now);
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// The signal that asks to stop, 0 for none yet.
  int asked() const;
  /// To be asked before every step: the same, and the run has heard it.
  int hear();

 private:
  void watch(const std::function<void()>& end_now);

  std::mutex mutex_;
  std::condition_variable changed_;
  bool heard_ = false, over_ = false;
  std::thread watcher_;
};

}  // namespace talus::app
