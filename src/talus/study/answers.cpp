#include "talus/study/answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "talus/base/text.h"
#include "talus/schema/expression.h"

namespace talus::study {

namespace {

using nlohmann::json;

std::string as_name(const std::string& text) {
  std::string out = text.substr(0, text.find(" ["));
  for (char& c : out)
    if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '_' && c != '.')
      c = '_';
  return out;
}

double evaluate(const std::string& formula, const Numbers& numbers, std::string& trouble) {
  Numbers used;
  for (const std::string& name : names_in_formula(formula)) {
    const auto at = numbers.find(name);
    // a set of which nothing slipped or broke is not listed
    if (at == numbers.end() && name.find("_by_set.") != std::string::npos && numbers.count("joints.points"))
      used[name] = 0;
    if (at == numbers.end()) continue;
    if (std::isnan(at->second)) return std::nan("");
    used.insert(*at);
  }
  return evaluate_with(formula, used, trouble);
}

// Ends of the parts of a formula between these operators, outside of parentheses; one part: it has none.
std::vector<std::string> parts_between(const std::string& formula,
                                       const std::vector<std::string>& operators) {
  std::vector<std::string> out(1);
  int depth = 0;
  for (size_t i = 0; i < formula.size(); ++i) {
    depth += formula[i] == '(', depth -= formula[i] == ')';
    const auto here = depth > 0 ? operators.end()
                                : std::find_if(operators.begin(), operators.end(), [&](const std::string& o) {
                                    return formula.compare(i, o.size(), o) == 0;
                                  });
    if (here == operators.end())
      out.back() += formula[i];
    else
      i += here->size() - 1, out.emplace_back();
  }
  return out;
}

// What stands in parentheses, outside of others: of a function each argument.
std::vector<std::string> in_parentheses(const std::string& formula) {
  std::vector<std::string> out;
  int depth = 0;
  size_t from = 0;
  for (size_t i = 0; i < formula.size(); ++i) {
    if (formula[i] == '(' && depth++ == 0) from = i + 1;
    if (formula[i] == ')' && --depth == 0)
      for (std::string& part : parts_between(formula.substr(from, i - from), {","}))
        out.push_back(std::move(part));
  }
  return out;
}

// Whether a comparison that the formula hangs on is of a number that is not finite: it would be false, and told as an answer.
// What follows a part that decides (false && ..., true || ...) is not asked, nor what a ? chooses from.
bool compares_no_number(const std::string& formula, const Numbers& numbers) {
  std::string trouble;
  if (const auto choice = parts_between(formula, {"?"}); choice.size() > 1)
    return compares_no_number(choice[0], numbers);
  for (const char* join : {"||", "&&"}) {
    const auto parts = parts_between(formula, {join});
    if (parts.size() == 1) continue;
    for (const std::string& part : parts) {
      if (compares_no_number(part, numbers)) return true;
      if ((evaluate(part, numbers, trouble) != 0) == (join[0] == '|')) return false;
    }
    return false;
  }
  const auto asked = [&](const std::string& part) { return compares_no_number(part, numbers); };
  const auto sides = parts_between(formula, {"<=", ">=", "==", "!=", "<", ">"});
  if (sides.size() > 1)
    return std::any_of(sides.begin(), sides.end(), [&](const std::string& side) {
      return !std::isfinite(evaluate(side, numbers, trouble)) || asked(side);
    });
  const auto inner = in_parentheses(formula);
  return std::any_of(inner.begin(), inner.end(), asked);
}

void add_leaves(const std::string& prefix, const json& j, Numbers& out) {
  for (const auto& [key, value] : j.items()) {
    const std::string name = prefix + as_name(key);
    if (value.is_number()) out[name] = value.get<double>();
    if (value.is_object()) add_leaves(name + ".", value, out);
  }
}

void add_column(const std::string& name, const json& column, Numbers& out) {
  for (const auto& [key, value] : column.items())
    out[name + "." + as_name(key)] = value.is_number() ? value.get<double>() : std::nan("");
  if (column.contains("least") && column["least"].is_number() && column["greatest"].is_number())
    out[name + ".largest"] =
        std::max(std::abs(column["least"].get<double>()), std::abs(column["greatest"].get<double>()));
}

constexpr const char* kOfColumn[] = {"at_start", "at_end",   "least",         "greatest",
                                     "largest",  "residual", "time_of_least", "time_of_greatest"};

}  // namespace

Numbers numbers_of(const json& summary) {
  Numbers out;
  for (const char* section : {"joints", "moved", "blocks", "contacts", "solver"})
    if (const auto at = summary.find(section); at != summary.end() && at->is_object())
      add_leaves(std::string(section) + ".", *at, out);
  if (const auto at = summary.find("energy_closure"); at != summary.end() && at->is_number())
    out["energy_closure"] = at->get<double>();
  const auto monitors = summary.find("monitors"), stages = summary.find("stages");
  if (monitors == summary.end() || !monitors->is_object()) return out;
  std::string last;
  if (stages != summary.end() && stages->is_array() && !stages->empty())
    last = stages->back().value("name", "");
  for (const auto& [monitor, all] : monitors->items()) {
    for (const auto& [key, value] : all.items())
      if (value.is_number()) out[as_name(monitor) + "." + as_name(key)] = value.get<double>();
    if (!all.contains("stages")) continue;
    for (const auto& [stage, columns] : all["stages"].items())
      for (const auto& [title, column] : columns.items()) {
        const std::string name = as_name(monitor) + "." + as_name(title);
        add_column(as_name(stage) + "." + name, column, out);
        if (stage == last) add_column(name, column, out);
      }
  }
  return out;
}

Numbers possible_numbers(const std::vector<std::string>& columns, const std::vector<std::string>& stages,
                         const std::vector<std::string>& sets) {
  Numbers out;
  for (const char* name : {"joints.time",
                           "joints.points",
                           "joints.intact",
                           "joints.slipped",
                           "joints.open",
                           "joints.slip_largest",
                           "joints.opening_largest",
                           "joints.slip_times_length",
                           "joints.broken_length",
                           "joints.slipped_joints",
                           "joints.residual_slip_largest",
                           "moved.blocks",
                           "moved.area",
                           "blocks.all",
                           "contacts.bond_faces",
                           "contacts.bond_faces_broken",
                           "energy_closure",
                           "solver.failed_steps",
                           "solver.loose_steps",
                           "solver.contact_error_worst"})
    out[name] = 1;
  for (const std::string& set : sets)
    for (const char* what : {"joints.slip_largest_by_set.", "joints.broken_length_by_set."})
      out[what + as_name(set)] = 1;
  for (const std::string& column : columns) {
    const std::string name = as_name(column), monitor = name.substr(0, name.find('.'));
    for (const char* what : kOfColumn) {
      out[name + "." + what] = 1;
      for (const std::string& stage : stages) out[as_name(stage) + "." + name + "." + what] = 1;
    }
    for (const char* what : {".peak_velocity", ".first_touch", ".last_touch"}) out[monitor + what] = 1;
  }
  return out;
}

std::vector<double> evaluate_answers(const Study& study, Numbers& numbers, std::string& trouble) {
  std::vector<double> out;
  for (const NamedFormula& answer : study.answers) {
    std::string why;
    out.push_back(evaluate(answer.formula, numbers, why));
    if (!why.empty()) trouble = fmt::format("answer \"{}\": {}", answer.name, why);
    numbers[answer.name] = out.back();
  }
  return out;
}

int is_damaged(const DamageState& state, const Numbers& numbers, std::string& trouble) {
  std::string why;
  double value = evaluate(state.when, numbers, why);
  if (why.empty() && compares_no_number(state.when, numbers))
    value = std::nan(""), why = fmt::format("\"{}\" compares what is not finite", state.when);
  if (!why.empty()) trouble = fmt::format("failure \"{}\": {}", state.name, why);
  return std::isnan(value) ? -1 : value != 0;
}

namespace {

// "slip_largest [m]" has m.
std::string unit_in(const std::string& title) {
  const size_t at = title.find(" [");
  return at == std::string::npos || title.back() != ']' ? "" : title.substr(at + 2, title.size() - at - 3);
}

// The unit of the key of a summary that this name stands for: its parts in turn, as numbers_of() names them.
std::string unit_of(const json& j, const std::string& name) {
  for (const auto& [key, value] : j.items()) {
    const std::string own = as_name(key);
    if (name != own && name.rfind(own + ".", 0) != 0) continue;
    if (const std::string unit = unit_in(key); !unit.empty())
      return name.find("time_of_") == std::string::npos ? unit : "s";
    if (name != own && value.is_object())
      if (const std::string unit = unit_of(value, name.substr(own.size() + 1)); !unit.empty()) return unit;
  }
  return "";
}

}  // namespace

void add_units(const Study& study, const json& summary, std::vector<std::string>& units) {
  for (size_t k = 0; k < units.size(); ++k) {
    const auto names = names_in_formula(study.answers[k].formula);
    if (!units[k].empty() || names.size() != 1 || *names.begin() != trimmed(study.answers[k].formula))
      continue;
    const std::string name = *names.begin();
    for (size_t before = 0; before < k; ++before)
      if (study.answers[before].name == name) units[k] = units[before];
    if (units[k].empty()) units[k] = unit_of(summary, name);
    // monitors: of a stage that is named, or of any
    const auto monitors = summary.find("monitors");
    if (!units[k].empty() || monitors == summary.end() || !monitors->is_object()) continue;
    for (const auto& [monitor, all] : monitors->items()) {
      if (units[k].empty()) units[k] = unit_of(json{{monitor, all}}, name);
      if (!all.contains("stages")) continue;
      for (const auto& [stage, columns] : all["stages"].items())
        for (const std::string& begin : {std::string(), as_name(stage) + "."})
          if (units[k].empty() && name.rfind(begin, 0) == 0)
            units[k] = unit_of(json{{monitor, columns}}, name.substr(begin.size()));
    }
  }
}

namespace {

// What the first name that there is not might have been.
std::string hint_for(const std::string& formula, const Numbers& numbers) {
  for (const std::string& name : names_in_formula(formula)) {
    if (numbers.count(name)) continue;
    const size_t dot = name.rfind('.');
    if (dot == std::string::npos) {
      std::vector<std::string> own;
      for (const auto& [known, value] : numbers)
        if (known.find('.') == std::string::npos) own.push_back(known);
      if (const std::string near = closest_name(name, own); !near.empty())
        return fmt::format("did you mean \"{}\"?", near);
      continue;
    }
    // the same beginning, another end
    std::vector<std::string> ends, all;
    for (const auto& [known, value] : numbers) {
      if (known.rfind(name.substr(0, dot + 1), 0) == 0) ends.push_back(known.substr(dot + 1));
      all.push_back(known);
    }
    if (!ends.empty()) return fmt::format("{} has {}", name.substr(0, dot), join_or(ends));
    if (const std::string near = closest_name(name, all); !near.empty())
      return fmt::format("did you mean \"{}\"?", near);
  }
  return "names are answers given before it, MONITOR.QUANTITY.largest (at_start, at_end, least, greatest, residual) and those of summary.json; "
         "numbers are in SI without units, equal is ==";
}

}  // namespace

void check_formulas(const Study& study, Numbers numbers, Findings& findings) {
  const auto check = [&](const std::string& formula, const Where& where, const std::string& path) {
    std::string trouble;
    evaluate(formula, numbers, trouble);
    if (trouble.empty() || trouble.find("is not finite") != std::string::npos) return;
    findings.error(where, path, trouble, hint_for(formula, numbers));
  };
  for (const NamedFormula& answer : study.answers) {
    check(answer.formula, answer.where, "answers." + answer.name);
    numbers[answer.name] = 1;
  }
  for (const DamageState& state : study.states)
    check(state.when, state.where, "failure." + state.name + ".when");
}

}  // namespace talus::study
