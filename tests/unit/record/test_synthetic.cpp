// Motions from a seed: the same each time, at rest at their end, near their target.

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "support/relative.h"
#include "support/tolerance.h"
#include "talus/base/error.h"
#include "talus/base/text_file.h"
#include "talus/record/measures.h"
#include "talus/record/motion_file.h"
#include "talus/record/response_spectrum.h"
#include "talus/record/synthetic.h"

namespace test_synthetic {

using namespace talus;
using namespace talus::record;
using namespace talus::test;

namespace {

SyntheticInput input(uint64_t seed, double pga) {
  SyntheticInput in;
  in.seed = seed;
  in.target = code_spectrum(pga);
  return in;
}

std::string refusal(const SyntheticInput& in) {
  try {
    make_synthetic(in);
  } catch (const InputError& e) {
    return e.what();
  }
  return "(accepted)";
}

}  // namespace

TEST_CASE("synthetic: matches the target, ends at rest") {
  for (const uint64_t seed : {1UL, 2UL, 3UL, 50UL}) {
    const SyntheticInput in = input(seed, 2);
    const Synthetic s = make_synthetic(in);
    // measured 0.04 to 0.09: harmonics 0.05 Hz apart cannot follow every period
    check_below(fmt::format("synthetic, seed {}: rms of ln(Sa / target)", seed), s.rms_misfit, 0.1, 0.03);
    check_below(fmt::format("synthetic, seed {}: v(T) [m/s]", seed), std::abs(s.motion.velocity.back()),
                1e-13, 1e-14);
    check_below(fmt::format("synthetic, seed {}: d(T) [m]", seed), std::abs(s.motion.displacement.back()),
                1e-12, 1e-14);
    CHECK(s.motion.size() == 2001);
    CHECK(s.motion.acceleration.front() == 0);
    CHECK(std::abs(s.motion.acceleration.back()) < 1e-12);
    // the misfit that is told is that of the motion that is given out
    const std::vector<double> periods = matched_periods(in);
    const std::vector<double> sa = response_spectrum(s.motion.acceleration, in.dt, periods);
    double sum = 0;
    for (size_t i = 0; i < periods.size(); ++i)
      sum += std::pow(std::log(sa[i] / in.target.at(periods[i])), 2);
    CHECK(std::sqrt(sum / static_cast<double>(periods.size())) == approx(s.rms_misfit).epsilon(1e-9));
  }
}

TEST_CASE("synthetic: scaled to the asked peak, which costs some of the match") {
  for (const uint64_t seed : {1UL, 2UL, 3UL, 50UL}) {
    SyntheticInput in = input(seed, 8.17);
    in.pga = 8.17;
    const Synthetic s = make_synthetic(in);
    check_close(fmt::format("synthetic, seed {}: PGA [m/s2]", seed), measure(s.motion).pga, 8.17, 1e-12,
                1e-14);
    // measured 0.05 to 0.25
    check_below(fmt::format("synthetic, seed {}: rms of ln(Sa / target), scaled", seed), s.rms_misfit, 0.3,
                0.1);
  }
}

TEST_CASE("synthetic: a seed gives its motion, another seed another") {
  SyntheticInput in = input(11, 1);
  in.iterations = 3;
  const Motion a = make_synthetic(in).motion, b = make_synthetic(in).motion;
  CHECK(a.acceleration == b.acceleration);
  in.seed = 12;
  CHECK(make_synthetic(in).motion.acceleration != a.acceleration);
}

TEST_CASE("synthetic: examples/record/motion.csv is what its README says") {
  SyntheticInput in = input(50, 8.17);
  in.pga = 8.17;
  const Motion made = make_synthetic(in).motion;
  const Record shipped = read_record(std::string(TALUS_SOURCE_DIR) + "/examples/record/motion.csv");
  REQUIRE(shipped.value.size() == made.size());
  // the same bits here; other libraries may round sin, cos and exp otherwise, which 30 turns of matching
  // carry on
  double worst = 0;
  for (size_t i = 0; i < made.size(); ++i)
    worst = std::max(worst, std::abs(made.acceleration[i] - shipped.value[i]));
  check_below("shipped motion against the one made here [m/s2]", worst, 1e-6, 1e-15);
}

TEST_CASE("synthetic: envelope and built-in target at their corners") {
  const Envelope e{3, 7, 8};
  CHECK(e.at(0) == 0);
  CHECK(e.at(1.5) == approx(0.25));
  CHECK(e.at(3) == 1);
  CHECK(e.at(10) == 1);
  CHECK(e.at(18) == approx(0.05));
  CHECK(e.at(14) == approx(std::sqrt(0.05)));

  // log-linear between 100 points a decade: 1e-3 of the value where the formula bends
  const TargetSpectrum t = code_spectrum(2);
  CHECK(t.at(0.075) == approx(2 * 1.75).epsilon(1e-3));
  CHECK(t.at(0.15) == approx(5).epsilon(5e-3));
  CHECK(t.at(0.3) == approx(5).epsilon(1e-3));
  CHECK(t.at(1) == approx(2.5).epsilon(1e-3));
  CHECK(t.at(4) == approx(2 * 2.5 * 0.5 * 2 / 16).epsilon(1e-3));
}

TEST_CASE("synthetic: a target from a file, and what is wrong with one") {
  const auto path = std::filesystem::temp_directory_path() / fmt::format("talus_target_{}.csv", getpid());
  const auto read = [&](const std::string& text) {
    std::ofstream(path) << text;
    return read_target(path);
  };
  const auto message = [&](const std::string& text) -> std::string {
    try {
      read(text);
    } catch (const InputError& e) {
      const std::string what = e.what();
      return what.substr(path.string().size(), what.find('\n') - path.string().size());
    }
    return "(accepted)";
  };
  const TargetSpectrum t = read("sa [g],period [s]\n0.5,0.1\n0.5,0.5\n0.125,2\n");
  CHECK(t.period == std::vector<double>{0.1, 0.5, 2});
  CHECK(t.at(1) == approx(0.25 * kStandardGravity));  // halfway in ln T and in ln Sa
  CHECK(t.at(9) == approx(0.125 * kStandardGravity));

  SyntheticInput in;
  in.target = t;
  check_below("synthetic for a target from a file: rms of ln(Sa / target)", make_synthetic(in).rms_misfit,
              0.1, 0.03);

  CHECK(message("1,2\n3,4\n") == ":1: error: the table of the target spectrum is not understood");
  CHECK(message("t [s],sa\n1,2\n2,3\n") == ":1: error: \"sa\" names no unit of acceleration");
  CHECK(message("t [s],v [m/s]\n1,2\n2,3\n") == ":1: error: \"v [m/s]\" names no unit of acceleration");
  CHECK(message("x [s],sa [g]\n1,2\n2,3\n") == ":1: error: there is no column of periods in s");
  CHECK(message("t [s],sa [g]\n1,2\n1,3\n") == ":3: error: periods do not rise: 1 s is followed by 1 s");
  CHECK(message("t [s],sa [g]\n1,2\n2,-3\n") == ":3: error: period and Sa must be above 0");
  CHECK(message("t [s],sa [g]\n1,2\n") == ":1: error: the target has one row");
  std::filesystem::remove(path);
}

TEST_CASE("synthetic: input out of range is refused") {
  const auto with = [](const auto& change) {
    SyntheticInput in = input(1, 1);
    change(in);
    return refusal(in);
  };
  const auto begins = [](const std::string& text, const std::string& with_what) {
    INFO(text);
    CHECK(text.rfind("synthetic motion: error: " + with_what, 0) == 0);
  };
  begins(with([](auto& in) { in.dt = 0; }), "20 s in steps of 0 s");
  begins(with([](auto& in) { in.duration = 3; }), "a duration of 3 s");
  begins(with([](auto& in) { in.envelope.rise = 15; }),
         "an envelope of 15 s rise, 7 s strong motion, 8 s decay in 20 s");
  begins(with([](auto& in) { in.pga = -1; }), "a peak acceleration of -1 m/s2");
  begins(with([](auto& in) {
           in.dt = 5;
           in.duration = 500;
         }),
         "a band from 0.1 to 0.08 Hz");
  begins(with([](auto& in) { in.target = {}; }), "there is no target spectrum");
  begins(with([](auto& in) {
           in.target = {{5, 6}, {1, 1}};
         }),
         "target and band of the motion share fewer than three");
}

}  // namespace test_synthetic
