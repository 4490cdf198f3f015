#include "talus/record/units.h"
#include "talus/base/index.h"
#include "talus/base/text.h"

#include <array>
#include <cctype>
#include <vector>

namespace talus::record {

namespace {

constexpr std::array kUnits{MotionUnit{"m/s2", Quantity::kAcceleration, 1},
                            MotionUnit{"cm/s2", Quantity::kAcceleration, 0.01},
                            MotionUnit{"mm/s2", Quantity::kAcceleration, 1e-3},
                            MotionUnit{"gal", Quantity::kAcceleration, 0.01},
                            MotionUnit{"g", Quantity::kAcceleration, kStandardGravity},
                            MotionUnit{"m/s", Quantity::kVelocity, 1},
                            MotionUnit{"cm/s", Quantity::kVelocity, 0.01},
                            MotionUnit{"mm/s", Quantity::kVelocity, 1e-3},
                            MotionUnit{"kine", Quantity::kVelocity, 0.01},
                            MotionUnit{"m", Quantity::kDisplacement, 1},
                            MotionUnit{"cm", Quantity::kDisplacement, 0.01},
                            MotionUnit{"mm", Quantity::kDisplacement, 1e-3}};

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

// One spelling for all: "CM / SEC**2" -> "cm/s2".
std::string plain_spelling(std::string_view text) {
  std::string s;
  for (const char c : lower_case(text))
    if (c != ' ' && c != '\t' && c != '^' && c != '*') s += c;
  replace_all(s, "\xc2\xb2", "2");  // superscript two
  replace_all(s, "sec", "s");
  replace_all(s, "_s_s", "/s2");
  replace_all(s, "_s", "/s");
  replace_all(s, "/s/s", "/s2");
  return s;
}

// Splits "a_m_s2" into "a" and "m_s2"; false when the end of the title names no unit.
bool split_suffix(std::string_view title, std::string_view& name, std::string_view& unit) {
  std::vector<size_t> bars;
  for (size_t i = 0; i < title.size(); ++i)
    if (title[i] == '_') bars.push_back(i);
  for (const size_t bar : bars) {  // from the left: the longest unit goes first
    const std::string_view end = title.substr(bar + 1);
    if (bar == 0 || (!find_unit(end) && end != "s" && end != "ms")) continue;
    name = title.substr(0, bar);
    unit = end;
    return true;
  }
  return false;
}

}  // namespace

std::string_view name_of(Quantity quantity) {
  constexpr std::array<std::string_view, 3> names{"acceleration", "velocity", "displacement"};
  return names[place_of(quantity)];
}

std::string_view si_symbol(Quantity quantity) {
  constexpr std::array<std::string_view, 3> symbols{"m/s2", "m/s", "m"};
  return symbols[place_of(quantity)];
}

std::optional<Quantity> quantity_called(std::string_view word) {
  const std::string w = lower_case(word);
  for (const char* name : {"a", "acc", "accel", "acceleration"})
    if (w == name) return Quantity::kAcceleration;
  for (const char* name : {"v", "vel", "velocity"})
    if (w == name) return Quantity::kVelocity;
  for (const char* name : {"d", "dis", "disp", "displacement"})
    if (w == name) return Quantity::kDisplacement;
  return {};
}

const MotionUnit* find_unit(std::string_view text) {
  const std::string plain = plain_spelling(text);
  for (const MotionUnit& unit : kUnits)
    if (unit.symbol == plain) return &unit;
  return nullptr;
}

std::string known_units() {
  std::string list;
  for (const MotionUnit& unit : kUnits) list += (list.empty() ? "" : ", ") + std::string(unit.symbol);
  return list;
}

Title parse_title(std::string_view title) {
  Title out;
  std::string_view rest = trimmed(title);
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const size_t from = rest.find(open);
    if (from == std::string_view::npos || rest.back() != close) continue;
    out.unit_text = std::string(trimmed(rest.substr(from + 1, rest.size() - from - 2)));
    rest = trimmed(rest.substr(0, from));
    break;
  }
  std::string_view name, unit;
  if (split_suffix(rest, name, unit)) {
    rest = name;
    if (!out.unit_text)
      out.unit_text = std::string(unit);
    else if (find_unit(unit) != find_unit(*out.unit_text))
      out.second_unit = std::string(unit);
  }
  out.name = std::string(rest);
  return out;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

}  // namespace talus::record
