#include "talus/solve/wide_kernels.h"

namespace talus::wide {

Worst& Worst::operator+=(const Worst& o) {
  if (o.row < 0 || o.error == 0) return *this;
  const bool none = std::isnan(error), other_none = std::isnan(o.error);
  const bool equal = none ? other_none : error == o.error;
  if (row < 0 || (equal ? o.row < row : !none && (other_none || o.error > error))) *this = o;
  return *this;
}

const Kernels& plain_kernels() {
  static constexpr Kernels kernels = make_kernels();
  return kernels;
}

bool has_avx2() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

const Kernels& best_kernels() { return has_avx2() ? avx2_kernels() : plain_kernels(); }

}  // namespace talus::wide
