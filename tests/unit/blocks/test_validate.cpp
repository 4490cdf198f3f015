// Promises of blocks, states and rows: each breach is told, and what a step leaves behind breaks none.

#include "talus/blocks/validate.h"

#include <doctest/doctest.h>

#include <stdexcept>

#include "support/block_scene.h"
#include "support/box_polygon.h"
#include "talus/rows/validate_rows.h"
#include "talus/step/step.h"

namespace test_validate {

using namespace talus;
using namespace talus::test;

namespace {

// A brick on two others that stand side by side, one step on.
struct Bricks {
  Bricks() {
    Model model = plain_rock();
    model.gravity = {0, -9.81};
    scene = laid_out_scene(std::move(model),
                           {box_polygon(0, 0, 1, 1), box_polygon(1, 0, 2, 1), box_polygon(0.5, 1, 1.5, 2)});
    state = start_state(scene);
    StepSettings settings;
    settings.tolerance = 1e-9;
    kick(scene, settings, 1e-4, work, state);
  }
  Scene scene;
  State state;
  StepWork work;
};

// What is said of the bricks once `harm` has been done to them; "" when nothing is.
std::string said(const std::function<void(Bricks&)>& harm) {
  Bricks bricks;
  harm(bricks);
  try {
    validate(bricks.scene.blocks);
    validate(bricks.state, bricks.scene.blocks);
    validate(bricks.work.rows, bricks.scene.blocks.count);
  } catch (const std::logic_error& e) {
    return e.what();
  }
  return "";
}

void check_said(const std::function<void(Bricks&)>& harm, const std::string& piece) {
  const std::string text = said(harm);
  INFO(text, " should hold: ", piece);
  CHECK(text.find(piece) != std::string::npos);
}

}  // namespace

TEST_CASE("validate: a step keeps every promise") {
  const Bricks bricks;
  REQUIRE(bricks.state.patches.size() >= 2);
  REQUIRE(bricks.state.pairs.size() == 3);
  REQUIRE(bricks.work.rows.size() == 2 * bricks.state.patches.size());
  CHECK(said([](Bricks&) {}) == "");
  // motions that are not finite are told by the run, with time and block
  CHECK(said([](Bricks& b) {
          b.state.rate[0].a.x = std::nan(""), b.work.rows.impulse[0][0] = std::nan("");
        }) == "");
}

TEST_CASE("validate: blocks") {
  check_said([](Bricks& b) { b.scene.blocks.mass.pop_back(); }, "masses has 2 entries, not 3");
  check_said([](Bricks& b) { b.scene.blocks.mass[1] = -1; }, "block 1 has a mass of -1");
  check_said([](Bricks& b) { b.scene.blocks.polar_inertia[2] = std::nan(""); },
             "block 2 has a polar inertia of nan");
  check_said([](Bricks& b) { std::swap(b.scene.blocks.arm[0], b.scene.blocks.arm[2]); },
             "block 0 runs clockwise");
  check_said([](Bricks& b) { b.scene.blocks.vertex_begin[1] = 2; }, "block 0 has 2 corners");
  check_said([](Bricks& b) { b.scene.blocks.arm.pop_back(); }, "arms of corners has 11 entries, not 12");
  check_said([](Bricks& b) { b.scene.blocks.centroid[1].y = INFINITY; }, "centroid of block 1 is not finite");
  check_said([](Bricks& b) { b.scene.blocks.radius[1] = 0; }, "block 1 has no size");
}

TEST_CASE("validate: states") {
  check_said([](Bricks& b) { b.state.rate.emplace_back(); }, "rates has 4 entries, not 3");
  check_said([](Bricks& b) { b.state.initial_stress.emplace_back(); },
             "initial stresses has 1 entries, not 3");
  check_said([](Bricks& b) { b.state.bond_force.emplace_back(); }, "forces of faces has 1 entries, not 0");
  check_said([](Bricks& b) { b.state.step = -1; }, "step -1");
  check_said([](Bricks& b) { std::swap(b.state.pairs[0].a, b.state.pairs[0].b); }, "are no pair");
  check_said([](Bricks& b) { b.state.pairs[1] = b.state.pairs[0]; }, "pair 1 is out of order");
  check_said([](Bricks& b) { b.state.pairs[0].begin = 1; }, "begin at 1, not 0");
  check_said([](Bricks& b) { b.state.pairs[0].face = 0; }, "have face 0 of 0");
  check_said([](Bricks& b) { b.state.followed.resize(1 + b.state.pairs.size()); }, "are followed");
  check_said(
      [](Bricks& b) {
        b.state.followed.resize(b.state.pairs.size());
        b.state.followed[0].covers = 1, b.state.followed[0].cover[0].block = 3;
      },
      "block 3 of 3 covers a side");
  check_said([](Bricks& b) { b.state.contacts.emplace_back(); }, "has contacts and patches");
  check_said([](Bricks& b) { b.state.patches.emplace_back(); }, "contacts of");
  check_said([](Bricks& b) { b.state.patches[0].block_a = 2; }, "is listed with those of 0 and 1");
  check_said([](Bricks& b) { b.state.patches[0].part_b = -1; }, "has no parts");
  check_said([](Bricks& b) { b.state.patches[0].side_a = 4; }, "lies on sides 4 and");
  check_said([](Bricks& b) { b.state.patches[0].joint = -2; }, "has joints -2");
  check_said([](Bricks& b) { b.state.patches[0].length = 0; }, "has length 0");
  check_said([](Bricks& b) { b.state.candidates.neighbours.block[0] = 3; }, "neighbour 3 is no block");
  check_said([](Bricks& b) { b.state.candidates.skin.pop_back(); }, "skins has 2 entries, not 3");
  check_said([](Bricks& b) { b.state.column_rate.emplace_back(); }, "rates of columns");
  check_said(
      [](Bricks& b) {
        Bolt bolt;
        bolt.nodes.resize(2), bolt.nodes[0].block = 0, bolt.nodes[1].block = 3, bolt.segments.resize(1);
        b.state.bolts = {bolt};
      },
      "a bolt is held in block 3");
  check_said(
      [](Bricks& b) {
        Bolt bolt;
        bolt.nodes.resize(2), bolt.nodes[0].block = 0, bolt.nodes[1].block = 1;
        bolt.segments.resize(1), bolt.segments[0].crossing = 0;
        b.state.bolts = {bolt};
      },
      "a bolt has no crossing 0");
}

TEST_CASE("validate: rows") {
  check_said([](Bricks& b) { b.work.rows.impulse.pop_back(); }, "without an impulse");
  check_said([](Bricks& b) { b.work.rows.owner[0].family = Family::kTie; }, "among those of another family");
  check_said([](Bricks& b) { b.work.rows.points[0].block_a = 3; }, "row 0 (contact): ties no block");
  check_said([](Bricks& b) { b.work.rows.points[0].block_a = b.work.rows.points[0].block_b; }, "to itself");
  check_said([](Bricks& b) { b.work.rows.points[1].normal *= 1.001; }, "row 1 (contact): its normal");
  check_said([](Bricks& b) { b.work.rows.points[0].upper = -1; }, "its bounds cross");
  check_said([](Bricks& b) { b.work.rows.points[0].friction = -0.1; }, "its friction is negative");
  check_said([](Bricks& b) { b.work.rows.points[0].row[1].compliance = -1; }, "its compliance is negative");
  check_said([](Bricks& b) { b.work.rows.points[0].partner = 99; }, "its partner is not there");
  check_said([](Bricks& b) { b.work.rows.points[0].partner = 1, b.work.rows.points[1].partner = -1; },
             "its partner has another one");
}

}  // namespace test_validate
