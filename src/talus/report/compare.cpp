#include "talus/report/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/model/model_keys.h"
#include "talus/model/model_schema.h"
#include "talus/output/columns.h"
#include "talus/output/summary_seal.h"
#include "talus/schema/units.h"

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
  const auto after = [&time](double t) -> size_t {
    return std::upper_bound(time.begin(), time.end(), t) - time.begin();
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
  const auto begin = time.begin() + rows.from, end = time.begin() + rows.to;
  const auto next = std::lower_bound(begin, end, t);
  if (next == end) return value[rows.to - 1];
  const size_t k = next - time.begin();
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
    if (same == other.end()) continue;  // told by compare_stages()
    const double la = s.end - s.begin, lb = same->end - same->begin;
    if (s.dynamic && std::abs(la - lb) > 1e-9 * std::max(la, lb))
      out.faults.push_back(
          fmt::format("stage \"{}\" is {:g} s long in {} and {:g} s in {}: compared as far as both go",
                      s.name, la, a.name, lb, b.name));
    const Rows ra = rows_of(ta, s), rb = rows_of(tb, *same);
    if ((ra.from == ra.to) != (rb.from == rb.to))
      out.faults.push_back(fmt::format("histories.csv of {} has no row of stage \"{}\"",
                                       ra.from == ra.to ? a.name : b.name, s.name));
    if (ra.from == ra.to || rb.from == rb.to) continue;
    for (size_t c = 0; c < a.histories.columns.size(); ++c) {
      const std::string& title = a.histories.columns[c];
      if (parts_of_title(title).monitor.empty()) continue;  // clocks
      const auto at = std::find(b.histories.columns.begin(), b.histories.columns.end(), title);
      if (at == b.histories.columns.end()) continue;
      const std::vector<double>&va = a.histories.values[c],
            &vb = b.histories.values[at - b.histories.columns.begin()];
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
      if (count == 0 && d.most == 0) continue;
      d.rms = std::sqrt(squares / static_cast<double>(std::max<size_t>(count, 1)));
      out.list.push_back(d);
    }
  }
  for (const auto& [one, two] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const std::string& title : one->histories.columns)
      if (std::find(two->histories.columns.begin(), two->histories.columns.end(), title) ==
          two->histories.columns.end())
        out.faults.push_back(fmt::format("{} is in {} alone", title, one->name));
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
    auto& sum = out[{row[stage], row[joint]}];
    sum[0] += std::atof(row[normal].c_str());
    sum[1] += std::abs(std::atof(row[shear].c_str()));
  }
  return out;
}

void compare_joints(const RunFolder& a, const RunFolder& b, Comparison& out) {
  const auto sums = joint_sums(a), others = joint_sums(b);
  const auto alone = [&out](const std::pair<std::string, std::string>& key, const std::string& name) {
    out.faults.push_back(
        fmt::format("joint \"{}\" has points in stage \"{}\" of {} alone", key.second, key.first, name));
  };
  for (const auto& [key, sum] : others)
    if (!sums.count(key)) alone(key, b.name);
  for (const Stage& s : stages_of(a))
    for (const auto& [key, sum] : sums) {
      if (key.first != s.name) continue;
      const auto same = others.find(key);
      if (same == others.end()) {
        alone(key, a.name);
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
  for (const auto& [one, two] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const std::string& title : one->steps.columns)
      if (std::find(two->steps.columns.begin(), two->steps.columns.end(), title) == two->steps.columns.end())
        out.faults.push_back(fmt::format("steps.csv: {} is in {} alone", title, one->name));
  for (size_t c = 0; c < a.steps.columns.size(); ++c) {
    const std::string& title = a.steps.columns[c];
    if (parts_of_title(title).unit != "J") continue;
    const auto at = std::find(b.steps.columns.begin(), b.steps.columns.end(), title);
    if (at == b.steps.columns.end()) continue;
    Difference d{"ledger", "", title};
    take(d, a.steps.values[c].back(), b.steps.values[at - b.steps.columns.begin()].back(),
         a.steps.values[0].back());
    out.list.push_back(d);
  }
}

// --- what a side is by itself ---

// Rows of a table of numbers go on in time, up to the end of each dynamic stage and without holes.
void judge_rows(const RunFolder& run, const CsvTable& table, const char* file, const char* interval,
                std::vector<std::string>& faults) {
  const auto fault = [&](const std::string& text) {
    faults.push_back(fmt::format("{} of {}: {}", file, run.name, text));
  };
  if (table.columns.empty()) return;  // told where it is missing
  for (size_t c = 0; c < table.columns.size(); ++c)
    if (const auto bad = std::find_if(table.values[c].begin(), table.values[c].end(),
                                      [](double v) { return std::isinf(v); });
        bad != table.values[c].end())
      fault(fmt::format("{} is not finite in row {}", table.columns[c], bad - table.values[c].begin() + 1));
  const std::vector<double>& time = table.values[0];
  for (size_t r = 0; r < time.size(); ++r)
    if (!(r == 0 ? std::isfinite(time[0]) : time[r] >= time[r - 1]))
      return fault(fmt::format("its times do not go on in row {}", r + 1));
  const json model = run.summary.value("model", json::object());
  const json intervals = model.is_object() ? model.value("intervals [s]", json::object()) : json::object();
  if (!intervals.is_object() || !intervals.contains(interval) || !run.summary["stages"].is_array()) return;
  for (const json& s : run.summary["stages"]) {
    if (s.value("kind", "") != "dynamic") continue;
    // a row at the first step at or behind each multiple of the interval
    const double end = s.value("end [s]", 0.0),
                 most = (intervals.value(interval, 0.0) + s.value("dt [s]", 0.0)) * (1 + 1e-6) + 1e-9 * end;
    double last = s.value("begin [s]", 0.0);
    for (const double t : time) {
      if (t <= last || t > end * (1 + 1e-12)) continue;
      if (t - last > most) break;
      last = t;
    }
    if (end - last > most)
      fault(fmt::format("rows are missing in stage \"{}\" after {:g} s", s.value("name", ""), last));
  }
}

void judge_side(const RunFolder& run, std::vector<std::string>& faults) {
  if (const std::string status = run.summary.value("status", ""); status != "finished")
    faults.push_back(fmt::format("{} {}", run.name,
                                 status.empty() ? "has no status" : "has not ended well: it is " + status));
  if (run.summary.contains("valid") && run.summary["valid"] == false)
    faults.push_back(fmt::format("{} is not valid, by its audit", run.name));
  if (run.summary.contains("arithmetic") && !run.summary.contains("digest"))
    faults.push_back(fmt::format("{}: its summary has no digest, which runs that end write", run.name));
  if (const std::string why = seal_defect(run.path, run.summary); !why.empty())
    faults.push_back(fmt::format("{}: {}", run.name, why));
  for (const std::string& note : run.notes) faults.push_back(fmt::format("{}: {}", run.name, note));
  if (!run.summary.contains("stages") || !run.summary["stages"].is_array() || run.summary["stages"].empty()) {
    faults.push_back(fmt::format("{}: its summary names no stage", run.name));
    return;
  }
  judge_rows(run, run.histories, "histories.csv", "history", faults);
  judge_rows(run, run.steps, "steps.csv", "steps", faults);
}

// --- what only one of two has, and in what they are two models ---

void compare_files(const RunFolder& a, const RunFolder& b, std::vector<std::string>& faults) {
  std::error_code ec;
  for (const auto& [one, two] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (const char* name : kMarkedFiles)
      if (std::filesystem::exists(one->path / name, ec) && !std::filesystem::exists(two->path / name, ec))
        faults.push_back(fmt::format("{} is missing in {}", name, two->name));
  for (const RunFolder* run : {&a, &b})
    if (run->model.empty())
      faults.push_back(fmt::format("{} has no model.toml to be held against the other", run->name));
  for (const auto& [name, table, other] :
       {std::tuple("histories.csv", &a.histories, &b.histories), std::tuple("steps.csv", &a.steps, &b.steps)})
    if ((table->rows() == 0) != (other->rows() == 0))
      faults.push_back(fmt::format("{} of {} has no row", name, table->rows() == 0 ? a.name : b.name));
}

void compare_stages(const RunFolder& a, const RunFolder& b, std::vector<std::string>& faults) {
  const std::vector<Stage> of_a = stages_of(a), of_b = stages_of(b);
  for (const auto& [one, two, name] : {std::tuple(&of_a, &of_b, &a.name), std::tuple(&of_b, &of_a, &b.name)})
    for (const Stage& s : *one) {
      const auto same =
          std::find_if(two->begin(), two->end(), [&s](const Stage& o) { return o.name == s.name; });
      if (same == two->end())
        faults.push_back(fmt::format("stage \"{}\" is in {} alone", s.name, *name));
      else if (one == &of_a && same->dynamic != s.dynamic)
        faults.push_back(fmt::format("stage \"{}\" is static in one of them, dynamic in the other", s.name));
    }
}

// Keys of how a model is solved and what is written of it: two runs that differ in these alone are of one model.
bool is_of_the_solution(const std::string& key) {
  static const std::vector<std::string> sections{"solver.",  "output.", "safety.", "penalty.",
                                                 "contact.", "title",   "folder",  "talus"};
  static const std::vector<std::string> of_stages{
      "time_step",    "integration",   "increments",        "safety",     "elasticity",  "moment_clamp",
      "damping_mass", "damping_local", "damping_stiffness", "unbalanced", "strict_rest", "relaxation"};
  const std::string last = key.substr(key.rfind('.') + 1);
  if (last == "file" || key == "cut.blocks") return true;  // known by its content
  if (key == "contact.joint" || key == "contact.restitution") return false;
  return key == "model.formulation" ||
         std::any_of(sections.begin(), sections.end(),
                     [&](const std::string& s) { return key.rfind(s, 0) == 0; }) ||
         last == "damping_time" ||
         (key.rfind("stage.", 0) == 0 &&
          std::find(of_stages.begin(), of_stages.end(), last) != of_stages.end());
}

std::vector<std::string> digests_read(const RunFolder& run) {
  std::vector<std::string> out;
  for (const json& file : run.summary.value("reads", json::array())) out.push_back(file.value("digest", ""));
  return out;
}

bool same_cell(const std::string& a, const std::string& b) {
  if (a == b) return true;
  char *end_a = nullptr, *end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
  return !a.empty() && !b.empty() && *end_a == '\0' && *end_b == '\0' &&
         std::abs(x - y) <= 1e-9 * (1 + std::abs(x));
}

// The values of a list of any depth, or the one that is none; quotes left away.
std::vector<std::string> values_in(const std::string& text) {
  std::vector<std::string> out;
  if (text.empty() || text.front() != '[') {
    const bool quoted = text.size() > 1 && (text.front() == '"' || text.front() == '\'');
    return {quoted ? text.substr(1, text.size() - 2) : text};
  }
  size_t from = 0;
  for (size_t i = 0; i <= text.size(); ++i) {
    const bool ends = i == text.size() || std::strchr("[],", text[i]);
    if (!ends) continue;
    if (const std::string_view one = trimmed(std::string_view(text).substr(from, i - from)); !one.empty())
      out.push_back(values_in(std::string(one))[0]);
    if (i < text.size() && text[i] != ',') out.emplace_back(1, text[i]);
    from = i + 1;
  }
  return out;
}

// "30 deg" and 0.5235987755982988, "500 ms" and 0.5, [0, 1] and ["0 m", 1.0].
bool same_value(const std::string& a, const std::string& b) {
  constexpr double kRounded =
      1e-12;  // a unit is converted to some 1e-16; nobody writes a 13th digit to mean another value
  const auto same = [](const std::string& one, const std::string& other) {
    const auto x = parse_any_quantity(one), y = parse_any_quantity(other);
    return one == other || (x && y && std::abs(x->value - y->value) <= kRounded * std::abs(x->value));
  };
  const auto of_a = values_in(a), of_b = values_in(b);
  return std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), same);
}

// What a key is where it is not given; "" where nothing is.
std::string default_of(const std::string& key) {
  const std::string section = key.substr(0, key.find('.')), last = key.substr(key.rfind('.') + 1);
  for (const SectionSpec& s : model_schema())
    if (s.name == section)
      for (const KeySpec& k : s.keys)
        if (k.name == last) return std::string(k.default_text);
  return "";
}

bool is_same(const KeyDifference& d) {
  const std::string unless_given = default_of(d.key);
  const std::string &now = d.now ? *d.now : unless_given, &before = d.before ? *d.before : unless_given;
  return !now.empty() && same_value(now, before);
}

void compare_models(const RunFolder& a, const RunFolder& b, std::vector<std::string>& models) {
  constexpr size_t kMost = 10;
  if (a.blocks.rows.size() != b.blocks.rows.size()) {
    models.push_back(
        fmt::format("{} blocks in {}, {} in {}", a.blocks.rows.size(), a.name, b.blocks.rows.size(), b.name));
  } else {
    for (size_t r = 0; r < a.blocks.rows.size(); ++r)
      if (const auto& x = a.blocks.rows[r], &y = b.blocks.rows[r];
          !std::equal(x.begin(), x.end(), y.begin(), y.end(), same_cell)) {
        models.push_back(fmt::format("block {} is another in {} (blocks.csv)", r, b.name));
        break;
      }
  }
  if (digests_read(a) != digests_read(b))
    models.push_back("files that the models read (motions, meshes, blocks) differ in content");
  if (a.model.empty() || b.model.empty() || a.model == b.model) return;
  const ModelKeys now = keys_in_force(a.model), before = keys_in_force(b.model);
  size_t count = 0;
  for (const KeyDifference& d : differences(now, before))
    if (!is_of_the_solution(d.key) && !is_same(d) && ++count <= kMost)
      models.push_back(fmt::format("{}: {} in {}, {} in {}", d.key, d.now ? *d.now : "not given", a.name,
                                   d.before ? *d.before : "not given", b.name));
  if (count > kMost) models.push_back(fmt::format("and {} keys more", count - kMost));
}

}  // namespace

double Difference::share() const {
  return scale > 0 ? most / scale : most > 0 ? std::numeric_limits<double>::infinity() : 0;
}

Comparison compare_runs(const RunFolder& a, const RunFolder& b) {
  Comparison out;
  for (const RunFolder* run : {&a, &b}) {
    judge_side(*run, out.faults);
    if (run->summary.contains("valid") && run->summary["valid"].is_null())
      out.notes.push_back(fmt::format("{} was not audited", run->name));
  }
  const std::string of_a = a.summary.value("arithmetic", ""), of_b = b.summary.value("arithmetic", "");
  if (!of_a.empty() && !of_b.empty() && of_a != of_b)
    out.notes.emplace_back("they were made by two mathematics libraries: last digits differ");
  compare_files(a, b, out.faults);
  compare_stages(a, b, out.faults);
  compare_models(a, b, out.models);
  compare_histories(a, b, out);
  compare_joints(a, b, out);
  compare_ledgers(a, b, out);
  if (out.list.empty())
    out.faults.push_back("they have nothing in common: no stage of one name, no monitor of one name");
  return out;
}

bool beyond(const Difference& d, const Tolerance& t) { return !(d.most <= t.atol + t.rtol * d.scale); }

void Tolerances::add(const std::string& text, double Tolerance::*part) {
  const size_t at = text.find('=');
  const std::string name = at == std::string::npos ? "" : text.substr(0, at),
                    number = at == std::string::npos ? text : text.substr(at + 1);
  char* end = nullptr;
  const double value = std::strtod(number.c_str(), &end);
  if (number.empty() || *end != '\0' || !std::isfinite(value) || value < 0 || (at == 0))
    throw Error(kExitUsage,
                fmt::format("\"{}\" is no tolerance: give a number from 0 on, or QUANTITY=NUMBER", text));
  by_name_[name].*part = value;
}

bool Tolerances::fits(const std::string& name, const Difference& d) {
  const ColumnTitle title = parts_of_title(d.what);
  return name.empty() || name == d.kind || name == title.unit || title.quantity.rfind(name, 0) == 0;
}

Tolerance Tolerances::of(const Difference& d) const {
  const std::pair<const std::string, Tolerance>* best = nullptr;
  for (const auto& one : by_name_)
    if (fits(one.first, d) && (!best || one.first.size() > best->first.size())) best = &one;
  return best ? best->second : Tolerance{};
}

std::vector<std::string> Tolerances::unused(const std::vector<Difference>& list) const {
  std::vector<std::string> out;
  for (const auto& entry : by_name_) {
    const auto fits_it = [&entry](const Difference& d) { return fits(entry.first, d); };
    if (std::none_of(list.begin(), list.end(), fits_it)) out.push_back(entry.first);
  }
  return out;
}

}  // namespace talus::report
