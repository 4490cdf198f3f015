#include "talus/base/name.h"

#include <fmt/format.h>

#include "talus/base/text.h"

namespace talus {

namespace {

// A control character that begins at byte i: its number, and how many bytes it has; 0 bytes: there is none.
// Those of two bytes (U+0080 to U+009F) are some, and those that turn the direction of what follows.
struct Control {
  unsigned number = 0;
  size_t bytes = 0;
};

Control control_at(std::string_view text, size_t i) {
  const auto byte = [&](size_t k) -> unsigned {
    return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0;
  };
  if (byte(0) < 0x20 || byte(0) == 0x7f) return {byte(0), 1};
  if (byte(0) == 0xc2 && byte(1) >= 0x80 && byte(1) < 0xa0) return {byte(1), 2};
  const unsigned last = byte(2);
  const bool turns = (byte(0) == 0xe2 && byte(1) == 0x80 && last >= 0xaa && last <= 0xae) ||
                     (byte(0) == 0xe2 && byte(1) == 0x81 && last >= 0xa6 && last <= 0xa9);
  return turns ? Control{0x2000 + (byte(1) - 0x80) * 64 + (last - 0x80), 3} : Control{};
}

}  // namespace

std::string name_defect(std::string_view name) {
  constexpr std::string_view kParts = ".,\"[]", kSeparators = "/\\", kFormula = "=+-@";
  if (name.empty()) return "it is empty";
  if (name.size() > kLongestName) return fmt::format("it is longer than {} bytes", kLongestName);
  for (size_t i = 0; i < name.size(); ++i)
    if (control_at(name, i).bytes > 0) return "it holds a control character";
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
    const Control control = control_at(name, i);
    if (control.bytes > 1)
      out += fmt::format("\\u{:04x}", control.number), i += control.bytes - 1;
    else if (control.bytes == 1 && kept.find(name[i]) == std::string_view::npos)
      out += fmt::format("\\x{:02x}", control.number);
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
    if (safe && control_at(text, i).bytes == 0)
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
