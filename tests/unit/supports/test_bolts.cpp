// Rock bolts in small: the path through blocks, the statics of a bar, superposed stiffness, rows that cost no
// time step.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "support/block_scene.h"
#include "support/relative.h"
#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/base/random.h"
#include "talus/supports/bar.h"
#include "talus/supports/bolt_path.h"

namespace test_bolts {

using namespace talus;
using namespace talus::test;

namespace {

const double kEA = 200e9 * std::numbers::pi * 0.025 * 0.025 / 4;

// A bar of three nodes and two segments of 1 MN/m, each node held by 1 MN/m.
Bolt small_bar(double bond, double yield) {
  Bolt bolt;
  bolt.rupture_strain = std::numeric_limits<double>::infinity();
  bolt.nodes.resize(3);
  for (BoltNode& n : bolt.nodes) n.stiffness = 1e6, n.limit = bond;
  bolt.segments.resize(2);
  for (BoltSegment& s : bolt.segments) s.length = s.gauge = 1, s.stiffness = 1e6, s.yield = yield;
  return bolt;
}

}  // namespace

TEST_CASE("path of a bolt: pieces, a gap, blocks that have moved") {
  const Scene scene = block_scene(
      jointed_rock(), {{box_polygon(0, 0, 1, 1)}, {box_polygon(1, 0, 2, 1)}, {box_polygon(2.5, 0, 4, 1)}});
  State state = start_state(scene);
  BoltPath path = path_through(scene.blocks, state, {0.5, 0.5}, {3, 0.5}, 1e-3);
  REQUIRE(path.trouble.empty());
  REQUIRE(path.pieces.size() == 3);
  CHECK(path.pieces[1].from == approx(0.5));
  CHECK(path.pieces[1].to == approx(1.5));
  CHECK(path.pieces[2].from == approx(2.0));
  CHECK(path.pieces[2].to == approx(2.5));

  state.displacement[1] = {0.2, 0};
  path = path_through(scene.blocks, state, {0.5, 0.5}, {3, 0.5}, 1e-3);
  CHECK(path.pieces[1].from == approx(0.7));
  state.displacement[1] = {0, 5};
  CHECK(path_through(scene.blocks, state, {0.5, 0.5}, {3, 0.5}, 1e-3).pieces.size() == 2);
}

TEST_CASE("statics of a bar by hand: elastic, slipping, yielding, ruptured") {
  // the rock opens by 1 mm in the first segment: slips z with 2 z0 - z1 = 1, -z0 + 3 z1 - z2 = -1, 2 z2 = z1
  Bolt bolt = small_bar(1e9, 1e9);
  balance_bar({1e-3, 0}, bolt);
  check_close("bar force in the first segment [N]", bolt.segments[0].force, 375, 1e-12, 1e-14);
  check_close("bar force in the second segment [N]", bolt.segments[1].force, -125 + 250, 1, 1);
  double sum = 0;
  for (const BoltNode& n : bolt.nodes) sum += n.stiffness * n.slip;
  check_below("bar: sum of all forces of the grout / force", std::abs(sum) / 375, 1e-12, 1e-14);
  // the work of opening slowly is what it stores
  check_close("bar: stored energy / work of opening", stored_energy(bolt), 0.5 * 375 * 1e-3, 1e-12, 1e-14);

  // all it can pass on is what the first node's bond holds
  bolt = small_bar(100, 1e9);
  balance_bar({10e-3, 0}, bolt);
  check_close("bar that slips at its head [N]", bolt.segments[0].force, 100, 1e-5, 1e-6);
  CHECK(std::abs(bolt.nodes[0].plastic) > 1e-3);

  bolt = small_bar(1e9, 50);
  balance_bar({1e-3, 0}, bolt);
  check_close("bar that yields [N]", bolt.segments[0].force, 50, 1e-6, 1e-9);
  CHECK(bolt.segments[0].yielded);
  const double plastic = bolt.segments[0].plastic;
  balance_bar({0, 0}, bolt);  // unloads elastically and is pushed
  CHECK(bolt.segments[0].force < 0);
  CHECK(bolt.segments[0].plastic <= plastic);

  bolt = small_bar(1e9, 1e9);
  bolt.rupture_strain = 1e-4;
  CHECK(balance_bar({1e-3, 0}, bolt) == 1);
  CHECK(bolt.segments[0].force == 0);
  CHECK(balance_bar({0, 0}, bolt) == 0);
  CHECK(bolt.segments[0].force == 0);
}

TEST_CASE("superposed bolt adds its stiffness over width and spacing") {
  // one block of 2 m width under 1 MPa, Poisson's ratio 0
  const char* text = R"(talus = 1
[material.rock]
density = 2500
young = "5 GPa"
poisson = 0
[[block]]
name = "b"
polygon = [[0, 0], [2, 0], [2, 1], [0, 1]]
material = "rock"
[[support]]
name = "base"
edge = [[0, 0], [2, 0]]
x = "free"
[[support]]
name = "corner"
point = [0, 0]
[history.p]
time = [0, 1]
value = [1e6, 1e6]
[[load]]
name = "top"
edge = [[0, 1], [2, 1]]
pressure = "p"
[bolt_type.t]
kind = "superposed"
diameter = "25 mm"
spacing = "0.1 m"
[[bolt]]
name = "v"
from = [0.7, 0]
to = [0.7, 1]
type = "t"
[[monitor]]
name = "m"
point = [1, 1]
[[stage]]
name = "s"
kind = "static"
duration = 10
unbalanced = 1e-9
)";
  const double bars = kEA / 0.1 / 2;  // a quarter of the rock's modulus, to tell
  const CaseResult r = run_case(text);
  const double shortening = -r.column("m.displacement_y [m]").back();
  // strains are those of F - I, against the reference area: no second-order term
  check_close("superposed: shortening [m]", shortening, 1e6 / (5e9 + bars), 1e-6, 1e-8);
  check_below("superposed: energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
}

TEST_CASE("rows of bolts cost no time step, and a grouted bar across two joints stays calm") {
  // three stones of 1250 kg in a row; between them grouted bars of some 2e8 N/m: steps of 20 ms are 11 times
  // the limit of an explicit spring
  std::string text = R"(talus = 1
[material.rock]
density = 2500
[bolt_type.t]
kind = "grouted"
diameter = "25 mm"
spacing = 1
[[bolt]]
name = "b"
from = [0.1, 0.5]
to = [2.9, 0.5]
type = "t"
[[stage]]
name = "s"
kind = "dynamic"
duration = 2
time_step = 0.02
)";
  for (int i = 0; i < 3; ++i)
    text += fmt::format(
        "[[block]]\nname = \"s{}\"\npolygon = [[{}, 0], [{}, 0], [{}, 0.5], [{}, 1], [{}, 1]]\nmaterial = "
        "\"rock\"\nkind = \"{}\"\nvelocity = [{}, 0]\n",
        i, i, i + 1, i + 1, i + 1, i, "rigid", i == 2 ? 0.01 : 0.0);
  double most = 0, moving = 0;
  const CaseResult r = run_case(text, {"block.s0.velocity=[0,0]"}, [&](const Instant& i) {
    if (i.state.step == 0) moving = i.report.energy.kinetic;
    most = std::max(most, i.report.energy.kinetic / moving);
    for (const BoltPart& p : bolt_parts(i.scene.blocks, i.state)) CHECK(p.condition == BoltPart::kElastic);
  });
  CHECK(most < 1 + 1e-9);
  // the momentum of one stone is that of three
  double momentum = 0;
  for (size_t k = 0; k < 3; ++k) momentum += r.state.rate[k].a.x;
  check_close("bolted stones: momentum", momentum, 0.01, 1e-12, 1e-14);
  check_close("bolted stones: velocity at the end", r.state.rate[2].a.x, 0.01 / 3, 1e-2, 1e-3);
  check_below("bolted stones: energy left over / largest term", r.run.closure(), 1e-2, 1e-9);
}

TEST_CASE("statics of a bar across three joints, drawn to and fro at random, is in balance every time") {
  // four stones, bars of 0.2 m, crossings 1e-6 diameters long: stiffnesses over seven powers of ten
  Random random(11);
  Bolt bolt;
  bolt.rupture_strain = 0.05;
  constexpr int kPieces = 4, kNodes = 6;
  for (int p = 0; p < kPieces; ++p)
    for (int k = 0; k < kNodes; ++k) {
      BoltNode n;
      n.stiffness = 2e8 * (k == 0 || k == kNodes - 1 ? 0.5 : 1), n.limit = 2e-4 * n.stiffness;
      bolt.nodes.push_back(n);
      if (bolt.nodes.size() == 1) continue;
      BoltSegment s;
      s.length = k == 0 ? 0 : 0.2, s.gauge = 0.2, s.yield = 2e5;
      s.stiffness = kEA / (k == 0 ? 2.5e-8 : 0.2);
      if (k == 0) s.crossing = p - 1;
      bolt.segments.push_back(s);
    }
  std::vector<double> rock(bolt.segments.size(), 0);
  double worst = 0;
  int ruptured = 0;
  for (int step = 0; step < 3000; ++step) {
    for (size_t j = 0; j < rock.size(); ++j) {
      const double size = bolt.segments[j].crossing >= 0 ? 1e-4 : 1e-6;
      rock[j] += size * (random.uniform() - 0.5) * (step % 100 == 0 ? 20 : 1);
    }
    ruptured += balance_bar(rock, bolt);
    double most = 1;
    for (const BoltSegment& s : bolt.segments) most = std::max(most, std::abs(s.force));
    for (size_t i = 0; i < bolt.nodes.size(); ++i) {
      const BoltNode& n = bolt.nodes[i];
      const double left = i > 0 ? bolt.segments[i - 1].force : 0,
                   right = i < bolt.segments.size() ? bolt.segments[i].force : 0;
      const double grout = n.stiffness * (n.slip - n.plastic);
      CHECK(std::abs(grout) <= n.limit * (1 + 1e-9));
      CHECK(std::abs(n.slip) < 1);  // not balanced by forces of metres of slip
      worst = std::max(worst, std::abs(left - right + grout) / most);
    }
  }
  // round-off of the stiff crossings
  check_below("bar at random: force out of balance / largest", worst, 1e-6, 1e-7);
  CHECK(ruptured <= 3);
}

}  // namespace test_bolts
