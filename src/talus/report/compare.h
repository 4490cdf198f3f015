#pragma once
// Two result folders beside each other, in numbers: histories stage by stage, what joints carry at the ends of stages, the
// ledger at the end.

#include <map>
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
  std::vector<std::string> notes;  // of no consequence
  std::vector<std::string>
      models;  // in what the models differ, but for how they are solved and what is written
  std::vector<std::string>
      faults;  // why the two cannot be taken for the same, whatever the differences are: a side that is not
               // whole, failed or is not valid, and what only one of them has
};

/// Stages of one name are compared, dynamic ones at the times of the first run (the second between its rows), static ones
/// at their ends.
Comparison compare_runs(const RunFolder& a, const RunFolder& b);

/// What two runs may differ by.
struct Tolerance {
  double rtol = 0;  // of the largest value of A
  double atol = 0;  // added to it, in the unit of the quantity
};

/// Tolerances by what they are of: "displacement" for all whose name begins so, "N", "m/s" for all of a unit, "joints",
/// "ledger"; the longest that fits counts. "" is for all others.
class Tolerances {
 public:
  /// "0.01", "velocity=0.05". Throws Error (usage) for anything else.
  void add(const std::string& text, double Tolerance::*part);
  bool given() const { return !by_name_.empty(); }
  Tolerance of(const Difference& d) const;
  /// Names that fit none of these. @pre given()
  std::vector<std::string> unused(const std::vector<Difference>& list) const;

 private:
  static bool fits(const std::string& name, const Difference& d);
  std::map<std::string, Tolerance> by_name_;
};

/// Whether a difference is above atol (in its unit) + rtol times the scale.
bool beyond(const Difference& d, const Tolerance& t);

}  // namespace talus::report
