// Strength of joints at one face against hand calculation: loss of cohesion and tension, residual values,
// dilation, stiffness; and the factor of safety of a two-block slope.

#include "support/limit_models.h"
#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/contact/joint_state.h"

namespace test_joint_strength {

using namespace talus;
using namespace talus::test;
using namespace talus::test::limit;

namespace {

constexpr double kArea = 1, kWeight = 2000 * kG;  // of the block: 1 x 1 m, 2000 kg

// A rigid block of 1 x 1 m on a fixed floor, moved sideways at `push` and upwards at `pull` (0: free) by
// supports along its left side and top.
std::string shear_text(const std::string& joint, const std::string& push, const std::string& pull = "",
                       double duration = 1) {
  std::string text =
      fmt::format("talus = 1\n[model]\ngravity = [0, {}]\n[material.m]\ndensity = 2000\n[joint.face]\n{}\n",
                  -kG, joint) +
      "[contact]\njoint = \"face\"\n" + block_text("floor", {{-2, -1}, {3, -1}, {3, 0}, {-2, 0}}, "fixed") +
      block_text("block", {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, "rigid") +
      "[[monitor]]\nname = \"c\"\npoint = [0.5, 0.5]\n[[monitor]]\nname = \"face\"\ncontact = [\"block\", "
      "\"floor\"]\n";
  if (!push.empty())
    text += fmt::format(
        "[history.push]\n{}\n[[support]]\nname = \"push\"\nedge = [[0,0],[0,1]]\nx = {{ displacement = "
        "\"push\" }}\ny = \"free\"\n",
        push);
  if (!pull.empty())
    text += fmt::format(
        "[history.pull]\n{}\n[[support]]\nname = \"pull\"\nedge = [[0,1],[1,1]]\nx = \"free\"\ny = {{ "
        "displacement = \"pull\" }}\n",
        pull);
  return text + stage_text(duration, 1e-3);
}

double largest(const std::vector<double>& v) {
  double most = 0;
  for (const double x : v) most = std::max(most, std::abs(x));
  return most;
}

void check_energy(const CaseResult& r) {
  // round-off of some thousand steps
  check_below("energy left over / largest term", r.run.closure(), 1e-9, 1e-12);
}

const std::string kSoft = "normal_stiffness = 1e9\nshear_stiffness = 5e8\n";

}  // namespace

TEST_CASE("cohesion holds a face up to c A + mu N, then residual strength slides") {
  for (const bool soft : {false, true}) {
    const std::string joint =
        std::string(soft ? kSoft : "") +
        "friction_angle = \"40 deg\"\ncohesion = 50e3\nresidual_friction_angle = \"25 deg\"\n"
        "residual_cohesion = 8e3";
    // 2 mm in 1 s, and on: where a history ends the block stops
    const CaseResult r = run_case(shear_text(joint, "time = [0, 0.5, 1.1]\nvalue = [0, 0.5e-3, 2.3e-3]"));
    const auto& shear = r.column("face.force_x");
    const std::string what = soft ? "soft joint, " : "hard joint, ";
    // what gives is read at the steps: before the limit, and beyond it not at all. A soft joint by 1 to 3 um of 5e8 N/m; a hard
    // one gives by 1e-5 of its length (theory 4.22), so that a step of the drive is some 80 N
    check_close(what + "largest shear c A + mu N [N]", largest(shear),
                50e3 * kArea + std::tan(radians(40)) * kWeight, soft ? 2e-2 : 5e-3, soft ? 1e-2 : 1e-9);
    check_close(what + "shear after c_r A + mu_r N [N]", std::abs(shear.back()),
                8e3 * kArea + std::tan(radians(25)) * kWeight, soft ? 1e-3 : 1e-6, 1e-9);
    CHECK(r.run.broken_faces == 1);
    check_energy(r);
  }
}

TEST_CASE("tension cut-off: a face breaks at T A and carries nothing after") {
  for (const bool soft : {false, true}) {
    const std::string joint = std::string(soft ? kSoft : "") +
                              "friction_angle = \"40 deg\"\ntensile_strength = 30e3\ncohesion = 1e6";
    const CaseResult r = run_case(shear_text(joint, "", "time = [0, 1]\nvalue = [0, 0.1e-3]"));
    const auto& normal = r.column("face.normal_force");
    const std::string what = soft ? "soft joint, " : "hard joint, ";
    check_close(what + "largest pull T A [N]", *std::min_element(normal.begin(), normal.end()), -30e3 * kArea,
                soft ? 1e-2 : 1e-9, soft ? 5e-3 : 1e-12);
    CHECK(normal.back() == 0);
    CHECK(r.run.broken_faces == 1);
    check_energy(r);
  }
}

TEST_CASE("a face with cohesion alone is lost when it opens") {
  const CaseResult r = run_case(shear_text("friction_angle = \"40 deg\"\ncohesion = 1e6",
                                           "time = [0, 0.5, 1]\nvalue = [0, 0, 1e-3]",
                                           "time = [0, 0.2, 0.5, 1]\nvalue = [0, 1e-4, 1e-4, 1e-4]"));
  CHECK(r.run.broken_faces == 1);
  // open before it was sheared: with cohesion left it would bear 1 MN
  check_below("shear of a face that opened first [N]", largest(r.column("face.force_x")), 1e-3, 1e-6);
  check_energy(r);
}

TEST_CASE("dilation: the block rises by tan(dilation) x slip, both ways, up to dilation_slip") {
  for (const bool soft : {false, true}) {
    const std::string joint =
        std::string(soft ? kSoft : "") + "friction_angle = \"30 deg\"\ndilation_angle = \"10 deg\"\n";
    const double sink = soft ? kWeight / (1e9 * kArea) : 0;
    const double elastic = soft ? std::tan(radians(30)) * kWeight / (5e8 * kArea) : 0;
    const std::string what = soft ? "soft joint, " : "hard joint, ";
    // begins and turns slowly enough not to throw the block; the rise lags by one step of slip, 20 um
    const std::string there = "time = [0, 0.2, 1]\nvalue = [0, 1e-3, 17e-3]";
    const std::string and_back = "time = [0, 0.4, 1]\nvalue = [0, 8e-3, -4e-3]";
    const CaseResult one = run_case(shear_text(joint, there));
    check_close(what + "rise after 17 mm [m]", one.column("c.displacement_y").back(),
                std::tan(radians(10)) * (17e-3 - elastic) - sink, 1e-2, 3e-3);
    double slip = 0;
    for (const Patch& c : one.state.patches) slip = std::max({slip, c.slip[0], c.slip[1]});
    // of a compliant joint at the place between two ends of a step at which its law holds: up to one step, 20 um, back
    check_close(what + "slip [m]", slip, 17e-3 - elastic, soft ? 20e-6 / 17e-3 : 1e-6, 1e-9);
    check_energy(one);

    const CaseResult two = run_case(shear_text(joint, and_back));
    check_close(what + "rise after 8 mm there and 12 mm back [m]", two.column("c.displacement_y").back(),
                std::tan(radians(10)) * (20e-3 - 3 * elastic) - sink, 1e-2, 3e-3);
    check_energy(two);

    const CaseResult end = run_case(shear_text(joint + "dilation_slip = 5e-3\n", there));
    check_close(what + "rise that ends at 5 mm of slip [m]", end.column("c.displacement_y").back(),
                std::tan(radians(10)) * 5e-3 - sink, 1e-3, 1e-4);
    check_energy(end);
  }
}

TEST_CASE("joint stiffness: force = k x closure, the way back the same as the way there") {
  // cohesion makes the touching face a glued one; without, it is a contact
  for (const std::string strength : {"", "cohesion = 1e6\ntensile_strength = 1e6\n"}) {
    const std::string joint = "friction_angle = \"45 deg\"\n" + kSoft + strength;
    // pressed by 0.2 mm and let go to 0.1 mm; sheared by 0.05 mm and back. Slow: 1 s of 2000 kg on 1e9 N/m
    const CaseResult r =
        run_case(shear_text(joint, "time = [0, 1, 2, 3, 4]\nvalue = [0, 0, 0.05e-3, 0, 0]",
                            "time = [0, 1, 2, 3, 4]\nvalue = [0, -0.2e-3, -0.2e-3, -0.2e-3, -0.1e-3]", 4));
    const auto &t = r.column("t [s]"), &normal = r.column("face.normal_force"),
               &shear = r.column("face.force_x"), &x = r.column("c.displacement_x"),
               &y = r.column("c.displacement_y");
    double off_normal = 0, off_shear = 0;
    for (size_t i = 0; i < t.size(); ++i) {
      if (t[i] < 0.05) continue;  // the first jump of velocity rings
      off_normal = std::max(off_normal, std::abs(normal[i] + 1e9 * kArea * y[i]) / 2e5);
      off_shear = std::max(off_shear, std::abs(std::abs(shear[i]) - 5e8 * kArea * std::abs(x[i])) / 2.5e4);
    }
    const std::string what = strength.empty() ? "contact: " : "glued face: ";
    // a step of the alpha family lags by less than a step: 0.2 um of 200 um and 0.05 of 50
    check_below(what + "normal force off kn x closure, of the largest", off_normal, 2e-3, 1e-6);
    check_below(what + "shear force off ks x slip, of the largest", off_shear, 2e-3, 1e-6);
    CHECK(r.run.broken_faces == 0);
    for (const Patch& c : r.state.patches) CHECK(std::max(c.slip[0], c.slip[1]) == 0);
    check_energy(r);
  }
}

TEST_CASE("residual friction alone: a face without cohesion weakens at its first slip") {
  const CaseResult r =
      run_case(shear_text("friction_angle = \"45 deg\"\nresidual_friction_angle = \"20 deg\"",
                          "time = [0, 0.5, 1.1]\nvalue = [0, 0.5e-3, 2.3e-3]"));
  const auto& shear = r.column("face.force_x");
  // as above, some 80 N before the limit
  check_close("largest shear mu N [N]", largest(shear), std::tan(radians(45)) * kWeight, 8e-3, 1e-9);
  check_close("shear after mu_r N [N]", std::abs(shear.back()), std::tan(radians(20)) * kWeight, 1e-6, 1e-9);
  CHECK(r.run.broken_faces == 1);
  check_energy(r);
}

}  // namespace test_joint_strength
