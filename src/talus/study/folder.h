#pragma once
// The folder of a study, which is its state: what is planned, what runs, what is done. Several processes on several
// hosts may work in it at once: a run is made in work/ and renamed into runs/ when it has ended, so that it is there
// whole or not at all, and the first of two wins. What cannot be trusted - a torn record, a record of other keys, a
// summary that is not whole - is as if it had never begun.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "talus/base/index.h"
#include "talus/study/study.h"

namespace talus::study {

/// What became of a run.
enum class Outcome {
  kFinished,   // and its audit accepts it
  kMechanism,  // a static stage finds no balance: an answer, and damage
  kNotValid,   // ended, and nothing can be said: its audit, or failure of numbers
  kRefused,    // its input is wrong
  kNotDone     // a file, memory, a signal, a host that was lost: the same command makes it again
};
/// "finished", "not valid" ...: as in results.csv.
const char* name_of(Outcome outcome);
/// Of the exit code of talus run.
Outcome outcome_of(int exit_code);

struct RunRecord {
  int number = 0;
  Outcome outcome = Outcome::kNotDone;
  int exit_code = 0;
  double wall_seconds = 0;
  std::string host, message;
};

class StudyFolder {
 public:
  explicit StudyFolder(std::filesystem::path path) : path_(std::move(path)) {}

  /// Which runs share their static stages, decided when they are planned.
  struct Sharing {
    std::string until;                                      // last of the static stages that come first
    std::vector<std::string> group;                         // of each run
    std::vector<std::vector<std::string>> group_overrides;  // of each run: those of its parent
  };

  /// Makes the folder for this study and plan, or finds that it is its own, and adds the runs that the plan has and the
  /// folder has not. Runs keep their numbers, which are given to `plan`.
  /// Throws FileError when it holds anything else; InputError when the model, a file or the program is not what it was
  /// begun with, or a run that it holds is not of this plan.
  /// @param files  all that the runs read, the model among them
  void begin(const Study& study, std::vector<PlannedRun>& plan, const Sharing& sharing,
             const std::string& program, const std::vector<std::string>& files);
  /// Throws FileError when it is no folder of a study; InputError when the model, a file that the runs read or the program
  /// is not what the study was begun with: results of two models are no study.
  void check(const std::string& program) const;
  /// Grows whenever check() meets a file that has been written since it looked at it last.
  int64_t writings() const { return writings_; }
  /// Numbers of the runs of this plan; those that the folder does not hold yet are taken out of it, and counted. Throws
  /// InputError when the folder holds runs that the plan does not, or of another model.
  int number(const Study& study, std::vector<PlannedRun>& plan) const;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path study_file() const { return path_ / "study.toml"; }
  /// The study file that it was begun with, from which paths count.
  std::string study_origin() const { return description().study_file; }
  std::string model() const { return description().model; }
  int planned() const { return count_of(tasks()); }
  /// Overrides of planned run `number`, and the name of its group (runs that share their static stages).
  struct Task {
    std::vector<std::string> overrides, group_overrides;
    std::string group;  // "": none shared
  };
  Task task(int number) const;
  /// Stage with which the shared stages end; "": none.
  std::string until() const { return description().until; }

  std::filesystem::path run_folder(int number) const;
  std::filesystem::path parent_folder(const std::string& group) const { return path_ / "parents" / group; }
  /// What became of a run; none while it has not ended, and where its record or its summary is not whole or not its own.
  std::optional<RunRecord> record_of(int number) const;
  /// Whether there is nothing more to do for it.
  bool is_done(int number) const;

  /// A place in work/, of absolute path.
  std::filesystem::path begun(const std::string& name) const;
  /// A folder in work/ for this attempt, which is not there yet.
  std::filesystem::path attempt(const std::string& what) const;
  /// Puts the record into the attempt, brings it to the disk and renames it to runs/; an attempt that comes second is
  /// removed, and what is not done gives way to any. Throws FileError; then the attempt stays in work/.
  void finish(int number, const std::filesystem::path& attempt, const RunRecord& record) const;
  /// Removes what attempts of processes of this host that have ended have left in work/.
  void clean() const;

 private:
  // What study.json holds. Throws FileError.
  struct Description {
    std::string id, program, study_file, model, until;  // id: of this study, in the records of its runs
    std::map<std::string, std::string> files;           // path and digest of each that the runs read
  };
  const Description& description() const;
  void check_files(const Description& d, const std::string& program) const;
  const std::vector<Task>& tasks() const;
  std::vector<Task> tasks_by_runs() const;
  void forget() const { description_.reset(), tasks_.reset(); }

  // What tells without reading it that a file has not been written.
  using Stamp = std::array<int64_t, 4>;
  std::filesystem::path path_;
  mutable std::map<std::string, Stamp> looked_at_;
  mutable int64_t writings_ = 0;
  mutable std::optional<Description> description_;
  mutable std::optional<std::vector<Task>> tasks_;  // of plan.jsonl
};

}  // namespace talus::study
