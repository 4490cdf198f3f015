#pragma once
// From a raw record to a motion that begins and ends at rest: one small function per step, and process(),
// which runs them in their order and writes down what it did (theory 11).

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "talus/record/filter.h"
#include "talus/record/motion.h"

namespace talus::record {

/// Takes the mean off: of the first `pre_event` seconds (noise before the event), or of all samples when it
/// is 0.
/// @return the mean [m/s2]
double remove_mean(std::vector<double>& a, double dt, double pre_event);

/// Multiplies `share` of the samples at the start (and at the end) by a raised cosine from 0 to 1 (from 1 to
/// 0).
void taper_ends(std::vector<double>& a, double share);

/// Fits d(t) by the sum of q_k t^k, k = 2 .. degree (least squares), and takes the second derivative of the
/// fit off a. Constant and linear terms are left out: d(0) = v(0) = 0.
/// @param degree  2 .. 10
/// @return q_k [m/s^k], k = 2 .. degree
std::vector<double> remove_baseline(std::vector<double>& a, double dt, int degree);

/// The samples from `begin` to `begin + duration` [s]; duration 0: to the end. A begin above 0 gets a cosine
/// taper of `taper` [s] at the start, and every window one at its end, down to 0.
/// @pre the window lies in the record
std::vector<double> cut_window(const std::vector<double>& a, double dt, double begin, double duration,
                               double taper);

/// Adds A t (T - t) + B t (T - t)(T - 2 t), with A and B such that v(T) = d(T) = 0. Zero at both ends, smooth
/// between.
/// @return A [m/s4], B [m/s5]
std::pair<double, double> pin_end(std::vector<double>& a, double dt);

struct Processing {
  double pre_event = 0;  // [s] 0: the mean of all samples
  double taper = 0.03;   // share of the samples at each end
  Band band;
  int baseline_degree = 6;  // 0: none
  double begin = 0;         // [s] of the window
  double duration = 0;      // [s] 0: to the end
  double end_taper = 1;     // [s]
};

/// What one step did: its name and the numbers that describe it.
struct Step {
  std::string name;
  std::vector<std::pair<std::string, double>> numbers;
};

struct Processed {
  Motion motion;
  std::vector<Step> steps;
};

/// Throws InputError naming the option that does not fit the record (corner above the Nyquist frequency,
/// window beyond its end ...). @param source  name of the record for messages
void check_processing(const Processing& how, size_t samples, double dt, const std::string& source);

/// All steps in their order. Throws as check_processing() does.
Processed process(std::vector<double> acceleration, double dt, const Processing& how,
                  const std::string& source);

}  // namespace talus::record
