// Studies: the plan, distributions, fragility, answers, the folder that several processes share.

#include "talus/study/study.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "support/folder.h"
#include "support/relative.h"
#include "talus/base/error.h"
#include "talus/base/text_file.h"
#include "talus/output/folder_lock.h"
#include "talus/output/summary_seal.h"
#include "talus/study/answers.h"
#include "talus/study/figures.h"
#include "talus/study/folder.h"
#include "talus/study/fragility.h"
#include "talus/study/gather.h"
#include "talus/study/normal.h"

namespace test_study {

using namespace talus;
using namespace talus::study;
using talus::test::Folder;

namespace {

Study read(const std::string& text, const std::string& file = "study.toml") {
  Findings findings(file, text);
  Study s = read_study(file, text, findings);
  findings.throw_if_errors();
  return s;
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// As a run seals it.
std::string sealed(const std::string& summary) {
  const auto j = nlohmann::ordered_json::parse(summary, nullptr, false);
  return j.is_object() ? sealed_summary(j) : summary;
}

const std::string kHead = "talus_study = 1\nmodel = \"m.toml\"\n";

}  // namespace

TEST_CASE(
    "study: listed keys make every combination, the last one fastest, sampled ones are drawn for each") {
  const Study s =
      read(kHead +
           "set = [\"solver.tolerance=1e-7\"]\n"
           "[[vary]]\nkey = \"variables.phi\"\nvalues = [\"28 deg\", \"30 deg\"]\n"
           "[[vary]]\nkey = \"cut.seed\"\nrange = { from = 1, to = 3, count = 3 }\n"
           "[[vary]]\nkey = \"variables.c\"\ndistribution = { from = \"1 kPa\", to = \"2 kPa\" }\n"
           "[sampling]\nruns = 5\nseed = 4\n");
  const std::vector<PlannedRun> plan = plan_runs(s);
  REQUIRE(plan.size() == 2 * 3 * 5);
  CHECK(plan[0].overrides[0] == "solver.tolerance=1e-7");
  CHECK(plan[0].overrides[1] == "variables.phi=\"28 deg\"");
  CHECK(plan[0].overrides[2] == "cut.seed=1");
  CHECK(plan[5].overrides[2] == "cut.seed=2");
  CHECK(plan[15].overrides[1] == "variables.phi=\"30 deg\"");
  CHECK(s.axes[0].title() == "phi [deg]");
  // the same five samples for each combination, one in each fifth of the range
  std::set<int> fifths;
  for (size_t i = 0; i < 5; ++i) {
    CHECK(plan[i].overrides[3] == plan[i + 5].overrides[3]);
    CHECK(plan[i].overrides[3].rfind("variables.c=\"1.", 0) == 0);
    fifths.insert(static_cast<int>((plan[i].values[2].number - 1) * 5));
  }
  CHECK(fifths.size() == 5);
}

TEST_CASE("study: values of a range are those that one would write") {
  const Study s =
      read(kHead + "[[vary]]\nkey = \"a\"\nrange = { from = \"0.1 g\", to = \"0.6 g\", count = 6 }\n");
  std::string all;
  for (const AxisValue& v : s.axes[0].values) all += v.toml + " ";
  CHECK(all == "\"0.1 g\" \"0.2 g\" \"0.3 g\" \"0.4 g\" \"0.5 g\" \"0.6 g\" ");
}

TEST_CASE("study: motions are scaled to their measures") {
  const Folder folder;
  for (const auto& [name, peak] : {std::pair("one", 2.0), std::pair("two", 4.0)}) {
    std::ofstream out(folder / (std::string(name) + ".csv"));
    out << "time [s],acceleration [m/s2]\n0,0\n0.01," << peak << "\n0.02,0\n0.03," << -peak / 2
        << "\n0.04,0\n";
  }
  const Study s = read(
      kHead +
          "[[vary]]\nname = \"motion\"\nkey = \"variables.file\"\nfiles = \"[ot][nw][eo].csv\"\n"
          "[[vary]]\nname = \"pga\"\nkey = \"variables.scale\"\nvalues = [\"0.5 g\", \"1 g\"]\nmeasure = \"PGA\"\n",
      (folder / "study.toml").string());
  const std::vector<PlannedRun> plan = plan_runs(s);
  REQUIRE(plan.size() == 4);
  CHECK(plan[0].values[0].shown == "one");
  CHECK(plan[0].overrides[1] == "variables.scale=2.4516625");
  CHECK(plan[2].overrides[1] == "variables.scale=1.22583125");
  CHECK(plan[1].overrides[1] == "variables.scale=4.903325");  // 9.80665 / 2
  CHECK(s.over == "pga");
}

TEST_CASE("study: wrong input is told with its place") {
  const std::string vary = "[[vary]]\nkey = \"a\"\nvalues = [1, 2]\n";
  struct Wrong {
    std::string text;
    std::vector<std::string> parts;
  };
  const std::vector<Wrong> cases = {
      {"talus_study = 1\n" + vary, {"model", "is missing"}},
      {kHead, {"vary", "nothing varies"}},
      {kHead + vary + "[failure]\nwen = \"x\"\n", {"study.toml:7", "failure.wen"}},
      {kHead + "[[vary]]\nkey = \"a\"\n",
       {"study.toml:3", "vary.0", "give one of values, range, files, distribution"}},
      {kHead + "[[vary]]\nkey = \"a\"\nvalues = [1]\nrange = { from = 1, to = 2, count = 2 }\n",
       {"more than one way"}},
      {kHead + "[[vary]]\nkey = \"a\"\nvalues = []\n", {"vary.0.values", "no list of values"}},
      {kHead + "[[vary]]\nkey = \"a\"\nrange = { from = 1, to = \"2 m\", count = 2 }\n",
       {"vary.0.range", "both in one unit"}},
      {kHead + "[[vary]]\nkey = \"a\"\ndistribution = { mean = 1, normal = 0 }\n", {"deviation > 0"}},
      {kHead + "[[vary]]\nkey = \"a\"\ndistribution = { mean = 1, normal = 1 }\n",
       {"sampling.runs", "is missing"}},
      {kHead + "[[vary]]\nkey = \"a\"\nfiles = \"nothing/*.csv\"\n", {"vary.0.files", "are no files"}},
      {kHead + vary + vary, {"a second [[vary]] is called \"a\""}},
      {kHead + vary + "[sampling]\nruns = 3\n", {"draws nothing"}},
      {kHead + "[[vary]]\nkey = \"s\"\nvalues = [\"1 g\"]\nmeasure = \"PGA\"\n",
       {"scales a motion", "add a [[vary]] with files"}},
      {kHead + "[[vary]]\nkey = \"s\"\nvalues = [\"1 m\"]\nmeasure = \"PGA\"\n", {"1 m", "PGA"}},
      {kHead + "[[vary]]\nkey = \"s\"\nvalues = [1]\nmeasure = \"Sb\"\n",
       {"\"Sb\" is not known", "Sa(0.5 s)"}},
      {kHead + vary + "[fragility]\nover = \"b\"\n", {"fragility.over", "there is a"}},
      {kHead + vary + "report = 1\n", {"vary.0.report"}},
      {kHead + vary + "[answer]\nx = \"1\"\n", {"did you mean \"answers\""}},
      {kHead + "keep = \"answers\"\nreport = true\n" + vary, {"report", "keep = \"all\""}},
      {kHead +
           "[[vary]]\nkey = \"a\"\nrange = { from = 1, to = 2, count = 2000 }\n[[vary]]\nkey = \"b\"\nrange = { from = 1, to = 2, count = 2000 }\n",
       {"4e+06 runs"}},
  };
  for (const Wrong& w : cases) {
    const std::string said = refusal(w.text);
    for (const std::string& part : w.parts) {
      INFO(said, "\nshould hold: ", part);
      CHECK(said.find(part) != std::string::npos);
    }
  }
}

TEST_CASE("study: quantiles of distributions") {
  CHECK(normal_quantile(0.975) == test::approx(1.959963984540054).epsilon(1e-14));
  CHECK(normal_quantile(1e-6) == test::approx(-4.753424308822899).epsilon(1e-12));
  const Distribution normal{Distribution::kNormal, 30, 2};
  CHECK(normal.quantile(0.975) == test::approx(33.919927969080108).epsilon(1e-13));
  // lognormal: mean and deviation of the quantity itself, by integrating its quantile
  const Distribution log{Distribution::kLognormal, 5, 1.5};
  double mean = 0, square = 0;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double x = log.quantile((i + 0.5) / n);
    mean += x / n, square += x * x / n;
  }
  // midpoints miss a little of the tail
  CHECK(mean == test::approx(5).epsilon(1e-5));
  CHECK(std::sqrt(square - mean * mean) == test::approx(1.5).epsilon(1e-3));
  // cut off at both sides: the middle stays where it is symmetric, and the ends are reached
  const Distribution cut{Distribution::kNormal, 30, 2, 28, 32};
  CHECK(cut.quantile(0.5) == test::approx(30).epsilon(1e-12));
  CHECK(cut.quantile(1e-12) == test::approx(28).epsilon(1e-9));
  CHECK(Distribution{Distribution::kUniform, 3, 1}.quantile(0.25) == 2.5);
}

TEST_CASE("study: a fragility curve is where the likelihood is greatest") {
  const std::vector<FragilityPoint> points{
      {0.2, 50, 2}, {0.4, 50, 11}, {0.6, 50, 27}, {0.8, 50, 38}, {1.0, 50, 44}};
  const Fragility f = fit_fragility(points);
  REQUIRE(f.found());
  const auto likelihood = [&](double median, double beta) {
    double sum = 0;
    for (const FragilityPoint& p : points) {
      const double q = 0.5 * std::erfc(-std::log(p.intensity / median) / (beta * std::sqrt(2)));
      sum += p.damaged * std::log(q) + (p.runs - p.damaged) * std::log1p(-q);
    }
    return sum;
  };
  // nothing beside it is better, by a search that knows no derivative
  const double best = likelihood(f.median, f.beta);
  for (const double dm : {-1e-4, 0.0, 1e-4})
    for (const double db : {-1e-4, 0.0, 1e-4}) CHECK(likelihood(f.median * (1 + dm), f.beta + db) <= best);
  // and it is where that search comes to
  double median = 0.5, beta = 0.5, step = 0.1;
  while (step > 1e-9) {
    bool moved = false;
    for (const auto& [dm, db] :
         {std::pair(step, 0.0), std::pair(-step, 0.0), std::pair(0.0, step), std::pair(0.0, -step)})
      if (likelihood(median * (1 + dm), beta + db) > likelihood(median, beta))
        median *= 1 + dm, beta += db, moved = true;
    if (!moved) step *= 0.5;
  }
  CHECK(f.median == test::approx(median).epsilon(1e-6));
  CHECK(f.beta == test::approx(beta).epsilon(1e-6));
  // the error of ln(median) by the curvature of the likelihood, beta being free: profile
  const auto profile = [&](double log_median) {
    double low = 0.05, high = 3;
    while (high - low > 1e-10) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      if (likelihood(std::exp(log_median), a) < likelihood(std::exp(log_median), b))
        low = a;
      else
        high = b;
    }
    return likelihood(std::exp(log_median), low);
  };
  const double h = 1e-3, m = std::log(f.median),
               curvature = -(profile(m + h) - 2 * profile(m) + profile(m - h)) / (h * h);
  // expected instead of observed information: equal for large samples
  CHECK(f.median_error == test::approx(1 / std::sqrt(curvature)).epsilon(0.03));
  // the band holds the curve, and is wider where there are no runs
  CHECK(f.band(0.6, -1.645) < f.probability(0.6));
  CHECK(f.band(0.6, 1.645) > f.probability(0.6));
}

TEST_CASE(
    "study: a fragility curve of thousands of intensities, each of one run, is that of the distribution drawn from") {
  // capacities lognormal: median 4, beta 0.3; a run is damaged when its intensity is above
  constexpr int kRuns = 20000;
  std::vector<FragilityPoint> points;
  for (int i = 0; i < kRuns; ++i) {
    const double x = 1 + 9 * (i + 0.5) / kRuns, u = std::fmod(0.5 + i * 0.6180339887498949, 1.0);
    points.push_back({x, 1, x > 4 * std::exp(0.3 * normal_quantile(std::clamp(u, 1e-9, 1 - 1e-9))) ? 1 : 0});
  }
  const Fragility f = fit_fragility(points);
  INFO(f.trouble);
  REQUIRE(f.found());
  // four standard errors
  CHECK(std::abs(std::log(f.median / 4)) < 4 * f.median_error);
  CHECK(std::abs(f.beta - 0.3) < 4 * f.beta_error);
  CHECK(f.median_error < 0.01);
}

TEST_CASE("study: where there is no fragility curve, it says why") {
  CHECK(fit_fragility({{1, 5, 0}, {2, 5, 0}}).trouble.find("no run is in this state") != std::string::npos);
  CHECK(fit_fragility({{1, 5, 5}, {2, 5, 5}}).trouble.find("every run") != std::string::npos);
  CHECK(fit_fragility({{1, 5, 0}, {2, 5, 5}}).trouble.find("levels between") != std::string::npos);
  CHECK(fit_fragility({{1, 5, 0}, {2, 5, 2}, {3, 5, 5}}).trouble.find("only at 2 some runs") !=
        std::string::npos);
  CHECK(fit_fragility({{1, 50, 0}, {2, 50, 20}, {3, 50, 49}}).found());
  CHECK(fit_fragility({{1, 5, 3}}).trouble.find("one intensity") != std::string::npos);
  CHECK(fit_fragility({{1, 50, 40}, {2, 50, 10}}).trouble.find("does not grow") != std::string::npos);
  CHECK(!fit_fragility({}).found());
}

TEST_CASE("study: formulas name what runs answer") {
  const auto summary = nlohmann::json::parse(R"({
    "stages": [{"name": "rest"}, {"name": "big shake"}],
    "joints": {"slip_largest [m]": 0.25, "slipped": 3},
    "monitors": {"top left": {"peak_velocity [m/s]": 2,
      "stages": {"rest": {"displacement_x [m]": {"least": -1, "greatest": 0.5, "residual": 0.1}},
                 "big shake": {"displacement_x [m]": {"least": -0.5, "greatest": 0.25, "residual": null}}}}}})");
  Numbers n = numbers_of(summary);
  CHECK(n.at("joints.slip_largest") == 0.25);
  CHECK(n.at("top_left.peak_velocity") == 2);
  CHECK(n.at("top_left.displacement_x.largest") == 0.5);
  CHECK(n.at("rest.top_left.displacement_x.largest") == 1);
  CHECK(n.at("big_shake.top_left.displacement_x.greatest") == 0.25);
  const Study s = read(
      kHead +
      "[[vary]]\nkey = \"a\"\nvalues = [1]\n[answers]\n"
      "drift = \"top_left.displacement_x.largest / 2.5\"\ntwice = \"2 * drift\"\nleft = \"top_left.displacement_x.residual\"\n"
      "[failure.slight]\nwhen = \"drift > 0.1\"\n[failure.total]\nwhen = \"drift > 0.1 && joints.slipped > 3\"\n");
  std::string trouble;
  const std::vector<double> answers = evaluate_answers(s, n, trouble);
  CHECK(answers[0] == 0.2);
  CHECK(answers[1] == 0.4);
  CHECK(std::isnan(answers[2]));
  CHECK(is_damaged(s.states[0], n, trouble) == 1);
  CHECK(is_damaged(s.states[1], n, trouble) == 0);
  CHECK(trouble.empty());
  // before anything runs: what there can be is known by columns and stages
  const Numbers possible = possible_numbers({"top left.displacement_x [m]"}, {"rest", "big shake"});
  Findings findings("study.toml", s.text);
  check_formulas(s, possible, findings);
  CHECK(!findings.has_errors());
  const Study wrong = read(
      kHead +
      "[[vary]]\nkey = \"a\"\nvalues = [1]\n[answers]\ndrift = \"top_left.displacement_x.larges\"\n[failure]\nwhen = \"drif > 1\"\n");
  Findings told("study.toml", wrong.text);
  check_formulas(wrong, possible, told);
  CHECK(told.error_count() == 2);
  CHECK(told.render().find("top_left.displacement_x has at_end, at_start, greatest") != std::string::npos);
}

TEST_CASE("study: the folder takes a run whole or not at all, and the first of two") {
  const Folder scratch;
  std::ofstream(scratch / "m.toml") << "talus = 1\n";
  const std::string model = (scratch / "m.toml").string();
  const auto study_of = [&](const std::string& values, const std::string& more = "") {
    return read(kHead + "[[vary]]\nkey = \"a\"\n" + values + "\n" + more, (scratch / "study.toml").string());
  };
  const auto begin = [&](StudyFolder& folder, const Study& s, const std::string& program = "talus test") {
    std::vector<PlannedRun> plan = plan_runs(s);
    folder.begin(s, plan, {}, program, {model});
    return plan;
  };
  const Study s = study_of("values = [1, 2]");
  StudyFolder folder(scratch / "out");
  begin(folder, s);
  CHECK(folder.planned() == 2);
  CHECK(folder.task(1).overrides == std::vector<std::string>{"a=2"});
  CHECK_THROWS_AS(folder.task(2), FileError);
  const std::string whole = R"({"status": "finished", "valid": true})";
  const auto finish = [&](int number, Outcome outcome, const std::string& mark, const std::string& summary) {
    const auto attempt = folder.attempt("000000");
    std::filesystem::create_directories(attempt);
    std::ofstream(attempt / "mark") << mark;
    if (!summary.empty()) std::ofstream(attempt / "summary.json") << sealed(summary);
    folder.finish(number, attempt,
                  {number, outcome, outcome == Outcome::kFinished ? 0 : 137, 1.0, "here", ""});
    CHECK(!std::filesystem::exists(attempt));
  };
  CHECK(!folder.is_done(0));
  finish(0, Outcome::kNotDone, "killed", "");
  CHECK(!folder.is_done(0));  // it is made again
  finish(0, Outcome::kFinished, "torn", whole.substr(0, 20));
  CHECK(!folder.is_done(0));  // and again: its summary is not whole
  finish(0, Outcome::kFinished, "other", R"({"status": "running"})");
  CHECK(!folder.is_done(0));
  finish(0, Outcome::kFinished, "second", whole);
  CHECK(folder.is_done(0));
  finish(0, Outcome::kFinished, "third", whole);  // another process, which comes too late
  CHECK(read_text_file(folder.run_folder(0) / "mark") == "second");
  // a record that is torn, or of other keys, is none
  const std::string record = read_text_file(folder.run_folder(0) / "run.json");
  const auto with_record = [&](const std::string& text) {
    std::ofstream(folder.run_folder(0) / "run.json") << text;
    return folder.is_done(0);
  };
  CHECK(!with_record(""));
  CHECK(!with_record(record.substr(0, record.size() / 2)));
  std::string other_keys = record;
  CHECK(!with_record(other_keys.replace(other_keys.find("a=1"), 3, "a=7")));
  CHECK(with_record(record));
  // what a process that has ended has left is cleared away; what lives stays
  std::filesystem::create_directories(folder.path() / "work" / ("000001." + this_host() + ".99999999.0"));
  std::filesystem::create_directories(folder.path() / "work" / "000001.elsewhere.1.0");
  folder.clean();
  CHECK(!std::filesystem::exists(folder.path() / "work" / ("000001." + this_host() + ".99999999.0")));
  CHECK(std::filesystem::exists(folder.path() / "work" / "000001.elsewhere.1.0"));
  // the same study goes on, and one of more values: a run keeps its number wherever its value stands
  StudyFolder again(scratch / "out");
  begin(again, s);
  const std::vector<PlannedRun> more = begin(again, study_of("values = [3, 1, 2]"));
  CHECK(more[0].number == 2);
  CHECK(more[1].number == 0);
  CHECK(again.planned() == 3);
  CHECK(again.is_done(0));
  CHECK_THROWS_AS(begin(again, s), InputError);  // run 2 would be gone
  CHECK_THROWS_AS(begin(again, study_of("values = [3, 1, 2]"), "talus other"), InputError);
  CHECK_NOTHROW(again.check("talus test"));
  // a plan that is torn is written anew by the study file and the records of its runs, which keep their numbers
  const std::string plan = read_text_file(again.path() / "plan.jsonl");
  std::ofstream(again.path() / "plan.jsonl") << plan.substr(0, plan.size() - 5);
  CHECK_THROWS_AS(StudyFolder(scratch / "out").planned(), FileError);
  begin(again, study_of("values = [3, 1, 2]"));
  CHECK(again.is_done(0));
  CHECK(again.task(0).overrides == std::vector<std::string>{"a=1"});
  // a summary that somebody has changed, or of another run
  const std::string mine = read_text_file(again.run_folder(0) / "summary.json");
  std::ofstream(again.run_folder(0) / "summary.json")
      << sealed(R"({"status": "finished", "valid": true, "x": 1})");
  CHECK(!again.is_done(0));
  std::ofstream(again.run_folder(0) / "summary.json") << mine;
  CHECK(again.is_done(0));
  // a study file that names another model
  std::ofstream(scratch / "other.toml") << "talus = 1\n";
  const Study other =
      read("talus_study = 1\nmodel = \"other.toml\"\n[[vary]]\nkey = \"a\"\nvalues = [3, 1, 2]\n",
           (scratch / "study.toml").string());
  std::vector<PlannedRun> others = plan_runs(other);
  CHECK_THROWS_AS(again.begin(other, others, {}, "talus test", {model}), InputError);
  CHECK_THROWS_AS(again.number(other, others), InputError);
  // another model
  std::ofstream(scratch / "m.toml") << "talus = 1 # another\n";
  CHECK_THROWS_AS(StudyFolder(scratch / "out").check("talus test"), InputError);
  CHECK_THROWS_AS(begin(again, study_of("values = [3, 1, 2]")), InputError);
  StudyFolder elsewhere(scratch.path());
  CHECK_THROWS_AS(begin(elsewhere, s), FileError);
}

TEST_CASE("study: random samples can be more, those of a Latin hypercube are others") {
  const Folder scratch;
  std::ofstream(scratch / "m.toml") << "talus = 1\n";
  for (const bool random : {true, false}) {
    StudyFolder folder(scratch / (random ? "random" : "squares"));
    const auto begin = [&](int runs) {
      const Study s =
          read(kHead + fmt::format("[[vary]]\nkey = \"a\"\ndistribution = {{ mean = 1, normal = 0.1 }}\n"
                                   "[sampling]\nruns = {}\nmethod = \"{}\"\n",
                                   runs, random ? "random" : "latin_hypercube"),
               (scratch / "study.toml").string());
      std::vector<PlannedRun> plan = plan_runs(s);
      folder.begin(s, plan, {}, "talus test", {(scratch / "m.toml").string()});
      std::filesystem::create_directories(folder.path() / "runs" / "begun");
    };
    begin(4);
    const auto first = folder.task(3).overrides;
    if (random) {
      begin(6);
      CHECK(folder.planned() == 6);
      CHECK(folder.task(3).overrides == first);
    } else {
      try {
        begin(6);
        FAIL("another hypercube was taken");
      } catch (const InputError& e) {
        CHECK(std::string(e.what()).find("Latin hypercube") != std::string::npos);
      }
    }
  }
}

TEST_CASE("study: exit codes, and what a run is that ends with them") {
  CHECK(outcome_of(kExitOk) == Outcome::kFinished);
  CHECK(outcome_of(kExitMechanism) == Outcome::kMechanism);
  for (const int code : {kExitNotValid, kExitNumerical}) CHECK(outcome_of(code) == Outcome::kNotValid);
  for (const int code : {kExitInput, kExitUsage}) CHECK(outcome_of(code) == Outcome::kRefused);
  for (const int code : {1, 4, 7, 10, 128 + 9, 128 + 15, 255}) CHECK(outcome_of(code) == Outcome::kNotDone);
}

TEST_CASE("study: what runs that are not valid count as, and which findings they have") {
  const Folder scratch;
  std::ofstream(scratch / "m.toml") << "talus = 1\n";
  const auto study_with = [&](const std::string& invalid) {
    return read(
        kHead +
            "[[vary]]\nkey = \"a\"\nvalues = [1, 2, 3, 4, 5, 6]\n[answers]\nslip = \"joints.slip_largest\"\n[failure]\nwhen = \"slip > 0.1\"\n" +
            invalid + "[fragility]\nover = \"a\"\n",
        (scratch / "study.toml").string());
  };
  const Study s = study_with("");
  std::vector<PlannedRun> plan = plan_runs(s);
  StudyFolder folder(scratch / "out");
  folder.begin(s, plan, {}, "talus test", {(scratch / "m.toml").string()});
  const auto finish = [&](int number, int code, const std::string& summary) {
    const auto attempt = folder.attempt("x");
    std::filesystem::create_directories(attempt);
    if (!summary.empty()) std::ofstream(attempt / "summary.json") << sealed(summary);
    folder.finish(number, attempt, {number, outcome_of(code), code, 1.0, "=here", "line one\nline \"two\""});
  };
  finish(0, 0, R"({"status": "finished", "valid": true, "joints": {"slip_largest [m]": 0.2}})");
  finish(1, 8,
         R"({"status": "finished", "valid": false, "joints": {"slip_largest [m]": 0.05}, "audit": {"defects":
      [{"kind": "force_vanished", "valid": false, "count": 3, "worst [s]": 1.5, "blocks": ["a", "b"], "x [m]": 1, "y [m]": 2,
        "text": "4 kN, 0.1 of the load"}, {"kind": "loose_steps", "valid": true, "count": 1}]}})");
  finish(2, 5, R"({"status": "failed", "failure": "step 7 was not solved"})");
  finish(
      3, 6,
      R"({"status": "failed", "valid": true, "failure": "a mechanism", "joints": {"slip_largest [m]": 0.01}})");
  finish(4, 137, "");
  const Gathered found = gather(s, plan, folder);
  CHECK(found.counts() == "6 runs: 1 finished, 1 mechanism, 2 not valid, 2 not done");
  CHECK(results_csv(s, found) ==
        "run,a,status,damaged: failure,slip [m],wall_time [s],host,message\n"
        "0,1,finished,1,0.2,1.000,'=here,line one line 'two'\n"
        "1,2,not valid,,0.05,1.000,'=here,line one line 'two'\n"
        "2,3,not valid,,,1.000,'=here,line one line 'two'\n"
        "3,4,mechanism,1,,1.000,'=here,line one line 'two'\n"
        "4,5,not done,,,1.000,'=here,line one line 'two'\n"
        "5,6,not done,,,,,\n");
  REQUIRE(found.rows[1].findings.size() == 1);
  CHECK(found.rows[1].findings[0].kind == "force_vanished");
  CHECK(found.rows[1].findings[0].where == "a and b at (1, 2) m");
  CHECK(found.rows[2].findings[0].text == "step 7 was not solved");
  CHECK(found.states[0].not_valid == 2);
  const Gathered strict = gather(study_with("invalid = \"failed\"\n"), plan, folder);
  CHECK(strict.rows[1].damaged[0] == 1);
  CHECK(strict.rows[2].damaged[0] == 1);
  CHECK(strict.rows[4].damaged[0] == -1);
  const std::string page = study_page(s, found, {});
  CHECK(page.find("force vanished") != std::string::npos);
  CHECK(page.find("2 of 4 runs are not valid: no single curve") != std::string::npos);
}

TEST_CASE(
    "study: the curve with what is not valid as damaged is that of runs that are damaged, and as sound of sound ones") {
  const Folder scratch;
  std::ofstream(scratch / "m.toml") << "talus = 1\n";
  // ten levels, ten runs each; of level k the first k are damaged, and at the four upper ones two are not valid
  const Study s = read(
      kHead +
          "[[vary]]\nkey = \"level\"\nvalues = [1, 2, 3, 4, 5, 6, 7, 8, 9]\n[[vary]]\nkey = \"k\"\nrange = { from = 1, to = 10, count = 10 }\n"
          "[answers]\nslip = \"joints.slip_largest\"\n[failure]\nwhen = \"slip > 0.1\"\n[fragility]\nover = \"level\"\n",
      (scratch / "study.toml").string());
  std::vector<PlannedRun> plan = plan_runs(s);
  const auto curves = [&](const std::string& name, int not_valid_as) {
    StudyFolder folder(scratch / name);
    folder.begin(s, plan, {}, "talus test", {(scratch / "m.toml").string()});
    for (const PlannedRun& run : plan) {
      const double level = run.values[0].number, k = run.values[1].number;
      const bool hidden = level >= 6 && k >= 9;
      int code = 0;
      double slip = k <= level ? 0.2 : 0;
      if (hidden && not_valid_as < 0) code = 8;
      if (hidden && not_valid_as >= 0) slip = not_valid_as;
      const auto attempt = folder.attempt("x");
      std::filesystem::create_directories(attempt);
      std::ofstream(attempt / "summary.json") << sealed(fmt::format(
          R"({{"status": "finished", "valid": {}, "joints": {{"slip_largest [m]": {}}}}})", code == 0, slip));
      folder.finish(run.number, attempt, {run.number, outcome_of(code), code, 1.0, "here", ""});
    }
    return gather(s, plan, folder).states[0];
  };
  const StateCurves open = curves("open", -1), damaged = curves("damaged", 1), sound = curves("sound", 0);
  CHECK(open.not_valid == 8);
  CHECK(open.has_single());  // 8 of 90
  CHECK(open.of(NotValidAs::kDamaged).median == damaged.of(NotValidAs::kLeftOut).median);
  CHECK(open.of(NotValidAs::kSound).median == sound.of(NotValidAs::kLeftOut).median);
  CHECK(open.of(NotValidAs::kDamaged).median < open.of(NotValidAs::kLeftOut).median);
  CHECK(open.of(NotValidAs::kLeftOut).median < open.of(NotValidAs::kSound).median);
  CHECK(open.headline(NotValidAs::kLeftOut).find("with what is not valid as damaged, median ") !=
        std::string::npos);
}

TEST_CASE("study: answers that are not finite are neither damaged nor sound, and counted") {
  const Folder scratch;
  std::ofstream(scratch / "m.toml") << "talus = 1\n";
  const Study s =
      read(kHead +
               "[[vary]]\nkey = \"a\"\nvalues = [1, 2]\n[answers]\nslip = \"joints.slip_largest\"\n"
               "drift = \"slip / sqrt(joints.opening_largest)\"\n[failure.one]\nwhen = \"drift > 0.01\"\n"
               "[failure.other]\nwhen = \"drift > 0.01 || slip > 0.05\"\n[fragility]\nover = \"a\"\n",
           (scratch / "study.toml").string());
  std::vector<PlannedRun> plan = plan_runs(s);
  StudyFolder folder(scratch / "out");
  folder.begin(s, plan, {}, "talus test", {(scratch / "m.toml").string()});
  for (int k = 0; k < 2; ++k) {
    const auto attempt = folder.attempt("x");
    std::filesystem::create_directories(attempt);
    std::ofstream(attempt / "summary.json") << sealed(
        std::string(
            R"({"status": "finished", "valid": true, "joints": {"slip_largest [m]": 0.2, "opening_largest [m]": )") +
        (k == 0 ? "-1" : "4") + "}}");
    folder.finish(k, attempt, {k, Outcome::kFinished, 0, 1.0, "here", ""});
  }
  const Gathered found = gather(s, plan, folder);
  CHECK(found.rows[0].damaged == std::vector<int>{-1, -1});
  CHECK(found.rows[1].damaged == std::vector<int>{1, 1});
  for (const StateCurves& c : found.states) {
    CHECK(c.not_finite == 1);
    CHECK(c.runs == 1);
  }
  CHECK(fragility_csv(s, found).find(",1,1,0,1,0,0,") != std::string::npos);
}

TEST_CASE("study: what is no number within a comparison decides nothing") {
  const auto damaged = [](const std::string& when, double x) {
    std::string trouble;
    return is_damaged({"s", when, false, {}}, {{"x", x}}, trouble);
  };
  CHECK(damaged("ln(x) > -8", 1) == 1);
  CHECK(damaged("ln(x) > -8", -1) == -1);
  CHECK(damaged("1 / (x - x) > 1", 1) == -1);
  CHECK(damaged("x > 0 && ln(x) > 1", -1) == 0);  // the first decides
  CHECK(damaged("x < 0 || (ln(x) > 1)", -1) == 1);
  CHECK(damaged("(ln(x) > 1) || x < 0", -1) == -1);
  CHECK(damaged("x > 0 ? ln(x) > 1 : 0", -1) == 0);
  CHECK(damaged("ln(x) > 1 ? 1 : 0", -1) == -1);
  CHECK(damaged("(x > 0.05) * (x < 3)", 1) == 1);
  CHECK(damaged("(x > 0.05) + (x > 3)", 0) == 0);
  CHECK(damaged("max(ln(x) > 1, x > 5)", -1) == -1);
  CHECK(damaged("(ln(x) > 1) * 1", -1) == -1);
  CHECK(damaged("(ln(x) > 1) == 0", -1) == -1);
}

TEST_CASE("study: values and keys that would count twice, and intensities without a logarithm, are refused") {
  const auto refused = [](const std::string& text) { return refusal(kHead + text); };
  CHECK(refused("[[vary]]\nkey = \"a\"\nvalues = [\"5 m\", \"5.0 m\"]\n").find("given twice") !=
        std::string::npos);
  CHECK(refused("[[vary]]\nkey = \"a\"\nvalues = [5, 5e0]\n").find("given twice") != std::string::npos);
  CHECK(refused("[[vary]]\nkey = \"a\"\nvalues = [5]\n[[vary]]\nkey = \"a\"\nname = \"b\"\nvalues = [1]\n")
            .find("varies already") != std::string::npos);
  CHECK(refused("[[vary]]\nkey = \"a\"\nvalues = [0, 1]\n[fragility]\nover = \"a\"\n")
            .find("has no logarithm") != std::string::npos);
  CHECK(
      refused("[[vary]]\nkey = \"a\"\nname = \"status\"\nvalues = [1]\n").find("is a column of the table") !=
      std::string::npos);
}

TEST_CASE("study: up to a tenth of runs that are not valid there is a single median") {
  const auto single = [](int runs, int not_valid) {
    StateCurves c;
    c.runs = runs, c.not_valid = not_valid;
    return c.has_single();
  };
  CHECK(single(100, 0));
  CHECK(single(91, 9));
  CHECK(!single(89, 11));
}

TEST_CASE("docs/many_runs.md holds the tables of the program") {
  const std::string page = read_text_file(std::string(TALUS_SOURCE_DIR) + "/docs/many_runs.md");
  const std::string begin = "<!-- begin of `talus schema --study` -->\n\n",
                    end = "<!-- end of `talus schema --study` -->";
  const size_t from = page.find(begin) + begin.size();
  CHECK(page.substr(from, page.find(end) - from) == study_markdown());
}

}  // namespace test_study
