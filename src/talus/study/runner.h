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
  std::string version;  // what it calls itself
  int jobs = 1;
  bool keep_all = true, report = false;
};

/// What the runner tells while it goes on.
struct Progress {
  int done = 0, running = 0, all = 0;
  int without = 0;    // of those done: not valid, or refused
  int not_done = 0;   // ended otherwise: the same command makes them again
  double to_go = 0;   // [s], 0: not known yet
  std::string cause;  // of the last one that is not done
};

class Runner {
 public:
  Runner(const StudyFolder& folder, RunnerSettings settings)
      : folder_(folder), settings_(std::move(settings)) {}

  /// Runs those of `numbers` that are not done, each with the files that the folder was begun with: throws InputError, as
  /// StudyFolder::check(), when one is another by now.
  /// @param told  after every run that has ended
  /// @param stop  asked between runs; true: what runs is ended and given up
  /// @return how it ended
  Progress run(const std::vector<int>& numbers, const std::function<void(const Progress&)>& told,
               const std::function<bool()>& stop);

 private:
  struct Job {
    int number = -1;    // of a run
    std::string group;  // number < 0: the parent of this group
    bool branch = false;
    StudyFolder::Task task;
    std::filesystem::path attempt;
    double begun = 0;
    int64_t writings = 0;  // of files that it reads, when it was started
  };
  Progress run_all(const std::vector<int>& numbers, const std::function<void(const Progress&)>& told,
                   const std::function<bool()>& stop);
  void give_up();
  void start(Job job);
  void ended(Job job, int status, bool stopped);
  void keep(const Job& job, RunRecord record);
  void make_report(const Job& job);
  pid_t one_that_ended(int& status) const;
  std::string state_of(const std::string& group) const;

  const StudyFolder& folder_;
  RunnerSettings settings_;
  std::deque<Job> waiting_;
  std::map<pid_t, Job> running_;
  std::map<std::string, int> group_state_;  // 0: being made, 1: there, 2: there is none to be had
  Progress progress_;
};

}  // namespace talus::study
