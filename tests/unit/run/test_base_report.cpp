// What a base tells of its motion before a run: the main frequency.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/relative.h"
#include "talus/run/base_report.h"

namespace test_base_report {

using namespace talus;

namespace {

History sine(double frequency, double duration) {
  constexpr int kPoints = 2000;
  History out;
  for (int i = 0; i <= kPoints; ++i) {
    out.time.push_back(duration * i / kPoints);
    out.value.push_back(std::sin(2 * std::numbers::pi * frequency * out.time.back()));
  }
  return out;
}

}  // namespace

// The frequencies of a window of 5 s are 0.2 Hz apart, and 2.3 Hz lies between two; sought in sixteenths of that.
TEST_CASE("the main frequency of a motion does not go by the length of its record") {
  CHECK(std::abs(dominant_frequency(sine(2.3, 5)) - 2.3) < 0.2 / 16);
}

// The spectrum of half a sine is largest at 0 Hz, where it tells the mean; a record tells nothing below one wave in it.
TEST_CASE("the main frequency of a pulse is not below one wave in its record") {
  CHECK(dominant_frequency(sine(1, 0.5)) == test::approx(2).epsilon(1e-12));
}

TEST_CASE("what does not move has no main frequency") { CHECK(dominant_frequency(sine(0, 1)) == 0); }

}  // namespace test_base_report
