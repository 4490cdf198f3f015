#include "talus/schema/findings.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/base/error.h"
#include "talus/base/name.h"

namespace talus {

namespace {

// What is longer than anyone reads is cut, so that the message stays one; control characters, which may stand in
// names, are shown and not sent to a terminal.
std::string shortened(const std::string& raw, size_t most, std::string_view kept = "\n") {
  const std::string text = shown_name(raw, kept);
  if (text.size() <= most) return text;
  size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not inside a character
  return fmt::format("{}... ({} characters)", text.substr(0, end), text.size());
}

constexpr size_t kMostSaid = 1000, kMostKey = 200, kMostLine = 500;

}  // namespace

Findings::Findings(std::string file, std::string_view text) : file_(std::move(file)) {
  size_t begin = 0;
  while (begin <= text.size()) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    std::string line(text.substr(begin, end - begin));
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::replace(line.begin(), line.end(), '\t', ' ');
    lines_.push_back(std::move(line));
    begin = end + 1;
  }
}

void Findings::error(const Where& where, const std::string& key, const std::string& text,
                     const std::string& hint) {
  list_.push_back({Severity::kError, where, shortened(key, kMostKey, ""), shortened(text, kMostSaid),
                   shortened(hint, kMostSaid)});
}

void Findings::warning(const Where& where, const std::string& key, const std::string& text,
                       const std::string& hint) {
  list_.push_back({Severity::kWarning, where, shortened(key, kMostKey, ""), shortened(text, kMostSaid),
                   shortened(hint, kMostSaid)});
}

int Findings::error_count() const {
  return static_cast<int>(std::count_if(list_.begin(), list_.end(),
                                        [](const Finding& f) { return f.severity == Severity::kError; }));
}

std::string Findings::render() const {
  std::vector<Finding> sorted = list_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Finding& a, const Finding& b) { return a.where.line < b.where.line; });
  constexpr size_t kMost = 20;  // a file with more has one cause; the count is told
  std::string out;
  for (size_t i = 0; i < std::min(sorted.size(), kMost); ++i) {
    const Finding& f = sorted[i];
    const char* level = f.severity == Severity::kError ? "error" : "warning";
    std::string place = file_;
    if (f.where.line > 0) place += fmt::format(":{}:{}", f.where.line, f.where.column);
    out += fmt::format("{}: {}: {}{}{}\n", place, level, f.key, f.key.empty() ? "" : ": ", f.text);
    if (!f.where.override_text.empty())
      out += fmt::format("   from {}\n", shortened(f.where.override_text, kMostSaid));
    const size_t line = f.where.line;
    if (line > 0 && line <= lines_.size()) {
      const int column = std::max(f.where.column, 1);
      out += fmt::format("{:>5} | {}\n", f.where.line, shortened(lines_[line - 1], kMostLine));
      if (static_cast<size_t>(column) <= kMostLine) out += fmt::format("      | {:>{}}\n", "^", column);
    }
    if (!f.hint.empty()) out += fmt::format("      = {}\n", f.hint);
  }
  if (sorted.size() > kMost) out += fmt::format("... and {} more\n", sorted.size() - kMost);
  return out;
}

void Findings::throw_if_errors() const {
  if (!has_errors()) return;
  const int n = error_count();
  throw InputError(render() + fmt::format("{}: {} error{}; nothing was run", file_, n, n == 1 ? "" : "s"));
}

void Findings::throw_if_any() const {
  throw_if_errors();
  const int n = warning_count();
  if (n == 0) return;
  throw InputError(render() +
                   fmt::format("{}: {} warning{}, which --strict takes for errors; nothing was run", file_, n,
                               n == 1 ? "" : "s"));
}

}  // namespace talus
