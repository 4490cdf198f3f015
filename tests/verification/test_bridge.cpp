// Two blocks whose face is partly intact, under cyclic shear: the bridge and what slides beside it add up to the force
// by hand, and the loop closes.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_bridge {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kNormal = 2e9, kShear = 1e9;  // of both joints [Pa/m]
constexpr double kFriction = 0.5773502691896257, kLength = 3, kSway = 2e-4;
constexpr double kYoung = 1e12, kHeight = 2;  // of the blocks [Pa], [m]
constexpr size_t kCycle = 2000;               // steps

struct Stretch {
  double from, to;
  bool intact;
};
struct Layout {
  std::string name;
  std::vector<Stretch> stretches;
};

const std::vector<Layout> kLayouts{
    {"in the middle", {{0, 1, false}, {1, 2, true}, {2, 3, false}}},
    {"at one end", {{0, 1, true}, {1, 3, false}}},
    {"at both ends", {{0, 0.5, true}, {0.5, 2.5, false}, {2.5, 3, true}}},
    {"in two places", {{0, 0.6, false}, {0.6, 1, true}, {1, 1.9, false}, {1.9, 2.5, true}, {2.5, 3, false}}}};

// The lower block's foot is held, the upper one's top closes the face by `closed` and then sways three times.
std::string model_of(const Layout& layout, double closed, const std::string& kind) {
  std::string text = fmt::format(
      "talus = 1\n[material.rock]\ndensity = 2500\nyoung = 1e12\npoisson = 0.0\n"
      "[joint.bridge]\nfriction_angle = \"30 deg\"\ncohesion = 1e9\ntensile_strength = 1e9\n"
      "normal_stiffness = {0}\nshear_stiffness = {1}\n[joint.open]\nfriction_angle = \"30 deg\"\n"
      "normal_stiffness = {0}\nshear_stiffness = {1}\ndamping_time = 0\n[[region]]\nname = \"r\"\n"
      "polygon = [[0, 0], [3, 0], [3, 2], [0, 2]]\nmaterial = \"rock\"\nkind = \"{2}\"\n"
      "[history.u]\nexpression = \"t<0.1 ? 0 : {3}*sin(2*_pi*(t-0.1))\"\nduration = \"3.1 s\"\nsamples = 31000\n"
      "[history.v]\nexpression = \"t<0.1 ? {4}*(t/0.1) : {4}\"\nduration = \"3.1 s\"\nsamples = 31000\n"
      "[[support]]\nname = \"foot\"\nedge = [[0, 0], [3, 0]]\n[[support]]\nname = \"top\"\n"
      "edge = [[0, 2], [3, 2]]\nx = {{ displacement = \"u\" }}\ny = {{ displacement = \"v\" }}\n"
      "[[stage]]\nname = \"sway\"\nkind = \"dynamic\"\nduration = \"3.1 s\"\ntime_step = \"0.5 ms\"\n{5}"
      "[[monitor]]\nname = \"face\"\ncontact = [\"r[0]\", \"r[1]\"]\n"
      "[[monitor]]\nname = \"top\"\npoint = [1.5, 1.99]\n[[monitor]]\nname = \"foot\"\npoint = [1.5, 0.01]\n",
      kNormal, kShear, kind, kSway, -closed, kind == "rigid" ? "" : "elasticity = \"implicit\"\n");
  int number = 0;
  for (const Stretch& s : layout.stretches)
    text += fmt::format("[[fault]]\nname = \"f{}\"\npoints = [[{}, 1], [{}, 1]]\njoint = \"{}\"\n", number++,
                        s.from, s.to, s.intact ? "bridge" : "open");
  return text;
}

}  // namespace

TEST_CASE(
    "bridge: an intact part of a face and what slides beside it bear the shear by hand, and the loop closes" *
    doctest::test_suite("optimised")) {
  for (const Layout& layout : kLayouts)
    for (const double closed : {1e-4, 6e-4, 0.0})
      for (const std::string kind : {"rigid", "deformable"}) {
        const CaseResult r = run_case(model_of(layout, closed, kind));
        if (!says_something()) continue;
        const std::vector<double>&t = r.column("t [s]"), &top = r.column("top.displacement_x [m]"),
              &foot = r.column("foot.displacement_x [m]"), &force = r.column("face.force_x [N]"),
              &press = r.column("face.force_y [N]");
        double intact = 0;
        for (const Stretch& s : layout.stretches) intact += s.intact ? s.to - s.from : 0;
        const double gives = kind == "rigid" ? 1 : 1 / (1 + kNormal * kHeight / kYoung),
                     pressure = kNormal * closed * gives, most = kFriction * pressure / kShear,
                     rest = kLength - intact;
        double elastic = 0, before = 0, largest = 0, off = 0, open = 0, pressed = 0;
        for (size_t i = 0; i < t.size(); ++i) {
          const double u = top[i] - foot[i];
          // the joint is sheared by what the blocks leave of it: G = E/2
          double slid = elastic, joint = u, hand = 0;
          for (int round = 0; round < 5; ++round) {
            slid = std::clamp(elastic + joint - before, -most, most);
            hand = kShear * (intact * joint + (closed > 0 ? rest * slid : 0));
            joint = u - (1 - gives) / gives * hand / (kNormal * kLength) * 2;
          }
          elastic = slid, before = joint;
          if (t[i] < 0.11) continue;
          largest = std::max(largest, std::abs(hand));
          off = std::max(off, std::abs(force[i] - hand));
          pressed = std::max(pressed, std::abs(std::abs(press[i]) - kLength * pressure));
          // the first cycle begins from rest, and the last instant is one without a step after it
          if (i >= 2 * kCycle + 200 && i + 1 < t.size())
            open = std::max(open, std::abs(force[i] - force[i - kCycle]));
        }
        const std::string what =
            fmt::format("bridge {}, closed by {} mm, {}: ", layout.name, 1e3 * closed, kind);
        CHECK(r.run.failed_steps == 0);
        CHECK(r.run.broken_faces == 0);
        // forces of a step are of its middle, half a step off: 0.16 % of the sway at most
        check_below(what + "largest error over the largest force", off / largest, 2e-3, 1e-4);
        check_below(what + "opening of the loop over the largest force", open / largest, 1e-6, 1e-9);
        if (closed > 0)
          check_below(what + "error of the pressure", pressed / (kLength * pressure), 2e-3, 1e-4);
      }
}

}  // namespace test_bridge
