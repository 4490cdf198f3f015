// Slopes of rock in three sets of finite joints, hard and with cohesion: equations that are tied crosswise. A family, judged step
// by step; most are solved by sweeps, the others by friction in turns (theory 5.8) or by pivoting (5.10).

#include "support/run_case.h"

namespace test_hard_slopes {

using namespace talus;
using namespace talus::test;

namespace {

std::string slope(int seed, double spacing) {
  const auto set = [&](const char* name, double angle, double share, double gap) {
    return fmt::format(
        "[[joint_set]]\nname = \"{}\"\nangle = {{ mean = \"{} deg\", normal = \"3 deg\" }}\n"
        "spacing = {{ mean = \"{} m\", uniform = \"{} m\" }}\n"
        "trace_length = {{ mean = \"{} m\", normal = \"3 m\" }}\ngap = \"{} m\"\n",
        name, angle, share * spacing, 0.3 * share * spacing, 3 * spacing, gap * spacing);
  };
  const auto held = [](const char* side, const char* y) {
    return fmt::format("[[support]]\nname = \"{0}\"\nalong = \"{0}\"\nx = \"fixed\"\ny = \"{1}\"\n", side, y);
  };
  return "talus = 1\n[model]\ngravity = [0, -9.81]\n"
         "[material.rock]\ndensity = 2600\nyoung = 15e9\npoisson = 0.25\n"
         "[joint.hard]\nfriction_angle = \"40 deg\"\ncohesion = \"0.1 MPa\"\n[contact]\njoint = \"hard\"\n"
         "[[region]]\nname = \"rock\"\npolygon = [[0, 0], [36, 0], [36, 20], [16, 20], [8, 5], [0, 5]]\n"
         "sides = [\"base\", \"right\", \"crest\", \"face\", \"bench\", \"left\"]\n"
         "material = \"rock\"\njoint = \"hard\"\n" +
         set("a", 40, 1, 0.9) + set("b", 118, 1.15, 0.5) + set("c", 184, 1.3, 1) +
         fmt::format("[cut]\nseed = {}\n", seed) + held("base", "fixed") + held("right", "free") +
         held("left", "free") +
         "[[stage]]\nname = \"load\"\nkind = \"dynamic\"\nduration = 0.004\ntime_step = 5e-4\nelasticity = "
         "\"implicit\"\n";
}

}  // namespace

TEST_SUITE_BEGIN("optimised");

TEST_CASE("hard slopes in three sets with cohesion: every step is solved") {
  for (const double spacing : {3.0, 4.0, 5.0})
    for (int seed = 1; seed <= 8; ++seed) {
      CAPTURE(spacing);
      CAPTURE(seed);
      run_case(slope(seed, spacing), {"solver.limit=1e-8"});  // no step is loose
    }
}

TEST_SUITE_END();

}  // namespace test_hard_slopes
