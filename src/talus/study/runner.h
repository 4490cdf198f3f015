#pragma once
// Runs the planned runs of a study as processes of `talus run`, several side by side.

#include <sys/types.h>

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "talus/study/folder.h"

namespace talus::study {

struct RunnerSettings {
  std::string program;  // path of talus
  int jobs = 1;
  bool keep_all = true, report = false;
};

/// What the runner tells while it goes on.
struct Progress {
  int done = 0, running = 0, failed = 0, all = 0;  // failed: ended without result
  double to_go = 0;                                // [s], 0: not known yet
};

class Runner {
 public:
  Runner(const StudyFolder& folder, RunnerSettings settings)
      : folder_(folder), settings_(std::move(settings)) {}

  /// Runs those of `numbers` that are not done.
  /// @param told  after every run that has ended
  /// @param stop  asked between runs; true: what runs is ended and given up
  void run(const std::vector<int>& numbers, const std::function<void(const Progress&)>& told,
           const std::function<bool()>& stop);

 private:
  struct Job {
    int number = -1;    // of a run
    std::string group;  // number < 0: the parent of this group
    bool branch = false;
    StudyFolder::Task task;
    std::filesystem::path attempt;
    double begun = 0;
  };
  void start(Job job);
  void ended(Job job, int status, bool stopped);
  std::string state_of(const std::string& group) const;

  const StudyFolder& folder_;
  RunnerSettings settings_;
  std::deque<Job> waiting_;
  std::map<pid_t, Job> running_;
  std::map<std::string, int> group_state_;  // 0: being made, 1: there, 2: there is none to be had
  Progress progress_;
};

}  // namespace talus::study
