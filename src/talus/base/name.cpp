#include "talus/base/name.h"

#include <fmt/format.h>

#include "talus/base/text.h"

namespace talus {

namespace {

// Control characters, those of two bytes included (U+0080 to U+009F).
bool is_control(std::string_view text, size_t i) {
  const auto c = static_cast<unsigned char>(text[i]);
  if (c < 0x20 || c == 0x7f) return true;
  return c == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0;
}

}  // namespace

std::string name_defect(std::string_view name) {
  constexpr std::string_view kParts = ".,\"[]", kSeparators = "/\\", kFormula = "=+-@";
  if (name.empty()) return "it is empty";
  if (name.size() > kLongestName) return fmt::format("it is longer than {} bytes", kLongestName);
  for (size_t i = 0; i < name.size(); ++i)
    if (is_control(name, i)) return "it holds a control character";
  if (name.find_first_of(kParts) != std::string_view::npos)
    return "names hold no dot, comma, quote or bracket";
  if (name.find_first_of(kSeparators) != std::string_view::npos)
    return "it holds a separator of paths, and names become file names";
  if (name.front() == ' ' || name.back() == ' ') return "it begins or ends with a blank";
  if (kFormula.find(name.front()) != std::string_view::npos)
    return fmt::format("it begins with \"{}\", which spreadsheets take for a formula", name.front());
  return "";
}

std::string shown_name(std::string_view name, std::string_view kept) {
  std::string out;
  for (size_t i = 0; i < name.size(); ++i) {
    const auto byte = static_cast<unsigned char>(name[i]);
    if (is_control(name, i) && byte >= 0x80)
      out += fmt::format("\\u{:04x}", static_cast<unsigned char>(name[++i]));
    else if (is_control(name, i) && kept.find(name[i]) == std::string_view::npos)
      out += fmt::format("\\x{:02x}", byte);
    else
      out += name[i];
  }
  return out;
}

std::string file_name_of(std::string_view text) {
  constexpr size_t kLongest = 120, kHash = 17;
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto byte = static_cast<unsigned char>(c);
    const bool safe = byte >= 0x80 || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                      (c >= '0' && c <= '9') || c == '_' || (c == '.' && i > 0) ||
                      ((c == '-' || c == ' ' || c == '+' || c == '(' || c == ')') && i > 0);
    if (safe && !is_control(text, i))
      out += c;
    else
      out += fmt::format("%{:02X}", byte);
  }
  if (out.empty()) return "%";
  if (out.size() <= kLongest) return out;
  size_t end = kLongest - kHash;
  while (end > 0 && (static_cast<unsigned char>(out[end]) & 0xC0) == 0x80) --end;  // not inside a character
  return out.substr(0, end) + "-" + text_hash(text);
}

}  // namespace talus
