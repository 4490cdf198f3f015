// Static stages that have no balance near: mechanisms, what falls, and the damped motion that follows (theory 14.4).

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "support/relative.h"
#include "talus/base/random.h"
#include "talus/model/read_model.h"
#include "talus/run/run.h"

namespace test_no_balance {

using namespace talus;

namespace {

struct Ended {
  PreparedRun prepared;
  State state;
  RunResult result;
};

class Silent : public Observer {
 public:
  void at(const Instant&) override {}
};

PreparedRun prepared(const std::string& text) {
  Findings findings("m.toml", text);
  return prepare_run("m.toml", text, {}, findings);
}

Ended run(const std::string& text) {
  Ended e{prepared(text), {}, {}};
  e.state = start_state(e.prepared.scene);
  Silent silent;
  e.result = run_stages(e.prepared.scene, e.prepared.plans, e.state, silent);
  return e;
}

std::string head(double friction, bool elastic, bool gravity = true) {
  return fmt::format(
      "talus = 1\n[model]\ngravity = [0, {}]\n[material.m]\ndensity = 2600\nyoung = \"30 GPa\"\npoisson = 0.2\n"
      "[joint.plane]\nfriction_angle = \"{:.17g} deg\"\n{}[contact]\njoint = \"plane\"\n",
      gravity ? -9.81 : 0, friction,
      elastic ? "normal_stiffness = \"20 GPa/m\"\nshear_stiffness = \"10 GPa/m\"\n" : "");
}

std::string block(const std::string& name, const std::string& polygon, const std::string& kind) {
  return fmt::format("[[block]]\nname = \"{}\"\npolygon = {}\nmaterial = \"m\"\nkind = \"{}\"\n", name,
                     polygon, kind);
}

std::string static_stage(double duration = 5) {
  return fmt::format("[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = {}\n", duration);
}

// A wedge on a plane of this dip.
std::string wedge(double dip, double friction, const std::string& kind, bool elastic) {
  const double angle = dip * 3.14159265358979323846 / 180, l = 40 * std::cos(angle), h = 40 * std::sin(angle);
  return head(friction, elastic) +
         block("base", fmt::format("[[-{0}, -{1}], [{0}, -{1}], [{0}, {1}]]", l, h), "fixed") +
         block("wedge", fmt::format("[[0, 0], [{0}, {1}], [{2}, {1}]]", l, h, 0.5 * l), kind) +
         static_stage();
}

}  // namespace

TEST_CASE(
    "no balance: of random wedges on a plane those above their friction are mechanisms, the others rest") {
  Random random(7);
  for (int i = 0; i < 24; ++i) {
    const double dip = 20 + 40 * random.uniform();
    const bool slides = i % 2 == 0, elastic = i % 4 < 2;
    const std::string kind = i % 8 < 4 ? "rigid" : "deformable";
    CAPTURE(i);
    CAPTURE(dip);
    const double radians = dip * 3.14159265358979323846 / 180;
    const double friction = std::atan(std::tan(radians) * (slides ? 0.98 : 1.02)) / radians * dip;
    const Ended e = run(wedge(dip, friction, kind, elastic));
    CHECK(e.result.mechanism == slides);
    CHECK(e.result.stages[0].at_rest == !slides);
    CHECK(e.result.steps <= (slides ? 300 : 12));
    if (!slides) continue;
    CHECK(e.result.failure.find("\"wedge\"") != std::string::npos);
    CHECK(e.result.failure.find("on joint \"plane\"") != std::string::npos);
    CHECK(e.result.failure.find("100 %") != std::string::npos);
    // along the plane
    const Vec2 d = e.state.displacement[1];
    CHECK(std::atan2(-d.y, -d.x) == test::approx(radians).epsilon(1e-3));
  }
}

TEST_CASE("no balance: a stone that falls is followed, and comes to rest where it lands") {
  for (const bool elastic : {false, true})
    for (const std::string kind : {"rigid", "deformable"}) {
      CAPTURE(elastic);
      CAPTURE(kind);
      const Ended e =
          run(head(30, elastic) + block("floor", "[[-2, -1], [2, -1], [2, 0], [-2, 0]]", "fixed") +
              block("stone", "[[0, 0.9], [1, 0.9], [1, 1.9], [0, 1.9]]", kind) + static_stage(20));
      const StageResult& s = e.result.stages[0];
      CHECK(!e.result.mechanism);
      CHECK(s.at_rest);
      CHECK(s.followed());
      CHECK(s.followed_because.find("1 block, 1 m2 (100 % of what can move), falls") != std::string::npos);
      CHECK(e.state.displacement[1].y == test::approx(-0.9).epsilon(1e-4));
    }
}

static std::string tower_and_crumbs(const std::string& crumbs) {
  return head(20, true) +
         block("base", "[[-5, -1], [6, -1], [6, 0], [1.5, 4.5], [1.5, 0], [-5, 0]]", "fixed") +
         block("tower", "[[-4, 0], [-2, 0], [-2, 3], [-4, 3]]", "rigid") + crumbs + static_stage(1);
}

TEST_CASE("no balance: a crumb that slides beside a standing block is no mechanism, and is not waited for") {
  const std::string text = tower_and_crumbs(block("crumb", "[[2.5, 3.5], [2.6, 3.4], [2.65, 3.5]]", "rigid")),
                    who = "slides, on joint \"plane\"; farthest \"crumb\"";
  const Ended strict = run(text + "strict_rest = true\n"), e = run(text);
  CHECK(!strict.result.mechanism);
  CHECK(strict.result.stages[0].followed());
  CHECK(strict.result.stages[0].followed_because.find(who) != std::string::npos);
  CHECK(strict.result.stages[0].left_out.empty());
  CHECK(!e.result.mechanism);
  CHECK(!e.result.stages[0].followed());
  CHECK(e.result.stages[0].at_rest);
  CHECK(e.result.stages[0].left_out.find(who) != std::string::npos);
  CHECK(e.state.left_out == std::vector<int>{2});
  // the tower stands as without it: 3 m of rock on joints of 20 GPa/m
  CHECK(e.state.displacement[1].y == test::approx(-2600 * 9.81 * 3 / 20e9).epsilon(1e-4));
}

TEST_CASE("no balance: crumbs are left out up to a hundredth of the area, all together") {
  for (const double side : {0.17, 0.18}) {
    CAPTURE(side);
    // two of them that fall, one after the other, beside a tower of 6 m2
    const std::string crumbs =
        block("first", fmt::format("[[7, 9], [{0}, 9], [{0}, {1}], [7, {1}]]", 7 + side, 9 + side), "rigid") +
        block("second", fmt::format("[[9, 9], [{0}, 9], [{0}, {1}], [9, {1}]]", 9 + side, 9 + side), "rigid");
    const Ended e = run(tower_and_crumbs(crumbs));
    CHECK(e.result.stages[0].followed() == (side > 0.175));
    CHECK((e.result.stages[0].left_out.find("2 blocks") != std::string::npos) == (side < 0.175));
  }
}

TEST_CASE("no balance: a run that is taken up in the motion that follows, or behind it, has the same bits") {
  const std::string falls =
      head(30, false) + block("floor", "[[-2, -1], [2, -1], [2, 0], [-2, 0]]", "fixed") +
      block("stone", "[[0, 0.9], [1, 0.9], [1, 1.9], [0, 1.9]]", "rigid") + static_stage(20);
  // hard contacts give by the shortest step that has been: that of the motion, not of the stage behind it
  const std::string text = falls +
                           "[[stage]]\nname = \"press\"\nkind = \"dynamic\"\nduration = 1\ntime_step = 0.1\n"
                           "[[load]]\nname = \"push\"\npoint = [0.5, 1.9]\nforce_y = \"-100 kN\"\nstages = "
                           "[\"press\"]\n";
  const Ended whole = run(text);
  REQUIRE(whole.result.failure == "");
  for (const int64_t steps : {int64_t{60}, whole.result.steps - 8}) {
    CAPTURE(steps);
    PreparedRun one = prepared(text), two = prepared(text);
    State state = start_state(one.scene);
    Silent silent;
    Standing standing;
    {
      StagedRun first(one.scene, one.plans, state, silent);
      CHECK(first.advance({.steps = steps}));
      standing = first.standing();
    }
    REQUIRE(standing.result.stages[0].followed());
    const RunResult end = continue_stages(two.scene, two.plans, standing, state, silent);
    CHECK(end.stages[0].at_rest);
    CHECK(end.steps == whole.result.steps);
    CHECK(state.displacement[1] == whole.state.displacement[1]);
    CHECK(state.time == whole.state.time);
  }
}

TEST_CASE("no balance: a stage that says how its blocks move is not taken from rest") {
  const std::string model = wedge(30, 40, "deformable", true);
  const auto from_rest = [&](const std::string& more) {
    return prepared(model + more).scene.model.stages[0].from_rest;
  };
  CHECK(from_rest(""));
  CHECK(from_rest("elasticity = \"implicit\"\n"));
  for (const std::string more : {"integration = \"dynamic\"\n", "elasticity = \"explicit\"\n",
                                 "damping_local = 0.5\n", "safety = 0.5\n"})
    CHECK(!from_rest(more));
  // a time step is one of the motion that follows, if any does
  const PreparedRun p = prepared(model + "time_step = \"0.1 ms\"\n"), q = prepared(model);
  CHECK(p.scene.model.stages[0].from_rest);
  CHECK(p.plans[0].dt == q.plans[0].dt);
  CHECK(p.plans[0].dt_follow == test::approx(1e-4));
  CHECK(p.plans[0].dt_follow != q.plans[0].dt_follow);
}

// A block of 1 m on a plane of 45 deg without friction, with so far to go before a stop.
static Ended slide_to_stop(double way) {
  const auto at = [](double s, double n) {  // along the plane upwards, across it
    const double c = std::sqrt(0.5);
    return fmt::format("[{:.17g}, {:.17g}]", c * (s - n), c * (s + n));
  };
  const auto box = [&](double from, double to, double low, double high) {
    return fmt::format("[{}, {}, {}, {}]", at(from, low), at(to, low), at(to, high), at(from, high));
  };
  return run(head(0, true) + block("plane", box(-5, 5, -1, 0), "fixed") +
             block("stop", box(-way - 1, -way, 0, 1), "fixed") + block("slider", box(0, 1, 0, 1), "rigid") +
             static_stage(20));
}

TEST_CASE(
    "no balance: what slides less than one and a half of its size may come to lie, further is a mechanism") {
  const Ended near = slide_to_stop(1), far = slide_to_stop(2.5);
  CHECK(!near.result.mechanism);
  CHECK(near.result.stages[0].at_rest);
  CHECK(!near.result.stages[0].followed());
  CHECK(far.result.mechanism);
}

TEST_CASE(
    "no balance: what falls by less than half its size lands in steps from rest, further it is followed") {
  for (const double gap : {0.3, 0.8}) {
    CAPTURE(gap);
    const Ended e =
        run(head(30, true) + block("floor", "[[-2, -1], [2, -1], [2, 0], [-2, 0]]", "fixed") +
            block("stone", fmt::format("[[0, {0}], [1, {0}], [1, {1}], [0, {1}]]", gap, 1 + gap), "rigid") +
            static_stage(20));
    CHECK(e.result.stages[0].at_rest);
    CHECK(e.result.stages[0].followed() == (gap > 0.5));
  }
}

TEST_CASE("no balance: a hundredth of the area that can move is a mechanism, less is a crumb") {
  for (const double share : {0.007, 0.015}) {
    CAPTURE(share);
    const double side = std::sqrt(share / (1 - share) * 36);
    const Ended e =
        run(head(0, true) + block("base", "[[-9, -9], [9, -9], [9, 9]]", "fixed") +
            block("ledge", "[[-20, -9], [-10, -9], [-10, 0], [-20, 0]]", "fixed") +
            block("stands", "[[-19, 0], [-13, 0], [-13, 6], [-19, 6]]", "rigid") +
            block("slides",
                  fmt::format("[[0, 0], [{0:.17g}, {0:.17g}], [0, {1:.17g}], [{2:.17g}, {0:.17g}]]",
                              side * std::sqrt(0.5), side * std::sqrt(2.0), -side * std::sqrt(0.5)),
                  "rigid") +
            static_stage(5));
    CHECK(e.result.mechanism == (share > 0.01));
    CHECK(!e.result.stages[0].left_out.empty() == (share < 0.01));
  }
}

TEST_CASE("no balance: who goes with whom, and what slides and what falls") {
  // blocks of 1 m on planes without friction and with some: paces g sin and so on
  const auto two = [](double ratio) {
    const double friction =
        std::atan(1 - ratio) * 180 / 3.14159265358979323846;  // of the second one on 45 deg
    return run(
        head(0, true) +
        fmt::format("[joint.rough]\nfriction_angle = \"{:.17g} deg\"\nnormal_stiffness = \"20 GPa/m\"\n"
                    "shear_stiffness = \"10 GPa/m\"\n[[contact_pair]]\nbetween = [\"other\", "
                    "\"second\"]\njoint = \"rough\"\n",
                    friction) +
        block("base", "[[-9, -9], [9, -9], [9, 9]]", "fixed") +
        block("other", "[[21, -9], [39, -9], [39, 9]]", "fixed") +
        block("first", "[[0, 0], [1, 1], [0, 2], [-1, 1]]", "rigid") +
        block("second", "[[30, 0], [31, 1], [30, 2], [29, 1]]", "rigid") + static_stage(5));
  };
  CHECK(two(0.15).result.failure.find(" 2 blocks") != std::string::npos);
  CHECK(two(0.07).result.failure.find(" 1 block,") != std::string::npos);
  // a plane that bears so much of the weight
  const auto steep = [](double borne) {
    const double x = borne / std::sqrt(1 - borne * borne);  // to 1 m of height
    return run(head(0, true) +
               block("wall",
                     fmt::format("[[{0:.17g}, -20], [30, -20], [30, 20], [{1:.17g}, 20]]", -20 * x, 20 * x),
                     "fixed") +
               block("slab", fmt::format("[[{0:.17g}, -5], [{1:.17g}, 5], [-3, 5], [-3, -5]]", -5 * x, 5 * x),
                     "rigid") +
               static_stage(3));
  };
  CHECK(steep(0.015).result.mechanism);
  CHECK(!steep(0.007).result.mechanism);
  CHECK(steep(0.007).result.stages[0].followed_because.find("falls") != std::string::npos);
}

TEST_CASE("no balance: a crumb is named alone where the others are a hundred times slower by their size") {
  for (const double ratio : {0.015, 0.007}) {
    CAPTURE(ratio);
    // the crumb of 0.1 m falls, the block of 2 m slides with this share of its pace
    const double pull = ratio * 20,
                 friction = std::atan(1 - pull * std::sqrt(2.0)) * 180 / 3.14159265358979323846;
    const Ended e = run(
        head(friction, true) + block("base", "[[-9, -9], [9, -9], [9, 9]]", "fixed") +
        block("slides",
              "[[0, 0], [1.41421356237, 1.41421356237], [0, 2.82842712475], [-1.41421356237, 1.41421356237]]",
              "rigid") +
        block("crumb", "[[-12, 9], [-11.9, 9], [-11.9, 9.1], [-12, 9.1]]", "rigid") + static_stage(5) +
        "strict_rest = true\n");
    const std::string text = e.result.failure + e.result.stages[0].followed_because;
    CHECK((text.find(" 2 blocks") != std::string::npos) == (ratio > 0.01));
    CHECK((text.find(" 1 block,") != std::string::npos) == (ratio < 0.01));
  }
}

TEST_CASE("no balance: after 300 steps from rest a stage is followed, whatever it is short of") {
  std::string text = wedge(30, 40, "rigid", true);
  text += "unbalanced = 1e-300\n";
  text.replace(text.find("duration = 5"), 12, "duration = 20");
  const Ended e = run(text);
  CHECK(e.result.stages[0].steps_from_rest == 300);
  CHECK(e.result.stages[0].followed_because == "no balance in 300 steps from rest");
}

// Sag of two voussoirs of 5 x 0.5 m between abutments, that bear by opposite corners: force F along their diagonal d strains
// them by F d/(E V) along it, and 2 F sin(its angle) is the weight of one.
static double sag_by_hand(double weight) {
  const double young = 2e9, volume = 2.5, d0 = std::hypot(5.0, 0.5);
  double low = 0, high = 0.2;
  for (int i = 0; i < 60; ++i) {
    const double u = 0.5 * (low + high), d = std::hypot(5, 0.5 - u);
    const double force = young * volume * (d0 - d) / (d0 * d0);
    (2 * force * (0.5 - u) / d < weight ? low : high) = u;
  }
  return low;
}

TEST_CASE(
    "no balance: what slides for 300 steps is a mechanism, however short the step that a small block asks for") {
  // a slab with a block a fourteenth as long in front of it, which no step may move by more than a twentieth of itself
  const auto on_slope = [](double friction) {
    const double angle = 30 * 3.14159265358979323846 / 180, c = std::cos(angle), s = std::sin(angle);
    const auto at = [&](double x, double y) {
      return fmt::format("[{:.17g}, {:.17g}]", c * x - s * y, s * x + c * y);
    };
    const auto box = [&](double from, double to, double high) {
      return fmt::format("[{}, {}, {}, {}]", at(from, 0), at(to, 0), at(to, high), at(from, high));
    };
    return run(head(friction, true) +
               block("base", fmt::format("[{}, {}, {}, {}]", at(-90, -5), at(90, -5), at(90, 0), at(-90, 0)),
                     "fixed") +
               block("slab", box(0, 2, 1.5), "rigid") + block("small", box(-0.14, 0, 0.14), "rigid") +
               static_stage(20));
  };
  const Ended slides = on_slope(25);
  CHECK(slides.result.mechanism);
  CHECK(slides.result.stages[0].steps == 300);
  CHECK(slides.result.failure.find("2 blocks") != std::string::npos);
  CHECK(on_slope(35).result.stages[0].at_rest);
}

TEST_CASE("no balance: a crumb stays where it was when it was named, and the others come to rest") {
  const Ended e =
      run(head(20, true) + block("base", "[[-20, -1], [20, -1], [20, 0], [-20, 0]]", "fixed") +
          block("hill", "[[-2.5, 0], [2.5, 0], [2.5, 2]]", "rigid") +
          block("crumb", "[[0, 1], [0.2, 1.08], [0.2, 1.28], [0, 1.2]]", "rigid") + static_stage(20));
  const StageResult& rest = e.result.stages[0];
  CHECK(rest.at_rest);
  CHECK(!rest.followed());
  REQUIRE(e.state.left_out == std::vector<int>{2});
  // named in the first step that brings it half its size, 0.1 m, off where it began; no step goes further than a twentieth
  const double way = norm(e.state.displacement[2]);
  CHECK(way > 0.1);
  CHECK(way < 0.11);
}

TEST_CASE("no balance: what moves pushes a crumb aside that was left out, which neither bears nor weighs") {
  const Ended e =
      run(head(20, true) + block("base", "[[-2, -1], [2, -1], [2, 0], [-2, 0]]", "fixed") +
          block("stands", "[[-1, 0], [0, 0], [0, 1], [-1, 1]]", "rigid") +
          block("pusher", "[[1, 1], [1.5, 1], [1.5, 1.5], [1, 1.5]]", "driven") +
          "motion_x = { displacement = \"way\" }\n" +
          block("crumb", "[[0.98, 1.2], [0.99, 1.2], [0.99, 1.21], [0.98, 1.21]]", "rigid") +
          "[history.way]\ntime = [0, 1]\nvalue = [0, -0.03]\n" +
          "[[stage]]\nname = \"rest\"\nkind = \"static\"\nduration = 20\npath = 1\nincrements = 20\n");
  CAPTURE(e.result.failure);
  REQUIRE(e.result.stages[0].balances == 21);
  REQUIRE(e.state.left_out == std::vector<int>{3});
  CHECK(e.state.displacement[3].x == test::approx(-0.02).epsilon(1e-6));
  // its fall is that of the step in which it was named, and no work is left over
  CHECK(e.state.displacement[3].y > -0.02);
  CHECK(std::abs(e.result.energy.left_over) < 1e-9 * e.result.largest_energy);
}

TEST_CASE("no balance: damped motion that goes faster to its end is a mechanism, what slows down is not") {
  const auto damped = [](double friction, double speed) {
    std::string text = wedge(35, friction, "rigid", false) + "integration = \"dynamic\"\ntime_step = 0.002\n";
    const std::string kind = "kind = \"rigid\"\n";
    return run(text.replace(text.find(kind), kind.size(),
                            kind + fmt::format("velocity = [{}, {}]\n", -speed * 0.81915, -speed * 0.57358)));
  };
  const Ended slides = damped(10, 0);
  CHECK(slides.result.mechanism);
  CHECK(slides.result.failure.find("on joint \"plane\"") != std::string::npos);
  CHECK(slides.result.failure.find("they go faster than ever") != std::string::npos);
  // 0.2 g (sin 35 deg - cos 35 deg tan 24 deg) for 5 s is 5.1 m, 0.37 of its size: it may yet come to lie on something
  CHECK(!damped(24, 0).result.mechanism);
  const Ended slows = damped(36, 5);
  CHECK(!slows.result.mechanism);
  CHECK(slows.result.no_rest);
}

TEST_CASE(
    "no balance: what only settles in a stage that is too short is no mechanism, however fast it is at its end") {
  const auto settles = [](const std::string& stages) {
    return run(head(30, true).replace(head(30, true).find("20 GPa"), 6, "10 MPa") +
               block("base", "[[-3, -1], [3, -1], [3, 0], [-3, 0]]", "fixed") +
               block("box", "[[-1, 0], [1, 0], [1, 2], [-1, 2]]", "rigid") + stages);
  };
  const auto stage = [](const std::string& name, double duration) {
    return fmt::format(
        "[[stage]]\nname = \"{}\"\nkind = \"static\"\nduration = {}\nintegration = \"dynamic\"\ntime_step = 2e-5\n"
        "damping_local = 0\nunbalanced = {}\n",
        name, duration, name == "first" ? 0.1 : 1e-5);
  };
  // it swings in 0.14 s: the fastest after a quarter of that
  const Ended short_one = settles(stage("second", 0.034));
  CHECK(short_one.result.no_rest);
  CHECK(!short_one.result.mechanism);
}

TEST_CASE("no balance: what is left out in its fall presses on nothing across the gap at which it stays") {
  int left_out = 0;
  for (const double drop : {0.101, 0.1025, 0.104, 0.1055, 0.107, 0.1085, 0.11, 0.1115}) {
    CAPTURE(drop);
    const Ended e = run(tower_and_crumbs(block(
        "crumb", fmt::format("[[-3.1, {0}], [-2.9, {0}], [-2.9, {1}], [-3.1, {1}]]", 3 + drop, 3.2 + drop),
        "rigid")));
    REQUIRE(e.result.stages[0].at_rest);
    if (e.state.left_out.empty()) continue;  // it has come to lie on the tower
    ++left_out;
    for (const Patch& c : e.state.patches)
      for (const size_t end : {0U, 1U})
        if (c.gap[end] > 1e-6) CHECK(c.force[end][0] == 0);
    double weight = 2600 * 9.81 * 6;
    for (const Patch& c : e.state.patches)  // what has landed in the step in which it was named presses
      if (c.block_a == 1 && c.block_b == 2) weight += c.force[0][0] + c.force[1][0];
    CHECK(e.state.displacement[1].y == test::approx(-weight / (2 * 20e9)).epsilon(1e-4));
  }
  CHECK(left_out > 0);
}

// The most that the work of closing contacts rises by from one step to the next [J].
class MostGiven : public Observer {
 public:
  void at(const Instant& i) override {
    const double now = i.state.work[Cause::kContactClosing];
    most = std::max(most, now - before), before = now;
  }
  double most = 0, before = 0;
};

TEST_CASE(
    "no balance: what comes under a corner in the step in which it rises is seen, not pushed out again") {
  // a crossing of four hard blocks: one is pushed over the joint below it by 1 mm, the one beyond that joint, on which it
  // then lies, is pushed up by as much, until what is beside and on it meets a wall and a roof
  const auto push = [](const std::string& name, const std::string& on, const std::string& at,
                       const std::string& force) {
    return fmt::format("[[load]]\nname = \"{}\"\nblock = \"{}\"\npoint = {}\n{}\n", name, on, at, force);
  };
  PreparedRun p = prepared(
      head(0, false, false) + block("below", "[[-1, -1], [0, -1], [0, 0], [-1, 0]]", "fixed") +
      block("pushed", "[[-1, 0], [0, 0], [0, 1], [-1, 1]]", "rigid") +
      block("rising", "[[0, -1], [1, -1], [1, 0], [0, 0]]", "rigid") +
      block("beside", "[[0, 0], [1, 0], [1, 1], [0, 1]]", "rigid") +
      block("wall", "[[1.001, -2], [2, -2], [2, 3], [1.001, 3]]", "fixed") +
      block("roof", "[[-1, 1.001], [1, 1.001], [1, 2], [-1, 2]]", "fixed") +
      push("aside", "pushed", "[-1, 0.5]", "force_x = \"100 kN\"") +
      push("down", "pushed", "[-0.1, 1]", "force_y = \"-50 kN\"") +
      "[[support]]\nname = \"guide\"\nblock = \"rising\"\npoint = [0.5, -0.5]\nx = \"fixed\"\ny = \"free\"\n" +
      push("up", "rising", "[0.5, -1]", "force_y = \"300 kN\"") + static_stage() +
      "time_step = 0.02\nintegration = \"implicit\"\n");
  State state = start_state(p.scene);
  MostGiven given;
  const RunResult r = run_stages(p.scene, p.plans, state, given);
  CHECK(r.stages[0].at_rest);
  // by the loads: 100, -50 and 300 J or less
  CHECK(state.work[Cause::kLoads] > 100);
  // let into each other first, the one would be lifted by half a millimetre to a millimetre under 50 kN at least: 25 J and
  // more; contacts give back what they gave, of the order of 300 kN times 1e-5 m
  CHECK(given.most < 10);
}

TEST_CASE("no balance: two voussoirs sag as von Mises' truss does, whatever the step") {
  const double weight = 2500 * 36.402807117194286 * 2.5;
  for (const double step : {1e-3, 5e-3, 2e-2}) {
    CAPTURE(step);
    const Ended e = run(
        "talus = 1\n[model]\nplane = \"stress\"\ngravity = [0, -36.402807117194286]\n[material.m]\ndensity = 2500\n"
        "young = \"2 GPa\"\npoisson = 0\n[joint.j]\nfriction_angle = \"45 deg\"\n[contact]\njoint = \"j\"\n" +
        block("left", "[[-6, -1], [-5, -1], [-5, 1.5], [-6, 1.5]]", "fixed") +
        block("right", "[[5, -1], [6, -1], [6, 1.5], [5, 1.5]]", "fixed") +
        block("a", "[[-5, 0], [0, 0], [0, 0.5], [-5, 0.5]]", "deformable") +
        block("b", "[[0, 0], [5, 0], [5, 0.5], [0, 0.5]]", "deformable") +
        "[[support]]\nname = \"lf\"\npoint = [-5, 0]\nblock = \"a\"\nx = \"free\"\n"
        "[[support]]\nname = \"rf\"\npoint = [5, 0]\nblock = \"b\"\nx = \"free\"\n" +
        static_stage(60) + fmt::format("integration = \"implicit\"\ntime_step = {}\n", step));
    REQUIRE(e.result.stages[0].at_rest);
    // the top of a at midspan: its centroid and what it has turned and strained by
    const Vec2 arm{2.499, 0.249};
    const double sag = -(e.state.displacement[2] + e.state.strain_part[2] * arm).y;
    CHECK(sag == test::approx(sag_by_hand(weight)).epsilon(5e-3));
  }
}

}  // namespace test_no_balance
