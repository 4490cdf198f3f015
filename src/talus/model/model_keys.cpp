#include "talus/model/model_keys.h"

#include <fmt/format.h>

#include <cstring>
#include <sstream>

#include "talus/model/model_schema.h"
#include "talus/schema/variables.h"

namespace talus {

namespace {

constexpr size_t kMostLines = 20;

std::string value_text(const toml::node& node) {
  if (const auto* number = node.as_floating_point())
    return fmt::format("{}", number->get());  // 0.2, not 0.20000000000000001
  std::ostringstream out;
  node.visit([&out](const auto& n) { out << n; });
  return out.str();
}

void flatten(const toml::table& table, const std::string& path, ModelKeys& all) {
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

std::vector<std::string> overrides_in(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind(kOverride, 0) == 0) all.push_back(line.substr(std::strlen(kOverride)));
  return all;
}

}  // namespace

ModelKeys keys_as_written(const std::string& text) {
  ModelKeys all;
  Findings findings("", text);
  flatten(parse_toml(text, {}, findings).root, "", all);
  for (const std::string& item : overrides_in(text)) {
    const size_t equals = item.find('=');
    all["--set " + item.substr(0, equals)] = equals == std::string::npos ? "" : item.substr(equals + 1);
  }
  return all;
}

ModelKeys keys_in_force(const std::string& text) {
  ModelKeys all;
  Findings findings("", text);
  toml::table root = std::move(read_toml(text, overrides_in(text), findings, model_schema()).root);
  root.erase("variables");  // they act by the keys that name them
  flatten(root, "", all);
  return all;
}

std::string KeyDifference::text() const {
  return fmt::format("{}: {}, was {}", key, now ? *now : "not given", before ? *before : "not given");
}

std::vector<KeyDifference> differences(const ModelKeys& now, const ModelKeys& before) {
  std::vector<KeyDifference> out;
  auto a = now.begin(), b = before.begin();
  while (a != now.end() || b != before.end()) {
    if (b == before.end() || (a != now.end() && a->first < b->first)) {
      out.push_back({a->first, &a->second, nullptr});
      ++a;
    } else if (a == now.end() || b->first < a->first) {
      out.push_back({b->first, nullptr, &b->second});
      ++b;
    } else {
      if (a->second != b->second) out.push_back({a->first, &a->second, &b->second});
      ++a, ++b;
    }
  }
  return out;
}

std::string difference_lines(const std::vector<KeyDifference>& all) {
  std::string out;
  for (size_t i = 0; i < all.size() && i < kMostLines; ++i) out += "  " + all[i].text() + "\n";
  if (all.size() > kMostLines) out += fmt::format("  and {} more\n", all.size() - kMostLines);
  return out;
}

std::string model_difference(const std::string& now, const std::string& before) {
  const ModelKeys a = keys_as_written(now), b = keys_as_written(before);
  return difference_lines(differences(a, b));
}

}  // namespace talus
