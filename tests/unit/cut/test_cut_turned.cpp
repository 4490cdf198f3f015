// A network of lines that are clearly apart gives the same blocks however it lies in the plane. (Properties
// of any network: test_cut_properties.cpp.)

#include <doctest/doctest.h>

#include "support/random_network.h"

namespace test_cut_turned {

using namespace talus;
using namespace talus::test;

namespace {

// In cells of the grid: lines and crossings this far apart stay apart, and what is nearer than the smaller
// number is one and the same but for the round-off of its coordinates.
constexpr double kApart = 20, kSame = 0.01;

using Segment = std::pair<Vec2, Vec2>;

std::vector<Segment> segments_of(const Model& model) {
  Findings findings("case.toml", "");
  std::vector<Segment> out;
  for (const Trace& t : make_traces(model, RegionMap(model), findings).traces)
    if (norm(t.line[1] - t.line[0]) > 0) out.emplace_back(t.line[0], t.line[1]);
  return out;
}

// Whether every end and every crossing lies on a line or more than kApart cells from it, and on one another
// or as far apart; ends that stop short of a line by less leave it open whether they reach it.
bool is_clear(const std::vector<Segment>& lines, double grid) {
  std::vector<Vec2> nodes;
  const auto add = [&](Vec2 p) {
    for (const Vec2 q : nodes) {
      const double d = norm(p - q);
      if (d < kSame * grid) return true;
      if (d < kApart * grid) return false;
    }
    nodes.push_back(p);
    return true;
  };
  for (size_t i = 0; i < lines.size(); ++i) {
    const auto [a, b] = lines[i];
    if (!add(a) || !add(b)) return false;
    for (size_t j = 0; j < i; ++j) {
      const auto [c, d] = lines[j];
      const double det = cross(b - a, d - c);
      if (det == 0) continue;
      const double t = cross(c - a, d - c) / det, s = cross(c - a, b - a) / det;
      if (t > 0 && t < 1 && s > 0 && s < 1 && !add(a + t * (b - a))) return false;
    }
  }
  for (const Vec2 p : nodes) {
    for (const auto& [a, b] : lines) {
      const double d = distance_to_segment(p, a, b);
      if (d > kSame * grid && d < kApart * grid) return false;
    }
  }
  return true;
}

// The model turned about `center` by `angle`, then shifted.
Model turned(Model model, Vec2 center, double angle, Vec2 shift) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto place = [&](Vec2& p) {
    const Vec2 r = p - center;
    p = center + shift + Vec2{c * r.x - s * r.y, s * r.x + c * r.y};
  };
  for (RegionInput& r : model.regions)
    for (Vec2& p : r.polygon) place(p);
  for (OpeningInput& o : model.openings)
    for (Vec2& p : o.polygon) place(p);
  for (FaultInput& f : model.faults)
    for (Vec2& p : f.points) place(p);
  for (JointSetInput& j : model.joint_sets) place(j.origin), j.angle.mean += angle;
  return model;
}

std::vector<double> sorted_areas(const Cut& cut) {
  std::vector<double> out;
  for (const CutBlock& b : cut.whole) out.push_back(signed_area(cut.polygon(b)));
  std::sort(out.begin(), out.end());
  return out;
}

// The networks from `first` to the one before `last`.
void check_turned(int first, int last) {
  int compared = 0;
  size_t blocks = 0;
  for (int i = first; i < last; ++i) {
    CAPTURE(i);
    Model model = NetworkMaker(static_cast<uint64_t>(i)).make();
    Findings findings("case.toml", "");
    const Cut cut = cut_model(model, findings);
    // of two ways to open a hole that are equally long, rounding decides
    if (cut.bridges > 0 || !is_clear(segments_of(model), cut.grid)) continue;
    ++compared, blocks += cut.whole.size();
    Random random(static_cast<uint64_t>(i));
    model.cut.grid = cut.grid;  // the box around the turned model is another, and would make another grid
    const Vec2 shift{2000 * (random.uniform() - 0.5), 2000 * (random.uniform() - 0.5)};
    const Cut other =
        cut_model(turned(model, model.regions[0].polygon[0], 6.28 * random.uniform(), shift), findings);
    REQUIRE(other.grid == cut.grid);
    const std::vector<double> a = sorted_areas(cut), b = sorted_areas(other);
    REQUIRE(a.size() == b.size());
    // Noding moves each line by less than a cell in either cut, and areas change by no more than a strip of
    // two cells along all edges of a block. Sorted lists differ by no more than the blocks do.
    double longest = 0, worst = 0;
    for (const CutBlock& block : cut.whole) longest = std::max(longest, perimeter(cut.polygon(block)));
    for (size_t k = 0; k < a.size(); ++k) worst = std::max(worst, std::abs(a[k] - b[k]));
    CHECK(worst <= 2 * cut.grid * longest);
  }
  CHECK(compared > (last - first) / 5);
  CHECK(blocks > static_cast<size_t>(10 * compared));
  MESSAGE(compared, " networks with ", blocks, " blocks");
}

}  // namespace

TEST_CASE("a clear network gives the same blocks when it is turned and shifted: a hundred") {
  check_turned(0, 100);
}

TEST_CASE("a clear network turned: nine hundred more" * doctest::test_suite("optimised")) {
  check_turned(100, 1000);
}

}  // namespace test_cut_turned
