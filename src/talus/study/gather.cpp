#include "talus/study/gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "talus/base/text_file.h"
#include "talus/output/text_table.h"
#include "talus/study/answers.h"

namespace talus::study {

namespace fs = std::filesystem;

namespace {

std::string number_text(double v) { return std::isnan(v) ? "" : fmt::format("{:.12g}", v); }

// Texts from outside stand in one line of a table.
std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r' || c == '"') c = c == '"' ? '\'' : ' ';
  return text;
}

ResultRow row_of(const Study& study, const PlannedRun& run, const StudyFolder& folder,
                 std::set<std::string>& troubles) {
  ResultRow row;
  row.number = run.number, row.values = run.values;
  row.answers.assign(study.answers.size(), std::nan(""));
  row.damaged.assign(study.states.size(), -1);
  const auto record = folder.record_of(run.number);
  if (!record) {
    row.status = "missing";
    return row;
  }
  row.record = *record, row.status = record->status;
  const fs::path there = folder.run_folder(run.number);
  nlohmann::json summary;
  std::error_code ec;
  if (fs::exists(there / "summary.json", ec))
    summary = nlohmann::json::parse(read_text_file(there / "summary.json"), nullptr, false);
  if (row.status == "finished" && (!summary.is_object() || summary.value("status", "") != "finished"))
    row.status = "failed";
  const bool invalid = summary.is_object() && summary.contains("valid") && summary["valid"].is_boolean() &&
                       !summary["valid"].get<bool>();
  if (row.status == "finished" && invalid) row.status = "not valid";
  row.counts = row.status == "finished";
  row.has_report = fs::exists(there / "report.html", ec);
  if (summary.is_object() && (row.counts || row.status == "not valid")) {
    std::string trouble;
    Numbers numbers;
    try {
      numbers = numbers_of(summary);
    } catch (const nlohmann::json::exception& e) {
      trouble = fmt::format("run {}: its summary cannot be read: {}", run.number, e.what());
    }
    row.answers = evaluate_answers(study, numbers, trouble);
    for (size_t s = 0; s < study.states.size(); ++s) {
      const bool damaged = is_damaged(study.states[s], numbers, trouble);
      if (row.counts) row.damaged[s] = damaged;
    }
    if (!trouble.empty()) troubles.insert(trouble);
  }
  if (row.status == "failed" || row.status == "not valid")
    for (size_t s = 0; s < study.states.size(); ++s)
      if (study.states[s].invalid_counts) row.damaged[s] = 1;
  return row;
}

}  // namespace

Gathered gather(const Study& study, const std::vector<PlannedRun>& plan, const StudyFolder& folder) {
  Gathered out;
  std::set<std::string> troubles;
  for (const PlannedRun& run : plan) {
    ResultRow row = row_of(study, run, folder, troubles);
    out.finished += row.counts, out.not_valid += row.status == "not valid",
        out.missing += row.status == "missing";
    out.failed += !row.counts && row.status != "not valid" && row.status != "missing";
    out.rows.push_back(std::move(row));
  }
  out.troubles.assign(troubles.begin(), troubles.end());
  size_t over = 0;
  while (over < study.axes.size() && study.axes[over].name != study.over) ++over;
  if (over == study.axes.size()) return out;
  for (size_t s = 0; s < study.states.size(); ++s) {
    std::map<double, FragilityPoint> by_level;
    for (const ResultRow& row : out.rows) {
      const double x = row.values[over].number;
      if (row.damaged[s] < 0 || !(x > 0)) continue;
      FragilityPoint& p = by_level[x];
      p.intensity = x, ++p.runs, p.damaged += row.damaged[s];
    }
    std::vector<FragilityPoint> points;
    for (const auto& [x, p] : by_level) points.push_back(p);
    out.fragility.push_back(fit_fragility(points));
    out.points.push_back(std::move(points));
  }
  return out;
}

std::string results_csv(const Study& study, const Gathered& found) {
  std::string out = "run";
  for (const Axis& a : study.axes) out += "," + table_cell(a.title());
  out += ",status";
  for (const DamageState& s : study.states) out += "," + table_cell("damaged: " + s.name);
  for (const NamedFormula& a : study.answers) out += "," + a.name;
  out += ",wall_time [s],host,message\n";
  for (const ResultRow& row : found.rows) {
    out += fmt::format("{}", row.number);
    for (const AxisValue& v : row.values) out += "," + table_cell(one_line(v.shown));
    out += "," + row.status;
    for (const int damaged : row.damaged) out += damaged < 0 ? "," : fmt::format(",{}", damaged);
    for (const double answer : row.answers) out += "," + number_text(answer);
    out += row.status == "missing" ? ",,,"
                                   : fmt::format(",{:.3f},{},{}", row.record.wall_seconds, row.record.host,
                                                 table_cell(one_line(row.record.message)));
    out += "\n";
  }
  return out;
}

std::string fragility_csv(const Study& study, const Gathered& found) {
  std::string out = "state,over,median,beta,error_of_ln_median,error_of_beta,runs,damaged,trouble\n";
  for (size_t s = 0; s < found.fragility.size(); ++s) {
    const Fragility& f = found.fragility[s];
    int runs = 0, damaged = 0;
    for (const FragilityPoint& p : found.points[s]) runs += p.runs, damaged += p.damaged;
    out += fmt::format("{},{},", table_cell(study.states[s].name), table_cell(study.over));
    out += f.found()
               ? fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}", f.median, f.beta, f.median_error, f.beta_error)
               : ",,,";
    out += fmt::format(",{},{},{}\n", runs, damaged, table_cell(f.trouble));
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
        if (row.counts && std::isfinite(row.answers[k]) && std::isfinite(row.values[a].number))
          x.push_back(row.values[a].number), y.push_back(row.answers[k]);
      if (x.size() < 3) continue;
      if (const double r = correlation(ranks(x), ranks(y)); std::isfinite(r))
        out.push_back({study.answers[k].name, study.axes[a].name, r});
    }
  return out;
}

std::string gathered_text(const Study& study, const Gathered& found) {
  std::string out =
      fmt::format("{} runs: {} finished, {} failed, {} not valid, {} missing\n", found.rows.size(),
                  found.finished, found.failed, found.not_valid, found.missing);
  constexpr int kMostReasons = 3;
  int reasons = 0;
  for (const ResultRow& row : found.rows)
    if (!row.counts && !row.record.message.empty() && reasons++ < kMostReasons)
      out += fmt::format("run {}, {}: {}\n", row.number, row.status, row.record.message);
  if (reasons > kMostReasons)
    out += fmt::format("and {} more: the last column of results.csv\n", reasons - kMostReasons);
  for (const std::string& trouble : found.troubles) out += "note: " + trouble + "\n";
  for (size_t s = 0; s < found.fragility.size(); ++s) {
    const Fragility& f = found.fragility[s];
    out += f.found() ? fmt::format("{}: median {:.4g} (68 %: {:.4g} to {:.4g}), beta {:.3g} +- {:.2g}\n",
                                   study.states[s].name, f.median, f.median * std::exp(-f.median_error),
                                   f.median * std::exp(f.median_error), f.beta, f.beta_error)
                     : fmt::format("{}: no curve: {}\n", study.states[s].name, f.trouble);
  }
  return out;
}

}  // namespace talus::study
