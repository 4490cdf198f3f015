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
  // on a ladder ways are counted from before anything was raised: it is what each trial adds that tells
  SafetyTrial before = trial(1.4, true, "at rest", 2e-2), last = trial(1.5, true, "at rest", 2.01e-2),
              fails = trial(1.6, false, "no rest", 2.05e-2);
  before.from = 1.3, last.from = 1.4, fails.from = 1.5;
  const auto ladder = [&] {
    SafetyResult r = found(last, fails);
    r.trials.insert(r.trials.begin(), before);
    return r;
  };
  CHECK(doubts(ladder()));
  fails.displacement = 4e-2;
  CHECK(!doubts(ladder()));
  SafetyResult below;
  below.status = SafetyStatus::kBelow;
  below.trials = {trial(0.5, false, "no rest", 1e-5)};
  below.fails = 0.5;
  CHECK(doubts(below));
  const auto text_has = [&](const std::string& part) {
    return safety_text(Model(), below).find(part) != std::string::npos;
  };
  CHECK(text_has("below 0.5, the lowest tried"));
  below.stands = 0.4;  // on a ladder that was only stopped
  CHECK(text_has("between 0.4 and 0.5, and sought no further below safety.lowest"));
  SafetyResult above;
  above.status = SafetyStatus::kAbove;
  above.trials = {trial(4, true, "at rest", 1e-5)};
  above.stands = 4;
  CHECK(!doubts(above));
}

}  // namespace test_safety_report
