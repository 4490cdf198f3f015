#pragma once
// Small text helpers used by messages: closest name, lists, readable sizes and times.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// The entry of `known` nearest to `word` in edits (insert, delete, replace, swap), or "" when none is near
/// enough to be worth suggesting.
std::string closest_name(std::string_view word, const std::vector<std::string>& known);

/// "a, b or c"
std::string join_or(const std::vector<std::string>& words);

/// Text without blanks at its ends.
std::string_view trimmed(std::string_view text);

/// The text as one of TOML or JSON: in double quotes, with a backslash before quotes and backslashes.
std::string in_quotes(std::string_view text);

/// The text within XML or HTML: < > & and double quotes by name, and what XML knows no sign for as blanks (control
/// characters, U+FFFE, U+FFFF).
std::string in_markup(std::string text);
/// A text that in_markup() made, as it was.
std::string from_markup(std::string_view text);

/// "950 B", "12.3 kB", "4.5 MB"
std::string readable_bytes(double bytes);

/// "850 ms", "12.3 s", "4 min 05 s", "2 h 03 min"
std::string readable_seconds(double seconds);

/// FNV-1a 64-bit hash as 16 hexadecimal digits; identifies a model text, protects nothing.
std::string text_hash(std::string_view text);

/// The same of a text that comes in parts.
class TextHash {
 public:
  void add(std::string_view part) {
    for (const char c : part) h_ = (h_ ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  }
  std::string text() const;

 private:
  uint64_t h_ = 14695981039346656037ull;
};

}  // namespace talus
