#include "talus/results/pace.h"

#include <doctest/doctest.h>

using namespace talus;

namespace {

// Shown once a second; a step at time t takes `step(t)`.
template <class Step>
Pace paced(double wall, Step step) {
  Pace pace;
  double steps = 0;
  pace.begin(0, 0);
  for (double t = 1; t <= wall; t += 1) steps += 1 / step(t), pace.add(t, steps);
  return pace;
}

}  // namespace

TEST_CASE("pace: steps that all take as long take as long") {
  const Pace::Range r = paced(7, [](double) { return 0.25; }).of(100);
  CHECK(r.low == doctest::Approx(25));
  CHECK(r.high == doctest::Approx(25));
}

TEST_CASE(
    "pace: where steps have become four times as dear, the range goes from the pace of all to that of now") {
  const Pace::Range r = paced(20, [](double t) { return t <= 10 ? 0.25 : 1.0; }).of(100);
  CHECK(r.high == doctest::Approx(100));
  CHECK(r.low == doctest::Approx(100 * 20 / 50.0));
}

TEST_CASE("pace: where steps have become cheaper, from that of now to the pace of all") {
  const Pace::Range r = paced(20, [](double t) { return t <= 10 ? 1.0 : 0.25; }).of(100);
  CHECK(r.low == doctest::Approx(25));
  CHECK(r.high == doctest::Approx(100 * 20 / 50.0));
}

TEST_CASE("pace: nothing is said before a step is over, and the first word is of all that is over") {
  Pace pace;
  pace.begin(3, 10);
  CHECK(pace.of(5).high == 0);
  pace.add(4, 10);
  CHECK(pace.of(5).high == 0);
  pace.add(5, 14);
  CHECK(pace.of(2).low == doctest::Approx(0.5));
  CHECK(pace.of(2).high == doctest::Approx(1));
}

TEST_CASE("pace: ends within a tenth of each other are written as one") {
  CHECK(readable_range({10, 10.5}) == "10.5 s");
  CHECK(readable_range({12, 180}) == "12 s to 3 min 00 s");
}
