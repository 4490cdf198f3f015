#pragma once
// Numbers behind a chart, without any drawing: ranges of axes, ticks and their labels, and the thinning out
// of curves with far more points than pixels.

#include <string>
#include <vector>

namespace talus::plot {

/// Values whose magnitude is larger count as gaps like NaN: differences of axis limits must stay finite.
constexpr double kLargestValue = 1e300;

/// Whether the value can be drawn: finite and not beyond kLargestValue.
bool is_drawable(double value);

struct Range {
  double lo = 0, hi = 1;
  double length() const { return hi - lo; }
};

/// The range with its ends in order, made longer where it is too short to compute ticks and pixels from.
Range widened(Range range);

/// Positions of the marks on an axis: multiples of `step`, ascending.
struct Ticks {
  double step = 0;
  std::vector<double> values;
};

/// Ticks inside [lo, hi] at a step of 1, 2 or 5 times a power of ten, about `target` intervals and never
/// more; no ticks when the range is empty or not finite.
Ticks nice_ticks(double lo, double hi, int target);

/// Texts of the ticks in one common format: plain numbers, thousands grouped from 10 000 on, scientific when
/// the largest magnitude on the axis is at least 1e6 or below 1e-3.
std::vector<std::string> tick_labels(const Ticks& ticks);

struct Point {
  double x = 0, y = 0;
};

/// Splits the curve at points that are not finite and thins out each piece: of successive points within one
/// of `columns` equal columns of [x_min, x_max], or on one side of it, only the first, lowest, highest and
/// last stay; throws std::invalid_argument when x and y differ in length.
std::vector<std::vector<Point>> reduce_by_column(const std::vector<double>& x, const std::vector<double>& y,
                                                 double x_min, double x_max, int columns);

}  // namespace talus::plot
