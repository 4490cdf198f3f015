#include "talus/schema/units.h"

#include <fmt/format.h>

#include <charconv>

#include "talus/base/angle.h"
#include "talus/base/text.h"

namespace talus {

namespace {

constexpr double kStandardGravity = 9.80665;

struct DimensionName {
  Dimension dimension;
  std::string_view article_name;
};

constexpr DimensionName kNames[] = {
    {Dimension::kNone, "a plain number"},
    {Dimension::kLength, "a length"},
    {Dimension::kArea, "an area"},
    {Dimension::kTime, "a time"},
    {Dimension::kVelocity, "a velocity"},
    {Dimension::kAcceleration, "an acceleration"},
    {Dimension::kAngle, "an angle"},
    {Dimension::kAngularVelocity, "an angular velocity"},
    {Dimension::kRate, "a rate"},
    {Dimension::kDensity, "a density"},
    {Dimension::kStress, "a stress"},
    {Dimension::kForce, "a force"},
    {Dimension::kStiffness, "a stiffness per area"},
    {Dimension::kLineForce, "a force per length"},
};

std::string_view trim(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t')) s.remove_suffix(1);
  return s;
}

std::string_view article_name(Dimension dimension) {
  for (const auto& n : kNames)
    if (n.dimension == dimension) return n.article_name;
  return "";
}

std::vector<std::string> symbols_of(Dimension dimension) {
  std::vector<std::string> symbols;
  for (const Unit& u : all_units())
    if (u.dimension == dimension) symbols.emplace_back(u.symbol);
  return symbols;
}

}  // namespace

const std::vector<Unit>& all_units() {
  using enum Dimension;
  static const std::vector<Unit> units = {
      {"m", kLength, 1},
      {"mm", kLength, 1e-3},
      {"cm", kLength, 1e-2},
      {"km", kLength, 1e3},
      {"ft", kLength, 0.3048},
      {"m2", kArea, 1},
      {"cm2", kArea, 1e-4},
      {"s", kTime, 1},
      {"ms", kTime, 1e-3},
      {"us", kTime, 1e-6},
      {"min", kTime, 60},
      {"m/s", kVelocity, 1},
      {"mm/s", kVelocity, 1e-3},
      {"cm/s", kVelocity, 1e-2},
      {"km/h", kVelocity, 1 / 3.6},
      {"m/s2", kAcceleration, 1},
      {"cm/s2", kAcceleration, 1e-2},
      {"gal", kAcceleration, 1e-2},
      {"g", kAcceleration, kStandardGravity},
      {"rad", kAngle, 1},
      {"deg", kAngle, kDegree},
      {"rad/s", kAngularVelocity, 1},
      {"deg/s", kAngularVelocity, kDegree},
      {"1/s", kRate, 1},
      {"1/min", kRate, 1.0 / 60},
      {"kg/m3", kDensity, 1},
      {"t/m3", kDensity, 1e3},
      {"g/cm3", kDensity, 1e3},
      {"kN/m3", kDensity, 1e3 / kStandardGravity},  // unit weight, at standard gravity
      {"Pa", kStress, 1},
      {"kPa", kStress, 1e3},
      {"MPa", kStress, 1e6},
      {"GPa", kStress, 1e9},
      {"psi", kStress, 6894.757293168361},  // 0.45359237 kg at standard gravity on (25.4 mm)^2
      {"N", kForce, 1},
      {"kN", kForce, 1e3},
      {"MN", kForce, 1e6},
      {"Pa/m", kStiffness, 1},
      {"kPa/m", kStiffness, 1e3},
      {"MPa/m", kStiffness, 1e6},
      {"GPa/m", kStiffness, 1e9},
      {"N/m", kLineForce, 1},
      {"kN/m", kLineForce, 1e3},
      {"MN/m", kLineForce, 1e6},
  };
  return units;
}

std::string_view si_symbol(Dimension dimension) {
  for (const Unit& u : all_units())
    if (u.dimension == dimension) return u.symbol;
  return "";
}

std::string describe(Dimension dimension) {
  if (dimension == Dimension::kNone) return std::string(article_name(dimension));
  std::string list;
  for (const std::string& s : symbols_of(dimension)) list += (list.empty() ? "" : ", ") + s;
  return fmt::format("{} ({})", article_name(dimension), list);
}

std::optional<AnyQuantity> parse_any_quantity(std::string_view text) {
  text = trim(text);
  AnyQuantity q;
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  const auto [rest, status] = std::from_chars(begin, end, q.number);
  if (status != std::errc{}) return std::nullopt;
  q.unit = trim({rest, static_cast<size_t>(end - rest)}), q.value = q.number;
  if (q.unit.empty()) return q;
  for (const Unit& u : all_units())
    if (u.symbol == q.unit) {
      q.value *= u.factor;
      return q;
    }
  return std::nullopt;
}

Quantity parse_quantity(std::string_view text, Dimension dimension) {
  text = trim(text);
  Quantity q;
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (begin != end && *begin == '+') ++begin;
  const auto [rest, status] = std::from_chars(begin, end, q.value);
  if (status != std::errc{}) {
    q.error = fmt::format("\"{}\" does not begin with a number; expected {}, for example \"{}\"", text,
                          describe(dimension), with_unit(1, dimension));
    return q;
  }
  const std::string_view symbol = trim({rest, static_cast<size_t>(end - rest)});
  if (symbol.empty()) {
    if (dimension == Dimension::kAngle && q.value != 0)
      q.error = fmt::format("an angle needs its unit: write \"{:g} deg\" or \"{:g} rad\"", q.value, q.value);
    return q;
  }
  for (const Unit& u : all_units()) {
    if (u.symbol == symbol && u.dimension == dimension) {
      q.value *= u.factor;
      return q;
    }
  }
  for (const Unit& u : all_units()) {
    if (u.symbol == symbol) {
      q.error =
          fmt::format("\"{}\" is {}; expected {}", text, article_name(u.dimension), describe(dimension));
      return q;
    }
  }
  if (symbol.size() > 1 && symbol[0] == ',' && symbol[1] >= '0' && symbol[1] <= '9') {
    std::string point(text);
    point[point.find(',')] = '.';
    q.error = fmt::format("\"{}\": numbers have a decimal point; write \"{}\"", text, point);
    return q;
  }
  const std::string near = closest_name(symbol, symbols_of(dimension));
  q.error = fmt::format("unknown unit \"{}\"; expected {}{}", symbol, describe(dimension),
                        near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near));
  return q;
}

std::string with_unit(double value, Dimension dimension) {
  if (dimension == Dimension::kAngle)
    return fmt::format("{:g} deg", value / kDegree);  // as people write them
  const std::string_view symbol = si_symbol(dimension);
  return symbol.empty() ? fmt::format("{:g}", value) : fmt::format("{:g} {}", value, symbol);
}

}  // namespace talus
