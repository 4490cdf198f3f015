#include "talus/plot/scale.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace talus::plot {
namespace {

constexpr const char* kThinSpace = "\u2009";
constexpr const char* kMinus = "\u2212";

std::string fixed_text(double value, int decimals) {
  std::array<char, 400> buffer;  // the longest double has 309 digits before the point
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, std::clamp(decimals, 0, 20));
  return {buffer.data(), end.ptr};
}

std::string group_thousands(const std::string& digits) {
  const std::size_t whole = std::min(digits.find('.'), digits.size());
  std::string grouped;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && i < whole && (whole - i) % 3 == 0) grouped += kThinSpace;
    grouped += digits[i];
  }
  return grouped;
}

std::string power_of_ten(int exponent) {
  constexpr std::array<const char*, 10> kRaised{"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                                "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = "\u00d710";
  if (exponent < 0) text += "\u207b";
  for (char c : std::to_string(std::abs(exponent))) text += kRaised[static_cast<std::size_t>(c - '0')];
  return text;
}

int decade(double magnitude) { return static_cast<int>(std::floor(std::log10(magnitude) + 1e-9)); }

}  // namespace

bool is_drawable(double value) { return std::abs(value) <= kLargestValue; }  // false for NaN as well

Range widened(Range r) {
  if (r.lo > r.hi) std::swap(r.lo, r.hi);
  const double size = std::max(std::abs(r.lo), std::abs(r.hi));
  if (r.length() > std::max(1e-12 * size, 1e-290)) return r;
  const double half = size > 1e-280 ? 0.1 * size : 1;
  return {r.lo - half, r.hi + half};
}

Ticks nice_ticks(double lo, double hi, int target) {
  Ticks ticks;
  if (!is_drawable(lo) || !is_drawable(hi) || !(lo < hi)) return ticks;
  const double least = (hi - lo) / std::max(target, 1);
  int exponent = decade(least);
  double factor = least / std::pow(10.0, exponent);
  for (const double nice : {1.0, 2.0, 5.0, 10.0}) {
    if (factor > nice * (1 + 1e-9)) continue;
    factor = nice;
    break;
  }
  // Dividing by a whole power of ten gives the double nearest to the decimal number; multiplying does not.
  const double power = std::pow(10.0, std::abs(exponent));
  const auto multiple = [&](double i) { return exponent < 0 ? i * factor / power : i * factor * power; };
  ticks.step = multiple(1);
  if (!(ticks.step > 0) || !std::isfinite(ticks.step)) return {};
  const double last = std::floor(hi / ticks.step + 1e-6);
  for (double i = std::ceil(lo / ticks.step - 1e-6); i <= last && ticks.values.size() < 1000; ++i) {
    ticks.values.push_back(i == 0 ? 0 : multiple(i));  // no negative zero
  }
  return ticks;
}

std::vector<std::string> tick_labels(const Ticks& ticks) {
  double largest = 0;
  for (double v : ticks.values) largest = std::max(largest, std::abs(v));
  const bool scientific = largest > 0 && (largest >= 1e6 * (1 - 1e-9) || largest < 1e-3 * (1 - 1e-9));
  const int exponent = scientific ? decade(largest) : 0;
  const int decimals = ticks.step > 0 ? std::max(0, exponent - decade(ticks.step)) : 0;
  std::vector<std::string> labels;
  for (double v : ticks.values) {
    const double mantissa = std::abs(v) / std::pow(10.0, exponent);
    std::string text = v == 0 && scientific ? "0" : fixed_text(mantissa, decimals);
    if (largest >= 1e4 && !scientific) text = group_thousands(text);
    if (scientific && v != 0) text += power_of_ten(exponent);
    labels.push_back(v < 0 ? kMinus + text : text);
  }
  return labels;
}

std::vector<std::vector<Point>> reduce_by_column(const std::vector<double>& x, const std::vector<double>& y,
                                                 double x_min, double x_max, int columns) {
  if (x.size() != y.size()) {
    throw std::invalid_argument(std::to_string(x.size()) + " values of x but " + std::to_string(y.size()) +
                                " of y");
  }
  const bool has_columns = x_min < x_max && columns > 0;
  const auto column = [&](double v) {
    if (!has_columns) return 0.0;
    return std::clamp(std::floor((v - x_min) / (x_max - x_min) * columns), -1.0,
                      static_cast<double>(columns));
  };
  std::vector<std::vector<Point>> pieces;
  std::size_t i = 0;
  while (i < x.size()) {
    if (!is_drawable(x[i]) || !is_drawable(y[i])) {
      ++i;
      continue;
    }
    const bool starts = i == 0 || !is_drawable(x[i - 1]) || !is_drawable(y[i - 1]);
    if (starts) pieces.emplace_back();
    const std::size_t first = i;
    std::size_t low = i, high = i, last = i;
    for (; i < x.size() && is_drawable(x[i]) && is_drawable(y[i]) && column(x[i]) == column(x[first]); ++i) {
      if (y[i] < y[low]) low = i;
      if (y[i] > y[high]) high = i;
      last = i;
    }
    std::array<std::size_t, 4> kept{first, std::min(low, high), std::max(low, high), last};
    const auto end = std::unique(kept.begin(), kept.end());  // they ascend already
    for (auto k = kept.begin(); k != end; ++k) pieces.back().push_back({x[*k], y[*k]});
  }
  return pieces;
}

}  // namespace talus::plot
