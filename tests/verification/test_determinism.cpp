// The same bits for any number of threads, from run to run, and from a checkpoint.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "talus/base/random.h"
#include "talus/step/step.h"

namespace test_determinism {

using namespace talus;

namespace {

constexpr double kPi = std::numbers::pi, kWeight = 9.81, kStep = 1e-3;

Polygon rectangle(double x_0, double y_0, double x_1, double y_1) {
  return {{x_0, y_0}, {x_1, y_0}, {x_1, y_1}, {x_0, y_1}};
}

struct Setting {
  double friction = 0;
  int sweeps = 20;
};

// Hard joints everywhere; blocks of 5 GPa.
class Stones {
 public:
  void add(const Polygon& polygon, BlockKind kind, Vec2 velocity = {}) {
    BlockShape shape;
    shape.name = "b" + std::to_string(layout_.blocks.size());
    shape.polygon = polygon;
    shape.kind = kind;
    shape.velocity = velocity;
    layout_.blocks.push_back(shape);
  }
  Scene scene(const Setting& setting) const {
    Model model;
    model.materials.push_back({"rock", 2000, 5e9, 0.29});
    JointProperty joint;
    joint.name = "joint";
    joint.friction_angle = std::atan(setting.friction);
    model.joints.push_back(joint);
    model.default_joint = 0;
    model.gravity = {0, -kWeight};
    model.solver.method = SolverKind::kGaussSeidel;
    model.solver.max_sweeps = setting.sweeps;
    model.solver.second_solver = false;
    Layout layout = layout_;
    layout.default_joint = 0;
    layout.groups = {"blocks"};
    layout.group_where.emplace_back();
    return build_scene(std::move(model), std::move(layout));
  }

 private:
  Layout layout_;
};

// Running-bond wall of 20 courses of 50 bricks, half bricks at the ends of every other course, on a floor.
Scene wall(int sweeps) {
  constexpr int kColumns = 50, kCourses = 20;
  Stones stones;
  stones.add(rectangle(-5, -1, kColumns + 5, 0), BlockKind::kFixed);
  for (int course = 0; course < kCourses; ++course) {
    const double bottom = 0.5 * course;
    const auto lay = [&](double left, double right) {
      stones.add(rectangle(left, bottom, right, bottom + 0.5), BlockKind::kDeformable);
    };
    const bool shifted = course % 2 == 1;
    if (shifted) lay(0, 0.5);
    for (int i = 0; i < kColumns - shifted; ++i) lay(i + 0.5 * shifted, i + 1 + 0.5 * shifted);
    if (shifted) lay(kColumns - 0.5, kColumns);
  }
  return stones.scene({0.6, sweeps});
}

// A thousand convex polygons in a box: cells of a crooked grid with corners cut off at random, half a
// centimetre apart and thrown at each other.
Scene pile(int sweeps) {
  constexpr int kRows = 40, kColumns = 25;
  constexpr double kWidth = kColumns, kTop = kRows + 5, kShrink = 0.995, kSpeed = 1;
  Stones stones;
  stones.add(rectangle(-5, -5, kWidth + 5, 0), BlockKind::kFixed);
  stones.add(rectangle(-5, 0, 0, kTop), BlockKind::kFixed);
  stones.add(rectangle(kWidth, 0, kWidth + 5, kTop), BlockKind::kFixed);
  Random random(7);
  const auto between = [&random](double low, double high) { return low + (high - low) * random.uniform(); };
  std::vector<Vec2> node;
  for (int y = 0; y <= kRows; ++y)
    for (int x = 0; x <= kColumns; ++x) {
      const double dx = between(-0.15, 0.15), dy = between(-0.15, 0.15);
      node.push_back({x + (x > 0 && x < kColumns ? dx : 0), y + (y > 0 ? dy : 0)});
    }
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) {
      const auto at = [&](int i, int j) { return node[j * (kColumns + 1) + i]; };
      const Polygon cell{at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)};
      const Vec2 center = 0.25 * (cell[0] + cell[1] + cell[2] + cell[3]);
      Polygon stone;
      for (size_t i = 0; i < 4; ++i) {
        const Vec2 c = center + kShrink * (cell[i] - center);
        const double cut = between(-0.2, 0.3);  // of the edges beside it
        if (cut < 0.05) {
          stone.push_back(c);
        } else {
          stone.push_back(c + cut * (cell[(i + 3) % 4] - cell[i]));
          stone.push_back(c + cut * (cell[(i + 1) % 4] - cell[i]));
        }
      }
      const double vx = between(-kSpeed, kSpeed), vy = between(-kSpeed, kSpeed);
      stones.add(stone, (x + y) % 7 == 0 ? BlockKind::kRigid : BlockKind::kDeformable, {vx, vy});
    }
  return stones.scene({0.5, sweeps});
}

// Shaken by gravity, so that nothing rests.
Vec2 shaken(double time) { return {-0.3 * kWeight * std::sin(2 * kPi * 2 * time), -kWeight}; }

// What the runs have been through, so that equal states mean something.
struct Seen {
  int closed = 0, sweeps = 0, second_phase = 0;
};

Seen march(Scene& scene, int steps, const Workers& workers, State& state) {
  StepSettings settings;
  settings.implicit = true;
  settings.tolerance = 1e-8 * *std::min_element(scene.blocks.size.begin(), scene.blocks.size.end());
  StepWork work;
  work.workers = workers;
  Seen seen;
  for (int i = 0; i < steps; ++i) {
    scene.model.gravity = shaken(state.time);
    StepReport report = kick(scene, settings, kStep, work, state);
    drift(scene, state.time + kStep, work, state, report);
    seen.closed = report.closed;
    seen.sweeps = std::max(seen.sweeps, report.solve.iterations);
    seen.second_phase += report.solve.second_phase;
  }
  return seen;
}

// FNV-1a over the bytes of numbers.
class Hash {
 public:
  void add(double v) {
    unsigned char byte[sizeof v];
    std::memcpy(byte, &v, sizeof v);
    for (const unsigned char b : byte) value_ = (value_ ^ b) * 1099511628211U;
  }
  void add(Vec2 v) { add(v.x), add(v.y); }
  void add(const Mat2& m) { add(m.xx), add(m.xy), add(m.yx), add(m.yy); }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 14695981039346656037U;
};

uint64_t hash_of(const State& s) {
  Hash hash;
  for (size_t i = 0; i < s.rate.size(); ++i) {
    hash.add(s.displacement[i]), hash.add(s.strain_part[i]), hash.add(s.angle[i]);
    hash.add(s.rate[i].a), hash.add(s.rate[i].G);
    hash.add(s.row_force[i].f), hash.add(s.row_force[i].Q);
  }
  for (const Patch& c : s.patches)
    for (size_t end = 0; end < 2; ++end)
      hash.add(c.force[end][0]), hash.add(c.force[end][1]), hash.add(c.stretch[end]), hash.add(c.slip[end]);
  const WorkDone& w = s.work;
  hash.add(w[Cause::kContactClosing]), hash.add(w[Cause::kFriction]), hash.add(w[Cause::kImplicit]),
      hash.add(s.energy_start);
  return hash.value();
}

// The same state after `steps` with 1 to 4 threads and after a second run.
Seen check_threads(Scene& scene, int steps) {
  State once = start_state(scene), again = once;
  const Seen seen = march(scene, steps, Workers(1), once);
  march(scene, steps, Workers(1), again);
  CHECK(hash_of(again) == hash_of(once));
  for (const int threads : {2, 3, 4}) {
    CAPTURE(threads);
    const Workers workers(threads);
    CHECK(workers.threads() == threads);
    State state = start_state(scene);
    march(scene, steps, workers, state);
    CHECK(hash_of(state) == hash_of(once));
    CHECK(state.pairs.size() == once.pairs.size());
    CHECK(state.patches.size() == once.patches.size());
  }
  return seen;
}

// Going on from a copy of the state in the middle with nothing else kept.
void check_checkpoint(Scene& scene, int first, int then) {
  for (const int threads : {1, 2}) {
    CAPTURE(threads);
    State whole = start_state(scene), half = whole;
    march(scene, first + then, Workers(threads), whole);
    march(scene, first, Workers(1), half);
    State copy = half;
    half = {};
    march(scene, then, Workers(threads), copy);
    CHECK(hash_of(copy) == hash_of(whole));
  }
}

}  // namespace

TEST_CASE("a shaken wall of 1010 bricks has the same bits for any number of threads") {
  Scene scene = wall(20);
  REQUIRE(scene.blocks.count == 1011);
  const Seen seen = check_threads(scene, 60);
  CHECK(seen.closed > 3000);     // of the 4000 ends of faces
  CHECK(seen.sweeps % 20 == 0);  // all that are allowed, twice where hard contacts close
  CHECK(seen.sweeps > 0);
}

TEST_CASE("so it has in the second phase of Gauss-Seidel, whose sums decide how it goes on") {
  Scene scene = wall(90);
  const Seen seen = check_threads(scene, 8);
  CHECK(seen.second_phase > 100);
}

TEST_CASE("a thousand stones falling into a box have the same bits for any number of threads") {
  Scene scene = pile(20);
  REQUIRE(scene.blocks.count == 1003);
  const Seen seen = check_threads(scene, 60);
  CHECK(seen.closed > 300);      // not free flight
  CHECK(seen.sweeps % 20 == 0);  // all that are allowed, twice where hard contacts close
  CHECK(seen.sweeps > 0);
}

TEST_CASE("a run that goes on from a copy of its state has the bits of the uninterrupted one") {
  SUBCASE("wall") {
    Scene scene = wall(20);
    check_checkpoint(scene, 23, 20);
  }
  SUBCASE("wall, second phase") {
    Scene scene = wall(50);
    check_checkpoint(scene, 5, 4);
  }
  SUBCASE("pile") {
    Scene scene = pile(20);
    check_checkpoint(scene, 31, 29);
  }
}

}  // namespace test_determinism
