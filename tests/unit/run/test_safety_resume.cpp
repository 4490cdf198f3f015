// talus safety that goes on where it was broken off: the trials that stood are taken from their states, and the answer has the
// bits of a search that was never stopped.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "talus/run/safety.h"

namespace test_safety_resume {

using namespace talus;

namespace {

// Two blocks in a row on a plane of 20 degrees; the upper one, rid of its load in the second stage, slides by then and is held by
// the lower one.
std::string row_of_two(const std::string& integration, const std::string& safety) {
  const auto box = [](const char* name, double x, double y, const char* kind) {
    return fmt::format(
        "[[block]]\nname = \"{}\"\npolygon = [[{}, {}], [{}, {}], [{}, {}], [{}, {}]]\nmaterial = \"m\"\nkind = \"{}\"\n",
        name, x, y, x + 1, y, x + 1, y + 1, x, y + 1, kind);
  };
  const auto joint = [](const char* name, const char* friction) {
    return fmt::format(
        "[joint.{}]\nfriction_angle = \"{}\"\nnormal_stiffness = \"1 GPa/m\"\nshear_stiffness = \"1 GPa/m\"\n",
        name, friction);
  };
  const auto pair = [](const char* one, const char* two, const char* of) {
    return fmt::format("[[contact_pair]]\nbetween = [\"{}\", \"{}\"]\njoint = \"{}\"\n", one, two, of);
  };
  const auto stage = [&](const char* name, const char* more) {
    return fmt::format("[[stage]]\nname = \"{}\"\nkind = \"static\"\nduration = 5\n{}{}", name, integration,
                       more);
  };
  return "talus = 1\n[model]\ngravity = [3.355, -9.218]\n[material.m]\ndensity = 2500\n" +
         joint("lower", "40 deg") + joint("upper", "30 deg") + joint("smooth", "0 deg") +
         "[contact]\njoint = \"smooth\"\n" +
         "[[block]]\nname = \"ground\"\npolygon = [[-9, -1], [9, -1], [9, 0], [-9, 0]]\nmaterial = \"m\"\nkind = \"fixed\"\n" +
         box("one", 0, 0, "rigid") + box("two", 1, 0, "rigid") + box("load", 0, 1, "rigid") +
         pair("ground", "one", "upper") + pair("ground", "two", "lower") + pair("load", "one", "lower") +
         stage("stand", "") + stage("dig", "excavate = [\"load\"]\n") +
         "[[change]]\nstage = \"dig\"\njoint = \"upper\"\nfriction_angle = \"12 deg\"\n[safety]\n" + safety;
}

struct Kept {
  std::vector<SafetyTrial> told;
  std::map<std::pair<double, double>, std::string> states;  // as files of them are
};

int threads() {
  int n = 0;
  for ([[maybe_unused]] const auto& task : std::filesystem::directory_iterator("/proc/self/task")) ++n;
  return n;
}

SafetyResult search(const PreparedRun& prepared, int jobs, Kept& kept, const Kept* before, int& taken) {
  SafetySettings settings;
  settings.jobs = jobs;
  settings.told = [&kept](const SafetyTrial& t) { kept.told.push_back(t); };
  settings.save = [&kept](const SafetyTrial& t, const Archive& a) {
    kept.states.insert_or_assign({t.factor, t.from}, archive_bytes(a));
  };
  if (before) settings.known = before->told;
  settings.saved = [before, &taken](const SafetyTrial& t) -> std::optional<Archive> {
    if (!before || before->states.count({t.factor, t.from}) == 0) return std::nullopt;
    CHECK(threads() == 1);  // or the copy of this process that reads a state waits for what another one held
    ++taken;
    return parse_archive("state", before->states.at({t.factor, t.from}));
  };
  return seek_safety(prepared, Workers(), settings);
}

}  // namespace

TEST_CASE("safety resumed: the answer and every trial have the bits of a search that was never broken off") {
  const std::string by_rest,
      by_motion = "integration = \"dynamic\"\ntime_step = \"2 ms\"\nunbalanced = 1e-4\n";
  const std::string lower = "joints = [\"lower\"]\ntolerance = 0.1\n";
  for (const auto& [safety, integration, jobs] :
       {std::tuple(lower, by_rest, 1), std::tuple(lower, by_rest, 3), std::tuple(lower, by_motion, 1),
        std::tuple(std::string("tolerance = 0.1\nlowest = 0.2\n"), by_rest, 1),
        std::tuple(std::string("by = \"tilt\"\ntolerance = 1\n"), by_rest, 1),
        std::tuple(std::string("by = \"acceleration\"\ntolerance = 0.05\n"), by_motion, 1)}) {
    CAPTURE(safety);
    CAPTURE(integration);
    CAPTURE(jobs);
    const std::string text = row_of_two(integration, safety);
    Findings findings("case.toml", text);
    const PreparedRun prepared = prepare_run("case.toml", text, {}, findings);
    Kept whole;
    int taken = 0;
    const SafetyResult all = search(prepared, jobs, whole, nullptr, taken);
    CHECK(all.status == SafetyStatus::kFound);
    REQUIRE(whole.told.size() > 3);
    const std::string csv = safety_csv(all);
    for (size_t n : {whole.told.size() / 2, whole.told.size() - 1}) {
      Kept cut{{whole.told.begin(), whole.told.begin() + n}, whole.states}, again;
      int64_t stood = 0;
      // run again their steps would be counted anew
      for (SafetyTrial& t : cut.told) t.steps = -1, stood += t.stands;
      REQUIRE(stood > 0);
      taken = 0;
      SafetyResult resumed = search(prepared, jobs, again, &cut, taken);
      CHECK(taken >= stood);
      REQUIRE(resumed.trials.size() == all.trials.size());
      for (size_t k = 0; k < all.trials.size(); ++k) {
        CHECK(resumed.trials[k].steps == (k < n ? -1 : all.trials[k].steps));
        resumed.trials[k].steps = all.trials[k].steps;
      }
      CHECK(safety_csv(resumed) == csv);
      CHECK(resumed.coarse == all.coarse);
    }
  }
}

}  // namespace test_safety_resume
