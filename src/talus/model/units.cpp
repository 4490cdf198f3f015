#include "talus/model/units.h"

#include <fmt/format.h>

#include <charconv>
#include <numbers>

#include "talus/base/text.h"

namespace talus {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
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
  using D = Dimension;
  static const std::vector<Unit> units = {
      {"m", D::kLength, 1},
      {"mm", D::kLength, 1e-3},
      {"cm", D::kLength, 1e-2},
      {"km", D::kLength, 1e3},
      {"m2", D::kArea, 1},
      {"cm2", D::kArea, 1e-4},
      {"s", D::kTime, 1},
      {"ms", D::kTime, 1e-3},
      {"us", D::kTime, 1e-6},
      {"min", D::kTime, 60},
      {"m/s", D::kVelocity, 1},
      {"mm/s", D::kVelocity, 1e-3},
      {"cm/s", D::kVelocity, 1e-2},
      {"km/h", D::kVelocity, 1 / 3.6},
      {"m/s2", D::kAcceleration, 1},
      {"cm/s2", D::kAcceleration, 1e-2},
      {"gal", D::kAcceleration, 1e-2},
      {"g", D::kAcceleration, kStandardGravity},
      {"rad", D::kAngle, 1},
      {"deg", D::kAngle, kDegree},
      {"rad/s", D::kAngularVelocity, 1},
      {"deg/s", D::kAngularVelocity, kDegree},
      {"1/s", D::kRate, 1},
      {"1/min", D::kRate, 1.0 / 60},
      {"kg/m3", D::kDensity, 1},
      {"t/m3", D::kDensity, 1e3},
      {"g/cm3", D::kDensity, 1e3},
      {"Pa", D::kStress, 1},
      {"kPa", D::kStress, 1e3},
      {"MPa", D::kStress, 1e6},
      {"GPa", D::kStress, 1e9},
      {"N", D::kForce, 1},
      {"kN", D::kForce, 1e3},
      {"MN", D::kForce, 1e6},
      {"Pa/m", D::kStiffness, 1},
      {"MPa/m", D::kStiffness, 1e6},
      {"GPa/m", D::kStiffness, 1e9},
      {"N/m", D::kLineForce, 1},
      {"kN/m", D::kLineForce, 1e3},
      {"MN/m", D::kLineForce, 1e6},
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
