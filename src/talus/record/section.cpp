#include "talus/record/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/angle.h"
#include "talus/base/error.h"

namespace talus::record {

std::vector<double> along_section(const std::vector<double>& a1, double azimuth_1,
                                  const std::vector<double>& a2, double azimuth_2, double section) {
  constexpr double kOff = 1;  // [deg]
  if (std::abs(std::cos((azimuth_1 - azimuth_2) * kDegree)) > std::sin(kOff * kDegree))
    throw InputError(fmt::format(
        "components at {:g} and {:g} deg are not at right angles: their motion along a section does not follow from them",
        azimuth_1, azimuth_2));
  const double c1 = std::cos((azimuth_1 - section) * kDegree), c2 = std::cos((azimuth_2 - section) * kDegree);
  std::vector<double> out(std::min(a1.size(), a2.size()));
  for (size_t i = 0; i < out.size(); ++i) out[i] = c1 * a1[i] + c2 * a2[i];
  return out;
}

}  // namespace talus::record
