// Two components to the azimuth of a section.

#include "talus/record/section.h"

#include <doctest/doctest.h>

#include <cmath>

#include "talus/base/angle.h"
#include "talus/base/error.h"

namespace test_section {

using namespace talus;
using namespace talus::record;

TEST_CASE("section: a motion along one azimuth comes back whatever the two components are called") {
  // ground that moves along N 30 E alone: what a component reads is its share of that
  const double direction = 30, kSample[] = {0, 1, -2.5, 4};
  for (const auto& [one, two] : {std::pair(0.0, 90.0), {90.0, 0.0}, {332.0, 242.0}, {118.0, 28.0}}) {
    std::vector<double> a, b;
    for (const double v : kSample) {
      a.push_back(v * std::cos((one - direction) * kDegree));
      b.push_back(v * std::cos((two - direction) * kDegree));
    }
    for (const double section : {30.0, 120.0, 210.0, 75.0}) {
      const std::vector<double> along = along_section(a, one, b, two, section);
      for (size_t i = 0; i < along.size(); ++i)
        CHECK(std::abs(along[i] - kSample[i] * std::cos((section - direction) * kDegree)) < 1e-14);
    }
  }
  CHECK(along_section({1, 2, 3}, 0, {1, 2}, 90, 0) == std::vector<double>{1, 2});
  CHECK_THROWS_WITH_AS(along_section({1}, 10, {1}, 60, 0), doctest::Contains("not at right angles"),
                       InputError);
  CHECK_THROWS_AS(along_section({1}, 10, {1}, 190, 0), InputError);
}

}  // namespace test_section
