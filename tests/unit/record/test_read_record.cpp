// The same motion written in every format and unit reads back, to the digits of the format.

#include <doctest/doctest.h>

#include <algorithm>

#include "support/record_text.h"
#include "support/relative.h"
#include "support/tolerance.h"
#include "talus/record/motion_file.h"
#include "talus/record/synthetic.h"

namespace test_read_record {

using namespace talus::record;
using namespace talus::test;

namespace {

const Motion& motion() {
  static const Motion m = [] {
    SyntheticInput in;
    in.seed = 7;
    in.dt = 0.02;
    in.pga = 3;
    in.target = code_spectrum(3);
    in.iterations = 2;
    return make_synthetic(in).motion;
  }();
  return m;
}

std::vector<double> in_unit(const std::vector<double>& si, double factor) {
  std::vector<double> out = si;
  for (double& v : out) v /= factor;
  return out;
}

double largest_error(const Record& r, const std::vector<double>& exact) {
  REQUIRE(r.value.size() == exact.size());
  double worst = 0;
  for (size_t i = 0; i < exact.size(); ++i) worst = std::max(worst, std::abs(r.value[i] - exact[i]));
  return worst;
}

}  // namespace

TEST_CASE("record: PEER files in every spelling of the header") {
  const auto& a = motion().acceleration;
  const auto n = a.size();
  const std::string g = "ACCELERATION TIME SERIES IN UNITS OF G";
  const std::string spellings[] = {fmt::format("NPTS=   {}, DT=   .0200 SEC,", n),
                                   fmt::format("NPTS =   {} , DT =   .020 SEC ,", n),
                                   fmt::format("NPTS =  {} , DT =  .020 SEC,   ", n),
                                   fmt::format("NPTS={},    DT=0.0200SEC", n),
                                   fmt::format("npts= {}, dt= 2.0E-02 sec", n),
                                   fmt::format("  {}   .0200   NPTS, DT", n),
                                   fmt::format("{} 0.02000 NPTS, DT", n)};
  for (const std::string& counts : spellings) {
    INFO(counts);
    const Record r = read_record_text("a.AT2", peer_text(g, counts, in_unit(a, kStandardGravity)));
    CHECK(r.format == Format::kPeer);
    CHECK(r.quantity == Quantity::kAcceleration);
    CHECK(r.dt == 0.02);
    CHECK(r.title == "NOWHERE 01/17/95 20:46, TEST, 000");
    // seven digits of values up to 0.31 g
    CHECK(largest_error(r, a) <= 0.5e-7 * kStandardGravity * (1 + 1e-9));
  }
  const Record old = read_record_text(
      "a.acc", peer_text("ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.05 Hz LP=40.0 Hz",
                         spellings[5], in_unit(a, kStandardGravity), 8));
  CHECK(largest_error(old, a) <= 0.5e-7 * kStandardGravity * (1 + 1e-9));
}

TEST_CASE("record: velocities and displacements, cm/s and cm") {
  const auto n = motion().size();
  const std::string counts = fmt::format("NPTS= {}, DT= .0200 SEC", n);
  const Record v = read_record_text(
      "a.VT2", peer_text("VELOCITY TIME SERIES IN UNITS OF CM/S", counts, in_unit(motion().velocity, 0.01)));
  CHECK(v.quantity == Quantity::kVelocity);
  CHECK(largest_error(v, motion().velocity) <= 0.5e-7);  // seven digits of up to 1e2 cm/s
  const Record d = read_record_text("a.DT2", peer_text("DISPLACEMENT TIME SERIES IN UNITS OF CM", counts,
                                                       in_unit(motion().displacement, 0.01)));
  CHECK(d.quantity == Quantity::kDisplacement);
  CHECK(largest_error(d, motion().displacement) <= 0.5e-7);
}

TEST_CASE("record: numbers glued by minus signs, D exponents, CR LF") {
  const std::string head =
      "title\r\nevent\r\nACCELERATION TIME SERIES IN UNITS OF CM/S2\r\nNPTS= 6, DT= .01 SEC\r\n";
  const Record r = read_record_text("a.AT2", head + " .12E-01-.34E+00-.5\r\n1.D0 +2.5d-1 -3\r\n");
  CHECK(r.value ==
        std::vector<double>{0.012 * 0.01, -0.34 * 0.01, -0.5 * 0.01, 0.01, 0.25 * 0.01, -3 * 0.01});
}

TEST_CASE("record: K-NET counts, with the offset of the logger taken off") {
  const auto& a = motion().acceleration;
  // duration and frequency make the count: 1001 values are no whole number of seconds at 50 Hz, 1000 are
  std::vector<double> part(a.begin(), a.begin() + 1000);
  double mean = 0;
  for (const double v : part) mean += v / 1000;
  for (double& v : part) v -= mean;
  const Record r = read_record_text("a.EW", knet_text(in_unit(part, 0.01), 50, -4711));
  CHECK(r.format == Format::kKnet);
  CHECK(r.dt == 0.02);
  CHECK(r.title == "CHB002 E-W 1996/09/11 11:37:43");
  const double count = 0.01 * 3920 / 6182761;  // [m/s2]
  CHECK(r.offset == approx(-4711 * count).epsilon(1e-3));
  CHECK(largest_error(r, part) <= count);  // half a count of rounding, and its mean
}

TEST_CASE("record: JMA components by name") {
  const auto& a = motion().acceleration;
  const std::string text = jma_text(in_unit(a, 0.01), 50);
  for (const auto& [name, factor] : {std::pair{"NS", 0.5}, std::pair{"ew", 1.0}, std::pair{"UD", 2.0}}) {
    ReadOptions options;
    options.column = name;
    const Record r = read_record_text("a.csv", text, options);
    CHECK(r.format == Format::kJma);
    CHECK(r.dt == 0.02);
    CHECK(largest_error(r, in_unit(a, 1 / factor)) <= 0.5e-4 * 0.01 * (1 + 1e-6));  // four decimals of a gal
  }
}

TEST_CASE("record: CSV with units in the title, in g, cm/s2 and m/s2") {
  const auto& a = motion().acceleration;
  const double g = kStandardGravity;
  struct Case {
    const char* titles;
    double factor;
  };
  for (const Case& c :
       {Case{"t_s,a_gal", 0.01}, Case{"time [s],acceleration [m/s2]", 1}, Case{"t,a_m_s2", 1},
        Case{"Time (s),acc (g)", g}, Case{"time [s],NS [cm/s/s]", 0.01}, Case{"t_s,a_cm_s_s", 0.01},
        Case{"time,acc [CM/SEC2]", 0.01}, Case{"t [s],ACC [m/s^2]", 1}, Case{"t [s],a [m/s\xc2\xb2]", 1},
        Case{"t [s],a_mm_s2", 1e-3}}) {
    INFO(c.titles);
    const Record r = read_record_text("a.csv", csv_text(c.titles, a, 0.02, c.factor));
    CHECK(r.format == Format::kCsv);
    CHECK(r.dt == approx(0.02).epsilon(1e-12));
    CHECK(largest_error(r, a) <= 1e-15 * 3 / std::min(c.factor, 1.0) * 1e-2 + 2e-15);  // rounding only
  }
  const Record v = read_record_text("v.csv", csv_text("t [s],v_cm_s", motion().velocity, 0.02, 0.01));
  CHECK(v.quantity == Quantity::kVelocity);
  CHECK(largest_error(v, motion().velocity) < 1e-15);
}

TEST_CASE("record: CSV with several columns, other separators, bare numbers") {
  const auto read = [](const std::string& text, const std::string& column = "", const std::string& unit = "",
                       std::optional<double> dt = {}) {
    return read_record_text("a.csv", text, {{}, column, unit, dt});
  };
  const std::string three = "time [ms];x_gal;y_gal\n0;1;2\n10;3;4\n20;5;6\n";
  CHECK(read(three, "y").value == std::vector<double>{0.02, 0.04, 0.06});
  CHECK(read(three, "x_gal").dt == approx(0.01));
  CHECK(read("# made by hand\n\na [m/s2]\n1\n2\n3\n", "", "", 0.5).value == std::vector<double>{1, 2, 3});
  CHECK(read("0 1\n1 2\n2 3\n", "2", "gal", 0.1).value == std::vector<double>{0.01, 0.02, 0.03});
  // times rounded beyond use: the step is told
  CHECK(read("t [s],a_gal\n0.00,1\n0.00,2\n0.01,3\n0.01,4\n", "", "", 0.005).dt == 0.005);
}

TEST_CASE("record: the written motion comes back bit by bit") {
  const Motion& m = motion();
  for (const char* column : {"", "acceleration", "velocity", "displacement [m]"}) {
    ReadOptions options;
    options.column = column;
    const Record r = read_record_text("motion.csv", motion_csv(m), options);
    const auto& exact = r.quantity == Quantity::kAcceleration ? m.acceleration
                        : r.quantity == Quantity::kVelocity   ? m.velocity
                                                              : m.displacement;
    CHECK(r.value == exact);
    CHECK(r.dt == approx(m.dt).epsilon(1e-12));
  }
}

TEST_CASE("record: acceleration from velocity and displacement by differences") {
  // of t^2 / 2 and t^3 / 6 exact inside, but for the ends
  Record r;
  r.dt = 0.1;
  r.quantity = Quantity::kVelocity;
  for (int i = 0; i <= 10; ++i) r.value.push_back(0.5 * (0.1 * i) * (0.1 * i));
  CHECK(acceleration_of(r)[5] == approx(0.5));
  CHECK(acceleration_of(r)[0] == approx(0.05));
  r.quantity = Quantity::kDisplacement;
  CHECK(acceleration_of(r)[5] == approx(1));
  r.quantity = Quantity::kAcceleration;
  CHECK(acceleration_of(r) == r.value);
}

}  // namespace test_read_record
