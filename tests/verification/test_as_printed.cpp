// The equations of Zhao et al. 2016 as printed (formulation = "as_printed"): friction that never sticks, a viscous edge
// without its area and on the velocity of one half step, and what they do not know, refused.

#include "support/model_text.h"
#include "support/run_case.h"
#include "support/told.h"
#include "support/tolerance.h"

namespace test_as_printed {

using namespace talus;
using namespace talus::test;

namespace {

const std::vector<std::string> kPrinted = {"model.formulation=\"as_printed\""};

// A block on a floor with gravity turned by 20 deg, below its friction angle of 30 deg.
std::string on_slope(double time_step) {
  return friction_model({3.35521761, -9.21838470}, 30, 2, time_step) +
         block_text("floor", {{-1, -1}, {3, -1}, {3, 0}, {-1, 0}}, "fixed") +
         block_text("block", {{0, 0}, {1, 0}, {1, 0.2}, {0, 0.2}}, "rigid") +
         "[[monitor]]\nname = \"b\"\npoint = [0.5, 0.1]\n";
}

// A bar of 16 cells along x that moves along x only, `tall` high, with a pulse let in at its left end.
std::string bar(double tall) {
  return fmt::format(R"(talus = 1
[material.m]
density = 2500
young = "20 GPa"
poisson = 0
[joint.glue]
kind = "bonded"
[history.pulse]
expression = "t < 5e-4 ? 0.5e-3*(1-cos(2*_pi*t/5e-4)) : 0"
duration = "10 ms"
samples = 20000
[[grid]]
name = "bar"
min = [0, 0]
max = [4.8, {0}]
cells = [16, 1]
material = "m"
joint = "glue"
[[support]]
name = "below"
edge = [[0, 0], [4.8, 0]]
y = "fixed"
x = "free"
[[support]]
name = "above"
edge = [[0, {0}], [4.8, {0}]]
y = "fixed"
x = "free"
[[support]]
name = "drive"
edge = [[0, 0], [0, {0}]]
x = {{ velocity = "pulse" }}
y = "free"
[[boundary]]
name = "end"
kind = "viscous"
edge = [[4.8, 0], [4.8, {0}]]
[[stage]]
name = "wave"
kind = "dynamic"
duration = "3.4 ms"
time_step = "20 us"
[[monitor]]
name = "middle"
point = [2.4, {1}]
)",
                     tall, tall / 2);
}

// Displacement that what comes back from the end leaves over that of what went there: of the slowest part of the pulse,
// which neither blocks nor steps disperse.
double reflected(const std::string& text, const std::vector<std::string>& overrides) {
  const CaseResult r = run_case(text, overrides);
  const auto &t = r.column("t [s]"), &u = r.column("middle.displacement_x");
  // the wave takes 1.7 ms to the end, half of it to the middle, and is 0.5 ms long
  const auto between = static_cast<size_t>(std::lower_bound(t.begin(), t.end(), 1.9e-3) - t.begin());
  return (u.back() - u[between]) / u[between];
}

}  // namespace

TEST_CASE("as printed: a block that should stand creeps, the faster the smaller the step") {
  // eq. 27: a share m of the friction needs a slip of epsilon_2 tan(pi m / 2) at every step
  const double share = std::tan(20 * M_PI / 180) / std::tan(30 * M_PI / 180);
  for (const double dt : {1e-3, 1e-4}) {
    const CaseResult r = run_case(on_slope(dt), kPrinted);
    check_close(fmt::format("as printed: creep at dt = {:g} s [m/s]", dt), r.column("b.velocity_x").back(),
                6e-8 * std::tan(M_PI * share / 2) / dt, 1e-2, 1e-3);
  }
}

TEST_CASE("as printed: a viscous edge has no area, and lets back what does not match" *
          doctest::test_suite("optimised")) {
  // z = rho c times 1 m2 for each block edge against rho c times the height; 1 % is the tail of the dispersed pulse that
  // has not passed the middle when the run ends
  for (const double tall : {0.4, 1.0, 2.5})
    check_close(fmt::format("as printed: reflection of a bar {:g} m high", tall),
                reflected(bar(tall), kPrinted), (tall - 1) / (tall + 1), 0.02, 0.005, 1);
  const std::string two = replaced(bar(1), "cells = [16, 1]", "cells = [16, 2]");
  check_close("as printed: reflection of a bar 1 m high in two rows", reflected(two, kPrinted),
              (1.0 - 2) / (1 + 2), 0.02, 0.005, 1);
  check_below("the viscous edge of talus: reflection of a bar 0.4 m high", std::abs(reflected(bar(0.4), {})),
              0.02, 0.005);
}

TEST_CASE("as printed: what the printed equations do not know is refused by its key") {
  const std::string sound = on_slope(1e-3), strength = "\"30 deg\"\n", joint = "joint = \"face\"\n",
                    by_sweeps = sound + "[solver]\nmethod = \"gauss_seidel\"\n";
  CHECK(refusal(sound, kPrinted).empty());
  const auto with = [&](const std::string& after, const std::string& more) {
    return replaced(sound, after, after + more);
  };
  check_told(with(strength, "cohesion = 1\n"),
             {"joint.face: cohesion, tensile strength and strengths after slip"}, kPrinted);
  check_told(with(strength, "residual_friction_angle = \"20 deg\"\n"), {"strengths after slip"}, kPrinted);
  check_told(with(strength, "normal_stiffness = 1e9\nshear_stiffness = 1e9\n"),
             {"joint.face: the printed equations know hard contacts"}, kPrinted);
  check_told(with(joint, "law = \"exact\"\n"), {"contact.law"}, kPrinted);
  check_told(sound + "[solver]\njacobian = \"analytic\"\n", {"solver.jacobian"}, kPrinted);
  check_told(by_sweeps, {"solver.method: model.formulation = \"as_printed\" solves by Newton's method"},
             kPrinted);
  CHECK(refusal(by_sweeps, kPrinted).find("solver.jacobian") == std::string::npos);
  check_told(with("kind = \"dynamic\"\n", "elasticity = \"implicit\"\n"), {"stage.run.elasticity"}, kPrinted);
  check_told(replaced(bar(1), "kind = \"viscous\"", "kind = \"viscous\"\nvelocity_x = \"pulse\""),
             {"boundary.end: the printed edge (theory 5.9) lets waves out"}, kPrinted);
}

}  // namespace test_as_printed
