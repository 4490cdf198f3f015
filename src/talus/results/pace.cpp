#include "talus/results/pace.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/base/text.h"

namespace talus {

Pace::Range Pace::of(double steps) const {
  if (marks_.size() < 2) return {};
  const Mark &first = marks_.front(), &last = marks_.back();
  const double middle = 0.5 * (first.wall + last.wall);
  // never the last one itself
  const Mark& from = *std::ranges::lower_bound(marks_.begin(), marks_.end() - 2, middle, {}, &Mark::wall);
  if (!(last.steps > from.steps)) return {};
  const double all = steps * (last.wall - first.wall) / (last.steps - first.steps);
  const double late = steps * (last.wall - from.wall) / (last.steps - from.steps);
  return {std::min(all, late), std::max(all, late)};
}

std::string readable_range(const Pace::Range& range) {
  if (!(range.high > 1.1 * range.low)) return readable_seconds(range.high);
  return fmt::format("{} to {}", readable_seconds(range.low), readable_seconds(range.high));
}

}  // namespace talus
