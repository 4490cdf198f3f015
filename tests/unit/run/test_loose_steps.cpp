// Steps above solver.tolerance and within solver.limit: the run goes on, and everything that tells of it says so.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "support/folder.h"
#include "support/relative.h"
#include "talus/audit/read_results.h"
#include "talus/base/error.h"
#include "talus/output/csv.h"
#include "talus/results/progress.h"
#include "talus/results/recorder.h"
#include "talus/run/safety.h"
#include "talus/run/saved_state.h"
#include "talus/run/trial.h"

namespace test_loose_steps {

using namespace talus;
using namespace talus::test;

namespace {

// Two bricks on a floor that is shaken.
const std::string kBricks = R"m(
talus = 1
[model]
gravity = [0, -9.81]
[material.m]
density = 2000
young = "1 GPa"
poisson = 0.2
[joint.face]
friction_angle = "30 deg"
normal_stiffness = "2 GPa/m"
shear_stiffness = "2 GPa/m"
[contact]
joint = "face"
[history.v]
expression = "0.3*sin(60*t)"
duration = "1 s"
[[block]]
name = "floor"
polygon = [[-2, -1], [4, -1], [4, 0], [-2, 0]]
material = "m"
kind = "driven"
motion_x = { velocity = "v" }
[[grid]]
name = "wall"
min = [0, 0]
max = [2, 1]
cells = [1, 2]
material = "m"
joint = "face"
)m";
const std::string kShaken = kBricks + R"([[stage]]
name = "shake"
kind = "dynamic"
duration = "50 ms"
time_step = "0.2 ms"
[output]
field_interval = "10 ms"
)";

// What no step with a force reaches; solvers need not try for long.
const std::vector<std::string> kOutOfReach{"solver.tolerance=1e-300", "solver.max_sweeps=100"};

struct Ran {
  PreparedRun prepared;
  RunResult result;
  State state;
};

class Nobody : public Observer {
  void at(const Instant&) override {}
};

Ran run(const std::string& text, const std::vector<std::string>& overrides, Observer* observer = nullptr) {
  Findings findings("m.toml", text);
  Ran r{prepare_run("m.toml", text, overrides, findings), {}, {}};
  r.state = start_state(r.prepared.scene);
  Nobody nobody;
  r.result = run_stages(r.prepared.scene, r.prepared.plans, r.state, observer ? *observer : nobody);
  return r;
}

// The same into a folder of results; the closing lines of talus run.
std::string recorded(const Folder& f, const std::string& text, const std::vector<std::string>& overrides) {
  Findings findings("m.toml", text);
  PreparedRun p = prepare_run("m.toml", text, overrides, findings);
  Recorder recorder(p.scene, ResultFolder(f / "out", true));
  State state = start_state(p.scene);
  const RunResult result = run_stages(p.scene, p.plans, state, recorder);
  recorder.finish(result);
  return closing_text(p.scene, result, recorder.joints(), recorder.bolts(), "out", recorder.audit());
}

void edit(const std::filesystem::path& file, const std::string& from, const std::string& to) {
  std::string text = content(file);
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  std::ofstream(file) << text.replace(at, from.size(), to);
}

// Zeros in these columns of a table.
void empty_columns(const std::filesystem::path& file, const std::set<std::string>& emptied) {
  const std::string text = content(file);
  const CsvTable t = read_csv(file);
  std::string forged = text.substr(0, text.find('\n') + 1);
  for (size_t r = 0; r < t.rows(); ++r)
    for (size_t c = 0; c < t.columns.size(); ++c)
      forged += fmt::format("{:.17g}{}", emptied.count(t.columns[c]) > 0 ? 0 : t.values[c][r],
                            c + 1 < t.columns.size() ? "," : "\n");
  std::ofstream(file) << forged;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const audit::Report::Entry& loose_in(const audit::FolderAudit& a) {
  return a.report.of(audit::Defect::kLooseSteps);
}

}  // namespace

TEST_CASE("loose steps: the run goes on over them, and counts them") {
  const Ran loose = run(kShaken, kOutOfReach), solved = run(kShaken, {});
  CHECK(loose.result.failure == "");
  CHECK(loose.result.failed_steps == 0);
  CHECK(loose.result.loose_steps > 150);
  CHECK(loose.result.loose_steps <= loose.result.steps);
  CHECK(loose.result.worst_error > 0);
  CHECK(loose.result.worst_error <= 1e-5);
  CHECK(has(loose.result.worst_error_row, "contact "));
  CHECK(solved.result.loose_steps == 0);
  // all solvers have tried: that no step is solved makes none worse
  CHECK(loose.result.worst_error <= solved.result.worst_error);
  CHECK(loose.state.displacement[2].x == approx(solved.state.displacement[2].x).epsilon(1e-4));
}

TEST_CASE("loose steps: above the limit a step fails, and a limit that is the tolerance leaves none loose" *
          doctest::test_suite("optimised")) {
  for (const char* limit : {"1e-300", "1e-290"}) {
    std::vector<std::string> overrides = kOutOfReach;
    overrides.push_back(std::string("solver.limit=") + limit);
    overrides.push_back(
        "stage.shake.duration=\"5 ms\"");  // a step that fails is tried in 64 parts, by all solvers
    const Ran stopped = run(kShaken, overrides);
    CHECK(has(stopped.result.failure, "the contact equations were not solved"));
    CHECK(has(stopped.result.failure, fmt::format("allowed {}", limit)));
    CHECK(stopped.result.failed_steps == 1);
    CHECK(stopped.result.loose_steps == 0);
    overrides.push_back("solver.on_failure=\"continue\"");
    const Ran counted = run(kShaken, overrides);
    CHECK(counted.result.failed_steps > 15);
    CHECK(counted.result.loose_steps == 0);
  }
}

TEST_CASE("loose steps: the smoothed law has none, as its error is no measure of a step") {
  Findings findings("m.toml", kShaken);
  PreparedRun p = prepare_run(
      "m.toml", kShaken, {"solver.tolerance=1e-300", "contact.law=\"smoothed\"", "solver.max_iterations=1"},
      findings);
  p.scene.model.solver.limit = 1e-2;  // which no file may give
  State state = start_state(p.scene);
  Nobody nobody;
  const RunResult r = run_stages(p.scene, p.plans, state, nobody);
  CHECK(has(r.failure, "a wider solver.tolerance may help"));
  CHECK(r.loose_steps == 0);
}

TEST_CASE("loose steps: one from rest is taken again with half the length as long as it can be" *
          doctest::test_suite("optimised")) {
  const std::string text = kBricks + R"([[stage]]
name = "rest"
kind = "static"
duration = "20 s"
integration = "implicit"
unbalanced = 1e-9
)";
  struct Lengths : Observer {
    void at(const Instant& i) override {
      double& longest = i.report.loose ? loose : solved;
      if (!i.last) longest = std::max(longest, i.work.clock.dt / i.plan.dt);
    }
    double loose = 0, solved = 0;  // longest such step, as share of the first length
  } out_of_reach, usual;
  const Ran r = run(text, kOutOfReach, &out_of_reach), s = run(text, {}, &usual);
  CHECK(r.result.failure == "");
  CHECK(r.result.failed_steps == 0);
  CHECK(r.result.loose_steps > 0);
  CHECK(out_of_reach.loose == 1.0 / kMostShortened);
  CHECK(s.result.loose_steps == 0);
  CHECK(usual.solved >= 1);
}

TEST_CASE("loose steps: the trial of a solver calls what few sweeps leave no solution") {
  Findings findings("m.toml", kShaken);
  const PreparedRun p = prepare_run("m.toml", kShaken, {"solver.tolerance=1e-300"}, findings);
  CHECK(time_stages(p, 0.05, 1, 0).at(0).at_least);
}

TEST_CASE("loose steps: a search for what a model bears allows them, and no failed ones" *
          doctest::test_suite("optimised")) {
  // a block on a slope of 20 degrees, friction 30
  const std::string text = R"(
talus = 1
[model]
gravity = [3.3552, -9.2184]
[material.m]
density = 2000
[joint.face]
friction_angle = "30 deg"
[contact]
joint = "face"
[[block]]
name = "slope"
polygon = [[-3, -1], [5, -1], [5, 0], [-3, 0]]
material = "m"
kind = "fixed"
[[block]]
name = "block"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "m"
kind = "rigid"
[[stage]]
name = "stand"
kind = "static"
duration = 2
time_step = 5e-3
[safety]
lowest = 1.4
highest = 1.8
tolerance = 0.41
)";
  const auto seek = [&](std::vector<std::string> more) {
    Findings findings("m.toml", text);
    more.insert(more.begin(), kOutOfReach.begin(), kOutOfReach.end());
    return seek_safety(prepare_run("m.toml", text, more, findings), Workers());
  };
  const SafetyResult r = seek({});
  CHECK(r.stands == 1.5);  // rungs beside tan 30 / tan 20 = 1.586
  CHECK(r.fails == 1.6);
  CHECK_THROWS_WITH_AS(seek({"solver.limit=1e-300"}), doctest::Contains("says nothing of safety"),
                       NumericalError);
}

TEST_CASE("loose steps: the folder, the closing lines and the audit tell them") {
  const Folder f;
  const std::string closing = recorded(f, kShaken, kOutOfReach);
  CHECK(has(closing, " steps not solved, "));
  CHECK(has(closing, " loose (above the tolerance, within solver.limit)"));
  CHECK(has(closing, "valid, with warnings"));
  CHECK(has(closing, "warning: loose steps: "));

  const auto summary = nlohmann::json::parse(content(f / "out/summary.json"));
  const int64_t loose = summary["solver"]["loose_steps"];
  CHECK(loose > 150);
  CHECK(summary["solver"]["failed_steps"] == 0);
  CHECK(summary["valid"] == true);
  double in_table = 0;
  const CsvTable steps = read_csv(f / "out/steps.csv");
  for (const double n : steps.column("loose steps")) in_table += n;
  CHECK(in_table == static_cast<double>(loose));

  const audit::FolderAudit a = audit::audit_folder(f / "out");
  CHECK(a.report.valid());
  REQUIRE(loose_in(a).count == 1);
  CHECK(has(closing, loose_in(a).worst.text));

  const Folder g;
  const std::string usual = recorded(g, kShaken, {});
  CHECK(has(usual, "; 0 of 251 steps not solved; "));
  CHECK_FALSE(has(usual, "loose"));
  CHECK(loose_in(audit::audit_folder(g / "out")).count == 0);
}

TEST_CASE("loose steps: what they leave is no finding of its own, in the run and from its folder") {
  // two sweeps leave errors of a tenth of what joints close by
  const Folder f;
  const std::string closing =
      recorded(f, kShaken,
               {"solver.tolerance=1e-12", "solver.limit=1e-2", "solver.method=\"gauss_seidel\"",
                "solver.second_solver=false", "solver.max_sweeps=2"});
  CHECK(has(closing, "valid, with warnings"));
  const auto summary = nlohmann::json::parse(content(f / "out/summary.json"));
  CHECK(summary["solver"]["contact_error_worst [m]"] > 1e-7);
  REQUIRE(summary["audit"]["defects"].size() == 1);
  CHECK(summary["audit"]["defects"][0]["kind"] == "loose_steps");
  const auto only_loose = [&f] {
    const audit::FolderAudit a = audit::audit_folder(f / "out");
    return a.report.valid() && a.report.warning_kinds() == 1 && loose_in(a).count == 1;
  };
  CHECK(only_loose());
  // the table of a branch has none of the steps before it
  empty_columns(f / "out/steps.csv", {"loose steps", "contact error [m]"});
  CHECK(only_loose());
}

TEST_CASE("loose steps: a folder that hides them is found out") {
  const Folder f;
  recorded(f, kShaken, kOutOfReach);
  const auto summary = f / "out/summary.json", steps = f / "out/steps.csv";
  const auto audited = [&f] { return audit::audit_folder(f / "out"); };
  const std::string told = loose_in(audited()).worst.text, sound = content(summary), table = content(steps);
  const int64_t loose = nlohmann::json::parse(sound)["solver"]["loose_steps"];
  const std::string count = fmt::format("\"loose_steps\": {}", loose);

  edit(summary, count, "\"loose_steps\": 0");  // the table has them
  CHECK(loose_in(audited()).worst.text == told);

  // and where that hides them too, its errors tell
  empty_columns(steps, {"loose steps"});
  CHECK(loose_in(audited()).worst.text == told);

  // errors above the limit are of failed steps
  const double limit = nlohmann::json::parse(sound)["model"]["contact_limit [m]"];
  edit(summary, fmt::format("\"contact_limit [m]\": {}", nlohmann::json(limit).dump()),
       "\"contact_limit [m]\": 1e-200");
  CHECK_FALSE(audited().report.valid());
  CHECK(audited().report.of(audit::Defect::kFailedSteps).worst.invalid);

  std::ofstream(steps) << table;
  const auto refused = [&](const std::string& wrong, const std::string& what) {
    std::ofstream(summary) << sound;
    edit(summary, count, wrong);
    CHECK_THROWS_WITH_AS(audited(), doctest::Contains(what.c_str()), FileError);
  };
  refused("\"loose_steps\": -1", "solver.loose_steps is -1, which is no number of steps");
  refused("\"loose_steps\": \"x\"", "solver.loose_steps is \"x\", which is no number of steps");
  refused("\"loose_steps\": 100000", "0 steps failed and 100000 are loose of 251: talus did not write that");
  std::ofstream(summary) << sound;
  edit(steps, "loose steps", "lose steps");
  CHECK_THROWS_WITH_AS(audited(), doctest::Contains("there is no column \"loose steps\""), FileError);
}

TEST_CASE("loose steps: the audit warns from one per cent of them on") {
  const auto warns = [](int64_t loose, int64_t steps) {
    audit::Report report;
    audit::add_loose(loose, steps, 0.5, 1e-9, report);
    CHECK(report.valid());
    return report.warning_kinds() == 1;
  };
  CHECK(warns(1, 100));
  CHECK_FALSE(warns(1, 101));
  CHECK_FALSE(warns(0, 0));
  CHECK(warns(1, 1));
}

TEST_CASE("loose steps: a saved state keeps their number, and the audit of a run that goes on") {
  struct Keeper : Observer {
    explicit Keeper(const Scene& scene) : auditor(scene) {}
    void at(const Instant& i) override { auditor.at(i, false); }
    Auditor auditor;
  };
  const Ran whole = run(kShaken, kOutOfReach);
  Findings findings("m.toml", kShaken);
  PreparedRun p = prepare_run("m.toml", kShaken, kOutOfReach, findings);
  State state = start_state(p.scene);
  Keeper first(p.scene);
  StagedRun begun(p.scene, p.plans, state, first);
  begun.advance({.steps = 100});
  const int64_t so_far = begun.standing().result.loose_steps;
  CHECK(so_far > 50);
  Archive archive = run_archive(p.scene, begun.standing(), state);
  Saver saver(archive);
  first.auditor.save(saver);

  PreparedRun again = prepare_run("m.toml", kShaken, kOutOfReach, findings);
  SavedRun saved = saved_run_of("state.h5", archive, again);
  CHECK(saved.standing.result.loose_steps == so_far);
  Keeper second(again.scene);
  Loader loader(archive);
  second.auditor.load(loader);
  const auto text = [](const Keeper& k) {
    return k.auditor.report().of(audit::Defect::kLooseSteps).worst.text;
  };
  CHECK(text(second) == text(first));
  const RunResult end = continue_stages(again.scene, again.plans, saved.standing, saved.state, second);
  CHECK(end.loose_steps == whole.result.loose_steps);
  CHECK(has(text(second), fmt::format("{} of {} steps", end.loose_steps, end.steps)));

  archive.numbers.at("run.loose_steps") = {-1};
  CHECK_THROWS_WITH_AS(saved_run_of("state.h5", archive, again),
                       doctest::Contains("it has counted less than nothing"), FileError);
}

}  // namespace test_loose_steps
