#include "talus/report/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "talus/base/error.h"
#include "talus/output/columns.h"

namespace talus::report {

namespace {

using json = nlohmann::ordered_json;

struct Stage {
  std::string name;
  bool dynamic = false;
  double begin = 0, end = 0;  // [s]
  bool on_path = false;
};

std::vector<Stage> stages_of(const RunFolder& run) {
  std::vector<Stage> out;
  const json list = run.summary.contains("stages") ? run.summary["stages"] : json::array();
  for (const json& s : list)
    out.push_back({s.value("name", ""), s.value("kind", "") == "dynamic", s.value("begin [s]", 0.0),
                   s.value("end [s]", 0.0), s.value("balances_of_path", 0) > 0});
  return out;
}

// Rows of a stage: after its begin, whose row counts displacements from before they were reset.
struct Rows {
  size_t from = 0, to = 0;
};
Rows rows_of(const std::vector<double>& time, const Stage& s) {
  const auto after = [&time](double t) {
    return static_cast<size_t>(std::upper_bound(time.begin(), time.end(), t) - time.begin());
  };
  return {after(s.begin), after(s.end)};
}

// The last of these rows at which the clock of the histories stands there: a path has two where something breaks.
std::optional<size_t> row_at_clock(const std::vector<double>& clock, const Rows& rows, double there) {
  constexpr double kSame = 1e-9;
  for (size_t r = rows.to; r > rows.from; --r)
    if (std::abs(clock[r - 1] - there) <= kSame * std::max(1.0, std::abs(there))) return r - 1;
  return std::nullopt;
}

// Value at a time between rows [from, to); at or outside the ends that of the end.
double value_at(const std::vector<double>& time, const std::vector<double>& value, const Rows& rows,
                double t) {
  const auto begin = time.begin() + static_cast<std::ptrdiff_t>(rows.from),
             end = time.begin() + static_cast<std::ptrdiff_t>(rows.to);
  const auto next = std::lower_bound(begin, end, t);
  if (next == end) return value[rows.to - 1];
  const auto k = static_cast<size_t>(next - time.begin());
  if (k == rows.from || *next == t) return value[k];
  const double share = (t - time[k - 1]) / (time[k] - time[k - 1]);
  return value[k - 1] + share * (value[k] - value[k - 1]);
}

void take(Difference& d, double a, double b, double at) {
  d.scale = std::max(d.scale, std::abs(a));
  const double off = std::abs(a - b);
  if (!(off <= d.most)) d.most = off, d.at = at;
}

void compare_histories(const RunFolder& a, const RunFolder& b, Comparison& out) {
  if (a.histories.columns.empty() || b.histories.columns.empty()) return;
  const std::vector<double>&ta = a.histories.values[0], &tb = b.histories.values[0];
  const std::vector<Stage> other = stages_of(b);
  for (const Stage& s : stages_of(a)) {
    const auto same =
        std::find_if(other.begin(), other.end(), [&s](const Stage& o) { return o.name == s.name; });
    if (same == other.end()) {
      out.notes.push_back(fmt::format("stage \"{}\" is in {} alone", s.name, a.name));
      continue;
    }
    const double la = s.end - s.begin, lb = same->end - same->begin;
    if (s.dynamic && std::abs(la - lb) > 1e-9 * std::max(la, lb))
      out.notes.push_back(
          fmt::format("stage \"{}\" is {:g} s long in {} and {:g} s in {}: compared as far as both go",
                      s.name, la, a.name, lb, b.name));
    const Rows ra = rows_of(ta, s), rb = rows_of(tb, *same);
    if (ra.from == ra.to || rb.from == rb.to) continue;
    for (size_t c = 0; c < a.histories.columns.size(); ++c) {
      const std::string& title = a.histories.columns[c];
      if (parts_of_title(title).monitor.empty()) continue;  // clocks
      const auto at = std::find(b.histories.columns.begin(), b.histories.columns.end(), title);
      if (at == b.histories.columns.end()) continue;
      const std::vector<double>&va = a.histories.values[c],
            &vb = b.histories.values[static_cast<size_t>(at - b.histories.columns.begin())];
      Difference d{"history", s.name, title};
      double squares = 0;
      size_t count = 0;
      // static stages rest at their ends, on a path at its balances, and how they come there is the scheme's own; impulses
      // go by the steps
      const bool on_path = s.on_path && same->on_path;
      if (on_path && title.find("impulse") != std::string::npos) continue;
      for (size_t r = s.dynamic || on_path ? ra.from : ra.to - 1; r < ra.to; ++r) {
        const double t = on_path ? a.histories.values[1][r] : ta[r] - s.begin;
        if (s.dynamic && t > same->end - same->begin) break;
        const auto there = on_path ? row_at_clock(b.histories.values[1], rb, t) : std::nullopt;
        if (on_path && !there) continue;
        const double w = on_path     ? vb[*there]
                         : s.dynamic ? value_at(tb, vb, rb, same->begin + t)
                                     : vb[rb.to - 1];
        if (!std::isfinite(va[r]) && !std::isfinite(w)) continue;
        if (std::isfinite(va[r]) != std::isfinite(w)) {  // one of them knows it, the other does not
          d.most = std::numeric_limits<double>::infinity(), d.at = t;
          continue;
        }
        take(d, va[r], w, t);
        squares += (va[r] - w) * (va[r] - w), ++count;
      }
      if (count == 0) continue;
      d.rms = std::sqrt(squares / static_cast<double>(count));
      out.list.push_back(d);
    }
  }
  for (const auto& [one, two] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const std::string& title : one->histories.columns)
      if (std::find(two->histories.columns.begin(), two->histories.columns.end(), title) ==
          two->histories.columns.end())
        out.notes.push_back(fmt::format("{} is in {} alone", title, one->name));
}

// Normal and shear forces of joints, added up by stage and joint [N].
std::map<std::pair<std::string, std::string>, std::array<double, 2>> joint_sums(const RunFolder& run) {
  std::map<std::pair<std::string, std::string>, std::array<double, 2>> out;
  const std::filesystem::path file = run.path / "joints.csv";
  std::error_code ec;
  if (!std::filesystem::exists(file, ec)) return out;
  const TextTable table = read_text_table(file);
  const int stage = table.find("stage"), joint = table.find("joint"), normal = table.find("normal_force [N]"),
            shear = table.find("shear_force [N]");
  if (stage < 0 || joint < 0 || normal < 0 || shear < 0) return out;
  for (const auto& row : table.rows) {
    auto& sum = out[{row[static_cast<size_t>(stage)], row[static_cast<size_t>(joint)]}];
    sum[0] += std::atof(row[static_cast<size_t>(normal)].c_str());
    sum[1] += std::abs(std::atof(row[static_cast<size_t>(shear)].c_str()));
  }
  return out;
}

void compare_joints(const RunFolder& a, const RunFolder& b, Comparison& out) {
  const auto sums = joint_sums(a), others = joint_sums(b);
  for (const Stage& s : stages_of(a))
    for (const auto& [key, sum] : sums) {
      if (key.first != s.name) continue;
      const auto same = others.find(key);
      if (same == others.end()) {
        out.notes.push_back(fmt::format("joint \"{}\" has points in stage \"{}\" of {} alone", key.second,
                                        key.first, a.name));
        continue;
      }
      for (size_t k = 0; k < 2; ++k) {
        Difference d{"joints", s.name,
                     fmt::format("{}: {} forces added up [N]", key.second, k == 0 ? "normal" : "shear")};
        take(d, sum[k], same->second[k], s.end - s.begin);
        out.list.push_back(d);
      }
    }
}

void compare_ledgers(const RunFolder& a, const RunFolder& b, Comparison& out) {
  if (a.steps.rows() == 0 || b.steps.rows() == 0) return;
  for (size_t c = 0; c < a.steps.columns.size(); ++c) {
    const std::string& title = a.steps.columns[c];
    if (parts_of_title(title).unit != "J") continue;
    const auto at = std::find(b.steps.columns.begin(), b.steps.columns.end(), title);
    if (at == b.steps.columns.end()) continue;
    Difference d{"ledger", "", title};
    take(d, a.steps.values[c].back(),
         b.steps.values[static_cast<size_t>(at - b.steps.columns.begin())].back(), a.steps.values[0].back());
    out.list.push_back(d);
  }
}

}  // namespace

double Difference::share() const {
  return scale > 0 ? most / scale : most > 0 ? std::numeric_limits<double>::infinity() : 0;
}

Comparison compare_runs(const RunFolder& a, const RunFolder& b) {
  Comparison out;
  for (const RunFolder* run : {&a, &b}) {
    if (const std::string status = run->summary.value("status", ""); status != "finished")
      out.notes.push_back(fmt::format("{} is {}", run->name, status.empty() ? "without a status" : status));
    if (run->summary.contains("valid") && run->summary["valid"] == false)
      out.notes.push_back(fmt::format("{} is not valid, by its audit", run->name));
  }
  compare_histories(a, b, out);
  compare_joints(a, b, out);
  compare_ledgers(a, b, out);
  if (out.list.empty())
    throw FileError(
        fmt::format("{} and {} have nothing in common: no stage of one name, no monitor of one name",
                    a.path.string(), b.path.string()));
  return out;
}

bool beyond(const Difference& d, double rtol, double atol) { return !(d.most <= atol + rtol * d.scale); }

}  // namespace talus::report
