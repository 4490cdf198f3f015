// Contact beside a face that is still intact: what two glued blocks bear at the two ends of the face, by hand.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "support/model_text.h"
#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_beside_ties {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kStiffness = 20e9;       // of the joint, either way [Pa/m]
constexpr double kMass = 2300 * 0.4;      // of a brick [kg]
constexpr double kG = 9.81, kFace = 0.5;  // [m/s2], [m]
const double kDiagonal = std::sqrt(0.5);

// A brick of 1 m x 0.4 m glued to another one that is fixed, half of either over the other, pushed along the face.
std::string bricks_text(const std::string& push, const std::string& stage) {
  return fmt::format(
             "talus = 1\n[model]\ngravity = [0, -{0}]\n[material.m]\ndensity = 2300\n[joint.face]\n"
             "friction_angle = \"25 deg\"\ncohesion = \"10 MPa\"\ntensile_strength = \"10 MPa\"\n"
             "normal_stiffness = {1:g}\nshear_stiffness = {1:g}\ndamping_time = 0\n[contact]\njoint = \"face\"\n"
             "[[load]]\nname = \"push\"\nacceleration_x = {2}\n{3}",
             kG, kStiffness, push, stage) +
         block_text("a", {{0, 0}, {1, 0}, {1, 0.4}, {0, 0.4}}, "fixed") +
         block_text("b", {{0.5, 0.4}, {1.5, 0.4}, {1.5, 0.8}, {0.5, 0.8}}, "rigid");
}

// At either end of the face a corner of one brick lies in the other, `deep` below the face and `aside` beyond its end.
// What lies above 45 deg from the corner is nearest to the tie; the rest of the rectangle presses against two sides at
// right angles, by k/2 A each.
double corner_force(double deep, double aside) {
  if (deep <= 0 || aside <= 0) return 0;
  const double m = std::min(deep, aside);
  return kStiffness * kDiagonal * (deep * m - 0.5 * m * m);
}

// Of the left end and the right one.
using Ends = std::array<double, 2>;

// By the foundation that the tie is: shear, closure and turn of a rigid block.
Ends at_rest(double push) {
  const double aside = -kMass * push / (kStiffness * kFace), closed = kMass * kG / (kStiffness * kFace);
  const double moment = -kMass * (0.2 * push + 0.25 * kG);  // about the middle of the face
  const double turn = moment / (kStiffness * kFace * kFace * kFace / 12);
  return {corner_force(closed + 0.5 * kFace * turn, aside), corner_force(closed - 0.5 * kFace * turn, aside)};
}

// By where the brick lies.
Ends by_place(const Instant& i) {
  Ends out{};
  for (const size_t end : {0U, 1U}) {
    const Vec2 arm = Vec2{0.5 + kFace * static_cast<double>(end), 0.4} - i.scene.blocks.centroid[1];
    const Vec2 moved = i.state.displacement[1] + i.state.strain_part[1] * arm;
    out[end] = corner_force(-moved.y, -moved.x);
  }
  return out;
}

// Along their normal, which is the same for both: 45 deg from the face.
Ends found(const State& state) {
  Ends out{};
  for (const Patch& p : state.patches) {
    CHECK(norm(p.normal + Vec2{kDiagonal, kDiagonal}) < 1e-3);
    CHECK(p.length < 1e-4);  // no more than the corner
    out[p.arm_a[0].x < 0.25 ? 0 : 1] += p.force[0][0] + p.force[1][0];
  }
  return out;
}

}  // namespace

TEST_CASE("beside a glued face: either end bears the corner that lies in the other block, and no more") {
  struct Case {
    double push;
    std::array<bool, 2> bears;
  };
  for (const auto& [push, bears] : {Case{-12, {true, true}}, Case{-30, {true, false}},
                                    Case{-3, {false, true}}, Case{12, {false, false}}}) {
    const CaseResult r = run_case(bricks_text(fmt::format("{}", push),
                                              "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = "
                                              "\"1 s\"\nintegration = \"implicit\"\nunbalanced = 1e-9\n"));
    if (!says_something()) continue;
    const Ends hand = at_rest(push), now = found(r.state);
    for (const size_t end : {0U, 1U}) {
      CHECK((hand[end] > 0) == bears[end]);
      const std::string what =
          fmt::format("pushed by {} m/s2, {} corner [N]", push, end == 0 ? "left" : "right");
      if (bears[end])
        check_close(what, now[end], hand[end], 1e-3, 1e-4);
      else
        check_below(what, now[end], 1e-6, 1e-9);
    }
  }
}

TEST_CASE("beside a glued face: shaken, the corners bear what they overlap by") {
  const std::string history = "[history.shake]\nexpression = \"30*sin(300*t)\"\nduration = \"0.05 s\"\n";
  Ends before{};
  double largest = 0, off = 0, most = 0;
  size_t both = 0;
  const CaseResult r = run_case(
      bricks_text("\"shake\"", history + "[[stage]]\nname = \"shake\"\nkind = \"dynamic\"\nduration = "
                                         "\"0.05 s\"\ntime_step = 1e-5\n"),
      {}, [&](const Instant& i) {
        const Ends now = by_place(i), force = found(i.state);
        for (const size_t end : {0U, 1U}) {
          // the law holds at a place between the two ends of the step
          largest = std::max(largest, now[end]), most = std::max(most, force[end]);
          off = std::max(off, std::abs(force[end] - 0.5 * (before[end] + now[end])));
        }
        before = now;
        // frames tell the ends of two patches of the same parts apart
        std::set<std::pair<int, int>> numbers;
        for (const FramePoint& p : frame_points(i.scene, i))
          if (p.kind == 0) numbers.emplace(p.corner, p.edge);
        CHECK(numbers.size() == 2 * i.state.patches.size());
        both += i.state.patches.size() == 2;
      });
  if (!says_something()) return;
  CHECK(both > 50);
  check_close("shaken, largest force of a corner [N]", most, largest, 1e-2, 1e-3);
  check_below("shaken, largest error over the largest force", off / largest, 1e-2, 1e-3);
  CHECK(r.run.broken_faces == 0);
}

}  // namespace test_beside_ties
