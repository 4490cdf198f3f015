#include "talus/study/gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/text_file.h"
#include "talus/output/text_table.h"
#include "talus/study/answers.h"

namespace talus::study {

namespace {

// Share of runs above which no single median is told: of a tenth the median is off by about its own error of some tens of runs.
constexpr double kMostNotValid = 0.1;

std::string number_text(double v) { return std::isnan(v) ? "" : fmt::format("{:.12g}", v); }

// Texts from outside stand in one line of a table, and are no formulas to a spreadsheet.
std::string outside_text(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r' || c == '\t' || c == '"') c = c == '"' ? '\'' : ' ';
  const size_t first = text.find_first_not_of(' ');
  const bool formula = first != std::string::npos && std::strchr("=+-@", text[first]);
  if (!formula) return text;
  char* end = nullptr;
  (void)std::strtod(text.c_str(), &end);
  return *end == '\0' ? text : "'" + text;  // -1.5 is a number
}

std::vector<RunFinding> findings_of(const nlohmann::json& summary, const RunRecord& record) {
  std::vector<RunFinding> out;
  if (record.exit_code == kExitNumerical)
    return {{"failed", "", 0, 1, summary.value("failure", record.message)}};
  const auto audit = summary.find("audit");
  if (audit == summary.end() || !audit->is_object()) return out;
  for (const auto& d : audit->value("defects", nlohmann::json::array())) {
    if (d.value("valid", true)) continue;
    RunFinding f{d.value("kind", ""), "", d.value("worst [s]", 0.0), d.value("count", int64_t{1}),
                 d.value("text", "")};
    if (d.contains("blocks")) {
      for (const auto& block : d["blocks"])
        f.where += (f.where.empty() ? "" : " and ") + block.get<std::string>();
      f.where += fmt::format(" at ({:.4g}, {:.4g}) m", d.value("x [m]", 0.0), d.value("y [m]", 0.0));
    }
    out.push_back(std::move(f));
  }
  return out;
}

ResultRow row_of(const Study& study, const PlannedRun& run, const StudyFolder& folder,
                 std::vector<std::string>& units, std::set<std::string>& troubles) {
  ResultRow row;
  row.number = run.number, row.values = run.values;
  row.answers.assign(study.answers.size(), std::nan(""));
  row.damaged.assign(study.states.size(), -1);
  const auto record = folder.record_of(run.number);
  if (!record) return row;
  row.begun = true, row.record = *record, row.outcome = record->outcome;
  if (row.outcome == Outcome::kRefused || row.outcome == Outcome::kNotDone) return row;
  const std::filesystem::path there = folder.run_folder(run.number);
  std::error_code ec;
  row.has_report = std::filesystem::exists(there / "report.html", ec);
  std::string trouble;
  Numbers numbers;
  try {
    const auto summary = nlohmann::json::parse(read_text_file(there / "summary.json"));
    numbers = numbers_of(summary);
    row.arithmetic = summary.value("arithmetic", "");
    if (row.outcome == Outcome::kNotValid) row.findings = findings_of(summary, *record);
    add_units(study, summary, units);
  } catch (const nlohmann::json::exception& e) {
    troubles.insert(fmt::format("run {}: its summary cannot be read: {}", run.number, e.what()));
  }
  row.answers = evaluate_answers(study, numbers, trouble);
  // what a run came to that did not reach its end is no answer
  if (record->exit_code == kExitNumerical || record->exit_code == kExitMechanism)
    row.answers.assign(study.answers.size(), std::nan(""));
  for (size_t s = 0; s < study.states.size(); ++s) {
    const int damaged = is_damaged(study.states[s], numbers, trouble);
    if (row.outcome == Outcome::kMechanism)
      row.damaged[s] = 1;
    else if (row.outcome == Outcome::kFinished)
      row.damaged[s] = damaged;
    else if (study.states[s].invalid_counts)
      row.damaged[s] = 1;
  }
  // of a run that has not reached its end some numbers are not there
  if (!trouble.empty() && row.outcome == Outcome::kFinished) troubles.insert(trouble);
  return row;
}

StateCurves curves_of(const std::vector<ResultRow>& rows, size_t state, size_t over) {
  StateCurves out;
  std::array<std::map<double, FragilityPoint>, kNotValidAs> levels;
  const auto add = [&](NotValidAs as, double x, int damaged) {
    FragilityPoint& p = levels[place_of(as)][x];
    p.intensity = x, ++p.runs, p.damaged += damaged;
  };
  for (const ResultRow& row : rows) {
    const double x = row.values[over].number;
    if (!(x > 0)) continue;
    if (row.outcome == Outcome::kNotValid) {
      ++out.not_valid;
      add(NotValidAs::kDamaged, x, 1), add(NotValidAs::kSound, x, 0);
    } else if (row.counts() && row.damaged[state] < 0) {
      ++out.not_finite;
    } else if (row.counts()) {
      ++out.runs, out.damaged += row.damaged[state];
      for (const NotValidAs as : {NotValidAs::kDamaged, NotValidAs::kSound, NotValidAs::kLeftOut})
        add(as, x, row.damaged[state]);
    }
  }
  for (size_t k = 0; k < kNotValidAs; ++k) {
    for (const auto& [x, p] : levels[k]) out.points[k].push_back(p);
    out.fit[k] = fit_fragility(out.points[k]);
  }
  return out;
}

std::string fit_text(const Fragility& f) {
  return f.found() ? fmt::format("median {:.4g} (68 %: {:.4g} to {:.4g}), beta {:.3g} +- {:.2g}", f.median,
                                 f.median * std::exp(-f.median_error), f.median * std::exp(f.median_error),
                                 f.beta, f.beta_error)
                   : "no curve: " + f.trouble;
}

}  // namespace

const char* name_of(NotValidAs as) {
  return as == NotValidAs::kDamaged ? "damaged" : as == NotValidAs::kSound ? "sound" : "left out";
}

std::vector<NotValidAs> StateCurves::ways() const {
  if (not_valid == 0) return {NotValidAs::kLeftOut};
  return {NotValidAs::kDamaged, NotValidAs::kSound, NotValidAs::kLeftOut};
}

FragilityPoint StateCurves::sum(NotValidAs as) const {
  FragilityPoint all;
  for (const FragilityPoint& p : points_of(as)) all.runs += p.runs, all.damaged += p.damaged;
  return all;
}

bool StateCurves::has_single() const { return not_valid <= kMostNotValid * (runs + not_valid); }

std::string StateCurves::headline(NotValidAs asked) const {
  if (not_valid == 0) return fit_text(of(NotValidAs::kLeftOut));
  const auto median = [this](NotValidAs as, const char* how) {
    const Fragility& f = of(as);
    return f.found() ? fmt::format("median {:.4g} {}", f.median, how)
                     : fmt::format("no curve {} ({})", how, f.trouble);
  };
  const std::string between = median(NotValidAs::kDamaged, "with what is not valid as damaged") + ", " +
                              median(NotValidAs::kSound, "as sound");
  return has_single() ? fmt::format("{}; {}: {}", between, name_of(asked), fit_text(of(asked)))
                      : fmt::format("{}; {} of {} runs are not valid: no single curve", between, not_valid,
                                    runs + not_valid);
}

std::string Gathered::counts() const {
  std::string out = fmt::format("{} runs: {} finished", rows.size(), of(Outcome::kFinished));
  for (const Outcome o : {Outcome::kMechanism, Outcome::kNotValid, Outcome::kRefused, Outcome::kNotDone})
    if (of(o) > 0) out += fmt::format(", {} {}", of(o), name_of(o));
  return out;
}

std::string Gathered::title(const Study& study, size_t answer) const {
  const std::string& name = study.answers[answer].name;
  return units[answer].empty() ? name : fmt::format("{} [{}]", name, units[answer]);
}

Gathered gather(const Study& study, const std::vector<PlannedRun>& plan, const StudyFolder& folder) {
  Gathered out;
  std::set<std::string> troubles;
  for (const NamedFormula& answer : study.answers) out.units.push_back(answer.unit);
  for (const PlannedRun& run : plan) {
    ResultRow row = row_of(study, run, folder, out.units, troubles);
    ++out.count[place_of(row.outcome)];
    out.rows.push_back(std::move(row));
  }
  std::set<std::string> arithmetics;
  for (const ResultRow& row : out.rows)
    if (!row.arithmetic.empty()) arithmetics.insert(row.arithmetic);
  if (arithmetics.size() > 1)
    troubles.insert(fmt::format(
        "the hosts that made these runs have {} mathematics libraries: the last digits of runs are those of their host",
        arithmetics.size()));
  out.troubles.assign(troubles.begin(), troubles.end());
  size_t over = 0;
  while (over < study.axes.size() && study.axes[over].name != study.over) ++over;
  if (over == study.axes.size()) return out;
  for (size_t s = 0; s < study.states.size(); ++s) out.states.push_back(curves_of(out.rows, s, over));
  return out;
}

std::string results_csv(const Study& study, const Gathered& found) {
  std::string out = "run";
  for (const Axis& a : study.axes) out += "," + table_cell(outside_text(a.title()));
  out += ",status";
  for (const DamageState& s : study.states) out += "," + table_cell("damaged: " + s.name);
  for (size_t k = 0; k < study.answers.size(); ++k) out += "," + table_cell(found.title(study, k));
  out += ",wall_time [s],host,message\n";
  for (const ResultRow& row : found.rows) {
    out += fmt::format("{}", row.number);
    for (const AxisValue& v : row.values) out += "," + table_cell(outside_text(v.shown));
    out += fmt::format(",{}", name_of(row.outcome));
    for (const int damaged : row.damaged) out += damaged < 0 ? "," : fmt::format(",{}", damaged);
    for (const double answer : row.answers) out += "," + number_text(answer);
    out += !row.begun ? ",,,"
                      : fmt::format(",{:.3f},{},{}", row.record.wall_seconds,
                                    table_cell(outside_text(row.record.host)),
                                    table_cell(outside_text(row.record.message)));
    out += "\n";
  }
  return out;
}

std::string fragility_csv(const Study& study, const Gathered& found) {
  std::string out =
      "state,over,not_valid_as,median,beta,error_of_ln_median,error_of_beta,runs,damaged,not_valid,not_finite,"
      "refused,not_done,trouble\n";
  for (size_t s = 0; s < found.states.size(); ++s)
    for (const NotValidAs as : found.states[s].ways()) {
      const StateCurves& c = found.states[s];
      const Fragility& f = c.of(as);
      const FragilityPoint sum = c.sum(as);
      out += fmt::format("{},{},{},", table_cell(outside_text(study.states[s].name)), table_cell(study.over),
                         name_of(as));
      out += f.found()
                 ? fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}", f.median, f.beta, f.median_error, f.beta_error)
                 : ",,,";
      out += fmt::format(",{},{},{},{},{},{},{}\n", sum.runs, sum.damaged, c.not_valid, c.not_finite,
                         found.of(Outcome::kRefused), found.of(Outcome::kNotDone), table_cell(f.trouble));
    }
  return out;
}

namespace {

// Ranks from 1; equal values share theirs.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<size_t> order(values.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return values[a] < values[b]; });
  std::vector<double> out(values.size());
  for (size_t i = 0; i < order.size();) {
    size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (size_t k = i; k < end; ++k) out[order[k]] = 0.5 * static_cast<double>(i + end - 1) + 1;
    i = end;
  }
  return out;
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (size_t i = 0; i < x.size(); ++i) mx += x[i] / n, my += y[i] / n;
  for (size_t i = 0; i < x.size(); ++i)
    xx += (x[i] - mx) * (x[i] - mx), yy += (y[i] - my) * (y[i] - my), xy += (x[i] - mx) * (y[i] - my);
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : std::nan("");
}

}  // namespace

std::vector<Sensitivity> sensitivities(const Study& study, const Gathered& found) {
  std::vector<Sensitivity> out;
  for (size_t k = 0; k < study.answers.size(); ++k)
    for (size_t a = 0; a < study.axes.size(); ++a) {
      std::vector<double> x, y;
      for (const ResultRow& row : found.rows)
        if (row.answers_count() && std::isfinite(row.answers[k]) && std::isfinite(row.values[a].number))
          x.push_back(row.values[a].number), y.push_back(row.answers[k]);
      if (x.size() < 3) continue;
      if (const double r = correlation(ranks(x), ranks(y)); std::isfinite(r))
        out.push_back({study.answers[k].name, study.axes[a].name, r});
    }
  return out;
}

std::string gathered_text(const Study& study, const Gathered& found) {
  std::string out = found.counts() + "\n";
  constexpr int kMostReasons = 3;
  int reasons = 0;
  for (const ResultRow& row : found.rows)
    if (!row.counts() && !row.record.message.empty() && reasons++ < kMostReasons)
      out += fmt::format("run {}, {}: {}\n", row.number, name_of(row.outcome), row.record.message);
  if (reasons > kMostReasons)
    out += fmt::format("and {} more: the last column of results.csv\n", reasons - kMostReasons);
  for (const std::string& trouble : found.troubles) out += "note: " + trouble + "\n";
  for (size_t s = 0; s < found.states.size(); ++s) {
    const StateCurves& c = found.states[s];
    out +=
        fmt::format("{}: {}\n", study.states[s].name,
                    c.headline(study.states[s].invalid_counts ? NotValidAs::kDamaged : NotValidAs::kLeftOut));
    if (c.not_finite > 0)
      out += fmt::format("{}: {} runs count as neither: their answers are not finite\n", study.states[s].name,
                         c.not_finite);
  }
  return out;
}

}  // namespace talus::study
