#include <fmt/format.h>

#include <map>
#include <set>
#include <sstream>

#include "talus/model/toml_source.h"
#include "talus/run/saved_state.h"

namespace talus {

namespace {

constexpr size_t kMostLines = 20;
const std::string kOverride = "# --set ";

std::string value_text(const toml::node& node) {
  std::ostringstream out;
  node.visit([&out](const auto& n) { out << n; });
  return out.str();
}

// Every key with its value, by its dotted path; entries of lists by their name or number.
void flatten(const toml::table& table, const std::string& path, std::map<std::string, std::string>& all) {
  for (const auto& [key, node] : table) {
    const std::string here = path + std::string(key.str());
    if (const toml::table* t = node.as_table()) {
      flatten(*t, here + ".", all);
    } else if (node.is_array_of_tables()) {
      int index = 0;
      for (const toml::node& item : *node.as_array()) {
        const toml::table& entry = *item.as_table();
        flatten(entry, here + "." + entry["name"].value_or(std::to_string(index)) + ".", all);
        ++index;
      }
    } else {
      all[here] = value_text(node);
    }
  }
}

std::map<std::string, std::string> keys_of(const std::string& text) {
  std::map<std::string, std::string> all;
  Findings findings("", text);
  flatten(parse_toml(text, {}, findings).root, "", all);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(kOverride, 0) != 0) continue;
    const size_t equals = line.find('=');
    all["--set " + line.substr(kOverride.size(), equals - kOverride.size())] =
        equals == std::string::npos ? "" : line.substr(equals + 1);
  }
  return all;
}

}  // namespace

std::string model_difference(const std::string& now, const std::string& before) {
  const auto a = keys_of(now), b = keys_of(before);
  std::set<std::string> keys;
  for (const auto& [key, value] : a) keys.insert(key);
  for (const auto& [key, value] : b) keys.insert(key);
  std::string out;
  size_t count = 0;
  for (const std::string& key : keys) {
    const auto in_a = a.find(key), in_b = b.find(key);
    if (in_a != a.end() && in_b != b.end() && in_a->second == in_b->second) continue;
    if (++count > kMostLines) continue;
    out += fmt::format("  {}: {}, was {}\n", key, in_a == a.end() ? "not given" : in_a->second,
                       in_b == b.end() ? "not given" : in_b->second);
  }
  if (count > kMostLines) out += fmt::format("  and {} more\n", count - kMostLines);
  return out;
}

}  // namespace talus
