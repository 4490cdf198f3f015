#pragma once
// A few of many, evenly.

#include <cstddef>
#include <vector>

namespace talus {

/// `count` of `n` places, spread evenly, the first and the last among them; of one the last.
inline std::vector<size_t> spread(size_t n, size_t count) {
  std::vector<size_t> out;
  if (n == 0 || count == 0) return out;
  if (count >= n) count = n;
  for (size_t k = 0; k < count; ++k) {
    const size_t at = count == 1 ? n - 1 : (k * (n - 1) + (count - 1) / 2) / (count - 1);
    if (out.empty() || out.back() != at) out.push_back(at);
  }
  return out;
}

}  // namespace talus
