#pragma once
// What `talus record` writes: the motion as CSV, and record.json, which says what was done to it.

#include <string>
#include <vector>

#include "talus/record/measures.h"
#include "talus/record/process.h"

namespace talus::record {

/// "time [s],acceleration [m/s2],velocity [m/s],displacement [m]" and a row per sample, with as many digits
/// as bring back the same numbers.
std::string motion_csv(const Motion& motion);
/// Response spectrum of its acceleration, damping 5 %: "period [s],sa [m/s2]", 200 periods from 0.02 to 10 s, as
/// --target reads it.
std::string spectrum_csv(const Motion& motion);

/// What record.json tells.
struct Account {
  std::string source;  // file as given, or "synthetic"
  std::string hash;    // text_hash() of the file, "" for a synthetic motion
  std::string format, title, unit;
  double offset = 0;                  // [m/s2] taken off by the reader
  std::vector<Measures> before = {};  // of the record as read; empty for a synthetic motion
  std::vector<Step> steps = {};       // in their order
  Measures after = {};                // of the motion that was written
  size_t samples = 0;
  double dt = 0;  // [s]
};

/// record.json: program, source, steps with their numbers, measures before and after (the residuals v(T) and
/// d(T) among them).
std::string record_json(const Account& account);

}  // namespace talus::record
