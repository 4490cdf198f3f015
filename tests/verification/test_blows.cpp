// Blows between bodies whose joint has a restitution (theory 4.7): against the laws of impact, in closed form.

#include <numbers>
#include <random>

#include "support/box_polygon.h"
#include "support/model_text.h"
#include "support/run_case.h"
#include "support/tolerance.h"

namespace test_blows {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kG = 9.81;

// Begins a model whose blocks weigh 2000 kg/m3 and rebound.
std::string model_of(double restitution, double friction, double gravity, double duration,
                     const std::string& step, const std::string& more = "") {
  return fmt::format(
      "talus = 1\n[model]\ngravity = [0, {:.17g}]\n[material.m]\ndensity = 2000\nyoung = 1e10\npoisson = 0.2\n"
      "[joint.face]\nfriction_angle = \"{:.17g} deg\"\nrestitution = {:.17g}\n[joint.glue]\nkind = \"bonded\"\n"
      "[contact]\njoint = \"face\"\n{}"
      "[[stage]]\nname = \"run\"\nkind = \"dynamic\"\nduration = {:.17g}\n{}\n",
      -gravity, friction, restitution, more, duration, step);
}

double rise_after(const CaseResult& r, const std::string& column) {
  const auto& y = r.column(column);
  const auto lowest = std::min_element(y.begin(), y.end());
  return *std::max_element(lowest, y.end()) - *lowest;
}

}  // namespace

TEST_CASE(
    "blows: five blocks in a row hand on the speed of the first, whatever the gaps, the kind and the step") {
  for (const std::string kind : {"rigid", "deformable"})
    for (const double gap : {0.0, 1e-3, 1e-2})
      for (const std::string step : {"", "time_step = 4e-5"}) {
        INFO(kind, " ", gap, " ", step);
        std::string text = model_of(1, 0, 0, 1.5, step);
        text += block_text("floor", box_polygon(-5, -1, 9, 0), "fixed");
        for (int k = 0; k < 5; ++k) {
          const double x = k == 0 ? -0.7 : (k - 1) * (0.2 + gap);
          text += block_text(fmt::format("b{}", k), box_polygon(x, 0, x + 0.2, 0.2), kind,
                             k == 0 ? "velocity = [1, 0]" : "");
        }
        const CaseResult r = run_case(text);
        for (size_t k = 1; k <= 5; ++k)
          CHECK(r.state.rate[k].a.x == doctest::Approx(k == 5 ? 1 : 0).epsilon(1e-12));
      }
}

TEST_CASE(
    "blows: a chain of unequal blocks, the last of which leaves by the product of the laws of its blows") {
  const std::array<double, 5> side{0.3, 0.2, 0.25, 0.15, 0.3};
  for (const double e : {0.6, 0.9, 1.0}) {
    std::string text = model_of(e, 30, 0, 0.06, "time_step = 1e-3");
    double x = -0.2, expected = 2;
    for (size_t k = 0; k < side.size(); ++k) {
      text += block_text(fmt::format("b{}", k), box_polygon(x, -side[k] / 2, x + side[k], side[k] / 2),
                         "rigid", k == 0 ? "velocity = [2, 0]" : "");
      x += side[k] + 2e-3 * static_cast<double>(k == 0 ? 50 : k);
      if (k > 0) {
        const double striker = side[k - 1] * side[k - 1], struck = side[k] * side[k];
        expected *= (1 + e) * striker / (striker + struck);
      }
    }
    double first = 0;  // the light ones strike again later
    run_case(text, {}, [&](const Instant& i) {
      if (first == 0) first = i.state.rate[4].a.x;
    });
    CHECK(first == doctest::Approx(expected).epsilon(1e-12));
  }
}

TEST_CASE(
    "blows: blocks fall and rise by the square of their restitution, of one piece, of nine, and deformable") {
  for (const double e : {0.5, 1.0})
    for (const std::string kind : {"rigid", "deformable"})
      for (const int pieces : {1, 3})
        for (const double friction : {0.0, 30.0}) {
          if (pieces > 1 && friction == 0) continue;
          INFO(e, " ", kind, " ", pieces, " ", friction);
          const double height = 0.5, dt = 4e-5;
          std::string text = model_of(e, friction, kG, std::sqrt(2 * height / kG) * (1 + 1.5 * e),
                                      fmt::format("time_step = {}", dt));
          text += block_text("floor", box_polygon(-5, -1, 5, 0), "fixed");
          text += fmt::format(
              "[[grid]]\nname = \"a\"\nmin = [0, {0}]\nmax = [0.3, {1}]\ncells = [{2}, {2}]\nmaterial = "
              "\"m\"\njoint = \"glue\"\nkind = \"{3}\"\n[[monitor]]\nname = \"a\"\ncentroid = \"a\"\n",
              height, height + 0.3, pieces, kind);
          const CaseResult r = run_case(text);
          // a step of the speed of the fall, before and after
          CHECK(rise_after(r, "a.displacement_y") ==
                doctest::Approx(e * e * height).epsilon(4 * dt * std::sqrt(2 * kG * height) / (e * height)));
          CHECK(r.run.closure() < 1e-3);
          CHECK(r.run.energy.work[Cause::kContactClosing] <= 1e-9);
        }
}

TEST_CASE("blows: two blocks without rebound go on together, a block thrown at one that is held or driven") {
  for (const std::string kind : {"rigid", "deformable"}) {
    std::string text = model_of(0, 0, 0, 0.5, "");
    text += block_text("a", box_polygon(-0.4, 0, -0.2, 0.2), kind, "velocity = [1, 0]") +
            block_text("b", box_polygon(0, 0, 0.2, 0.2), kind);
    const CaseResult r = run_case(text);
    CHECK(r.state.rate[0].a.x == doctest::Approx(0.5).epsilon(1e-12));
    CHECK(r.state.rate[1].a.x == doctest::Approx(0.5).epsilon(1e-12));
  }
  const std::string ball = block_text("ball", box_polygon(-0.4, 0, -0.2, 0.2), "rigid", "velocity = [1, 0]");
  const CaseResult held = run_case(model_of(0.6, 0, 0, 0.5, "") + ball +
                                   block_text("wall", box_polygon(0, 0, 0.2, 0.2), "deformable") +
                                   "[[support]]\nname = \"s\"\nedge = [[0.2, 0], [0.2, 0.2]]\n");
  CHECK(held.state.rate[0].a.x == doctest::Approx(-0.6).epsilon(1e-12));
  const CaseResult driven = run_case(
      model_of(0.6, 0, 0, 0.5, "", "[history.push]\nexpression = \"-0.5\"\nduration = 1\n") + ball +
      block_text("wall", box_polygon(0, 0, 0.2, 0.2), "driven", "motion_x = { velocity = \"push\" }"));
  // -0.5 - 0.6 (1 + 0.5)
  CHECK(driven.state.rate[0].a.x == doctest::Approx(-1.4).epsilon(1e-9));
  CHECK(driven.run.closure() < 1e-9);
}

TEST_CASE("blows: what is hinged turns about its hinge, what a roller holds does not give way along it") {
  // a ball on the free end of a bar: Newton's law with the moment of inertia about the hinge
  const double e = 0.8, side = 0.2, length = 2, width = 0.2, lever = 1.8, ball = 2000 * side * side,
               bar = 2000 * length * width, inertia = bar * (length * length + width * width) / 3,
               spin = (1 + e) * ball * lever / (ball * lever * lever + inertia);
  double first = 1;
  const CaseResult r =
      run_case(model_of(e, 0, 0, 0.3, "time_step = 1e-4") +
                   block_text("ball", box_polygon(-0.4, lever - side / 2, -0.2, lever + side / 2), "rigid",
                              "velocity = [1, 0]") +
                   block_text("bar", box_polygon(0, 0, width, length), "rigid") +
                   "[[support]]\nname = \"hinge\"\npoint = [0, 0]\n",
               {}, [&](const Instant& i) {
                 if (first == 1) first = i.state.rate[0].a.x;
               });
  // the ends of its side strike at levers of 1.7 and 1.9 m, and turn the ball a little
  CHECK(first == doctest::Approx(1 - spin * inertia / (ball * lever)).epsilon(1e-3));
  CHECK(std::abs(r.run.energy.work[Cause::kSupports]) < 0.1);  // of 40 J, by the turn of a step
  CHECK(r.run.closure() < 1e-2);

  const CaseResult roller =
      run_case(model_of(1, 0, 0, 0.5, "") +
               block_text("ball", box_polygon(-0.4, 0, -0.2, 0.2), "rigid", "velocity = [1, 0]") +
               block_text("wall", box_polygon(0, 0, 0.2, 0.2), "rigid") +
               "[[support]]\nname = \"s\"\nedge = [[0.2, 0], [0.2, 0.2]]\ny = \"free\"\n");
  CHECK(roller.state.rate[0].a.x == doctest::Approx(-1).epsilon(1e-9));
}

TEST_CASE("blows: what stands or slides elsewhere bears and slips as without them") {
  // a stack, a block that slides, and stones that land at all times beside them
  const auto text_of = [](bool stones, const std::string& more) {
    std::string text = model_of(0.5, 20, kG, 0.2, "time_step = 2e-4", more) +
                       block_text("floor", box_polygon(-5, -1, 30, 0), "fixed") +
                       block_text("slider", box_polygon(-4, 0, -3, 1), "rigid", "velocity = [3, 0]");
    for (int k = 0; k < 30; ++k)
      text += block_text(fmt::format("s{}", k), box_polygon(0, 0.2 * k, 1, 0.2 * (k + 1)), "rigid");
    for (int k = 0; stones && k < 8; ++k)
      text += block_text(fmt::format("stone{}", k),
                         box_polygon(3 + k, 0.01 + 0.02 * k, 3.5 + k, 0.51 + 0.02 * k), "rigid");
    return text + "[[monitor]]\nname = \"base\"\ncontact = [\"s0\", \"floor\"]\n";
  };
  for (const std::string more : {"", "stiffness = \"none\"\n"}) {
    INFO(more);
    std::array<double, 2> slip{}, way{}, most{};
    int met = 0;
    for (const size_t stones : {size_t{0}, size_t{1}}) {
      const CaseResult r = run_case(text_of(stones == 1, more), {}, [&](const Instant& i) {
        met += i.work.meeting.is_one();
        for (const Patch& c : i.state.patches)
          if (c.block_a == 0 && c.block_b == 1) slip[stones] = std::max(c.slip[0], c.slip[1]);
      });
      way[stones] = r.state.displacement[1].x;
      for (const double f : r.column("base.normal_force")) most[stones] = std::max(most[stones], std::abs(f));
    }
    CHECK(met > 7);
    CHECK(slip[1] == doctest::Approx(slip[0]).epsilon(1e-6));
    CHECK(way[1] == doctest::Approx(way[0]).epsilon(1e-9));
    CHECK(slip[1] == doctest::Approx(way[1]).epsilon(1e-2));
    CHECK(most[1] == doctest::Approx(most[0]).epsilon(0.03));  // in the first blows it bore 1.7 times as much
  }
}

// A bar that comes down on a corner, at an angle: the impulse is that of two equations, or of one where it slides.
TEST_CASE("blows: a bar on its corner sticks or slides, and friction gives it no energy") {
  const double length = 1, width = 0.1, spin = 0;
  for (const double degrees : {20.0, 45.0, 60.0})
    for (const double friction : {0.0, 10.0, 35.0, 60.0})
      for (const double e : {0.2, 0.7, 1.0})
        for (const double v_x : {-1.0, 0.0, 2.0}) {
          INFO(degrees, " ", friction, " ", e, " ", v_x);
          const double c = std::cos(degrees * std::numbers::pi / 180),
                       s = std::sin(degrees * std::numbers::pi / 180);
          const auto turned_corner = [&](double x, double y) { return Vec2{c * x - s * y, s * x + c * y}; };
          Polygon bar;
          for (const Vec2 p : box_polygon(-length / 2, -width / 2, length / 2, width / 2))
            bar.push_back(turned_corner(p.x, p.y));
          const Vec2 low = *std::ranges::min_element(bar, {}, &Vec2::y);
          for (Vec2& p : bar) p.y += 1e-3 - low.y;
          std::string text = model_of(e, friction, 0, 2e-3, "time_step = 1e-5");
          text += block_text("floor", box_polygon(-5, -1, 5, 0), "fixed") +
                  block_text("bar", bar, "rigid", fmt::format("velocity = [{}, -1]", v_x));
          const CaseResult r = run_case(text);
          const double m = 2000 * length * width, I = m * (length * length + width * width) / 12;
          const Vec2 arm = low;
          const double nn = 1 / m + arm.x * arm.x / I, tt = 1 / m + arm.y * arm.y / I,
                       nt = -arm.x * arm.y / I;
          const double mu = std::tan(friction * std::numbers::pi / 180);
          // normal along y, tangent along x: e = 0 with u + share e u_before
          const auto impulse_for = [&](double rebound) {
            const double want_n = 1 + rebound, want_t = -v_x, det = nn * tt - nt * nt;
            Vec2 p{(nn * want_t - nt * want_n) / det, (tt * want_n - nt * want_t) / det};
            if (std::abs(p.x) <= mu * p.y) return p;
            for (const double side : {-1.0, 1.0}) {
              const double n = want_n / (nn + side * mu * nt);
              const double slides = v_x + (nt + side * mu * tt) * n;
              if (n > 0 && slides * side <= 0) return Vec2{side * mu * n, n};
            }
            return p;
          };
          const auto energy_after = [&](Vec2 p) {
            const double vx = v_x + p.x / m, vy = -1 + p.y / m, w = (arm.x * p.y - arm.y * p.x) / I;
            return 0.5 * m * (vx * vx + vy * vy) + 0.5 * I * w * w;
          };
          const double before = 0.5 * m * (v_x * v_x + 1);
          Vec2 p = impulse_for(e);
          if (energy_after(p) > before) {
            // as far towards no rebound as it takes
            const Vec2 least = impulse_for(0), full = p;
            double lo = 0, hi = 1;
            for (int k = 0; k < 80; ++k) {
              const double x = 0.5 * (lo + hi);
              (energy_after(least + x * (full - least)) > before ? hi : lo) = x;
            }
            p = least + lo * (full - least);
          }
          CHECK(r.state.rate[1].a.x == doctest::Approx(v_x + p.x / m).epsilon(1e-9));
          CHECK(r.state.rate[1].a.y == doctest::Approx(-1 + p.y / m).epsilon(1e-9));
          CHECK(r.state.rate[1].G.yx ==
                doctest::Approx(spin + (arm.x * p.y - arm.y * p.x) / I).epsilon(1e-9));
          CHECK(energy_after(p) <= before * (1 + 1e-12));
          CHECK(r.run.closure() < 1e-9);
        }
}

TEST_CASE("blows: stones that fall on each other gain nothing, whatever restitution, friction and kind") {
  for (unsigned seed = 1; seed <= 2; ++seed)
    for (const std::string kind : {"rigid", "deformable"})
      for (const double e : {0.0, 0.5, 1.0})
        for (const double friction : {0.0, 30.0, 60.0}) {
          INFO(seed, " ", kind, " ", e, " ", friction);
          std::mt19937 random(seed);
          const auto between = [&](double a, double b) {
            return a + (b - a) * (static_cast<double>(random()) / 4294967296.0);
          };
          std::string text = model_of(e, friction, kG, 1, "time_step = 2e-4");
          if (kind == "deformable") text += "elasticity = \"implicit\"\n";
          text += block_text("floor", box_polygon(-5, -1, 5, 0), "fixed") +
                  block_text("wall", box_polygon(-5, 0, -4, 5), "fixed");
          for (int i = 0; i < 9; ++i) {
            Polygon stone;
            const int n = 3 + static_cast<int>(random() % 4U);
            const double r = between(0.15, 0.3), turn = between(0, 7);
            const Vec2 at{(i % 3) * 0.7 - 3.4 + between(-0.05, 0.05), 0.5 + (i / 3) * 0.7};
            for (int k = 0; k < n; ++k) {
              const double a = turn + (k + between(-0.2, 0.2)) * 2 * std::numbers::pi / n;
              stone.push_back(at + r * Vec2{std::cos(a), std::sin(a)});
            }
            text += block_text(fmt::format("s{}", i), stone, kind,
                               fmt::format("velocity = [{:.17g}, 0]", between(-1, 1)));
          }
          double given = 0, before = 0;
          bool met = false;
          const CaseResult r = run_case(text, {}, [&](const Instant& i) {
            const WorkDone& w = i.report.energy.work;
            const double both = w[Cause::kContactClosing] + w[Cause::kFriction];
            // halves of the work of a blow stand on either side of it
            if (!met && !i.work.meeting.is_one()) given = std::max(given, both - before), before = both;
            met = i.work.meeting.is_one();
          });
          // overlaps that are let out; by the law of Newton alone 1e-2
          CHECK(given <= 1e-3 * std::abs(r.run.energy.gravity));
          CHECK(r.run.closure() < 1e-2);
        }
}

TEST_CASE("blows: shaken drums that deform and ring on each other get nothing from what bears between them") {
  for (const double e : {0.0, 0.5}) {
    INFO(e);
    std::string text = model_of(e, 39, kG, 1, "time_step = 2e-4\nelasticity = \"implicit\"",
                                "[history.base]\nexpression = \"0.4 * sin(4 * _pi * t)\"\nduration = 1.5\n"
                                "[[stage]]\nname = \"stand\"\nkind = \"static\"\nduration = 5\n");
    text += block_text("base", box_polygon(-3, -0.5, 3, 0), "driven", "motion_x = { velocity = \"base\" }");
    for (int k = 0; k < 5; ++k)
      text += block_text(fmt::format("d{}", k), box_polygon(-0.5, k, 0.5, k + 1), "deformable");
    double given = 0, before = 0;
    int64_t steps = 0;
    const CaseResult r = run_case(text, {}, [&](const Instant& i) {
      // over 10 ms: halves of the work of a step are in the next
      if (++steps % 50 != 0) return;
      const double now = i.report.energy.work[Cause::kContactClosing];
      given += std::max(0.0, now - before), before = now;
    });
    // overlaps that are let out, 4e-6; with blows between contacts that bear 5e-5 and 6e-4
    CHECK(given <= 2e-5 * -r.run.energy.work[Cause::kContactClosing]);
  }
}

TEST_CASE("blows: steps in which blocks knock that ring are counted, and no others") {
  const auto ringing = [](const std::string& kind, const std::string& joint, bool glued) {
    std::string text = fmt::format(
        "talus = 1\n[model]\ngravity = [0, -9.81]\n[material.m]\ndensity = 2000\nyoung = 1e10\npoisson = 0.2\n"
        "[joint.face]\nfriction_angle = \"30 deg\"\n{}\n[joint.glue]\nkind = \"bonded\"\n[contact]\njoint = "
        "\"face\"\n[[stage]]\nname = \"run\"\nkind = \"dynamic\"\nduration = 0.1\n",
        joint == "ground" ? "" : joint);
    text += block_text("floor", box_polygon(-5, -1, 5, 0), "fixed") +
            block_text("a", box_polygon(0, 0.01, 1, 1.01), kind) +
            block_text("b", box_polygon(1, 0.01, 2, 1.01), kind);
    if (joint == "ground") {
      text += block_text("c", box_polygon(3, 0, 4, 0.5), kind) +
              block_text("d", box_polygon(4, 0, 5, 0.5), kind) +
              block_text("e", box_polygon(3.5, 0.51, 4.5, 1), kind) +
              "[[contact_pair]]\nbetween = [\"c\", \"d\"]\njoint = \"glue\"\n";
    }
    if (glued) text += "[[contact_pair]]\nbetween = [\"a\", \"b\"]\njoint = \"glue\"\n";
    return run_case(text).run.ringing_steps;
  };
  CHECK(ringing("deformable", "", false) > 0);
  CHECK(ringing("deformable", "", true) == 0);
  // one alone on two that are tied
  CHECK(ringing("deformable", "ground", true) > 0);
  CHECK(ringing("rigid", "", false) == 0);
  CHECK(ringing("deformable", "restitution = 0", false) == 0);
  CHECK(ringing("deformable", "normal_stiffness = 1e10\nshear_stiffness = 1e10", false) == 0);
}

}  // namespace test_blows
