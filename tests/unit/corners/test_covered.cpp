// Corners over crossings of joints: which side they bear on, and what they remember.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "support/block_scene.h"
#include "support/relative.h"
#include "talus/corners/follow.h"

namespace test_covered {

using namespace talus;
using namespace talus::test;

namespace {

// Lower left and right, upper left and right; unit squares around (1, 1).
Scene crossing() {
  const auto free = BlockKind::kDeformable;
  return block_scene(jointed_rock(), {{box_polygon(0, 0, 1, 1), BlockKind::kFixed},
                                      {box_polygon(1, 0, 2, 1), free},
                                      {box_polygon(0, 1, 1, 2), free},
                                      {box_polygon(1, 1, 2, 2), free}});
}

// Returns how many pairs were sought.
int update(const Scene& scene, State& state) {
  const StepClock clock{1e-3};
  const LookAhead ahead{clock, state.rate};
  renew_pairs(scene.blocks, scene.bonds, scene.layout, joint_laws(scene.model.joints), ahead, Workers(),
              state);
  return update_contacts(scene.blocks, scene.bonds, scene.layout, ahead, Workers(), state).searched;
}

std::vector<Contact> contacts_of(const State& state, int a, int b) {
  for (const ContactPair& p : state.pairs)
    if (p.a == a && p.b == b)
      return {state.contacts.begin() + p.begin, state.contacts.begin() + p.begin + p.count};
  return {};
}

bool bears_sideways(const Scene& scene, const State& state, const Contact& c) {
  const CornerEdge over = corner_over_edge(scene.blocks, state, c.key.corner(), c.key.on());
  return std::abs(over.normal.x) > 0.1;
}

}  // namespace

TEST_CASE("a row of blocks pressed down slides over the joint below it without bearing on its side") {
  const Scene scene = crossing();
  for (const double closure : {1e-6, 2e-5, 1e-3, 0.02})
    for (const double open : {0.0, 0.1, 0.9})  // of the closure
      for (const double way : {0.01, 0.3, 0.9, 1.5, 4.0}) {
        CAPTURE(closure);
        CAPTURE(open);
        CAPTURE(way);
        State state = start_state(scene);
        state.displacement[1].x = open * closure;
        for (const size_t upper : {size_t{2}, size_t{3}})
          state.displacement[upper] = {way * closure, -closure};
        update(scene, state);
        bool level = false;
        for (const Contact& c : contacts_of(state, 1, 2)) {
          CHECK_FALSE(bears_sideways(scene, state, c));
          level = true;
        }
        // once it is over it by more than the joints overlap: none here
        if ((way - open) * closure > 2.1e-5) CHECK(level);
      }
}

TEST_CASE("a joint open by a hair, wider than the blocks have closed, does not catch a corner at its top") {
  const Scene scene = crossing();
  for (const double closure : {1e-6, 2e-5, 1e-4})
    for (const double open : {5e-5, 1.8e-4, 1e-3}) {
      CAPTURE(closure);
      CAPTURE(open);
      State state = start_state(scene);
      state.displacement[1].x = open;
      // the corner has gone beyond the joint by less than the closure
      state.displacement[2] = {open + 0.3 * closure, -closure};
      state.displacement[3] = {0.5, 0.5};  // and nothing stands beside it
      update(scene, state);
      const auto found = contacts_of(state, 1, 2);
      const bool sideways = std::any_of(found.begin(), found.end(),
                                        [&](const Contact& c) { return bears_sideways(scene, state, c); });
      // the side of one that stands open wider does
      if (open <= 2e-4) CHECK_FALSE(sideways);
      if (open > 2e-4 && closure > 1e-5) CHECK(sideways);
    }
}

TEST_CASE("a step higher than the closure stops a corner") {
  const Scene scene = crossing();
  State state = start_state(scene);
  state.displacement[1].y = 1e-3;  // the lower right one stands up
  for (const size_t upper : {size_t{2}, size_t{3}}) state.displacement[upper] = {1e-5, -1e-6};
  state.displacement[3] = {0.5, 0.5};  // and nothing is on it
  update(scene, state);
  const auto found = contacts_of(state, 1, 2);
  CHECK(std::any_of(found.begin(), found.end(),
                    [&](const Contact& c) { return bears_sideways(scene, state, c); }));
}

TEST_CASE("what bore a force stays on its side, covered, it goes where it is free") {
  const Scene scene = crossing();
  State state = start_state(scene);
  state.displacement[0].x = -0.05;  // the joint below is wide open: the corner falls in and bears on the side
  state.displacement[3] = {0.5, 0.5};
  state.displacement[2] = {2e-5, -1e-3};
  update(scene, state);
  REQUIRE(contacts_of(state, 1, 2).size() > 0);
  for (const Contact& c : contacts_of(state, 1, 2)) CHECK(bears_sideways(scene, state, c));
  for (Contact& c : state.contacts) c.memory = Contact::kWhole, c.force = {1e3, 0};
  state.displacement[2].x = 3e-3;  // deeper than the way up, and still held
  update(scene, state);
  for (const Contact& c : contacts_of(state, 1, 2)) CHECK(bears_sideways(scene, state, c));
  state.displacement[0].x = 0;  // the joint closes: the side is covered
  update(scene, state);
  REQUIRE(contacts_of(state, 1, 2).size() > 0);
  for (const Contact& c : contacts_of(state, 1, 2)) CHECK_FALSE(bears_sideways(scene, state, c));
}

TEST_CASE("a block that slides along the side that it covers is no reason to seek, one that leaves it is") {
  const Scene scene = crossing();
  State state = start_state(scene);
  for (const size_t upper : {size_t{2}, size_t{3}}) state.displacement[upper] = {1e-4, -1e-3};
  update(scene, state);
  const auto pair = [&](int a, int b) {
    const auto at = std::find_if(state.pairs.begin(), state.pairs.end(),
                                 [&](const ContactPair& p) { return p.a == a && p.b == b; });
    return state.followed[at - state.pairs.begin()];
  };
  // lower left and upper right: the others cover both sides
  REQUIRE(pair(0, 3).covers == 2);
  REQUIRE(pair(0, 3).reuse >= 0);
  const int always = update(scene, state);  // velocities decide some of the others in every step
  int its_own = 0;                          // of the lower right one
  for (size_t i = 0; i < state.pairs.size(); ++i)
    its_own += (state.pairs[i].a == 1 || state.pairs[i].b == 1) && state.followed[i].reuse >= 0;
  state.displacement[1].y += 1e-3;  // upwards, beside the whole of the side still
  CHECK(update(scene, state) == always + its_own);
  state.displacement[1].x += 3e-3;  // off it by more than the two overlap
  CHECK(update(scene, state) == always + its_own + 1);
}

TEST_CASE("an end of an interface keeps its memory when another corner comes to lie there") {
  const Scene scene = block_scene(jointed_rock(), {{box_polygon(0, 0, 1, 1), BlockKind::kFixed},
                                                   {box_polygon(0, 1, 1, 2), BlockKind::kDeformable}});
  State state = start_state(scene);
  state.displacement[1] = {1e-3, -1e-5};
  update(scene, state);
  REQUIRE(state.contacts.size() == 2);
  std::array<double, 2> off{1e-4, 3e-4};  // from where each end sticks
  for (Contact& c : state.contacts) {
    CHECK(c.face.side_lo >= 0);
    const int end = c.face.end;
    const CornerEdge over = corner_over_edge(scene.blocks, state, c.key.corner(), c.key.on());
    c.memory = Contact::kWhole, c.force = {1e3 + static_cast<double>(end), 10}, c.stretch = off[end];
    c.anchor = -over.along - off[end];  // edges of 1 m
  }
  const State before = state;
  state.displacement[1].x = -1e-3;  // to the left of the lower one now: other corners at both ends
  update(scene, state);
  REQUIRE(state.contacts.size() == 2);
  for (const Contact& c : state.contacts) {
    CHECK(std::none_of(before.contacts.begin(), before.contacts.end(),
                       [&](const Contact& o) { return o.key == c.key; }));
    CHECK(c.memory == Contact::kWhole);
    CHECK(c.force[0] == 1e3 + c.face.end);
    const CornerEdge over = corner_over_edge(scene.blocks, state, c.key.corner(), c.key.on());
    // it moved by 2 mm to the left; along the tangent of the upper block's corners that is less, of the lower
    // one's more
    const double now = -over.along - c.anchor, moved = std::abs(now - off[c.face.end]);
    CHECK(moved == approx(2e-3).epsilon(1e-9));
  }
}

TEST_CASE("an overlap that a hard point was born with is kept for now") {
  const Scene scene = block_scene(jointed_rock(), {{box_polygon(0, 0, 1, 1), BlockKind::kFixed},
                                                   {box_polygon(0, 1, 1, 2), BlockKind::kDeformable}});
  State state = start_state(scene);
  state.displacement[1].y = -2e-5;
  update(scene, state);
  REQUIRE(state.contacts.size() == 2);
  for (const Contact& c : state.contacts) CHECK(c.allowed == approx(2e-5).epsilon(1e-9));
}

}  // namespace test_covered
