#pragma once
// The folder of a study, which is its state: what is planned, what runs, what is done. Several processes on several
// hosts may work in it at once: a run is made in work/ and renamed into runs/ when it has ended, so that it is there
// whole or not at all, and the first of two wins.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "talus/study/study.h"

namespace talus::study {

/// What became of a run that has ended.
struct RunRecord {
  int number = 0;
  std::string status;  // "finished", "failed", "refused", "killed"
  int exit_code = 0;
  double wall_seconds = 0;
  std::string host, message;
};

class StudyFolder {
 public:
  explicit StudyFolder(std::filesystem::path path) : path_(std::move(path)) {}

  /// Which runs share their static stages, decided when the study begins.
  struct Sharing {
    std::string until;                                      // last of the static stages that come first
    std::vector<std::string> group;                         // of each run
    std::vector<std::vector<std::string>> group_overrides;  // of each run: those of its parent
  };

  /// Makes the folder for this study and plan, or finds that it is its own. Throws FileError when it holds anything
  /// else, InputError when another study, model or plan was begun in it.
  /// @param inputs  digest of all files that the runs read
  void begin(const Study& study, const std::vector<PlannedRun>& plan, const Sharing& sharing,
             const std::string& program, const std::string& inputs);
  /// Throws FileError when it is no folder of a study.
  void check() const;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path study_file() const { return path_ / "study.toml"; }
  /// The study file that it was begun with, from which paths count.
  std::string study_origin() const { return description().study_file; }
  std::string model() const { return description().model; }
  int planned() const { return description().runs; }
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
  /// What became of a run; none while it has not ended.
  std::optional<RunRecord> record_of(int number) const;
  /// Whether there is nothing more to do for it: it has ended, and was not killed.
  bool is_done(int number) const;

  /// A place in work/, of absolute path.
  std::filesystem::path begun(const std::string& name) const;
  /// A folder in work/ for this attempt, which is not there yet.
  std::filesystem::path attempt(const std::string& what) const;
  /// Puts the record into the attempt and renames it to runs/; an attempt that comes second is removed. A killed run
  /// gives way to any.
  void finish(int number, const std::filesystem::path& attempt, const RunRecord& record) const;
  /// Removes what attempts of processes of this host that have ended have left in work/.
  void clean() const;

 private:
  // What study.json holds. Throws FileError.
  struct Description {
    std::string study_file, model, until;
    int runs = 0;
  };
  Description description() const;
  const std::string& line(int number) const;

  std::filesystem::path path_;
  mutable std::vector<std::string> lines_;  // of plan.jsonl
};

}  // namespace talus::study
