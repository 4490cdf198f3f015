// What talus safety says of its trials.

#include <doctest/doctest.h>

#include <string>

#include "talus/run/safety.h"

namespace test_safety_report {

using namespace talus;

namespace {

SafetyTrial trial(double factor, bool stands, const std::string& outcome, double displacement) {
  SafetyTrial t;
  t.factor = factor, t.stands = stands, t.outcome = outcome, t.displacement = displacement, t.block = "key";
  return t;
}

SafetyResult found(const SafetyTrial& stands, const SafetyTrial& fails) {
  SafetyResult r;
  r.trials = {stands, fails};
  r.stands = stands.factor, r.fails = fails.factor;
  return r;
}

bool doubts(const SafetyResult& r) { return safety_text(Model(), r).find("DOUBTFUL") != std::string::npos; }

}  // namespace

TEST_CASE("safety report: a trial without rest in which hardly anything moved is doubtful") {
  const SafetyTrial stands = trial(1.5, true, "at rest", 1e-4);
  CHECK(doubts(found(stands, trial(1.6, false, "no rest", 5e-4))));
  CHECK(!doubts(found(stands, trial(1.6, false, "no rest", 5e-2))));
  CHECK(!doubts(found(stands, trial(1.6, false, "displacement limit", 5e-4))));
  SafetyResult below;
  below.status = SafetyStatus::kBelow;
  below.trials = {trial(0.5, false, "no rest", 1e-5)};
  below.fails = 0.5;
  CHECK(doubts(below));
  SafetyResult above;
  above.status = SafetyStatus::kAbove;
  above.trials = {trial(4, true, "at rest", 1e-5)};
  above.stands = 4;
  CHECK(!doubts(above));
}

}  // namespace test_safety_report
