#pragma once
// A study: one model run many times, with keys that vary. What the study file says, as plain data.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "talus/schema/findings.h"
#include "talus/schema/schema.h"

namespace talus::study {

/// How a sampled key is distributed, in the unit it is given in.
struct Distribution {
  enum Kind { kNormal, kLognormal, kUniform };
  Kind kind = kNormal;
  double mean = 0, deviation = 0;  // of the quantity itself; of kUniform its middle and half width
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();

  /// The value below which the share `u` of all lies. @pre 0 < u < 1
  double quantile(double u) const;
};

/// One value that a key takes.
struct AxisValue {
  std::string toml;                                          // as it is written behind KEY=
  std::string shown;                                         // in tables
  double number = std::numeric_limits<double>::quiet_NaN();  // none of a text
};

/// One key that varies: [[vary]].
struct Axis {
  std::string name, key, unit;
  std::vector<AxisValue> values;  // of a list; of a sampled key one per sample
  bool sampled = false;
  Distribution distribution;
  bool files = false;                        // motions: each value is a file
  std::vector<std::filesystem::path> paths;  // of them
  std::string measure;                       // "PGA", "PGV", "Sa": values are what a motion is scaled to
  double period = 0;                         // of Sa [s]
  std::string motion;                        // name of the axis of the motions that are scaled
  Where where;

  std::string title() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

struct NamedFormula {
  std::string name, formula;
  std::string unit;  // of SI; "": that of the number where the formula is one alone
  Where where;
};

/// A state of damage: a run is in it when its formula in answers is not 0.
struct DamageState {
  std::string name, when;
  bool invalid_counts = false;  // runs that failed by numbers, or are not valid, count as damaged
  Where where;
};

struct Study {
  std::string file, text;  // of the study
  std::string title;
  std::filesystem::path model;  // its file
  std::vector<std::string> set;
  std::vector<Axis> axes;
  int samples = 0;  // of the sampled axes together
  int64_t seed = 0;
  bool latin_hypercube = true;
  std::vector<NamedFormula> answers;
  std::vector<DamageState> states;
  std::string over;  // axis of fragility and incremental curves; "": none
  bool keep_all = true, report = false, share = true;
};

/// All sections and keys of a study file.
const std::vector<SectionSpec>& study_schema();
/// The same as tables of Markdown.
std::string study_markdown();

/// Reads a study. Samples are drawn, motions found in their folders. Wrong input becomes findings.
Study read_study(const std::string& file, const std::string& text, Findings& findings);

/// One run of a study.
struct PlannedRun {
  int number = 0;
  std::vector<AxisValue> values;       // of each axis
  std::vector<std::string> overrides;  // KEY=VALUE of all
};

/// All runs: every combination of the listed values, with every sample. Motions are measured where they are scaled.
/// Throws InputError, FileError as the readers of records.
std::vector<PlannedRun> plan_runs(const Study& study);

}  // namespace talus::study
