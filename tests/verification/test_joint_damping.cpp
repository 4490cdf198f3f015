// Dashpots beside the stiffness of joints (theory 4.6): a blow, blocks that swing on their joints, what slips.

#include <numbers>
#include <optional>

#include "support/box_polygon.h"
#include "support/model_text.h"
#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_joint_damping {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kDensity = 2500, kNormal = 20e9, kShear = 2e9, kTime = 0.25e-3;

// A block on a floor, by one joint; `step` and `duration` in seconds.
std::string block_on_floor(const std::string& gravity, const std::string& block, double damping_time,
                           double step, double duration, const std::string& more = "") {
  return fmt::format(
      "talus = 1\n[model]\ngravity = {}\n[material.m]\ndensity = {}\n[joint.j]\nfriction_angle = \"30 deg\"\n"
      "normal_stiffness = {}\nshear_stiffness = {}\ndamping_time = {:.17g}\n[contact]\njoint = \"j\"\nalpha = 0\n"
      "[[block]]\nname = \"floor\"\npolygon = [[-9, -1], [9, -1], [9, 0], [-9, 0]]\nmaterial = \"m\"\nkind = \"fixed\"\n"
      "[[block]]\nname = \"block\"\nmaterial = \"m\"\nkind = \"rigid\"\n{}\n"
      "[[monitor]]\nname = \"c\"\npoint = [0, 0.025]\n"
      "[[stage]]\nname = \"move\"\nkind = \"dynamic\"\nduration = {:.17g}\ntime_step = {:.17g}\n{}",
      gravity, kDensity, kNormal, kShear, damping_time, block, duration, step, more);
}

}  // namespace

TEST_CASE("joint damping: a blow gives back what stiffness and dashpot leave of it") {
  const double omega = std::sqrt(kNormal / kDensity);  // of a block of 1 m x 1 m
  for (const double share : {0.1, 0.36, 0.59, 0.9}) {
    const double root = std::sqrt(1 - share * share),
                 exact = std::exp(-2 * share / root * std::atan(root / share));  // eq. 4.1c
    for (const double step : {2e-6, 1e-6}) {
      Energy end;
      const CaseResult r = run_case(
          block_on_floor("[0, 0]", "polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]\nvelocity = [0, -0.1]",
                         2 * share / omega, step, 4e-3),
          {}, [&](const Instant& i) { end = i.report.energy; });
      check_close(fmt::format("rebound at {} of critical, step {:g} us", share, 1e6 * step),
                  r.state.rate[1].a.y / 0.1, exact, 1e-4, 1e-5);
      // the spring has given back what it took; where the two cancel it still bears, and sheds that
      const double came = 0.5 * kDensity * 0.01;
      const double bears = came * 4 * share * share * exact * exact;
      check_close("damping work of the blow [J]", -end.work[Cause::kDamping] - end.work[Cause::kJoints],
                  came * (1 - exact * exact), 1e-4, 1e-5);
      check_close("what the spring has taken for good [J]", -end.work[Cause::kJoints], bears,
                  omega * step / share, 1e-3);  // in the last step it changes by that
    }
  }
}

TEST_CASE("joint damping: what flies feels no dashpot before it touches") {
  // closes 0.3 mm within the 1 mm by which a dashpot that reached ahead of its joint would slow it down
  const double omega = std::sqrt(kNormal / kDensity), gap = 3e-4, speed = 4, share = 0.5 * kTime * omega,
               root = std::sqrt(1 - share * share),
               exact = std::exp(-2 * share / root * std::atan(root / share));
  for (const double step : {2e-6, 1e-6}) {
    double flown = 0, slowest = speed;
    bool touched = false;
    const CaseResult r = run_case(
        block_on_floor("[0, 0]",
                       "polygon = [[0, 3e-4], [1, 3e-4], [1, 1.0003], [0, 1.0003]]\nvelocity = [0, -4]",
                       kTime, step, 4e-3),
        {}, [&](const Instant& i) {
          const double way = -i.state.displacement[1].y;
          touched = touched || way > gap - speed * step;
          if (!touched) flown = way, slowest = std::min(slowest, -i.state.rate[1].a.y);
        });
    check_above("the last way seen before it touches [m]", flown, gap - 3 * speed * step, 0);
    check_close("speed then", slowest, speed, 1e-12, 1e-15);
    // the step in which it touches has a spring alone
    check_close(fmt::format("rebound behind a gap, step {:g} us", 1e6 * step), r.state.rate[1].a.y / speed,
                exact, 4 * omega * share * step, omega * step);
  }
}

TEST_CASE("joint damping: blocks swing out on their joints as a damped oscillator does") {
  // wide and low: it hardly rocks. Gravity comes at once, and what it closes is never let go. Alpha damps as a time of alpha dt
  // does, here 0.01 ms of the 0.25: counted in it leaves 0.6 %, added to the joint's own 1.5 and 1.9 %
  const double height = 0.05, mass = kDensity * height, duration = 2e-3;
  const std::string block = "polygon = [[-2, 0], [2, 0], [2, 0.05], [-2, 0.05]]";
  for (const auto& [alpha, step, allowed] : {std::tuple(0.0, 1e-6, 1e-3), std::tuple(0.5, 2e-5, 1e-2)}) {
    const CaseResult r = run_case(
        block_on_floor("[0.5, -10]", block, kTime, step, duration, "[output]\nhistory_interval = \"1 us\"\n"),
        {fmt::format("contact.alpha={}", alpha)});
    const std::vector<double>& t = r.column("t [s]");
    for (const auto& [axis, stiffness, pull] :
         {std::tuple("y", kNormal, -10.0), std::tuple("x", kShear, 0.5)}) {
      const std::vector<double>& u = r.column(fmt::format("c.displacement_{}", axis));
      const double omega = std::sqrt(stiffness / mass), share = 0.5 * kTime * omega,
                   rest = pull * mass / stiffness;
      double worst = 0;
      for (size_t i = 0; i < t.size(); ++i) {
        double exact = 1 - std::exp(-omega * t[i]) * (1 + omega * t[i]);
        const double root = std::sqrt(std::abs(1 - share * share));
        if (share < 1)
          exact = 1 - std::exp(-share * omega * t[i]) *
                          (std::cos(root * omega * t[i]) + share / root * std::sin(root * omega * t[i]));
        else if (share > 1)
          exact = 1 - std::exp(-share * omega * t[i]) *
                          (std::cosh(root * omega * t[i]) + share / root * std::sinh(root * omega * t[i]));
        worst = std::max(worst, std::abs(u[i] / rest - exact));
      }
      check_below(fmt::format("damped swing along {}, {:.3g} of critical, alpha {:g}", axis, share, alpha),
                  worst, allowed, 1e-4);
    }
  }
}

TEST_CASE("joint damping: what slides bears its friction, and shaken at half the step goes as far") {
  const std::string block = "polygon = [[-2, 0], [2, 0], [2, 0.05], [-2, 0.05]]";
  const double mu = std::tan(std::numbers::pi / 6);
  const CaseResult slides = run_case(
      block_on_floor("[8, -10]", block, kTime, 1e-5, 0.2, "[output]\nhistory_interval = \"10 ms\"\n"));
  const std::vector<double>&t = slides.column("t [s]"), &v = slides.column("c.velocity_x");
  const size_t one = t.size() / 2, two = t.size() - 1;
  check_close("acceleration of what slides on a damped joint", (v[two] - v[one]) / (t[two] - t[one]),
              8 - 10 * mu, 1e-6, 1e-9);

  // slider and dashpot stand in a row: once it slides the spring alone bears the friction, and what is left of the step is added.
  // The mean of both ends: friction tilts the block a little; the step leaves T a dt/2 of it, 0.8 %
  const Patch& patch = slides.state.patches.at(0);
  const double stretch =
      0.5 * std::abs(patch.stretch[0] + patch.stretch[1]) - 1e-5 * slides.state.rate[1].a.x;
  check_close("elastic slip of what slides [m]", stretch, mu * kDensity * 0.05 * 10 / kShear, 1e-2, 1e-3);

  const auto shaken = [&](double damping_time, double step) {
    double worst = 0, given = -1e300, way = 0;
    const CaseResult r = run_case(
        block_on_floor("[0, -10]", block, damping_time, step, 0.3,
                       "[history.a]\nexpression = \"9*sin(2*_pi*10*t)+2*sin(2*_pi*3*t)\"\nduration = 0.3\n"
                       "[[load]]\nname = \"shake\"\nacceleration_x = \"a\"\n"),
        {}, [&](const Instant& i) {
          const Energy& e = i.report.energy;
          way = std::max(way, std::abs(i.state.displacement[1].x));
          worst = std::max(worst, std::abs(e.left_over) / std::max(1e-300, e.largest()));
          given = std::max(given, e.work[Cause::kJoints] + e.work[Cause::kFriction]);
        });
    CHECK(given <= 1e-9);  // neither spring, dashpot nor friction gives energy
    CHECK(worst <= 1e-9);
    return std::pair(r.state.displacement[1].x, way);
  };
  // What is left, as share of the largest way: of first order in the step. (Without dashpots it does not settle: 0.895, 0.918,
  // 0.905 mm.)
  const auto whole = shaken(kTime, 4e-5), half = shaken(kTime, 2e-5), quarter = shaken(kTime, 1e-5);
  check_close("way of a block that slips to and fro, at half the step", whole.first, half.first, 1e-3, 1e-4,
              half.second);
  check_close("the same at a quarter", half.first, quarter.first, 5e-4, 1e-4, quarter.second);
  check_close("its largest way, at half the step", whole.second, half.second, 1e-4, 1e-5);
}

TEST_CASE("joint damping: accelerations far above those given are told with block, joint and time") {
  const auto text_of = [](double above, bool stiff) {
    return fmt::format(
               "talus = 1\n[model]\ngravity = [0, -9.81]\n[material.m]\ndensity = 2600\n[joint.face]\nfriction_angle = \"30 "
               "deg\"\n{}[contact]\njoint = \"face\"\n[history.base]\nexpression = \"0.05*sin(20*t)\"\nduration = 1\n[[stage]]\n"
               "name = \"run\"\nkind = \"dynamic\"\nduration = 0.2\ntime_step = 2e-5\n",
               stiff ? "normal_stiffness = 2e10\nshear_stiffness = 1e10\n" : "") +
           block_text("floor", box_polygon(-2, -1, 3, 0), "driven", "motion_x = { velocity = \"base\" }") +
           block_text("b", box_polygon(0, above, 1, 1 + above), "rigid");
  };
  const auto told = [&](double above, bool stiff) {
    std::string out;
    std::optional<Scene> scene;
    const CaseResult r = run_case(text_of(above, stiff), {}, [&](const Instant& i) {
      if (!scene) scene = i.scene;
    });
    // 0.05 sin(20 t): 1 m/s2; v sqrt(k/m) of a fall of 5 mm, damped
    if (stiff && above > 0) {
      CHECK(r.run.jolt > 300);
      CHECK(r.run.jolt < 1000);
      CHECK(r.run.jolt_time == doctest::Approx(std::sqrt(2 * above / 9.81)).epsilon(0.02));
    }
    return jolt_text(*scene, r.run);
  };
  // ten times: neither twenty nor five
  const Scene still = [] {
    Scene scene;
    scene.model.gravity = {0, -9.81};
    return scene;
  }();
  RunResult jolted;
  jolted.jolt = 97;
  CHECK(jolt_text(still, jolted) == "");
  jolted.jolt = 99;
  CHECK(jolt_text(still, jolted) != "");
  const std::string text = told(5e-3, true);
  CHECK_MESSAGE(text.find("accelerations: b (contact") == 0, text);
  CHECK_MESSAGE(
      text.find("times the largest that is given, gravity included (9.81 m/s2)") != std::string::npos, text);
  CHECK(told(0, true) == "");      // at rest, but for the weight that it takes on
  CHECK(told(5e-3, false) == "");  // a speed over a step
}

}  // namespace test_joint_damping
