#pragma once
// What a study found: results.csv, fragility, figures and one page.

#include <string>
#include <vector>

#include "talus/study/folder.h"
#include "talus/study/fragility.h"
#include "talus/study/study.h"

namespace talus::study {

/// One planned run and what came of it.
struct ResultRow {
  int number = 0;
  std::vector<AxisValue> values;
  std::string status;           // as in RunRecord, "not valid", "missing"
  bool counts = false;          // finished, and valid
  std::vector<double> answers;  // NaN where there is none
  std::vector<int> damaged;     // of each state: 1, 0, or -1: counts as neither
  RunRecord record;
  bool has_report = false;
};

struct Gathered {
  std::vector<ResultRow> rows;
  std::vector<Fragility> fragility;                 // of each state, with points below
  std::vector<std::vector<FragilityPoint>> points;  // by intensity
  std::vector<std::string> troubles;                // of formulas
  int finished = 0, failed = 0, not_valid = 0, missing = 0;
};

/// Reads what is there. Writes nothing.
Gathered gather(const Study& study, const std::vector<PlannedRun>& plan, const StudyFolder& folder);

/// results.csv. The last columns are time, host and message.
std::string results_csv(const Study& study, const Gathered& found);
/// fragility.csv: a row per state.
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
