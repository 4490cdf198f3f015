#include "talus/schema/variables.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "talus/base/index.h"
#include "talus/base/text.h"
#include "talus/schema/expression.h"
#include "talus/schema/units.h"

namespace talus {

namespace {

constexpr std::string_view kSection = "variables";
constexpr double kMostWhole = 9007199254740992;  // 2^53

bool begins_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_in_name(char c) { return begins_name(c) || (c >= '0' && c <= '9'); }

bool is_variable_name(std::string_view name) {
  if (name.empty() || !begins_name(name[0])) return false;
  for (const char c : name)
    if (!is_in_name(c)) return false;
  return true;
}

// SI value of a number or of a text with a unit of any dimension; none of anything else.
std::optional<double> number_of(const toml::node& node) {
  if (node.is_number()) return node.value<double>();
  const auto text = node.value_exact<std::string>();
  if (!text) return std::nullopt;
  const auto q = parse_any_quantity(*text);
  return q ? std::optional(q->value) : std::nullopt;
}

// A value of any kind that is on its way to its place.
using Held = std::optional<toml::array>;

const std::string* text_with_dollar(const toml::node& node) {
  const auto* text = node.as_string();
  return text && text->get().find('$') != std::string::npos ? &text->get() : nullptr;
}

class Substitution {
 public:
  Substitution(TomlSource& source, Findings& findings) : source_(source), findings_(findings) {
    toml::node* section = source.root.get(kSection);
    if (!section) return;
    variables_ = section->as_table();
    if (!variables_)
      findings_.error(where_of(section->source()), std::string(kSection), "is written [variables]");
  }

  void put() {
    if (variables_) {
      check_names();
      for (const std::string& name : keys_of(*variables_)) resolve(name);
    }
    for (const std::string& key : keys_of(source_.root))
      if (key != kSection) put_at(source_.root, key, key);
  }

 private:
  static std::string path_of(std::string_view name) { return fmt::format("{}.{}", kSection, name); }

  static std::vector<std::string> keys_of(const toml::table& table) {
    std::vector<std::string> keys;
    for (const auto& [key, node] : table) keys.emplace_back(key.str());
    return keys;
  }

  void check_names() {
    for (const auto& [key, node] : *variables_)
      if (!is_variable_name(key.str()))
        findings_.error(where_of(key.source()), path_of(key.str()), "is no name of a variable",
                        "letters a to z, digits and _, no digit first");
  }

  // The value of a variable, without others in it; null where it stands on itself (which is told).
  // @pre  there is one of this name
  const toml::node* resolve(const std::string& name) {
    if (open_.count(name)) return nullptr;
    if (!done_.count(name)) {
      open_.insert(name);
      put_at(*variables_, name, path_of(name));
      open_.erase(name);
      done_.insert(name);
    }
    return variables_->get(name);
  }

  void put_at(toml::table& table, const std::string& key, const std::string& path) {
    toml::node& node = *table.get(key);
    const std::string* text = text_with_dollar(node);
    if (!text) return put_in(node, path);
    if (const Held value = value_of(*text, place_of(node, path), path))
      table.insert_or_assign(key, *value->get(0));
  }

  void put_in(toml::node& node, const std::string& path) {
    if (toml::table* table = node.as_table()) {
      for (const std::string& key : keys_of(*table)) put_at(*table, key, path + "." + key);
    } else if (toml::array* list = node.as_array()) {
      for (size_t i = 0; i < list->size(); ++i) {
        toml::node& item = *list->get(i);
        const std::string* text = text_with_dollar(item);
        if (!text)
          put_in(item, path);
        else if (const Held value = value_of(*text, place_of(item, path), path))
          list->replace(list->cbegin() + i, *value->get(0));
      }
    }
  }

  Where place_of(const toml::node& node, const std::string& path) const {
    const auto over = source_.overridden.find(path);
    return over != source_.overridden.end() ? Where{0, 0, over->second} : where_of(node.source());
  }

  // What a text with variables stands for; none after having told why.
  Held value_of(const std::string& text, const Where& where, const std::string& path) {
    std::string out;
    for (size_t at = 0; at < text.size();) {
      const char next = at + 1 < text.size() ? text[at + 1] : '\0';
      if (text[at] != '$' || !(next == '$' || next == '(' || begins_name(next))) {
        out += text[at++];
      } else if (next == '$') {
        out += '$', at += 2;
      } else {
        const size_t end = next == '(' ? end_of_brackets(text, at + 1) : end_of_name(text, at + 1);
        const Held value = next == '('
                               ? result_of(text.substr(at + 2, end - at - 3), where, path, end <= text.size())
                               : copy_of(text.substr(at + 1, end - at - 1), where, path);
        if (!value || (at == 0 && end == text.size())) return value;
        const toml::node& node = *value->get(0);
        if (const auto whole = node.value_exact<int64_t>()) {
          out += fmt::format("{}", *whole);
        } else if (const auto number = node.value_exact<double>()) {
          out += fmt::format("{}", *number);
        } else if (const auto inner = node.value_exact<std::string>()) {
          out += *inner;
        } else {
          findings_.error(
              where, path,
              fmt::format("\"{}\" is no number or text to stand within one", text.substr(at, end - at)));
          return {};
        }
        at = end;
      }
    }
    return toml::array{out};
  }

  static size_t end_of_name(const std::string& text, size_t at) {
    while (at < text.size() && is_in_name(text[at])) ++at;
    return at;
  }

  // Behind the bracket that closes the one at `at`; beyond the text where none does.
  static size_t end_of_brackets(const std::string& text, size_t at) {
    for (int open = 0; at < text.size(); ++at) {
      if (text[at] == '(') ++open;
      if (text[at] == ')' && --open == 0) return at + 1;
    }
    return text.size() + 1;
  }

  Held copy_of(const std::string& name, const Where& where, const std::string& path) {
    if (!variables_ || !variables_->contains(name)) {
      std::vector<std::string> names;
      if (variables_) names = keys_of(*variables_);
      const std::string near = closest_name(name, names);
      findings_.error(where, path, fmt::format("there is no variable \"{}\"", name),
                      !near.empty() ? fmt::format("did you mean \"${}\"? A dollar sign is written $$", near)
                      : names.empty()
                          ? "variables are given in [variables]; a dollar sign is written $$"
                          : fmt::format("there is {}; a dollar sign is written $$", join_or(names)));
      return {};
    }
    source_.variables_used.insert(name);
    const toml::node* node = resolve(name);
    if (!node) {
      findings_.error(where, path, fmt::format("\"${}\" stands on itself", name),
                      "break the ring of variables");
      return {};
    }
    toml::array held;
    held.push_back(*node);
    return held;
  }

  Held result_of(const std::string& formula, const Where& where, const std::string& path, bool closed) {
    if (!closed) {
      findings_.error(where, path, "\"$(\" has no closing bracket");
      return {};
    }
    std::map<std::string, double> values;
    for (const std::string& name : names_in_formula(formula)) {
      if (!variables_ || !variables_->contains(name)) continue;  // a function, or what the parser will name
      const Held value = copy_of(name, where, path);
      if (!value) return {};
      const auto number = number_of(*value->get(0));
      if (!number) {
        findings_.error(where, path,
                        fmt::format("variable \"{}\" is no number, and stands in an expression", name));
        return {};
      }
      values[name] = *number;
    }
    std::string trouble;
    const double result = evaluate_with(formula, values, trouble);
    if (!trouble.empty()) {
      findings_.error(where, path, trouble,
                      "variables of [variables] and the functions of muParser may stand here");
      return {};
    }
    // whole, so that it may be a count
    if (result == std::floor(result) && std::abs(result) < kMostWhole)
      return toml::array{static_cast<int64_t>(result)};
    return toml::array{result};
  }

  TomlSource& source_;
  Findings& findings_;
  toml::table* variables_ = nullptr;
  std::set<std::string> open_, done_;
};

}  // namespace

TomlSource read_toml(const std::string& text, const std::vector<std::string>& overrides, Findings& findings,
                     const Schema& schema) {
  TomlSource source = parse_toml(text, overrides, findings, schema);
  if (!findings.has_errors()) put_variables(source, findings);
  return source;
}

void put_variables(TomlSource& source, Findings& findings) { Substitution(source, findings).put(); }

void check_variables_used(const TomlSource& source, Findings& findings) {
  const toml::table* variables = source.root[kSection].as_table();
  if (!variables) return;
  for (const auto& [key, node] : *variables) {
    const std::string name(key.str()), path = fmt::format("{}.{}", kSection, name);
    if (source.variables_used.count(name)) continue;
    const auto over = source.overridden.find(path);
    const std::string hint = fmt::format("where it is meant to stand, write \"${}\"", name);
    if (over != source.overridden.end())
      findings.error({0, 0, over->second}, path, "is used by nothing in the file", hint);
    else
      findings.warning(where_of(key.source()), path, "is used by nothing in the file", hint);
  }
}

}  // namespace talus
