#include <algorithm>

#include "talus/model/model.h"

namespace talus {

namespace {

// Index i of the piece [time[i], time[i+1]] holding t. @pre inside the table
size_t piece_of(const std::vector<double>& time, double t) {
  const auto after = std::upper_bound(time.begin(), time.end(), t);
  const size_t i = after - time.begin();
  return std::min(std::max<size_t>(i, 1), time.size() - 1) - 1;
}

}  // namespace

double History::value_at(double t) const {
  if (t <= time.front()) return value.front();
  if (t >= time.back()) return value.back();
  const size_t i = piece_of(time, t);
  const double s = (t - time[i]) / (time[i + 1] - time[i]);
  return value[i] + s * (value[i + 1] - value[i]);
}

double History::integral_at(double t) const {
  // integral from time[0] to t, the curve held outside
  const auto from_start = [this](double at) {
    if (at <= time.front()) return (at - time.front()) * value.front();
    if (at >= time.back()) return integral.back() + (at - time.back()) * value.back();
    const size_t i = piece_of(time, at);
    return integral[i] + 0.5 * (at - time[i]) * (value[i] + value_at(at));
  };
  return from_start(t) - from_start(0);
}

double Motion::displacement_at(double t, const std::vector<History>& histories) const {
  if (kind == kVelocity) return histories[history].integral_at(t);
  if (kind == kDisplacement) return histories[history].value_at(t);
  return 0;
}

}  // namespace talus
