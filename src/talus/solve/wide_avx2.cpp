// Compiled for processors with AVX2 where the compiler can (CMakeLists.txt); otherwise the plain kernels
// again.
#include "talus/solve/wide_kernels.h"

namespace talus::wide {

const Kernels& avx2_kernels() {
  static constexpr Kernels kernels = make_kernels();
  return kernels;
}

}  // namespace talus::wide
