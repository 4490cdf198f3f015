#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <set>

#include "talus/base/error.h"
#include "talus/base/name.h"
#include "talus/base/random.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"
#include "talus/schema/read_section.h"
#include "talus/schema/variables.h"
#include "talus/study/study.h"

namespace talus::study {

namespace fs = std::filesystem;

namespace {

constexpr int64_t kMostRuns = 1000000;

using K = KeyType;

std::vector<SectionSpec> sections() {
  return {
      {"top",
       SectionShape::kTop,
       "First lines of the file.",
       {key("talus_study", K::kInteger, Range{.min = 1, .max = 1}, kRequired, "Number of the format: 1."),
        key("title", K::kText, Default{"\"\""}, "Free text, shown in the report."),
        key("model", K::kText, kRequired,
            "Model file that is run; the path counts from the folder of the study file."),
        key("set", K::kTexts, "Overrides for all runs, \"KEY=VALUE\" as behind --set."),
        key("keep", Choices{{"all", "answers"}}, Default{"\"all\""},
            "What stays of a run: its whole result folder, or summary.json and monitors.csv alone (thousands of runs)."),
        key("report", K::kBool, Default{"false"},
            "Make report.html of every run; the table of the study opens it. Needs keep = \"all\"."),
        key("share_static", K::kBool, Default{"true"},
            "Run the static stages that come first once for all runs whose keys differ only in what begins later, and branch off (Branches, in docs/file_format.md). Keys of `[solver]` and `[[stage]]` are not shared over: they tell in the stages before.")}},
      {"vary",
       SectionShape::kList,
       "A key of the model that varies. Give one of `values` (a list), `range` `{ from, to, count }`, `files`, `distribution` `{ mean, normal }`, `{ mean, lognormal }` or `{ from, to }` (with `least`, `most` where it is cut off). Listed keys make every combination; sampled ones are drawn together, `sampling.runs` times for each combination.",
       {key("key", K::kText, kRequired,
            "Key of the model file, as behind --set: `variables.phi`, `joint.bed.friction_angle.seed`, `history.base.file`."),
        key("name", K::kText, "Name in tables and figures; none: the last part of the key."),
        key("files", K::kText,
            "Pattern of file names (`*`, `?`, `[abc]`), `motions/*.csv`, from the folder of the study: each file is a value."),
        key("measure", K::kText,
            "With `values` or `range`: these are what a motion is scaled to, and the key is a factor (`history.base.scale`): \"PGA\", \"PGV\" or \"Sa(0.5 s)\" (5 % damping)."),
        key("motion", K::kText,
            "With `measure`: name of the [[vary]] whose files are scaled; none: the only one with `files`.")}},
      {"sampling",
       SectionShape::kTable,
       "How keys with a `distribution` are drawn.",
       {key("runs", K::kInteger, Range{.min = 1, .max = 1e6}, "Number of samples."),
        key("seed", K::kInteger, Range{.min = 0, .max = 9e15}, Default{"0"},
            "Seed; the same seed draws the same samples."),
        key("method", Choices{{"latin_hypercube", "random"}}, Default{"\"latin_hypercube\""},
            "`latin_hypercube`: each key takes one value of each of as many equally likely parts of its distribution as there are samples.")}},
      {"failure",
       SectionShape::kNamed,
       "A state of damage. One alone may be written `[failure]`.",
       {key("when", K::kText, kRequired,
            "Formula in answers; the run is in this state when it is true: \"drift > 0.02\"."),
        key("invalid", Choices{{"left out", "failed"}}, Default{"\"left out\""},
            "What a run counts as in results.csv that is not valid (by its audit, or ended by failure of numbers): as neither, or as failed. Curves are drawn for both, and with it as sound.")}},
      {"fragility",
       SectionShape::kTable,
       "Probability of the states of damage, and answers, over one key that varies.",
       {key("over", K::kText,
            "Name of a [[vary]] with numbers; none: the one with `measure`, if there is one.")}}};
}

std::optional<AnyQuantity> quantity_of(const toml::node& node) {
  if (node.is_number()) return AnyQuantity{*node.value<double>(), "", *node.value<double>()};
  const auto text = node.value_exact<std::string>();
  const auto q = text ? parse_any_quantity(*text) : std::nullopt;
  return q && std::isfinite(q->number) ? q : std::nullopt;
}

// An override is a line: long lists are written in several.
std::string in_one_line(std::string text, const std::string& instead) {
  for (size_t at; (at = text.find('\n')) != std::string::npos;) text.replace(at, 1, instead);
  return text;
}

std::string digits(double v) {
  return v == std::floor(v) && std::abs(v) < 1e15 ? fmt::format("{}", static_cast<int64_t>(v))
                                                  : fmt::format("{}", v);
}

AxisValue value_of(double number, const std::string& unit) {
  AxisValue v;
  v.number = number, v.shown = digits(number);
  v.toml = unit.empty() ? v.shown : in_quotes(v.shown + " " + unit);
  return v;
}

// Paths that a pattern of the shell stands for, below a folder whose name is none; in order.
std::vector<fs::path> paths_of(const fs::path& folder, const std::string& pattern) {
  std::string whole;
  for (const char c : folder.string())
    whole += std::strchr("*?[]\\", c) ? std::string("\\") + c : std::string(1, c);
  whole = (fs::path(whole) / pattern).string();
  glob_t found{};
  std::vector<fs::path> paths;
  if (glob(whole.c_str(), 0, nullptr, &found) == 0)
    for (size_t i = 0; i < found.gl_pathc; ++i) paths.emplace_back(found.gl_pathv[i]);
  globfree(&found);
  return paths;
}

// What stood for the first part of a pattern that is no name, without ending: what tells its paths apart.
std::string name_of_match(const fs::path& path, const fs::path& pattern) {
  const auto parts = std::distance(pattern.begin(), pattern.end()),
             all = std::distance(path.begin(), path.end());
  auto there = std::next(path.begin(), all - parts);
  for (const fs::path& part : pattern) {
    if (part.string().find_first_of("*?[") != std::string::npos) return there->stem().string();
    ++there;
  }
  return path.stem().string();
}

class StudyReader {
 public:
  StudyReader(TomlSource& source, Study& study, Findings& findings)
      : source_(source), study_(study), findings_(findings) {}

  void read() {
    check_sections();
    const Fields top = read_section(spec("top"), source_.root, "", {1, 1, ""}, source_, findings_);
    folder_ = fs::path(study_.file).parent_path();
    study_.title = top.get<std::string>("title");
    study_.model = folder_ / top.get<std::string>("model");
    study_.set = top.get<std::vector<std::string>>("set");
    study_.keep_all = top.get<std::string>("keep") != "answers";
    study_.report = top.get("report", false), study_.share = top.get("share_static", true);
    if (study_.report && !study_.keep_all)
      findings_.error(top.where("report"), "report", "needs the results of the runs", "give keep = \"all\"");
    read_vary();
    read_sampling();
    read_answers();
    read_states();
    read_fragility();
    if (study_.axes.empty())
      findings_.error({1, 1, ""}, "vary", "is missing: nothing varies", "add [[vary]] with key and values");
    check_count();
  }

 private:
  static const SectionSpec& spec(const std::string& name) {
    for (const SectionSpec& s : study_schema())
      if (s.name == name) return s;
    fail_assertion("the section is in the schema of studies", __FILE__, __LINE__);
  }

  void check_sections() {
    std::vector<std::string> known{"variables", "answers"};
    for (const SectionSpec& s : study_schema()) {
      if (s.shape != SectionShape::kTop) known.emplace_back(s.name);
      if (s.shape == SectionShape::kTop)
        for (const KeySpec& k : s.keys) known.emplace_back(k.name);
    }
    for (const auto& [key, node] : source_.root) {
      const std::string name(key.str());
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      const std::string near = closest_name(name, known);
      findings_.error(where_of(key.source()), name, "is no key or section of a study",
                      near.empty() ? fmt::format("there is {}", join_or(known))
                                   : fmt::format("did you mean \"{}\"?", near));
    }
  }

  void read_vary() {
    toml::node* node = source_.root.get("vary");
    if (!node) return;
    if (!node->is_array_of_tables()) {
      findings_.error(where_of(node->source()), "vary", "is a list: write [[vary]] with double brackets");
      return;
    }
    std::set<std::string> names;
    int index = 0;
    for (toml::node& entry : *node->as_array()) {
      toml::table& t = *entry.as_table();
      const std::string path = fmt::format("vary.{}", index++);
      // values of any type are read here, the others by the schema
      toml::table plain;
      Axis axis;
      axis.where = where_of(t.source());
      int ways = 0;
      for (const char* way : {"values", "range", "distribution", "files"}) ways += t.contains(way);
      if (ways != 1) {
        findings_.error(axis.where, path,
                        ways == 0 ? "does not say what the key takes" : "says it in more than one way",
                        "give one of values, range, files, distribution");
        continue;
      }
      for (auto&& [key, value] : t)
        if (key.str() != "values" && key.str() != "range" && key.str() != "distribution")
          plain.insert(key, value);
      const Fields f = read_section(spec("vary"), plain, path, axis.where, source_, findings_);
      axis.key = f.get<std::string>("key");
      axis.name = f.get<std::string>("name");
      if (axis.name.empty()) axis.name = axis.key.substr(axis.key.rfind('.') + 1);
      if (const std::string defect = name_defect(axis.name); !defect.empty() && !axis.key.empty())
        findings_.error(f.where("name"), path + ".name",
                        fmt::format("\"{}\" is no name: {}", shown_name(axis.name), defect));
      if (!names.insert(axis.name).second)
        findings_.error(axis.where, path, fmt::format("a second [[vary]] is called \"{}\"", axis.name),
                        "give it a name");
      for (const Axis& other : study_.axes)
        if (!axis.key.empty() && other.key == axis.key)
          findings_.error(axis.where, path,
                          fmt::format("\"{}\" varies already, as \"{}\"", axis.key, other.name),
                          "the last one would hold for all runs: leave one out");
      if (axis.name == "run" || axis.name == "status" || axis.name == "host" || axis.name == "message")
        findings_.error(f.where("name"), path + ".name",
                        fmt::format("\"{}\" is a column of the table", axis.name), "give it another name");
      if (t.contains("values")) read_values(*t.get("values"), path, axis);
      if (t.contains("range")) read_range(*t.get("range"), path, axis);
      if (t.contains("distribution")) read_distribution(*t.get("distribution"), path, axis);
      if (t.contains("files")) read_files(f, path, axis);
      read_measure(f, path, axis);
      study_.axes.push_back(std::move(axis));
    }
    find_motions();
  }

  void read_values(const toml::node& node, const std::string& path, Axis& axis) {
    const toml::array* list = node.as_array();
    if (!list || list->empty()) {
      findings_.error(where_of(node.source()), path + ".values", "is no list of values",
                      "write values = [1, 2, 3] or [\"30 deg\", \"35 deg\"]");
      return;
    }
    bool numbers = true, quantities = true;
    std::string unit;
    for (const toml::node& item : *list) {
      const auto v = quantity_of(item);
      if (v && axis.values.empty()) unit = v->unit;
      numbers = numbers && v && v->unit == unit, quantities = quantities && v;
      AxisValue value;
      if (v) {
        value = value_of(v->number, v->unit);
      } else {
        std::ostringstream out;
        if (const auto text = item.value_exact<std::string>())
          value.shown = *text, value.toml = in_one_line(in_quotes(*text), "\\n");
        else
          item.visit([&out](const auto& n) { out << n; }),
              value.shown = value.toml = in_one_line(out.str(), " ");
      }
      axis.values.push_back(value);
    }
    if (quantities && !numbers)
      findings_.error(where_of(node.source()), path + ".values", "has more than one unit",
                      "write all values in one");
    std::set<std::string> seen;
    for (const AxisValue& v : axis.values)
      if (!seen.insert(v.toml).second)
        findings_.error(where_of(node.source()), path + ".values", fmt::format("{} is given twice", v.shown),
                        "its runs would count twice: leave one out");
    if (numbers) axis.unit = unit;
    if (!numbers)
      for (size_t i = 0; i < axis.values.size(); ++i) {
        const auto v = quantity_of(*list->get(i));
        axis.values[i].number = std::numeric_limits<double>::quiet_NaN();
        if (v && !v->unit.empty()) axis.values[i].shown += " " + v->unit;
      }
  }

  // { from = ..., to = ..., count = N }
  void read_range(const toml::node& node, const std::string& path, Axis& axis) {
    const toml::table* t = node.as_table();
    const auto bad = [&] {
      findings_.error(
          where_of(node.source()), path + ".range", "is no range",
          "write range = { from = \"0.1 g\", to = \"0.6 g\", count = 6 }, both in one unit, count from 2 on");
    };
    if (!t || t->size() != 3 || !t->contains("from") || !t->contains("to")) return bad();
    const auto from = quantity_of(*t->get("from")), to = quantity_of(*t->get("to"));
    const int64_t count = (*t)["count"].value_or(int64_t{0});
    if (!from || !to || from->unit != to->unit || count < 2 || count > kMostRuns) return bad();
    axis.unit = from->unit;
    for (int64_t i = 0; i < count; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(count - 1);
      // 0.1 and 0.6 in six are 0.2, 0.3 ..., and no 0.30000000000000004
      axis.values.push_back(value_of(
          std::stod(fmt::format("{:.12g}", from->number + share * (to->number - from->number))), axis.unit));
    }
  }

  // { mean = ..., normal = ... }, { mean, lognormal }, { from, to }; with least, most
  void read_distribution(const toml::node& node, const std::string& path, Axis& axis) {
    axis.sampled = true;
    const toml::table* t = node.as_table();
    const auto bad = [&](const std::string& why) {
      findings_.error(
          where_of(node.source()), path + ".distribution", why,
          "write { mean = \"35 deg\", normal = \"3 deg\" }, { mean = ..., lognormal = ... } (standard deviations of the "
          "quantity itself) or { from = ..., to = ... } (uniform), each with least and most if it is cut off; all in one unit");
    };
    if (!t) return bad("is no distribution");
    std::map<std::string, AnyQuantity> given;
    for (const auto& [key, value] : *t) {
      const auto v = quantity_of(value);
      if (!v) return bad(fmt::format("\"{}\" is no number", key.str()));
      given[std::string(key.str())] = *v;
    }
    axis.unit = given.begin()->second.unit;
    for (const auto& [key, v] : given)
      if (v.unit != axis.unit) return bad("has more than one unit");
    Distribution& d = axis.distribution;
    size_t used = 2;
    if (given.count("mean") && given.count("normal") != given.count("lognormal")) {
      d.kind = given.count("normal") ? Distribution::kNormal : Distribution::kLognormal;
      d.mean = given["mean"].number,
      d.deviation = given[d.kind == Distribution::kNormal ? "normal" : "lognormal"].number;
      if (d.deviation <= 0) return bad("has no deviation > 0");
      if (d.kind == Distribution::kLognormal && d.mean <= 0)
        return bad("is lognormal with a mean of 0 or less");
    } else if (given.count("from") && given.count("to")) {
      d.kind = Distribution::kUniform;
      d.mean = 0.5 * (given["from"].number + given["to"].number),
      d.deviation = 0.5 * (given["to"].number - given["from"].number);
      if (d.deviation <= 0) return bad("goes from more to less");
    } else {
      return bad("is none that is known");
    }
    if (given.count("least")) d.least = given["least"].number, ++used;
    if (given.count("most")) d.most = given["most"].number, ++used;
    if (!(d.least < d.most)) return bad("has a least value that is not below its most");
    if (used != given.size()) return bad("has keys that are not known");
  }

  void read_files(const Fields& f, const std::string& path, Axis& axis) {
    axis.files = true;
    const std::string pattern = f.get<std::string>("files");
    for (const fs::path& file : paths_of(folder_, pattern)) {
      std::error_code ec;
      if (!fs::is_regular_file(file, ec)) continue;
      axis.paths.push_back(file);
      axis.values.push_back({in_quotes(fs::weakly_canonical(file).string()), name_of_match(file, pattern)});
    }
    std::set<std::string> names;
    for (const AxisValue& v : axis.values) names.insert(v.shown);
    if (names.size() < axis.values.size())  // told apart by what the pattern leaves open
      for (size_t i = 0; i < axis.paths.size(); ++i)
        axis.values[i].shown = axis.paths[i].lexically_relative(folder_.empty() ? "." : folder_).string();
    if (axis.paths.empty())
      findings_.error(
          f.where("files"), path + ".files", fmt::format("\"{}\" are no files", (folder_ / pattern).string()),
          "the path counts from the folder of the study file; * stands for anything within a name, ? for one character, [abc] for one of these");
  }

  void read_measure(const Fields& f, const std::string& path, Axis& axis) {
    const std::string text = f.get<std::string>("measure");
    axis.motion = f.get<std::string>("motion");
    if (text.empty()) {
      if (f.given("motion"))
        findings_.error(f.where("motion"), path + ".motion", "belongs to a measure", "leave it out");
      return;
    }
    if (text == "PGA" || text == "PGV") {
      axis.measure = text;
    } else if (text.rfind("Sa(", 0) == 0 && text.back() == ')') {
      const Quantity period = parse_quantity(text.substr(3, text.size() - 4), Dimension::kTime);
      if (period.error.empty() && period.value > 0) axis.measure = "Sa", axis.period = period.value;
    }
    if (axis.measure.empty()) {
      findings_.error(f.where("measure"), path + ".measure", fmt::format("\"{}\" is not known", text),
                      "give \"PGA\", \"PGV\" or \"Sa(0.5 s)\"");
      return;
    }
    const Dimension dimension = axis.measure == "PGV" ? Dimension::kVelocity : Dimension::kAcceleration;
    for (const AxisValue& v : axis.values)
      if (!(v.number > 0) || !parse_quantity(v.shown + " " + axis.unit, dimension).error.empty()) {
        findings_.error(
            axis.where, path,
            fmt::format("{} {} is no {} that a motion could be scaled to", v.shown, axis.unit, axis.measure),
            fmt::format("give {} above 0", describe(dimension)));
        return;
      }
  }

  void find_motions() {
    std::vector<std::string> with_files;
    for (const Axis& a : study_.axes)
      if (a.files) with_files.push_back(a.name);
    for (Axis& a : study_.axes) {
      if (a.measure.empty()) continue;
      if (a.motion.empty() && with_files.size() == 1) a.motion = with_files[0];
      if (std::find(with_files.begin(), with_files.end(), a.motion) == with_files.end())
        findings_.error(a.where, "vary." + a.name,
                        a.motion.empty()
                            ? "scales a motion, and does not say which"
                            : fmt::format("there is no [[vary]] with files called \"{}\"", a.motion),
                        with_files.empty() ? "add a [[vary]] with files"
                                           : fmt::format("give motion = {}", join_or(with_files)));
    }
  }

  void read_sampling() {
    const toml::table none;
    const toml::node* node = source_.root.get("sampling");
    const Fields f = read_section(spec("sampling"), node && node->is_table() ? *node->as_table() : none,
                                  "sampling", node ? where_of(node->source()) : Where{}, source_, findings_);
    study_.samples = static_cast<int>(f.get<int64_t>("runs")), study_.seed = f.get<int64_t>("seed");
    study_.latin_hypercube = f.get<std::string>("method") != "random";
    const bool sampled =
        std::any_of(study_.axes.begin(), study_.axes.end(), [](const Axis& a) { return a.sampled; });
    if (sampled && study_.samples == 0)
      findings_.error({1, 1, ""}, "sampling.runs",
                      "is missing: keys with a distribution are drawn so many times",
                      "add [sampling] with runs = 100");
    if (!sampled && node)
      findings_.error(f.where(), "sampling", "draws nothing: no key has a distribution", "leave it out");
    for (Axis& a : study_.axes)
      if (a.sampled) draw(a);
  }

  void draw(Axis& axis) {
    Random random(stream_seed(static_cast<uint64_t>(study_.seed), axis.name));
    const int n = study_.samples;
    std::vector<size_t> part(n);
    for (int i = 0; i < n; ++i) part[i] = i;
    if (study_.latin_hypercube)
      for (size_t i = n; i > 1; --i)
        std::swap(part[i - 1], part[static_cast<size_t>(random.uniform() * static_cast<double>(i))]);
    for (int i = 0; i < n; ++i) {
      const double r = random.uniform();
      // never 0 or 1
      const double u = study_.latin_hypercube
                           ? (static_cast<double>(part[i]) + std::max(r, 1e-9)) / static_cast<double>(n)
                           : std::max(r, 1e-12);
      axis.values.push_back(
          value_of(std::stod(fmt::format("{:.9g}", axis.distribution.quantile(u))), axis.unit));
    }
  }

  void read_answers() {
    const toml::node* node = source_.root.get("answers");
    if (!node) return;
    const toml::table* t = node->as_table();
    if (!t) {
      findings_.error(where_of(node->source()), "answers", "is written [answers]");
      return;
    }
    for (const auto& [key, value] : *t) {
      const std::string name(key.str()), path = "answers." + name;
      const toml::table* with_unit = value.as_table();
      const bool known = !with_unit || (with_unit->size() == 2 && with_unit->contains("unit"));
      const auto formula = with_unit && known ? (*with_unit)["formula"].value_exact<std::string>()
                                              : value.value_exact<std::string>();
      if (!formula)
        findings_.error(
            where_of(key.source()), path, "is no formula in quotes",
            "write drift = \"top.displacement_x.largest / 3\", or { formula = \"...\", unit = \"m\" }");
      const std::string unit = with_unit ? (*with_unit)["unit"].value_or(std::string("?")) : "";
      const auto one = parse_any_quantity("1 " + unit);
      if (with_unit && (!one || one->value != 1))
        findings_.error(where_of(key.source()), path + ".unit", fmt::format("\"{}\" is no unit of SI", unit),
                        "formulas count in SI, and so do answers: m, m/s, N, Pa, rad");
      if (name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") !=
          std::string::npos)
        findings_.error(where_of(key.source()), path, "is no name of an answer",
                        "letters a to z, digits and _");
      if (formula) study_.answers.push_back({name, *formula, unit, where_of(value.source())});
    }
    // in the order of the file
    std::stable_sort(
        study_.answers.begin(), study_.answers.end(),
        [](const NamedFormula& a, const NamedFormula& b) { return a.where.line < b.where.line; });
  }

  void read_states() {
    const toml::node* node = source_.root.get("failure");
    if (!node) return;
    const toml::table* t = node->as_table();
    if (!t) {
      findings_.error(where_of(node->source()), "failure", "is written [failure] or [failure.NAME]");
      return;
    }
    const auto add = [&](const std::string& name, const toml::table& table, const std::string& path) {
      const Fields f =
          read_section(spec("failure"), table, path, where_of(table.source()), source_, findings_);
      study_.states.push_back(
          {name, f.get<std::string>("when"), f.get<std::string>("invalid") == "failed", f.where("when")});
    };
    if (const toml::node* when = t->get("when"); when && when->is_string())
      return add("failure", *t, "failure");
    for (const auto& [key, value] : *t) {
      const std::string path = "failure." + std::string(key.str());
      if (const toml::table* state = value.as_table())
        add(std::string(key.str()), *state, path);
      else
        findings_.error(where_of(key.source()), path, "is no section",
                        "write [failure.NAME] with when = \"...\", or [failure] with when");
    }
    std::stable_sort(study_.states.begin(), study_.states.end(),
                     [](const DamageState& a, const DamageState& b) { return a.where.line < b.where.line; });
  }

  void read_fragility() {
    const toml::table none;
    const toml::node* node = source_.root.get("fragility");
    const Fields f = read_section(spec("fragility"), node && node->is_table() ? *node->as_table() : none,
                                  "fragility", node ? where_of(node->source()) : Where{}, source_, findings_);
    study_.over = f.get<std::string>("over");
    std::vector<std::string> names;
    for (const Axis& a : study_.axes) {
      const bool numbers = std::all_of(a.values.begin(), a.values.end(),
                                       [](const AxisValue& v) { return std::isfinite(v.number); });
      if (numbers && !a.values.empty()) names.push_back(a.name);
      if (study_.over.empty() && !a.measure.empty() && !f.given("over")) study_.over = a.name;
    }
    for (const Axis& a : study_.axes)
      if (a.name == study_.over)
        for (const AxisValue& v : a.values)
          if (!a.sampled && !(v.number > 0) && std::isfinite(v.number)) {
            findings_.error(a.where, "vary." + a.name, fmt::format("{} has no logarithm", v.shown),
                            "fragility is over values above 0");
            break;
          }
    if (f.given("over") && std::find(names.begin(), names.end(), study_.over) == names.end())
      findings_.error(f.where("over"), "fragility.over",
                      fmt::format("there is no [[vary]] with numbers called \"{}\"", study_.over),
                      names.empty() ? "" : fmt::format("there is {}", join_or(names)));
  }

  void check_count() {
    double count = 1;
    bool sampled = false;
    for (const Axis& a : study_.axes) {
      if (a.sampled)
        sampled = true;
      else
        count *= static_cast<double>(std::max<size_t>(a.values.size(), 1));
    }
    if (sampled) count *= std::max(study_.samples, 1);
    if (count > static_cast<double>(kMostRuns))
      findings_.error({1, 1, ""}, "vary", fmt::format("makes {:.3g} runs; {} are the most", count, kMostRuns),
                      "give fewer values, or draw from distributions");
  }

  TomlSource& source_;
  Study& study_;
  Findings& findings_;
  fs::path folder_;
};

}  // namespace

const std::vector<SectionSpec>& study_schema() {
  static const std::vector<SectionSpec> all = sections();
  return all;
}

std::string study_markdown() { return schema_markdown(study_schema()); }

Study read_study(const std::string& file, const std::string& text, Findings& findings) {
  Study study;
  study.file = file, study.text = text;
  TomlSource source = read_toml(text, {}, findings);
  if (!findings.has_errors()) StudyReader(source, study, findings).read();
  return study;
}

}  // namespace talus::study
