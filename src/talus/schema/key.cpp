#include "talus/schema/key.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/text.h"

namespace talus {

std::string Range::describe(Dimension dimension) const {
  const double infinity = std::numeric_limits<double>::infinity();
  const bool low = min > -infinity, high = max < infinity;
  const auto show = [dimension](double v) { return with_unit(v, dimension); };
  if (low && high)
    return fmt::format("{} {} and {} {}", min_open ? ">" : ">=", show(min), max_open ? "<" : "<=", show(max));
  if (low) return fmt::format("{} {}", min_open ? ">" : ">=", show(min));
  if (high) return fmt::format("{} {}", max_open ? "<" : "<=", show(max));
  return "";
}

namespace key_detail {

int place_among(const KeySpec& key, const std::string& text) {
  return static_cast<int>(std::find(key.choices.begin(), key.choices.end(), text) - key.choices.begin());
}

std::string text_of(const KeySpec& key, bool v) {
  return key.choices.empty() ? v ? "true" : "false" : text_of_choice(key, v);
}

std::string text_of(const KeySpec&, int64_t v) { return fmt::format("{}", v); }

std::string text_of(const KeySpec& key, double v) {
  if (std::isnan(v) && key.type == KeyType::kQuantityAuto) return "\"auto\"";
  if (!std::isfinite(v)) return "";
  if (key.dimension == Dimension::kAngle) return fmt::format("\"{}\"", with_unit(v, key.dimension));
  std::string number = fmt::format("{}", v);  // 1e-07 is written 1e-7
  if (const size_t e = number.find("e-0"); e != std::string::npos) number.erase(e + 2, 1);
  const std::string_view unit = si_symbol(key.dimension);
  return unit.empty() ? number : fmt::format("\"{} {}\"", number, unit);
}

std::string text_of(const KeySpec& key, const Scattered& v) { return text_of(key, v.mean); }

std::string text_of(const KeySpec&, const std::string& v) { return v.empty() ? "" : in_quotes(v); }

std::string text_of(const KeySpec&, Vec2 v) { return fmt::format("[{}, {}]", v.x, v.y); }

std::string text_of_choice(const KeySpec& key, int place) {
  return fmt::format("\"{}\"", key.choices.at(place));
}

}  // namespace key_detail

}  // namespace talus
