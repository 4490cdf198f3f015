#include "talus/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "talus/base/index.h"

namespace talus {

namespace {

// Edits between two words, a swap of neighbours counting once (optimal string alignment).
int edit_distance(std::string_view a, std::string_view b) {
  const size_t n = a.size(), m = b.size();
  std::vector<std::vector<int>> d(n + 1, std::vector<int>(m + 1));
  for (size_t i = 0; i <= n; ++i) d[i][0] = static_cast<int>(i);
  for (size_t j = 0; j <= m; ++j) d[0][j] = static_cast<int>(j);
  for (size_t i = 1; i <= n; ++i) {
    for (size_t j = 1; j <= m; ++j) {
      const int replace = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[n][m];
}

}  // namespace

std::string closest_name(std::string_view word, const std::vector<std::string>& known) {
  std::string best;
  constexpr size_t kLongestWord = 200;
  if (word.empty() || word.size() > kLongestWord) return best;
  int best_distance = (count_of(word) + 2) / 3;
  for (const std::string& name : known) {
    if (name.size() > word.size() + kLongestWord) continue;
    const int distance = edit_distance(word, name);
    const bool begins = word.size() >= 3 && name.rfind(word, 0) == 0;  // "dens" for "density"
    if ((distance <= best_distance && distance < count_of(word)) || (begins && best.empty())) {
      if (best.empty() || distance < best_distance) best = name;
      best_distance = std::min(best_distance, distance);
    }
  }
  return best;
}

std::string join_or(const std::vector<std::string>& words) {
  std::string out;
  for (size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += i + 1 == words.size() ? " or " : ", ";
    out += words[i];
  }
  return out;
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string in_markup(std::string text) {
  for (const char* none : {"\xef\xbf\xbe", "\xef\xbf\xbf"})
    for (size_t at = 0; (at = text.find(none, at)) != std::string::npos;) text.replace(at, 3, " ");
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += ' ';
    else
      out += c;
  }
  return out;
}

std::string from_markup(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    bool known = false;
    for (const auto& [name, c] :
         {std::pair<std::string_view, char>("&lt;", '<'), {"&gt;", '>'}, {"&quot;", '"'}, {"&amp;", '&'}}) {
      if (text.substr(0, name.size()) != name) continue;
      out += c, text.remove_prefix(name.size());
      known = true;
      break;
    }
    if (known) continue;
    out += text.front(), text.remove_prefix(1);
  }
  return out;
}

std::string readable_bytes(double bytes) {
  const char* unit[] = {"B", "kB", "MB", "GB", "TB"};
  int i = 0;
  while (bytes >= 999.5 && i < 4) bytes /= 1000, ++i;
  return i == 0 ? fmt::format("{:.0f} B", bytes) : fmt::format("{:.3g} {}", bytes, unit[i]);
}

std::string readable_seconds(double seconds) {
  if (seconds < 0.9995) return fmt::format("{:.3g} ms", 1e3 * seconds);
  if (seconds < 119.5) return fmt::format("{:.3g} s", seconds);
  const int64_t s = static_cast<int64_t>(seconds + 0.5);
  if (s < 7200) return fmt::format("{} min {:02} s", s / 60, s % 60);
  if (s < 72 * 3600) return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
  return fmt::format("{} days", s / 86400);
}

std::string text_hash(std::string_view text) {
  TextHash hash;
  hash.add(text);
  return hash.text();
}

std::string TextHash::text() const { return fmt::format("{:016x}", h_); }

}  // namespace talus
