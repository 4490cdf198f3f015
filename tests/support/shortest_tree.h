#pragma once
// What cuts that connect islands are measured by.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace talus::test {

/// Length of the shortest tree that connects `count` things (Prim); distance(i, j) is that of two of them.
template <class Distance>
double shortest_tree(size_t count, const Distance& distance) {
  std::vector<double> to(count, std::numeric_limits<double>::infinity());
  std::vector<bool> in(count, false);
  if (count > 0) to[0] = 0;
  double sum = 0;
  for (size_t n = 0; n < count; ++n) {
    size_t next = count;
    for (size_t i = 0; i < count; ++i)
      if (!in[i] && (next == count || to[i] < to[next])) next = i;
    in[next] = true, sum += to[next];
    for (size_t i = 0; i < count; ++i)
      if (!in[i]) to[i] = std::min(to[i], distance(next, i));
  }
  return sum;
}

}  // namespace talus::test
