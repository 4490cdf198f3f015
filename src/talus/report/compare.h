#pragma once
// Two result folders beside each other, in numbers: histories stage by stage, what joints carry at the ends of stages, the
// ledger at the end.

#include <string>
#include <vector>

#include "talus/report/run_folder.h"

namespace talus::report {

/// How far a quantity of one run is from the same of another.
struct Difference {
  std::string kind;   // "history", "joints", "ledger"
  std::string stage;  // "" of the ledger
  std::string what;   // title with unit
  double most = 0;    // largest difference, in the unit
  double at = 0;      // when, from the begin of the stage [s]
  double rms = 0;     // of a history
  double scale = 0;   // largest size of the first run's
  /// Largest difference over the scale; infinite where that is 0 and they differ.
  double share() const;
};

struct Comparison {
  std::vector<Difference> list;    // histories, joints, ledger
  std::vector<std::string> notes;  // what only one of them has
};

/// Stages of one name are compared, dynamic ones at the times of the first run (the second between its rows), static ones
/// at their ends. Throws FileError when the two have nothing in common.
Comparison compare_runs(const RunFolder& a, const RunFolder& b);

/// Whether a difference is above atol (in its unit) + rtol times the scale.
bool beyond(const Difference& d, double rtol, double atol);

}  // namespace talus::report
