#pragma once
// What the columns of the monitors came to, stage by stage: monitors.csv, summary.json and what studies ask.

#include <limits>
#include <string>
#include <vector>

#include "talus/output/archive.h"
#include "talus/output/columns.h"
#include "talus/run/instant.h"

namespace talus {

/// One column of histories.csv over one stage: of every step, whatever `history_interval` says.
struct Answer {
  double at_start = 0, at_end = 0;            // of the first and the last step of the stage
  double least = 0, time_of_least = 0;        // [s] of the run
  double greatest = 0, time_of_greatest = 0;  // [s]
  double tail = 0, tail_steps = 0;            // sum and number of steps of the last tenth of a dynamic stage

  /// What is left: the mean of the last tenth of a dynamic stage, NaN of one that has not come so far; the last
  /// value of a static stage.
  double residual(bool dynamic) const {
    if (!dynamic) return at_end;
    return tail_steps > 0 ? tail / tail_steps : std::numeric_limits<double>::quiet_NaN();
  }
};

class Answers {
 public:
  /// @param columns  of histories.csv; those of `asked` are followed
  Answers(const Scene& scene, const std::vector<ColumnTitle>& columns, std::vector<size_t> asked);

  /// @param row  all columns at this instant
  void at(const Instant& instant, const std::vector<double>& row);

  struct Stage {
    int stage = 0;              // of the model
    double tail_begin = 0;      // [s] of the run
    std::vector<Answer> asked;  // in the order of titles()
  };
  const std::vector<Stage>& stages() const { return stages_; }
  const std::vector<ColumnTitle>& titles() const { return titles_; }

  /// monitors.csv: a row per stage and column.
  std::string csv() const;

  /// Throws FileError when they are not those of these monitors and stages.
  void save(Saver& to) const;
  void load(Loader& from);

 private:
  template <class X, class Self>
  static void exchange(X& x, Self& self, size_t count);

  const Scene& scene_;
  std::vector<ColumnTitle> titles_;
  std::vector<size_t> asked_;
  std::vector<Stage> stages_;
};

}  // namespace talus
