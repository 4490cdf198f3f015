// What patches remember: elastic shear and slip go by place, along with the blocks.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "support/block_scene.h"
#include "support/relative.h"
#include "talus/contact/pairs.h"
#include "talus/contact/patch_rows.h"

namespace test_patch_memory {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kStiffness = 1e9, kFriction = 0.6;  // normal and shear [Pa/m]
// what slides stays where its law has put it
constexpr StepClock kClock{.dt = 1e-3, .dt_kick = 1e-3, .alpha = 1};

struct Pose {
  Vec2 way;         // of the centroid from where it was drawn [m]
  double turn = 0;  // about it [rad]
};

JointProperty joint_of(double factor, double friction) {
  JointProperty joint = jointed_rock().joints[0];
  joint.normal_stiffness = joint.shear_stiffness = factor * kStiffness;
  joint.friction_angle = std::atan(friction);
  return joint;
}

struct Borne {
  Vec2 normal, shear;  // sums of forces along normals and along tangents, on the block of lower id [N]
  Vec2 all() const { return normal + shear; }
};

// Rigid blocks that are put where they are to be, one step after the other.
class PutBlocks {
 public:
  /// Faces that touch as they are drawn are tied where the joint has cohesion.
  explicit PutBlocks(const std::vector<Polygon>& polygons, double friction = kFriction)
      : PutBlocks(polygons, joint_of(1, friction)) {}
  PutBlocks(const std::vector<Polygon>& polygons, const JointProperty& joint)
      : scene_(scene_of(polygons, joint)),
        state_(start_state(scene_)),
        laws_(scene_.laws),
        pose_(polygons.size()) {
    state_.step = 1;  // no stress of the ground
  }

  void change_stiffness(double factor) { laws_ = joint_laws({joint_of(factor, kFriction)}); }

  // What they remember goes along to the new place; forces there are known then.
  void put(const std::vector<Pose>& to) {
    const std::vector<BlockRate> still(to.size());
    if (rows_.size() > 0) {
      for (size_t i = 0; i < to.size(); ++i)
        state_.rate[i] = {(to[i].way - pose_[i].way) / kClock.dt,
                          (1 / kClock.dt) * turn_between(pose_[i].turn, to[i].turn)};
      solve();  // slip is what the end of the step leaves of it
      for (size_t r = rows_.range(Family::kContact).begin; r < rows_.range(Family::kContact).end; ++r)
        remember_patch(scene_.blocks, scene_.laws, rows_, r, relative_velocity(rows_.points[r], state_.rate),
                       still, kClock, state_);
    }
    for (size_t i = 0; i < to.size(); ++i) {
      state_.displacement[i] = to[i].way, state_.angle[i] = to[i].turn;
      state_.strain_part[i] = rotation_minus_identity(to[i].turn);
    }
    pose_ = to, state_.rate = still;
    const LookAhead ahead{kClock, state_.rate};
    renew_pairs(scene_.blocks, scene_.bonds, scene_.layout, laws_, ahead, Workers(), state_);
    const PatchWorld world{scene_.blocks, scene_.outlines, scene_.bonds, scene_.layout, scene_.model, laws_};
    search_.update(world, ahead, Workers(), state_);
    rows_.restart();
    add_patch_rows(world, scene_.give, state_, still, kClock, Workers(), rows_, gaps_);
    rows_.finish();
    solve();
  }

  // Between two blocks, all patches.
  Borne between(int a, int b) const {
    Borne out;
    for (size_t r = 0; r < rows_.size(); ++r) {
      const PointRows& p = rows_.points[r];
      if (p.block_a != a || p.block_b != b) continue;
      out.normal += rows_.impulse[r][0] / kClock.dt_kick * p.normal;
      out.shear += rows_.impulse[r][1] / kClock.dt_kick * turn_right(p.normal);
    }
    return out;
  }
  std::vector<Patch>& patches() { return state_.patches; }
  std::vector<FaceState>& faces() { return state_.face; }
  // Speed at which the blocks are asked to part at an end of a patch [m/s].
  double asked(size_t row) const { return -rows_.points[row].row[0].bias; }
  // Patches in overlap.
  int count() const {
    return static_cast<int>(std::count_if(state_.patches.begin(), state_.patches.end(),
                                          [](const Patch& p) { return p.overlaps; }));
  }
  Vec2 centroid(size_t block) const { return scene_.blocks.centroid[block]; }

 private:
  Scene scene_;
  State state_;
  std::vector<JointLaw> laws_;
  std::vector<Pose> pose_;
  PatchSearch search_;
  RowSet rows_;
  std::vector<double> gaps_;

  static Scene scene_of(const std::vector<Polygon>& polygons, const JointProperty& joint) {
    Model model = jointed_rock();
    model.joints[0] = joint;
    std::vector<ScenePart> parts;
    for (const Polygon& p : polygons) parts.push_back({p, BlockKind::kRigid});
    return block_scene(std::move(model), parts);
  }
  // From one place to the next, as a share of the arms at the first.
  static Mat2 turn_between(double from, double to) { return rotation_minus_identity(to - from); }

  // The rows of all patches, of blocks that go on as they do.
  void solve() {
    for (size_t r = 0; r < rows_.size(); r += 2) solve(0, r), solve(1, r);
  }
  void solve(int k, size_t first) {
    rows_.impulse[first][k] = rows_.impulse[first + 1][k] = 0;
    constexpr int kSweeps = 60;  // each leaves a quarter of the error
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (const size_t r : {first, first + 1}) {
        const PointRows& p = rows_.points[r];
        if (!(p.row[k].compliance > 0)) continue;
        const double u = relative_velocity(p, state_.rate)[k];
        const double by_partner = p.partner < 0 ? 0 : p.cross(k) * rows_.impulse[p.partner][k];
        const Bounds bounds = bounds_of(p, k, rows_.impulse[r][0]);
        rows_.impulse[r][k] =
            std::clamp(-(p.row[k].bias + u + by_partner) / p.row[k].compliance, bounds.lower, bounds.upper);
      }
  }
};

// A floor of 6 m, and a block of 1 m on it; block 0 is the upper one, so that its patches push it up.
std::vector<Polygon> block_on_floor() { return {box_polygon(0, 0, 1, 1), box_polygon(-3, -1, 3, 0)}; }

constexpr double kClosure = 1e-4;  // [m]
constexpr double kShare =
    1e-9;  // of what is kept: places of 1 m are rounded to 1e-16 m, 1e-12 of the closure, over 100 steps

double off(double value, double exact) { return std::abs(value - exact) / std::abs(exact); }
double off(Vec2 value, Vec2 exact) { return norm(value - exact) / norm(exact); }

// Pressed and sheared by a share of the closure.
void shear(PutBlocks& blocks, double share) {
  blocks.put({{{0, -kClosure}}, {}});
  blocks.put({{{share * kClosure, -kClosure}}, {}});
}

}  // namespace

TEST_CASE("patch memory: elastic shear is kept under a turn of the loaded pair") {
  for (const int steps : {10, 100}) {
    CAPTURE(steps);
    PutBlocks blocks(block_on_floor());
    shear(blocks, 0.3);
    const Borne before = blocks.between(0, 1);
    // half of the way is ground that the block had not covered: it has no shear yet
    CHECK(off(norm(before.shear), 0.3 * kClosure * kStiffness) < kClosure);
    CHECK(off(norm(before.normal), kStiffness * kClosure * (1 - 0.5 * kClosure)) < 1e-9);
    const Vec2 centre{0.7, -2};
    double worst = 0;
    for (int k = 1; k <= steps; ++k) {
      const double angle = static_cast<double>(k) / steps;
      const Mat2 turn = rotation_minus_identity(angle);
      std::vector<Pose> to{{{0.3 * kClosure, -kClosure}}, {}};
      for (size_t i = 0; i < 2; ++i)
        to[i].way += turn * (blocks.centroid(i) + to[i].way - centre), to[i].turn = angle;
      blocks.put(to);
      const Borne now = blocks.between(0, 1);
      const auto turned_back = [&](Vec2 x) { return x + rotation_minus_identity(-angle) * x; };
      worst = std::max(
          {worst, off(turned_back(now.shear), before.shear), off(turned_back(now.normal), before.normal)});
    }
    CHECK(worst < kShare);
    MESSAGE("largest error ", worst);
  }
}

TEST_CASE("patch memory: elastic shear is kept while the closure goes up and down by half") {
  PutBlocks blocks(block_on_floor());
  shear(blocks, 0.2);
  const Vec2 before = blocks.between(0, 1).shear;
  double worst = 0;
  for (int k = 1; k <= 200; ++k) {
    const double closure = kClosure * (1 + 0.5 * std::sin(0.1 * k));
    blocks.put({{{0.2 * kClosure, -closure}}, {}});
    worst = std::max(worst, off(blocks.between(0, 1).shear, before));
    CHECK(off(blocks.between(0, 1).normal.y, kStiffness * closure * (1 - 0.5 * closure)) < 1e-9);
  }
  CHECK(worst < kShare);
  MESSAGE("largest error ", worst);
}

TEST_CASE(
    "patch memory: a block that opens all of its face has lost its shear, and one that slides its excess") {
  PutBlocks blocks(block_on_floor());
  shear(blocks, 0.3);
  blocks.put({{{0.3 * kClosure, kClosure}}, {}});
  CHECK(blocks.between(0, 1).all() == Vec2{});
  blocks.put({{{0.3 * kClosure, -kClosure}}, {}});
  CHECK(blocks.between(0, 1).normal.y > 0.9 * kStiffness * kClosure);
  CHECK(norm(blocks.between(0, 1).shear) < 1e-9 * kStiffness * kClosure);  // rounding of places

  PutBlocks slides(block_on_floor());
  shear(slides, 1.5);
  const Borne there = slides.between(0, 1);
  CHECK(off(norm(there.shear), kFriction * norm(there.normal)) < 2 * kClosure);  // fresh ground at its front
  for (const Patch& p : slides.patches())
    for (const double slip : p.slip)
      CHECK(off(slip, 1.5 * kClosure - kFriction * kClosure * (1 - 0.5 * kClosure)) < 1e-9);
  // back by 0.3 closures: elastic
  slides.put({{{1.2 * kClosure, -kClosure}}, {}});
  CHECK(off(norm(slides.between(0, 1).shear), (kFriction - 0.3) * kStiffness * kClosure) < 4 * kClosure);
}

namespace {

// Turns the block about the middle of its lower left corner's overlap until half of its face has opened, and back.
std::vector<Pose> rocked(const PutBlocks& blocks, double turn, double way) {
  const Mat2 by = rotation_minus_identity(turn);
  return {{Vec2{way, -kClosure} + by * (blocks.centroid(0) - Vec2{0, 0}), turn}, {}};
}

}  // namespace

TEST_CASE("patch memory: what opens loses its share of the shear, for good, what stays closed keeps it") {
  PutBlocks blocks(block_on_floor());
  constexpr double kSheared = 0.05;  // of the closure: the toe's end bears little
  shear(blocks, kSheared);
  const Vec2 before = blocks.between(0, 1).shear;
  // up by the closure at half the face: the left half stays in touch
  constexpr int kSteps = 100;
  for (int k = 1; k <= kSteps; ++k)
    blocks.put(rocked(blocks, 2 * kClosure * k / kSteps, kSheared * kClosure));
  REQUIRE(blocks.count() == 1);
  CHECK(blocks.patches()[0].length == approx(0.5).epsilon(1e-3));
  // a turn by 2 c moves places in the overlap, c above the corner at most, by 2 c^2: 4e-3 of the shear
  CHECK(off(blocks.between(0, 1).shear, 0.5 * before) < 1e-2);
  for (int k = kSteps - 1; k >= 0; --k)
    blocks.put(rocked(blocks, 2 * kClosure * k / kSteps, kSheared * kClosure));
  CHECK(off(blocks.between(0, 1).shear, 0.5 * before) < 1e-2);
  CHECK(blocks.patches()[0].length == approx(1).epsilon(1e-6));
}

TEST_CASE("patch memory: accumulated slip is kept when the patch shortens and lengthens again") {
  PutBlocks blocks(block_on_floor());
  blocks.put({{{0, -kClosure}}, {}});
  for (Patch& p : blocks.patches()) p.slip = {0.1, 0.3}, p.slip_signed = {-0.05, 0.15};
  constexpr int kSteps = 50;
  for (int k = 1; k <= kSteps; ++k) blocks.put(rocked(blocks, 2 * kClosure * k / kSteps, 0));
  REQUIRE(blocks.count() == 1);
  // places along the face are found to the closure; the rest of it is none of a place's business
  constexpr double kFound = 1e-3;
  CHECK(off(blocks.patches()[0].slip[0], 0.1) < kFound);
  CHECK(off(blocks.patches()[0].slip[1], 0.2) < kFound);
  CHECK(off(blocks.patches()[0].slip_signed[1], 0.05) < 4 * kFound);
  for (int k = kSteps - 1; k >= 0; --k) blocks.put(rocked(blocks, 2 * kClosure * k / kSteps, 0));
  CHECK(blocks.patches()[0].length == approx(1).epsilon(1e-6));
  CHECK(off(blocks.patches()[0].slip[0], 0.1) < kFound);
  CHECK(off(blocks.patches()[0].slip[1], 0.2) < kFound);  // that of the old end
}

namespace {

// As wide as the floor, with a notch below: cut from there up and to the left through its top, at x = -0.5.
Polygon notched_floor() { return {{-3, -1}, {0, -1}, {0, -0.5}, {3, -0.5}, {3, 0}, {-3, 0}}; }

// Slides by steps of a share of the closure; tells what is borne on the way.
template <class F>
void slide(PutBlocks& blocks, double from, double to, double step, size_t bodies, F told) {
  const int steps = std::max(1, static_cast<int>(std::abs(to - from) / step + 0.5));
  for (int k = 0; k <= steps; ++k) {
    std::vector<Pose> pose(bodies);
    pose[0].way = {from + (to - from) * k / steps, -1e-3};
    blocks.put(pose), told(k);
  }
}

}  // namespace

TEST_CASE("patch memory: shear goes on across a cut between two parts of the block below") {
  constexpr double c = 1e-3, kStep = 0.25 * c;
  PutBlocks cut({box_polygon(0, 0, 1, 1), notched_floor()}), whole(block_on_floor());
  std::vector<Borne> by_cut, by_whole;
  int most = 0;
  const auto there_and_back = [&](PutBlocks& blocks, std::vector<Borne>& out) {
    const auto told = [&](int) {
      out.push_back(blocks.between(0, 1)), most = std::max(most, blocks.count());
    };
    slide(blocks, 0, -0.6, kStep, 2, told), slide(blocks, -0.6, -0.2, kStep, 2, told);
    slide(blocks, -0.2, -2, kStep, 2, told);
  };
  there_and_back(cut, by_cut), there_and_back(whole, by_whole);
  CHECK(most == 2);
  REQUIRE(by_cut.size() == by_whole.size());
  double normal = 0, shear = 0;
  for (size_t k = 0; k < by_cut.size(); ++k) {
    const double scale = norm(by_whole[k].normal);
    normal = std::max(normal, norm(by_cut[k].normal - by_whole[k].normal) / scale);
    shear = std::max(shear, norm(by_cut[k].shear - by_whole[k].shear) / (kFriction * scale));
  }
  CHECK(normal < 1e-12);  // cells of the cut patch make up those of the whole one: 1e-16 m of 1e-3 m
  CHECK(shear < 10 * c);  // chords of both parts overlap by a slanted cut's c, of 1 m
  MESSAGE("largest difference: normal ", normal, ", shear ", shear);
}

TEST_CASE(
    "patch memory: of one long step the ground that lay under the block keeps its shear, whatever the parts") {
  constexpr double c = 1e-3, kNeverSlips = 1e6;
  for (const double step : {0.2, -0.2})
    for (const bool cut : {true, false}) {
      CAPTURE(step);
      CAPTURE(cut);
      PutBlocks blocks({box_polygon(-1, 0, 0, 1), cut ? notched_floor() : box_polygon(-3, -1, 3, 0)},
                       kNeverSlips);
      blocks.put({{{0, -c}}, {}}), blocks.put({{{step, -c}}, {}});
      REQUIRE(blocks.count() == (cut ? 2 : 1));
      // a place of the joint has gone half as far as the block: half a step is fresh ground without shear. A slanted
      // cut is c wide
      const double kept = 1;  // a field goes on where the two have slid along it
      CHECK(off(norm(blocks.between(0, 1).shear), std::abs(step) * kept * kStiffness) < 2 * c);
    }
}

TEST_CASE("patch memory: shear that differs along the chord stays where it is") {
  PutBlocks blocks(block_on_floor());
  blocks.put({{{0, -kClosure}}, {}});
  REQUIRE(blocks.count() == 1);
  const double one = 0.02 * kClosure, two = 0.06 * kClosure;
  blocks.patches()[0].stretch = {one, two};
  for (int k = 1; k <= 10; ++k) {
    const Mat2 turn = rotation_minus_identity(0.1 * k);
    blocks.put({{Vec2{0, -kClosure} + turn * (blocks.centroid(0) - Vec2{0, kClosure}), 0.1 * k},
                {turn * blocks.centroid(1), 0.1 * k}});
  }
  CHECK(off(blocks.patches()[0].stretch[0], one) < kShare);
  CHECK(off(blocks.patches()[0].stretch[1], two) < kShare);
  // and of half the face its own half is left
  PutBlocks opens(block_on_floor());
  opens.put({{{0, -kClosure}}, {}});
  opens.patches()[0].stretch = {one, two};
  constexpr int kSteps = 100;
  for (int k = 1; k <= kSteps; ++k) opens.put(rocked(opens, 2 * kClosure * k / kSteps, 0));
  // the turn moves places within the overlap by its square, as above
  CHECK(off(norm(opens.between(0, 1).shear), 0.5 * 0.03 * kClosure * kStiffness) < 2e-2);
}

TEST_CASE("patch memory: elastic shear is kept where a cut is crossed at rest against the floor") {
  // the pair goes on as one body: nothing is crossed, and both patches keep their shares
  constexpr double c = 1e-3;
  PutBlocks blocks({box_polygon(-1, 0, 0, 1), notched_floor()});
  blocks.put({{{0, -c}}, {}}), blocks.put({{{0.3 * c, -c}}, {}});
  REQUIRE(blocks.count() == 2);
  const Borne before = blocks.between(0, 1);
  CHECK(off(norm(before.shear), 0.3 * c * kStiffness) < 2 * c);  // chords overlap by c
  for (int k = 1; k <= 100; ++k) blocks.put({{{0.3 * c + 0.01 * k, -c + 0.02 * k}}, {{0.01 * k, 0.02 * k}}});
  CHECK(off(blocks.between(0, 1).shear, before.shear) < kShare);
}

TEST_CASE("patch memory: elastic shear is kept through vibrations that no place slips in") {
  constexpr double c = 1e-3;
  PutBlocks blocks(block_on_floor());
  blocks.put({{{0, -c}}, {}}), blocks.put({{{0.3 * c, -c}}, {}});
  const Vec2 before = blocks.between(0, 1).shear;
  constexpr int kCycles = 100, kSteps = 20;
  for (int k = 1; k <= kCycles * kSteps; ++k) {
    const double phase = 2 * std::numbers::pi * (k % kSteps) / kSteps;
    blocks.put({{{(0.3 + 0.2 * std::sin(phase)) * c, -c}}, {}});
  }
  // the ends of the chord are off by 0.2 c, to and fro
  CHECK(off(blocks.between(0, 1).shear, before) < c);
}

TEST_CASE("patch memory: an overlap that a hard patch is born with is pushed out, and slowly") {
  // a speed of 1e-4 m/s out of an overlap of 1e-2 m, of 1e-2 m/s were it a thousandth of that in a step of 1 ms
  constexpr double kFastest = 1e-3;
  for (const double c : {1e-6, 1e-2}) {
    CAPTURE(c);
    PutBlocks blocks(block_on_floor(), joint_of(0, kFriction));
    blocks.put({{{0, -c}}, {}});
    REQUIRE(blocks.count() == 1);
    CHECK(blocks.asked(0) == 0);
    double kept = blocks.patches()[0].allowed[0], fastest = 0;
    CHECK(off(kept, c) < 1e-9);
    constexpr int kSteps = 5000;
    for (int k = 0; k < kSteps; ++k) {
      blocks.put({{{0, -c}}, {}});
      const double left = blocks.patches()[0].allowed[0];
      CHECK(left < kept);
      fastest = std::max(fastest, (kept - left) / kClock.dt), kept = left;
    }
    CHECK(fastest < kFastest);
    CHECK(kept < (c > 1e-3 ? c : 0.01 * c));
    CHECK(blocks.asked(0) > 0);
  }
}

TEST_CASE("patch memory: what lay on one side tells nothing to what lies on the next one round the corner") {
  PutBlocks blocks(block_on_floor());
  blocks.put({{{2, -kClosure}}, {}}),
      blocks.put({{{2 - 0.3 * kClosure, -kClosure}}, {}});  // up to the floor's end
  CHECK(norm(blocks.between(0, 1).shear) > 0.2 * kClosure * kStiffness);
  blocks.put({{{3 - kClosure, -1}}, {}});  // and beside it
  CHECK(off(blocks.between(0, 1).normal.x, kStiffness * kClosure) < 2 * kClosure);
  CHECK(norm(blocks.between(0, 1).shear) < 1e-9 * kStiffness * kClosure);  // rounding of places
}

TEST_CASE("patch memory: a block that has ridden up is met by the next part of the block below") {
  constexpr double c = 1e-3, kStep = 0.25 * c, kSlip = 0.1;
  JointProperty joint = joint_of(1, kFriction);
  joint.dilation_angle = 0.5, joint.dilation_slip = kSlip;
  const double rise =
      std::tan(joint.dilation_angle) * kSlip;  // 0.05 m, more than what is looked at of a block of 1 m
  PutBlocks blocks({box_polygon(0, 0, 1, 1), notched_floor()}, joint);
  const double elastic = kFriction * c, end = -1.9;  // the cut ends at x = -0.5 at the top
  double least = 1;
  for (double x = 0; x > end; x -= kStep) {
    const double slip = std::clamp(-x - elastic, 0.0, kSlip);
    blocks.put({{{x, rise * slip / kSlip - c}}, {}});
    if (x < -2 * kSlip) least = std::min(least, blocks.between(0, 1).normal.y / (kStiffness * c));
  }
  CHECK(least > 0.5);
}

TEST_CASE("patch memory: a block that slides on to a second one is held by friction all the way") {
  constexpr double c = 1e-3, kStep = 0.1 * c;
  PutBlocks blocks({box_polygon(0, 0, 1, 1), box_polygon(-3, -1, 1.5, 0), box_polygon(1.5, -1, 4, 0)});
  double worst = 0, least = 1, before = 0, jump = 0;
  bool both = false;
  slide(blocks, 0, 2, kStep, 3, [&](int k) {
    const Borne one = blocks.between(0, 1), two = blocks.between(0, 2);
    const double whole = kStiffness * c * (1 - 0.5 * c),
                 held = norm(one.shear + two.shear) / (kFriction * whole);
    both = both || (one.normal.y > 0.3 * whole && two.normal.y > 0.3 * whole);
    worst = std::max(worst, off((one.normal + two.normal).y, whole));
    if (k < 20) return;  // 6 steps to the limit
    least = std::min(least, held);
    if (k > 20) jump = std::max(jump, std::abs(held - before));
    before = held;
  });
  CHECK(both);
  CHECK(worst < 2 * c);  // at the joint of the two an end of each has its corner's triangle
  // the new pair begins without shear on its first piece, which is 6 steps long when it has come to the limit
  CHECK(least > 1 - 2 * c);
  CHECK(jump < c);
  MESSAGE("normal off by ", worst, ", at least of the friction ", least, ", largest jump ", jump);
}

TEST_CASE("patch memory: shear on one block is not passed to the next") {
  constexpr double c = 1e-3;
  PutBlocks blocks({box_polygon(0, 0, 1, 1), box_polygon(-3, -1, 0.5, 0), box_polygon(0.5, -1, 4, 0)});
  blocks.put({{{0, -c}}, {}, {0, -2 * c}});  // the second one lies lower
  blocks.put({{{0.3 * c, -c}}, {}, {0, -2 * c}});
  const Vec2 before = blocks.between(0, 1).shear;
  CHECK(blocks.between(0, 2).all() == Vec2{});
  blocks.put({{{0.3 * c, -c}}, {}, {}});
  CHECK(blocks.between(0, 2).normal.y > 0.4 * c * kStiffness);
  CHECK(norm(blocks.between(0, 2).shear) < 1e-9 * norm(before));  // rounding of places
  CHECK(off(blocks.between(0, 1).shear, before) < kShare);
}

TEST_CASE("patch memory: each of two patches beside an intact face remembers its own") {
  // half over each other; the upper one lies c deep and, beyond the two ends of the face, half of that aside
  constexpr double c = 1e-4;
  JointProperty joint = joint_of(1, 1e6);
  joint.cohesion = 1e6;
  PutBlocks blocks({box_polygon(0, 0, 1, 0.4), box_polygon(0.5, 0.4, 1.5, 0.8)}, joint);
  REQUIRE(blocks.faces().size() == 1);
  blocks.put({{}, {{-0.5 * c, -c}}});
  REQUIRE(blocks.count() == 2);
  const auto is_left = [](const Patch& p) { return p.arm_a[0].x < 0.25; };
  REQUIRE(is_left(blocks.patches()[0]) != is_left(blocks.patches()[1]));
  const auto kept = [&](const Patch& p) { return is_left(p) ? 0.3 * c : -0.1 * c; };
  for (Patch& p : blocks.patches()) {
    p.stretch = {kept(p), kept(p)}, p.slip = {2 * kept(p) + c, 2 * kept(p) + c}, p.slip_signed = p.stretch;
    p.root_kept = 1e-3 * kept(p);  // little next to its own
  }
  // on as one body, turned
  constexpr int kSteps = 20;
  const Vec2 apart = blocks.centroid(1) - blocks.centroid(0);
  const auto turned_by = [&](double angle, Vec2 aside) {
    const Mat2 turn = rotation_minus_identity(angle);
    return std::vector<Pose>{{{}, angle}, {aside + turn * (apart + aside), angle}};
  };
  for (int k = 1; k <= kSteps; ++k) {
    blocks.put(turned_by(0.02 * k, {-0.5 * c, -c}));
    REQUIRE(blocks.count() == 2);
    for (const Patch& p : blocks.patches())
      for (const size_t end : {0U, 1U}) {
        CHECK(off(p.stretch[end], kept(p)) < 1e-8);  // over an extent of c, in place of 1 m
        CHECK(off(p.slip[end], 2 * kept(p) + c) < 1e-8);
        CHECK(off(p.slip_signed[end], kept(p)) < 1e-8);
        CHECK(p.root_kept == 1e-3 * kept(p));
      }
  }
  // up by so much at the right end that nothing lies in each other there
  const double up = 4 * c;
  const auto left_alone = [&](double angle) {
    const Mat2 by = rotation_minus_identity(up);
    std::vector<Pose> out = turned_by(angle + up, {});
    out[0].turn = angle;
    const Vec2 corner{0.5, 0.4};  // of both blocks' drawing: the left end of the face stays c deep
    const Vec2 aside = Vec2{-0.5 * c, -c} + by * (blocks.centroid(1) - corner);
    out[1].way = aside + rotation_minus_identity(angle) * (apart + aside);
    return out;
  };
  blocks.put(left_alone(0.02 * kSteps));
  REQUIRE(blocks.count() == 1);
  CHECK(is_left(blocks.patches()[0]));
  CHECK(off(blocks.patches()[0].slip_signed[0], kept(blocks.patches()[0])) < 1e-8);
  blocks.put(turned_by(0.02 * kSteps, {-0.5 * c, -c}));
  REQUIRE(blocks.count() == 2);
  for (const Patch& p :
       blocks.patches())  // what came back has slipped as the one that is left tells, and bears no shear
    if (!is_left(p)) CHECK(std::abs(p.stretch[0]) + std::abs(p.stretch[1]) < 1e-8 * c);
  // the face breaks: one patch along all of it
  for (FaceState& face : blocks.faces()) face.broken = true;
  blocks.put(turned_by(0.02 * kSteps, {-0.5 * c, -c}));
  REQUIRE(blocks.count() == 1);
  CHECK(blocks.patches()[0].length == approx(0.5).epsilon(1e-3));
}

}  // namespace test_patch_memory
