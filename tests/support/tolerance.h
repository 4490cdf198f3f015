#pragma once
// Comparison of a computed number with its exact value. Every comparison prints what was reached beside the
// tolerance that must hold and the one aimed for; TALUS_TEST_TOLERANCE=0 makes each fail, to see them all.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "support/formulation.h"

namespace talus::test {

inline double tolerance_factor() {
  const char* text = std::getenv("TALUS_TEST_TOLERANCE");
  return text ? std::atof(text) : 1;
}

/// Requires |value - exact| <= pass x scale (scale: |exact| unless given). `stretch` is printed only.
inline void check_close(const std::string& what, double value, double exact, double pass, double stretch,
                        double scale = 0) {
  if (!says_something()) return;
  if (scale == 0) scale = std::abs(exact);
  const double reached = std::abs(value - exact) / scale;
  REQUIRE(what.find('|') == std::string::npos);  // it stands between the columns of a table
  print_pair();
  fmt::print("residual | {:<58} | {:>15.9g} | {:>15.9g} | {:>9.2e} | {:>7.3g} | {:>7.3g} |{}\n", what, value,
             exact, reached, pass, stretch, reached <= stretch ? " stretch" : "");
  std::fflush(stdout);
  INFO(what, ": computed ", value, ", exact ", exact, ", relative error ", reached, ", allowed ", pass);
  CHECK(reached <= pass * tolerance_factor());
}

/// Requires value <= pass.
inline void check_below(const std::string& what, double value, double pass, double stretch) {
  check_close(what, value, 0, pass, stretch, 1);
}

/// Requires value >= pass (printed with the stretch goal).
inline void check_above(const std::string& what, double value, double pass, double stretch) {
  if (!says_something()) return;
  print_pair();
  fmt::print("residual | {:<58} | {:>15.9g} | {:>15} | {:>9} | {:>7.3g} | {:>7.3g} |{}\n", what, value,
             "at least", "", pass, stretch, value >= stretch ? " stretch" : "");
  std::fflush(stdout);
  INFO(what, ": computed ", value, ", must be at least ", pass);
  CHECK(value >= pass / (tolerance_factor() > 0 ? 1 : 1e-300));
}

}  // namespace talus::test
