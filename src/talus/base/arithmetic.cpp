#include "talus/base/arithmetic.h"

#include <cmath>
#include <cstring>

#include "talus/base/text.h"

namespace talus {

std::string arithmetic_digest() {
  constexpr int kPlaces = 2000;  // one in some thousands of last bits differs
  TextHash hash;
  const auto add = [&hash](double v) {
    char bytes[sizeof v];
    std::memcpy(bytes, &v, sizeof v);
    hash.add({bytes, sizeof v});
  };
  for (int i = 0; i < kPlaces; ++i) {
    const double x = 1e-3 + 0.01237 * i, share = (i + 0.5) / kPlaces;
    for (const double v : {std::sin(x),          std::cos(x),
                           std::tan(x),          std::atan(x),
                           std::atan2(share, x), std::asin(share),
                           std::acos(share),     std::exp(x),
                           std::exp2(share),     std::log(x),
                           std::log1p(share),    std::log2(x),
                           std::log10(x),        std::pow(x, 1 + share),
                           std::cbrt(x),         std::hypot(x, share),
                           std::sinh(share),     std::cosh(share),
                           std::tanh(share),     std::erfc(share)})
      add(v);
  }
  return hash.text();
}

}  // namespace talus
