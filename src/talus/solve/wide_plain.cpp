#include "talus/solve/wide_kernels.h"

namespace talus::wide {

const Kernels& plain_kernels() {
  static constexpr Kernels kernels = make_kernels();
  return kernels;
}

bool has_avx2() {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

const Kernels& best_kernels() { return has_avx2() ? avx2_kernels() : plain_kernels(); }

}  // namespace talus::wide
