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

/// For a run: from listen() on the first signal asks the run to stop, which it does between two steps. Where
/// that takes long, because a step does, what listen() got is called in a thread of its own and the process
/// ends. A second Ctrl-C ends it at once.
class StopSignals {
 public:
  /// Starts the thread that waits; std::system_error when there is none to be had. Signals do what they did.
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// From now on signals wait for the run to begin.
  void begin();
  /// It has begun.
  /// @param end_now  saves what there is to save; the process ends when it returns or throws
  void listen(std::function<void()> end_now);

  /// The signal that asks to stop, 0 for none yet.
  int asked() const;
  /// To be asked before every step: the same, and the run has heard it.
  int hear();
  /// No step is to come: what is written at the end may take its time.
  void run_has_ended();

 private:
  void watch();

  std::function<void()> end_now_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool heard_ = false, over_ = false;
  std::thread watcher_;
};

}  // namespace talus::app
