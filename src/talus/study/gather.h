#pragma once
// What a study found: results.csv, fragility, figures and one page.

#include <array>
#include <string>
#include <vector>

#include "talus/base/index.h"
#include "talus/study/folder.h"
#include "talus/study/fragility.h"
#include "talus/study/study.h"

namespace talus::study {

/// Why a run is not valid: one kind of finding of its audit, or that it failed.
struct RunFinding {
  std::string kind;   // "force_vanished" ..., "failed"
  std::string where;  // blocks and place of the worst; "" of the whole run
  double time = 0;    // of it [s]
  int64_t count = 0;  // how often
  std::string text;   // what there is, and what may be
};

/// One planned run and what came of it.
struct ResultRow {
  int number = 0;
  std::vector<AxisValue> values;
  Outcome outcome = Outcome::kNotDone;
  std::vector<double> answers;  // NaN where there is none
  std::vector<int> damaged;     // of each state: 1, 0, or -1: counts as neither
  std::vector<RunFinding> findings;
  RunRecord record;
  std::string arithmetic;                  // of the host that made it
  bool begun = false, has_report = false;  // begun: there is a record

  /// Whether its answers are those of a whole run, for figures and correlations: what a mechanism came to until it failed is
  /// damage, and no answer.
  bool answers_count() const { return outcome == Outcome::kFinished; }
  bool counts() const { return outcome == Outcome::kFinished || outcome == Outcome::kMechanism; }
};

/// As what runs that are not valid count in a curve. Strong motions are the ones that fail: leaving them out alone is biased,
/// and the truth lies between the other two.
enum class NotValidAs { kDamaged, kSound, kLeftOut };
inline constexpr size_t kNotValidAs = 3;
const char* name_of(NotValidAs as);

/// Fragility of one state of damage.
struct StateCurves {
  std::array<std::vector<FragilityPoint>, kNotValidAs> points;  // by intensity
  std::array<Fragility, kNotValidAs> fit;
  int runs = 0, damaged = 0, not_valid = 0, not_finite = 0;  // of those at an intensity > 0 that ended

  const Fragility& of(NotValidAs as) const { return fit[place_of(as)]; }
  const std::vector<FragilityPoint>& points_of(NotValidAs as) const { return points[place_of(as)]; }
  /// Ways of counting that differ: one where all runs are valid.
  std::vector<NotValidAs> ways() const;
  /// All points of one way together.
  FragilityPoint sum(NotValidAs as) const;
  /// Whether so few are not valid that a single median may be told.
  bool has_single() const;
  /// "median 0.98 (68 %: 0.89 to 1.07), beta 0.22"; of runs that are not valid the interval of medians; or why there is none.
  std::string headline(NotValidAs asked) const;
};

struct Gathered {
  std::vector<ResultRow> rows;  // in the order of their numbers
  std::vector<StateCurves> states;
  std::vector<std::string> units;     // of each answer, "" where none is known
  std::vector<std::string> troubles;  // of formulas
  std::array<int, 5> count{};         // of each outcome

  int of(Outcome outcome) const { return count[place_of(outcome)]; }
  /// "20 runs: 16 finished, 4 not valid"
  std::string counts() const;
  /// "slip [m]"
  std::string title(const Study& study, size_t answer) const;
};

/// Reads what there is. Writes nothing.
Gathered gather(const Study& study, const std::vector<PlannedRun>& plan, const StudyFolder& folder);

/// results.csv. The last columns are time, host and message.
std::string results_csv(const Study& study, const Gathered& found);
/// fragility.csv: rows per state, one for each way to count what is not valid.
std::string fragility_csv(const Study& study, const Gathered& found);
/// sensitivity.csv: rank correlation (Spearman) of each answer with each key that has numbers.
struct Sensitivity {
  std::string answer, axis;
  double correlation = 0;
};
std::vector<Sensitivity> sensitivities(const Study& study, const Gathered& found);

/// Lines for the terminal.
std::string gathered_text(const Study& study, const Gathered& found);

}  // namespace talus::study
