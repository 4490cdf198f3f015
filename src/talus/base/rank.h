#pragma once
// Values by their rank.

#include <algorithm>
#include <vector>

#include "talus/base/error.h"

namespace talus {

/// The value that `rank` others of the list come before, in rising order. Cost: linear. @pre rank < size
inline double value_at_rank(std::vector<double> values, size_t rank) {
  TALUS_ASSERT(rank < values.size());
  const auto at = values.begin() + rank;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Of two in the middle the larger. @pre not empty
inline double median(std::vector<double> values) {
  const size_t middle = values.size() / 2;
  return value_at_rank(std::move(values), middle);
}

}  // namespace talus
