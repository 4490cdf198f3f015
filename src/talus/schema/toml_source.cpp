#include "talus/schema/toml_source.h"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

#include "talus/base/text.h"

namespace talus {

namespace {

constexpr int kMostParts = 20;  // of a key; those of a model have four at most

// Line of the first byte that no TOML text may hold (control character, broken UTF-8), or 0.
int first_bad_line(const std::string& text) {
  int line = 1;
  for (size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c == '\n') ++line;
    if (c < 0x20 && c != '\n' && c != '\r' && c != '\t') return line;
    if (c < 0x80) continue;
    const int more = c >= 0xf0 && c < 0xf5 ? 3 : c >= 0xe0 ? 2 : c >= 0xc2 ? 1 : -1;
    if (more < 0 || c >= 0xf5) return line;
    for (int k = 1; k <= more; ++k) {
      const size_t at = i + k;
      if (at >= text.size() || (static_cast<unsigned char>(text[at]) & 0xc0) != 0x80) return line;
    }
    i += more;
  }
  return 0;
}

// Reads over the texts and comments of a TOML text; what is left tells keys apart.
class TomlScan {
 public:
  explicit TomlScan(std::string_view text) : text_(text) {}

  // Line of the first key of more than `most` parts, or 0.
  int deep_key(int most) {
    int parts = 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (c == '"' || c == '\'') {
        skip_text(c);
      } else {
        if (c == '.' && ++parts > most) return line_;
        if (c == '\n' || c == '=' || c == ',' || c == '{' || c == '}' || c == '[') parts = 1;
        step();
      }
    }
    return 0;
  }

 private:
  void step() { line_ += text_[at_++] == '\n'; }
  bool is_triple(char quote) const { return text_.substr(at_, 3) == std::string(3, quote); }
  // Behind a text of one line or more; at the end of its line where the text has no end.
  void skip_text(char quote) {
    const bool triple = is_triple(quote);
    at_ += triple ? 3 : 1;
    while (at_ < text_.size()) {
      if (text_[at_] == '\\' && quote == '"' && at_ + 1 < text_.size()) {
        ++at_;
        step();
      } else if (text_[at_] == quote && (!triple || is_triple(quote))) {
        at_ += triple ? 3 : 1;
        return;
      } else if (text_[at_] == '\n' && !triple) {
        return;
      } else {
        step();
      }
    }
  }

  std::string_view text_;
  size_t at_ = 0;
  int line_ = 1;
};

std::vector<std::string> split(const std::string& s, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : s) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

// The entry of a list of tables called `name` (or numbered so); null when there is none.
toml::table* find_entry(toml::array& list, const std::string& name) {
  for (toml::node& entry : list) {
    toml::table* t = entry.as_table();
    if (t && (*t)["name"].value_or(std::string()) == name) return t;
  }
  size_t index = 0;
  const auto [end, status] = std::from_chars(name.data(), name.data() + name.size(), index);
  if (status == std::errc{} && end == name.data() + name.size() && index < list.size())
    return list[index].as_table();
  return nullptr;
}

std::string names_in(const toml::array& list) {
  std::vector<std::string> names;
  for (const toml::node& entry : list)
    if (const toml::table* t = entry.as_table())
      names.push_back((*t)["name"].value_or(std::string("(unnamed)")));
  return join_or(names);
}

// Whether `section` has entries of the model's own: one that is not there was mistyped, or is meant to be
// new.
bool is_of_entries(const std::string& section, const Schema& schema) {
  for (const SectionSpec& s : schema)
    if (s.name == section) return s.shape == SectionShape::kNamed || s.shape == SectionShape::kList;
  return false;
}

// An override of a table that the file does not have.
void no_such_table(const std::vector<std::string>& parts, const toml::table& root, const Where& where,
                   const std::string& item, Findings& findings) {
  std::vector<std::string> names;
  if (const toml::table* section = root[parts[0]].as_table())
    for (const auto& [key, node] : *section) names.emplace_back(key.str());
  const std::string& wanted = parts.size() > 2 ? parts[1] : parts[0];
  const std::string near = closest_name(wanted, names);
  findings.error(where, item.substr(0, item.find('=')),
                 fmt::format("the file has no [{}.{}]", parts[0], wanted),
                 (near.empty() ? names.empty() ? "" : fmt::format("there is {}; ", join_or(names))
                               : fmt::format("did you mean \"{}\"? ", near)) +
                     fmt::format("to make one on purpose: --set new:{}", item));
}

void apply_override(const std::string& whole, const Schema& schema, TomlSource& source, Findings& findings) {
  const Where where{0, 0, "--set " + whole};
  constexpr std::string_view kNew = "new:";
  const bool is_new = whole.rfind(kNew, 0) == 0;
  const std::string item = is_new ? whole.substr(kNew.size()) : whole;
  const size_t equal = item.find('=');
  if (equal == std::string::npos || equal == 0) {
    findings.error(where, "",
                   "an override is written path=value, for example --set material.rock.young=\"5 GPa\"");
    return;
  }
  if (item.find_first_of("\n\r") != std::string::npos) {
    findings.error(
        where, item.substr(0, equal), "an override has more than one line",
        "overrides are kept as comments of one line in the copy of the model: write \\n in texts, and lists "
        "without line breaks");
    return;
  }
  const std::string path = item.substr(0, equal), value = item.substr(equal + 1);
  const std::vector<std::string> parts = split(path, '.');
  if (parts.size() > kMostParts) {
    findings.error(where, path, fmt::format("a key has more than {} parts", kMostParts));
    return;
  }
  toml::table* table = &source.root;
  for (size_t i = 0; i + 1 < parts.size(); ++i) {
    toml::node* next = table->get(parts[i]);
    if (!next) {
      if (!is_new && is_of_entries(parts[0], schema))
        return no_such_table(parts, source.root, where, item, findings);
      table->insert(parts[i], toml::table{});
      next = table->get(parts[i]);
    }
    if (toml::array* list = next->as_array(); list && i + 2 < parts.size()) {
      next = find_entry(*list, parts[++i]);
      if (!next) {
        findings.error(where, path, fmt::format("no {} is called \"{}\"", parts[i - 1], parts[i]),
                       fmt::format("there is {}", names_in(*list)));
        return;
      }
    }
    table = next->as_table();
    if (!table) {
      findings.error(where, path, fmt::format("\"{}\" holds no further keys", parts[i]));
      return;
    }
  }
  try {
    const std::string line = "v = " + value + "\n";
    if (TomlScan(line).deep_key(kMostParts) > 0) throw std::invalid_argument("a deep key");
    const toml::table parsed = toml::parse(line);
    if (parsed.size() != 1) throw std::invalid_argument("more than one value");
    table->insert_or_assign(parts.back(), *parsed.get("v"));
  } catch (const std::exception&) {
    table->insert_or_assign(parts.back(), value);  // no TOML value: a bare text such as 5 GPa
  }
  source.overridden[path] = where.override_text;
}

}  // namespace

std::string with_overrides(std::string text, const std::vector<std::string>& overrides) {
  for (const std::string& item : overrides) text += "\n" + std::string(kOverride) + item;
  return text;
}

Where where_of(const toml::source_region& region) {
  return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), ""};
}

TomlSource parse_toml(const std::string& text, const std::vector<std::string>& overrides, Findings& findings,
                      const Schema& schema) {
  TomlSource source;
  if (text.size() > kMostModelText) {
    findings.error({}, "", fmt::format("the file is larger than {}", readable_bytes(kMostModelText)));
    return source;
  }
  if (const int line = first_bad_line(text); line > 0) {
    findings.error({line, 1, ""}, "", "the line holds bytes that are not UTF-8 text",
                   "save the file as UTF-8");
    return source;
  }
  if (const int line = TomlScan(text).deep_key(kMostParts); line > 0) {
    findings.error({line, 1, ""}, "", fmt::format("a key has more than {} parts", kMostParts),
                   "keys of a model have four at most");
    return source;
  }
  try {
    source.root = toml::parse(text + "\n");
  } catch (const toml::parse_error& e) {
    const auto at = e.source().begin;
    const std::string_view text_of = e.description();
    const bool open_text = text_of.find("unescaped control characters") != std::string_view::npos;
    const bool bare_unit = text_of.find("expected a comment or whitespace") != std::string_view::npos;
    findings.error({static_cast<int>(at.line), static_cast<int>(at.column), ""}, "",
                   fmt::format("syntax: {}", text_of),
                   open_text   ? "a closing quote is missing before the end of the line"
                   : bare_unit ? "texts, and values with a unit, stand in quotes: \"10 GPa\""
                               : "");
    return source;
  }
  for (const std::string& item : overrides) apply_override(item, schema, source, findings);
  return source;
}

}  // namespace talus
