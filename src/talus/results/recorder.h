#pragma once
// Writes the result folder while a run goes on, and the summary when it ends.

#include <memory>
#include <mutex>
#include <optional>

#include "talus/output/csv.h"
#include "talus/output/frame_series.h"
#include "talus/results/auditor.h"
#include "talus/results/bolt_summary.h"
#include "talus/results/frames.h"
#include "talus/results/histories.h"
#include "talus/results/joint_report.h"
#include "talus/results/summary.h"
#include "talus/run/saved_state.h"

namespace talus {

/// model.toml, histories.csv, steps.csv, joints.csv, slips.csv, fields/, saved/, with bolts also bolts.csv.
/// Rows reach the system at least once a second, frames at once, saved states and summaries the disk.
class Recorder : public Observer {
 public:
  /// @param folder  ready for results
  Recorder(const Scene& scene, ResultFolder folder, RunNotes notes = {});
  /// Goes on in the folder of a saved run: what was written after the state was saved is cut off. Throws as
  /// check().
  Recorder(const Scene& scene, ResultFolder folder, const Archive& saved, RunNotes notes = {});
  /// Begins the results of a branch, notes.branch, of the run that `parent` was saved of: monitors, output intervals and
  /// audit go on where they stood as far as they are the same and the parent wrote results.
  static std::unique_ptr<Recorder> branch_off(const Scene& scene, ResultFolder folder, const Archive& parent,
                                              RunNotes notes);
  ~Recorder() override;
  /// Throws FileError when the results in the folder are not as they were when the state was saved, or the
  /// state is damaged. Changes nothing.
  static void check(const ResultFolder& folder, const Scene& scene, const Archive& saved);

  /// Saves the state in saved/: stage_NN.h5 at the end of each stage; in between at intervals of wall time
  /// step_N.h5, of which the last two stay.
  bool wants_state() override;
  /// Holds the state in memory as often as it costs little; of a run that fails the last one is saved as
  /// step_N.h5.
  bool wants_copy() override;
  void hold_state(const Standing& standing, const State& state) override;
  void fails(const Instant& instant) override;
  void keep_state(const Standing& standing, const State& state) override;
  /// What it saves.
  Archive archive_of(const Standing& standing, const State& state) const;

  void at(const Instant& instant) override;

  /// Also writes the contact equations of this step as step_N.json. A failed step is always written.
  void dump_step(int64_t step) { dump_step_ = step; }

  /// Joints at the end of the last stage that has ended.
  const JointSummary& joints() const { return joint_summary_; }
  /// The same of bolts.
  const BoltSummary& bolts() const { return bolt_summary_; }

  /// What the audit found; none with `audit = false`.
  std::optional<audit::Report> audit() const;

  /// Writes waiting rows and summary.json. To be called also when the run failed or was interrupted.
  void finish(const RunResult& result);

  /// The last word of a run that an error has ended which is none of its numbers (a full disk, no memory):
  /// summary.json says why, as far as it still can be written. Never throws.
  void abandon(const std::string& why) noexcept;

  /// The same of results that could not be begun or taken up, where summary.json says that they are.
  static void abandon_begun(const std::filesystem::path& folder, const std::string& why) noexcept;

  /// Throws FileError when the name of the folder leads elsewhere by now.
  void check_place() const { folder_.check_place(); }

  /// Ends the results as if the run had been interrupted when its state was last held in memory, and saves
  /// that state: for a process that has to end while a step goes on. May be called from another thread; no
  /// result is taken any more, and the folder is free for others. Throws when that cannot be written;
  /// summary.json then says why.
  void end_as_held();

  /// Files that a failed run leaves to look at, by their path in the folder; "" for none.
  struct Left {
    std::string state, step;
    std::optional<double> frame;  // time [s]
  };
  const Left& left() const { return left_; }

 private:
  struct Held {
    Archive archive;
    int64_t step = -1;
    std::string summary;  // of a run that is interrupted there
  };

  // When what is written next, and what waits for it.
  struct Due {
    Histories::Even history;
    double steps = 0, frame = 0;  // time [s]
    std::vector<double> worst;    // of steps.csv columns since its last row
    bool dumped_failure = false;

    template <class X, class Self>
    static void exchange(X& x, Self& due);
  };

  static void check_kept(const Scene& scene, const Archive& saved, bool monitors, bool output);
  static ResultFolder taken_up(ResultFolder folder, const Scene& scene, const Archive& saved);
  void write_last_word(const std::string& why) noexcept;
  void load(const Archive& saved);
  std::string summary_of(const RunResult& result) const;
  void write_failed(const Instant& i);
  std::string marked(const std::string& summary) const;
  void append_history(const std::vector<double>& row);
  std::filesystem::path write_saved(const std::string& name, const Archive& archive);
  void write_step(int64_t step, const Archive& archive);
  void write_held();
  void flush_tables();
  void find_saved();
  void record_step(const Instant& instant);
  std::string write_dump(const Instant& instant);
  FrameTexts write_frame(const Instant& instant);
  void write_bolts(const Instant& instant);
  void write_joints(const Instant& instant, int stage);

  const Scene& scene_;
  ResultFolder folder_;
  RunNotes notes_;
  std::mutex taking_;   // results, or ending them
  bool ended_ = false;  // end_as_held()
  std::string model_;   // in numbers, as it began: stages change materials and joints
  CsvWriter history_file_, steps_file_;
  Histories histories_;
  std::optional<Auditor> auditor_;
  FrameSeries block_frames_, contact_frames_, bolt_frames_;
  std::string bolt_table_;  // bolts.csv so far
  BoltSummary bolt_summary_;
  Due due_;
  std::string joints_, slips_;  // joints.csv and slips.csv so far
  JointSummary joint_summary_;
  double last_flush_ = 0, last_saved_ = 0;
  int64_t saved_step_ = -1;
  std::vector<std::filesystem::path> saved_;  // between stages
  int steps_since_look_ = 0, steps_since_held_ = 0;
  std::optional<Held> held_;  // in case the next steps fail
  Left left_;
  double held_at_ = 0, holding_took_ = 0;  // wall time [s]
  int64_t dump_step_ = -1;
};

}  // namespace talus
