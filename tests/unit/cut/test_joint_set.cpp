#include "talus/cut/joint_set.h"

#include <doctest/doctest.h>

#include <limits>
#include <map>

#include "support/cut_case.h"
#include "support/relative.h"

namespace test_joint_set {

using namespace talus;
using namespace talus::test;

namespace {

using Lines = std::vector<std::pair<Vec2, Vec2>>;

constexpr double kRound = 1e-12;  // of lengths of 1e3 m at most, in a few operations of 1e-16 each

Lines lines_of(const JointSetInput& set, const Box& box, const CutInput& cut = {}) {
  const JointSetNote note = describe(set, cut.section_azimuth);
  REQUIRE(joint_set_defect(set, note, box).text == "");
  return joint_set_lines(set, note, cut, box);
}

Vec2 middle(const std::pair<Vec2, Vec2>& l) { return 0.5 * (l.first + l.second); }
double length(const std::pair<Vec2, Vec2>& l) { return norm(l.second - l.first); }
double angle(const std::pair<Vec2, Vec2>& l) {
  return std::atan2(l.second.y - l.first.y, l.second.x - l.first.x);
}

struct Statistics {
  double mean = 0, deviation = 0;
};
Statistics statistics(const std::vector<double>& x) {
  Statistics s;
  const auto n = static_cast<double>(x.size());
  for (const double v : x) s.mean += v / n;
  for (const double v : x) s.deviation += (v - s.mean) * (v - s.mean) / (n - 1);
  s.deviation = std::sqrt(s.deviation);
  return s;
}

// Distances between the neighbours of a set of level lines through a column 4000 m high.
std::vector<double> spacings(const Scattered& spacing) {
  JointSetInput set = joint_set("set", 0, 1);
  set.spacing = spacing;
  std::vector<double> y, out;
  for (const auto& l : lines_of(set, {{0, -2000}, {1, 2000}})) y.push_back(l.first.y);
  std::sort(y.begin(), y.end());
  for (size_t i = 1; i < y.size(); ++i) out.push_back(y[i] - y[i - 1]);
  return out;
}

// Three standard errors, as chance allows in 997 of 1000 draws; the seed is fixed.
void check_statistics(const std::vector<double>& x, double mean, double deviation,
                      double error_of_deviation) {
  const Statistics s = statistics(x);
  const auto n = static_cast<double>(x.size());
  REQUIRE(n > 1000);
  CHECK(std::abs(s.mean - mean) < 3 * deviation / std::sqrt(n));
  CHECK(std::abs(s.deviation - deviation) < 3 * error_of_deviation * deviation / std::sqrt(n));
}

// Whether the line comes again in `all` along the same line, to round-off; traces end where they ended, too.
bool is_among(const std::pair<Vec2, Vec2>& l, const Lines& all, bool ends) {
  constexpr double kNear = kRound * 1e3;
  return std::any_of(all.begin(), all.end(), [&](const auto& m) {
    if (ends) return norm(l.first - m.first) < kNear && norm(l.second - m.second) < kNear;
    const Vec2 d = (l.second - l.first) / length(l);
    return std::abs(cross(d, m.first - l.first)) < kNear && std::abs(cross(d, m.second - l.first)) < kNear;
  });
}

// Lines over the box from (0, 0) to (40, 30) are among those over a larger one, and those over the larger one
// that cross the smaller are all there.
void check_places(const JointSetInput& set) {
  const Box box{{0, 0}, {40, 30}};
  const bool ends = set.trace_length.mean > 0;
  const Lines small = lines_of(set, box), large = lines_of(set, {{-70, -20}, {60, 90}});
  CHECK(large.size() > small.size());
  size_t lost = 0, missed = 0;
  for (const auto& l : small) lost += !is_among(l, large, ends);
  for (const auto& l : large) {
    bool crosses = false;
    for (int i = 0; i <= 1000; ++i) {
      const Vec2 p = l.first + i / 1000.0 * (l.second - l.first);
      crosses = crosses || (p.x > 0 && p.x < 40 && p.y > 0 && p.y < 30);
    }
    missed += crosses && !is_among(l, small, ends);
  }
  CHECK(lost == 0);
  CHECK(missed == 0);
}

}  // namespace

TEST_CASE("apparent dip: tan of it is tan dip times cos of the angle to the section") {
  // tan 75 cos(302.5 - 60) = -1.7232: the trace rises towards +x at 59.87 deg
  CHECK(apparent_dip(degrees(75), degrees(302.5), degrees(60)).angle == approx(degrees(59.87)).epsilon(1e-4));
  CHECK(apparent_dip(degrees(55), 0, degrees(60)).angle == approx(degrees(-35.53)).epsilon(1e-4));
  for (double dip = 5; dip < 90; dip += 17) {
    for (double to = 0; to < 360; to += 37) {
      const ApparentDip a = apparent_dip(degrees(dip), degrees(to), degrees(60));
      const double slope = std::tan(degrees(dip)) * std::cos(degrees(to - 60));
      CHECK(std::tan(a.angle) == approx(-slope).epsilon(kRound));
      // planes 1 m apart: the pole less its part across the section is what the traces are spaced by
      const double across = std::sin(degrees(dip)) * std::sin(degrees(to - 60));
      CHECK(a.widening == approx(1 / std::sqrt(1 - across * across)).epsilon(kRound));
    }
  }
}

TEST_CASE("apparent dip: along the dip direction the true dip, along the strike level") {
  const ApparentDip along = apparent_dip(degrees(40), degrees(110), degrees(110));
  CHECK(along.angle == approx(degrees(-40)).epsilon(kRound));
  CHECK(along.widening == approx(1).epsilon(kRound));
  CHECK(apparent_dip(degrees(40), degrees(110), degrees(290)).angle == approx(degrees(40)).epsilon(kRound));
  const ApparentDip strike = apparent_dip(degrees(40), degrees(110), degrees(200));
  CHECK(std::abs(strike.angle) < kRound);
  CHECK(strike.widening == approx(1 / std::cos(degrees(40))).epsilon(kRound));
  CHECK(apparent_dip(0, 0, 1).angle == 0);
  CHECK(std::abs(apparent_dip(degrees(90), 0.3, 0.3).angle) == approx(degrees(90)).epsilon(kRound));
}

TEST_CASE("a joint set in space is widened and tells its apparent dip") {
  JointSetInput set = joint_set("set", 0, 3);
  set.in_space = true;
  set.dip = degrees(40), set.dip_direction = degrees(110);
  const JointSetNote note = describe(set, degrees(200));
  CHECK(note.spacing == approx(3 / std::cos(degrees(40))).epsilon(kRound));
  CHECK(describe(set, degrees(110)).apparent_dip == approx(degrees(40)).epsilon(kRound));
  set.dip = degrees(90);
  const Box box{{0, 0}, {10, 10}};
  CHECK(joint_set_defect(set, describe(set, degrees(200)), box).text.find("parallel to the section") !=
        std::string::npos);
  CHECK(joint_set_defect(set, describe(set, degrees(199)), box).text == "");
  set.spacing.mean = 1e-8;
  CHECK(joint_set_defect(set, describe(set, degrees(110)), box).text.find("traces") != std::string::npos);
}

TEST_CASE("constant spacing: lines at origin + offset to the left + multiples, out of the box at both ends") {
  JointSetInput set = joint_set("set", 0, 1);
  set.origin = {3, 0};
  set.offset.mean = 0.25;
  const Lines level = lines_of(set, {{0, 0}, {10, 3}});
  REQUIRE(level.size() == 3);
  for (size_t i = 0; i < 3; ++i) {
    CHECK(level[i].first.y == 0.25 + static_cast<double>(i));
    CHECK(level[i].second.y == level[i].first.y);
    CHECK(level[i].first.x < 0);
    CHECK(level[i].second.x > 10);
  }
  set.angle.mean = degrees(90);  // to the left is towards -x
  const Lines upright = lines_of(set, {{0, 0}, {2, 3}});
  REQUIRE(upright.size() == 2);
  for (const auto& l : upright) CHECK(std::abs(l.first.x - (&l == &upright[0] ? 1.75 : 0.75)) < kRound);
  // a slope of 3 in 4, spacing 1: the normal is (-0.6, 0.8), corners of the box at -6 and 0 along it
  set = joint_set("set", std::atan2(3, 4), 1);
  const Lines sloping = lines_of(set, {{0, 0}, {10, 0}});
  CHECK((sloping.size() == 6 || sloping.size() == 7));  // the two through corners may be lost to round-off
  for (const auto& l : sloping) {
    const double s = dot(l.first, {-0.6, 0.8});
    CHECK(std::abs(s - std::round(s)) < kRound * 10);
  }
}

TEST_CASE("traces of constant length and gap repeat both ways from their start") {
  JointSetInput set = joint_set("set", 0, 2);
  set.trace_length.mean = 2;
  set.gap.mean = 1;
  set.start.mean = 0.5;
  set.origin = {1, 0};
  Lines lines = lines_of(set, {{-5, -0.5}, {8, 0.5}});
  std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.first.x < b.first.x; });
  std::vector<double> begins;
  for (const auto& l : lines) {
    CHECK(l.first.y == 0);
    CHECK(std::abs(length(l) - 2) < kRound);
    if (l.second.x > -5 && l.first.x < 8) begins.push_back(l.first.x);
  }
  REQUIRE(begins.size() == 5);  // those that reach the box begin at 1 + 0.5 + 3 k
  for (size_t i = 0; i < 5; ++i) CHECK(std::abs(begins[i] - (-4.5 + 3 * static_cast<double>(i))) < kRound);
}

TEST_CASE("scattered spacings have the mean and deviation asked for") {
  check_statistics(spacings({Scattered::kNormal, 2, 0.4}), 2, 0.4, std::sqrt(0.5));
  check_statistics(spacings({Scattered::kUniform, 2, 1.5}), 2, 1.5 / std::sqrt(3), std::sqrt(0.2));
  check_statistics(spacings({Scattered::kExponential, 1, 1}), 1, 1,
                   std::sqrt(2));                                            // coefficient of variation 1
  for (const double d : spacings({Scattered::kNormal, 1, 2})) CHECK(d > 0);  // drawn again
}

TEST_CASE("scattered angles, lengths, gaps and starts have the mean and deviation asked for") {
  JointSetInput set = joint_set("set", 0, 1);
  set.angle = {Scattered::kNormal, degrees(30), degrees(5)};
  set.trace_length = {Scattered::kUniform, 4, 1};
  set.gap = {Scattered::kExponential, 2, 2};
  std::vector<double> angles, lengths;
  for (const auto& l : lines_of(set, {{0, 0}, {150, 150}}))
    angles.push_back(angle(l)), lengths.push_back(length(l));
  check_statistics(angles, degrees(30), degrees(5), std::sqrt(0.5));
  check_statistics(lengths, 4, 1 / std::sqrt(3), std::sqrt(0.2));
  // without turning, the gaps between traces of one line
  set.angle = {Scattered::kConstant, 0, 0};
  std::map<double, std::vector<double>> ends;
  for (const auto& l : lines_of(set, {{0, 0}, {300, 40}}))
    ends[l.first.y].push_back(l.first.x), ends[l.first.y].push_back(l.second.x);
  std::vector<double> gaps;
  for (auto& [y, x] : ends) {
    std::sort(x.begin(), x.end());
    for (size_t i = 1; i + 1 < x.size(); i += 2) gaps.push_back(x[i + 1] - x[i]);
  }
  check_statistics(gaps, 2, 2, std::sqrt(2));
}

TEST_CASE("Fisher: the mean cosine between poles and their mean is coth kappa - 1 / kappa") {
  // The same poles in two sections, north and east: the slopes of their traces are -n / u and -e / u of the
  // pole.
  JointSetInput set = joint_set("set", 0, 1);
  set.in_space = true;
  set.dip = degrees(40), set.dip_direction = degrees(70);
  set.fisher = 30;
  const auto slopes = [&](double azimuth) {
    CutInput cut;
    cut.section_azimuth = degrees(azimuth);
    const JointSetNote note = describe(set, cut.section_azimuth);
    const Vec2 across{-std::sin(note.angle), std::cos(note.angle)};
    std::map<int64_t, double> out;  // by the number of the line
    for (const auto& l : lines_of(set, {{-3000, -3000}, {3000, 3000}}, cut))
      out[std::llround(dot(middle(l), across) / note.spacing)] =
          (l.second.y - l.first.y) / (l.second.x - l.first.x);
    return out;
  };
  const auto north = slopes(0), east = slopes(90);
  const double sd = std::sin(set.dip), cd = std::cos(set.dip), sa = std::sin(set.dip_direction),
               ca = std::cos(set.dip_direction);
  std::vector<double> cosines, sideways;
  for (const auto& [k, n] : north) {
    const auto e = east.find(k);
    if (e == east.end()) continue;
    const double size = std::sqrt(1 + n * n + e->second * e->second);
    cosines.push_back((-e->second * sd * sa - n * sd * ca + cd) / size);
    sideways.push_back((-e->second * ca + n * sa) / size);
  }
  // moments of the distribution: deviation of the cosine, and of the two parts across, sqrt(mean cosine /
  // kappa) each
  const double mean = 1 / std::tanh(set.fisher) - 1 / set.fisher;
  const double deviation = std::sqrt(1 / (set.fisher * set.fisher) - 1 / std::pow(std::sinh(set.fisher), 2));
  check_statistics(cosines, mean, deviation, std::sqrt(2));  // 1 - cosine is almost exponential
  check_statistics(sideways, 0, std::sqrt(mean / set.fisher), 1);
}

TEST_CASE("a line keeps its place when the box grows") {
  JointSetInput set = joint_set("set", degrees(35), 2);
  set.origin = {1, 2};
  check_places(set);
  set.spacing = {Scattered::kExponential, 2, 2};
  set.offset = {Scattered::kUniform, 0, 1};
  check_places(set);
  set.trace_length = {Scattered::kNormal, 5, 1};
  set.gap = {Scattered::kExponential, 2, 2};
  set.start = {Scattered::kUniform, 0, 8};
  check_places(set);
  set.angle = {Scattered::kNormal, degrees(35), degrees(4)};
  check_places(set);
}

TEST_CASE("a through-going line that turns keeps its place when the box grows") {
  JointSetInput set = joint_set("set", degrees(35), 2);
  set.angle = {Scattered::kNormal, degrees(35), degrees(4)};
  check_places(set);
}

TEST_CASE("a long trace that turns into the box from far outside is not missed") {
  JointSetInput set = joint_set("set", 0, 0.5);
  set.angle = {Scattered::kNormal, 0, degrees(30)};
  set.trace_length = {Scattered::kExponential, 5, 5};
  check_places(set);
}

TEST_CASE("what one set draws depends on its name and the seed, not on the other sets") {
  Model model = rock_model(box_polygon(0, 0, 50, 50));
  JointSetInput a = joint_set("a", 0.3, 2), b = joint_set("b", 1.3, 3);
  a.spacing.kind = b.spacing.kind = Scattered::kExponential;
  const auto lines_called = [&](const std::string& name) {
    Findings findings("case.toml", "");
    const TraceSet traces = make_traces(model, RegionMap(model), findings);
    std::vector<std::vector<Vec2>> out;
    for (const Trace& t : traces.traces)
      if (traces.origins[t.origin].name == name) out.push_back(t.line);
    return out;
  };
  model.joint_sets = {a};
  const auto alone = lines_called("a");
  REQUIRE(alone.size() > 5);
  model.joint_sets = {b, a};
  CHECK(lines_called("a") == alone);
  model.joint_sets[1].name = "c";
  CHECK(lines_called("c") != alone);
  model.joint_sets = {a};
  model.cut.seed = 2;
  CHECK(lines_called("a") != alone);
}

}  // namespace test_joint_set
