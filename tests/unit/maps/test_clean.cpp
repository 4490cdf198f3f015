// Cleaning of maps: each rule by itself, then a lattice with every defect put in by hand, and all counted.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "support/relative.h"
#include "talus/base/index.h"
#include "talus/base/random.h"
#include "talus/maps/clean.h"

namespace test_clean {

using namespace talus;
using namespace talus::maps;

namespace {

std::vector<MapLine> lines_of(const std::vector<Polyline>& list) {
  std::vector<MapLine> out;
  for (const Polyline& l : list) out.push_back({l, count_of(out), 0, false});
  return out;
}

int count(const std::vector<Mend>& mends, Mend::Kind kind) {
  return static_cast<int>(
      std::count_if(mends.begin(), mends.end(), [kind](const Mend& m) { return m.kind == kind; }));
}

bool has_point(const Polyline& line, Vec2 p) { return std::find(line.begin(), line.end(), p) != line.end(); }

}  // namespace

TEST_CASE("clean: sound lines stay as they are") {
  std::vector<MapLine> lines = lines_of({{{0, 0}, {10, 0}}, {{3, -2}, {3, 5}, {4, 9}}, {{0, 0}, {0, 4}}});
  const std::vector<MapLine> before = lines;
  CHECK(clean_lines(lines, {0.1, 0.05, 1e-6}).empty());
  REQUIRE(lines.size() == before.size());
  for (size_t i = 0; i < lines.size(); ++i) CHECK(lines[i].points == before[i].points);
}

TEST_CASE("clean: an end that stops short is brought to the line, straight on, and the line gets the point") {
  std::vector<MapLine> lines = lines_of({{{0, 0}, {10, 0}}, {{3, 4}, {3.9, 0.05}}});
  const auto mends = clean_lines(lines, {0.1, 0, 1e-6});
  CHECK(count(mends, Mend::kGap) == 1);
  CHECK(mends.size() == 1);
  const Vec2 end = lines[1].points.back();
  CHECK(std::abs(end.y) < 1e-12);
  // on the line through (3, 4) and (3.9, 0.05)
  CHECK(end.x == test::approx(3.9 + 0.9 * 0.05 / 3.95).epsilon(1e-12));
  CHECK(has_point(lines[0].points, end));
  CHECK(lines[0].points.size() == 3);
}

TEST_CASE("clean: an end that crosses by a little is cut back to the line") {
  std::vector<MapLine> lines = lines_of({{{0, 0}, {10, 0}}, {{3, 4}, {3, -0.08}}});
  const auto mends = clean_lines(lines, {0.1, 0, 1e-6});
  CHECK(count(mends, Mend::kOvershoot) == 1);
  CHECK(mends.size() == 1);
  CHECK(norm(lines[1].points.back() - Vec2{3, 0}) < 1e-12);
  CHECK(has_point(lines[0].points, lines[1].points.back()));
}

TEST_CASE("clean: ends further away than the distance stay") {
  std::vector<MapLine> lines = lines_of({{{0, 0}, {10, 0}}, {{3, 4}, {3, 0.11}}, {{5, 4}, {5, -0.11}}});
  CHECK(clean_lines(lines, {0.1, 0, 1e-6}).empty());
}

TEST_CASE("clean: two ends near each other meet, and do not change places") {
  std::vector<MapLine> lines = lines_of({{{0, 0}, {5, 0}}, {{5.03, 0.04}, {9, 3}}});
  const auto mends = clean_lines(lines, {0.1, 0, 1e-6});
  CHECK(count(mends, Mend::kGap) == 1);
  CHECK(lines[0].points.back() == lines[1].points.front());
}

TEST_CASE("clean: four ends near a junction meet in one point") {
  std::vector<MapLine> lines = lines_of(
      {{{-5, 0}, {-0.03, 0.01}}, {{5, 0}, {0.02, 0.03}}, {{0, 5}, {0.01, 0.04}}, {{0, -5}, {0.0, -0.03}}});
  clean_lines(lines, {0.15, 0, 1e-6});
  const Vec2 meeting = lines[0].points.back();
  for (const MapLine& l : lines) CHECK(norm(l.points.back() - meeting) == 0);
}

TEST_CASE("clean: doubles go, the longer of two stays, parts that only touch stay") {
  std::vector<MapLine> lines = lines_of({{{2, 0.01}, {8, -0.01}},  // along the next
                                         {{0, 0}, {10, 0}},
                                         {{10, 0}, {0, 0}},              // the same the other way round
                                         {{0, 0}, {5, 0.02}, {5, 4}}});  // turns away
  const auto mends = clean_lines(lines, {0.05, 0, 1e-6});
  CHECK(count(mends, Mend::kDouble) == 2);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].source == 1);
  CHECK(lines[1].source == 3);
}

TEST_CASE(
    "clean: a straight line beside one that swings about it is no double, nor is one along an outline") {
  std::vector<MapLine> lines = lines_of({{{0, 0}, {10, 0}}, {{0, 0}, {2.5, 1}, {5, 0}, {7.5, -1}, {10, 0}}});
  CHECK(count(clean_lines(lines, {0.1, 0, 1e-6}), Mend::kDouble) == 0);
  lines = lines_of({{{0, 0}, {10, 0}, {10, 5}, {0, 5}, {0, 0}}, {{1, 0.01}, {9, 0.01}}});
  lines[0].fixed = true;
  CHECK(count(clean_lines(lines, {0.1, 0, 1e-6}), Mend::kDouble) == 0);
}

TEST_CASE("clean: of a fault and a longer joint along it the fault stays") {
  std::vector<MapLine> lines = lines_of({{{0, 0}, {10, 0}}, {{-5, 0.01}, {15, 0.01}}});
  lines[0].rank = 1;
  CHECK(count(clean_lines(lines, {0.1, 0, 1e-6}), Mend::kDouble) == 0);  // the joint goes on beyond the fault
  lines = lines_of({{{0, 0}, {10, 0}}, {{0, 0.01}, {10.05, 0.01}}});
  lines[0].rank = 1;
  clean_lines(lines, {0.1, 0, 1e-6});
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].source == 0);
}

TEST_CASE("clean: joining takes no corner away, however near it is") {
  // B ends 5.5 cm beside the corner of A, and D at it: farther than snap, nearer than the shortest segment
  std::vector<MapLine> lines =
      lines_of({{{0, 0}, {5, 0}, {5, 5}}, {{4.945, -3}, {4.945, 0}}, {{5, 0}, {9, -1}}});
  clean_lines(lines, {0.05, 0.06, 1e-6});
  CHECK(has_point(lines[0].points, {5, 0}));
  CHECK(has_point(lines[0].points, lines[1].points.back()));
  CHECK(lines[2].points.front() == Vec2{5, 0});
}

TEST_CASE("clean: crumbs and points too close go, ends stay where they are") {
  std::vector<MapLine> lines =
      lines_of({{{0, 0}, {0.01, 0.01}}, {{0, 1}, {0.02, 1}, {5, 1}, {5.01, 1}, {9.99, 1}, {10, 1}}});
  const auto mends = clean_lines(lines, {0, 0.05, 1e-6});
  CHECK(count(mends, Mend::kCrumb) == 1);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].points.front() == Vec2{0, 1});
  CHECK(lines[0].points.back() == Vec2{10, 1});
  CHECK(lines[0].points.size() == 3);
}

TEST_CASE("clean: openings take ends, but do not move") {
  std::vector<MapLine> lines = lines_of({{{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0}}, {{2.05, 1}, {6, 1}}});
  lines[0].fixed = true;
  const auto mends = clean_lines(lines, {0.1, 0, 1e-6});
  CHECK(count(mends, Mend::kGap) == 1);
  CHECK(lines[1].points.front() == Vec2{2, 1});
  CHECK(has_point(lines[0].points, {2, 1}));
}

TEST_CASE("clean: a lattice with defects put in by hand is mended as often as it was harmed") {
  // vertical lines end on the horizontal ones 0 and 20; gaps and overshoots of up to 4 cm, doubles 1 cm
  // beside
  std::vector<Polyline> list;
  for (int j = 0; j <= 20; ++j) list.push_back({{-1, 1.0 * j}, {41, 1.0 * j}});
  Random random(7);
  int gaps = 0, overshoots = 0, doubles = 0;
  for (int i = 0; i < 40; ++i) {
    const double x = i + 0.1 + 0.3 * random.uniform();
    const double low =
        random.uniform() < 0.5 ? 0.01 + 0.03 * random.uniform() : -0.01 - 0.03 * random.uniform();
    const double high =
        random.uniform() < 0.5 ? 0.01 + 0.03 * random.uniform() : -0.01 - 0.03 * random.uniform();
    gaps += (low > 0) + (high < 0), overshoots += (low < 0) + (high > 0);
    list.push_back({{x, low}, {x + 0.1, 20 + high}});
    if (i % 5 == 0) list.push_back({{x + 0.01, 2}, {x + 0.1, 18}}), ++doubles;
  }
  std::vector<MapLine> lines = lines_of(list);
  const auto mends = clean_lines(lines, {0.05, 0.02, 1e-6});
  CHECK(count(mends, Mend::kGap) == gaps);
  CHECK(count(mends, Mend::kOvershoot) == overshoots);
  CHECK(count(mends, Mend::kDouble) == doubles);
  CHECK(lines.size() == 61);
  for (const MapLine& l : lines)
    if (l.source > 20)
      for (const Vec2 end : {l.points.front(), l.points.back()})
        CHECK(std::min(std::abs(end.y), std::abs(end.y - 20)) < 1e-9);
  // a second pass finds nothing
  CHECK(clean_lines(lines, {0.05, 0.02, 1e-6}).empty());
}

}  // namespace test_clean
