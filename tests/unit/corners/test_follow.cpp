// Pairs kept from step to step: contacts that are followed against contacts that are sought anew.

#include "talus/base/index.h"
#include "talus/corners/follow.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "support/block_scene.h"
#include "talus/step/step.h"

namespace test_pairs {

using namespace talus;
using namespace talus::test;

namespace {

constexpr double kMargin = 0.02;

// Blocks with one joint everywhere; the first is fixed.
Scene scene_of(const std::vector<Polygon>& polygons, double strength = 0) {
  Model model = jointed_rock();
  model.joints[0].cohesion = model.joints[0].tensile_strength = strength;
  model.solver.method = SolverKind::kGaussSeidel;
  std::vector<ScenePart> parts;
  for (const Polygon& p : polygons)
    parts.push_back({p, parts.empty() ? BlockKind::kFixed : BlockKind::kDeformable});
  return block_scene(std::move(model), parts);
}

// Bricks of 1 x 0.5 m in running bond on a floor.
Scene small_wall(int columns, int courses) {
  std::vector<Polygon> bricks{box_polygon(-3, -1, columns + 3, 0)};
  for (int course = 0; course < courses; ++course)
    for (int i = 0; i < columns; ++i) {
      const double left = i + 0.5 * (course % 2), bottom = 0.5 * course;
      bricks.push_back(box_polygon(left, bottom, left + 1, bottom + 0.5));
    }
  return scene_of(bricks);
}

// Polygons of 5 to 8 corners that nearly touch.
Scene small_pile(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Polygon> stones{box_polygon(-3, -3, 9, -0.5)};
  for (int k = 0; k < 36; ++k) {
    const Vec2 center{0.98 * (k % 6), 0.98 * (k / 6)};
    const int corners = 5 + k % 4;
    const double phase = 3 * unit(random);
    Polygon stone;
    for (int i = 0; i < corners; ++i) {
      const double angle = phase + 6.283185307 * (i + 0.2 * unit(random)) / corners;
      stone.push_back(center + 0.5 * Vec2{std::cos(angle), std::sin(angle)});
    }
    stones.push_back(stone);
  }
  return scene_of(stones);
}

int update(const Scene& scene, State& state) {
  const StepClock clock{1e-3};
  const LookAhead ahead{clock, state.rate};
  renew_pairs(scene.blocks, scene.bonds, scene.layout, joint_laws(scene.model.joints), ahead, Workers(),
              state);
  return update_contacts(scene.blocks, scene.bonds, scene.layout, ahead, Workers(), state).searched;
}

// The same, every pair sought anew: what was in touch stays on its side.
State sought_anew(const Scene& scene, State state) {
  for (FollowedPair& p : state.followed) p.reuse = -1;
  update(scene, state);
  return state;
}

const ContactPair* pair_of(const State& state, int a, int b) {
  for (const ContactPair& p : state.pairs)
    if (p.a == a && p.b == b) return &p;
  return nullptr;
}

std::vector<Contact> contacts_of(const State& state, int a, int b) {
  const ContactPair* p = pair_of(state, a, b);
  if (!p) return {};
  const auto from = state.contacts.begin() + p->begin;
  return {from, from + p->count};
}

std::vector<ContactKey> keys_of(const std::vector<Contact>& contacts) {
  std::vector<ContactKey> keys;
  for (const Contact& c : contacts) keys.push_back(c.key);
  return keys;
}

// Those with a gap below half the margin: the others may be found a quarter of it late.
std::vector<ContactKey> near(const Scene& scene, const State& state, const std::vector<Contact>& contacts) {
  std::vector<ContactKey> keys;
  for (const ContactKey& key : keys_of(contacts))
    if (corner_over_edge(scene.blocks, state, key.corner(), key.on()).gap < 0.5 * kMargin)
      keys.push_back(key);
  return keys;
}

std::vector<Vec2> corners_now(const Scene& scene, const State& state, int i) {
  std::vector<Vec2> corners;
  for (int v = 0; v < scene.blocks.vertex_count(i); ++v)
    corners.push_back(scene.blocks.centroid[i] + offset_now(state, i, scene.blocks.corner({i, v})));
  return corners;
}

// Marks every contact as one that bore a force, different for each.
void remember_all(State& state) {
  double n = 100;
  for (Contact& c : state.contacts) {
    c.memory = Contact::kWhole;
    c.force = {n, 0.1 * n};
    c.anchor = 1e-3 * n, c.stretch = 1e-6 * n;
    n += 1;
  }
}

void move_at_random(std::mt19937& random, double size, State& state) {
  std::uniform_real_distribution<double> unit(-size, size);
  for (size_t i = 1; i < state.rate.size(); ++i) {
    state.displacement[i] += Vec2{unit(random), unit(random)};
    state.strain_part[i] += Mat2{0.1 * unit(random), unit(random), unit(random), 0.1 * unit(random)};
  }
}

// Lists are in order and pairs own the contacts one after the other.
void check_order(const State& state) {
  int next = 0;
  for (size_t i = 0; i < state.pairs.size(); ++i) {
    const ContactPair& p = state.pairs[i];
    CHECK(p.begin == next);
    CHECK(p.a < p.b);
    if (i > 0) CHECK(std::pair(state.pairs[i - 1].a, state.pairs[i - 1].b) < std::pair(p.a, p.b));
    for (int k = 0; k < p.count; ++k) {
      const ContactKey& key = state.contacts[p.begin + k].key;
      CHECK(std::min(key.block_a, key.block_b) == p.a);
      CHECK(std::max(key.block_a, key.block_b) == p.b);
    }
    next += p.count;
  }
  CHECK(next == count_of(state.contacts));
}

}  // namespace

TEST_CASE("random small motions: the contacts that are followed are those that would be found") {
  for (const bool wall : {true, false}) {
    CAPTURE(wall);
    const Scene scene = wall ? small_wall(6, 5) : small_pile(1);
    std::mt19937 random(3);
    State state = start_state(scene);
    update(scene, state);
    remember_all(state);
    CHECK(state.contacts.size() > 15);
    int searched = 0, followed = 0, differ = 0;
    for (int step = 0; step < 200; ++step) {
      const State before = state;
      // far below what a pair may move unsought (a thousandth of a brick), and above what it may near a
      // corner
      move_at_random(random, 3e-5, state);
      searched += update(scene, state);
      check_order(state);
      const State anew = sought_anew(scene, state);
      for (const ContactPair& p : anew.pairs) {
        const ContactPair* kept = pair_of(state, p.a, p.b);
        REQUIRE(kept != nullptr);
        const ContactPair* old = pair_of(before, p.a, p.b);
        const auto arm = [](const State& of, const ContactPair* one) {
          return of.followed[one - of.pairs.data()].arm;
        };
        const bool sought = !old || norm(arm(before, old) - arm(state, kept)) != 0;
        const auto now = contacts_of(state, p.a, p.b);
        if (sought) {
          CHECK(keys_of(now) == keys_of(contacts_of(anew, p.a, p.b)));
          continue;
        }
        // not sought: the points of before, and memory with them
        ++followed;
        const auto then = contacts_of(before, p.a, p.b);
        CHECK(keys_of(now) == keys_of(then));
        for (size_t i = 0; i < now.size(); ++i) {
          CHECK(now[i].force == then[i].force);
          CHECK(now[i].memory == then[i].memory);
          CHECK(now[i].anchor == then[i].anchor);
        }
        differ += near(scene, state, now) != near(scene, state, contacts_of(anew, p.a, p.b));
      }
    }
    CHECK(searched > 0);
    CHECK(followed > searched);
    // a pair is followed for half of what could change its points, or less
    CHECK(differ == 0);
  }
}

TEST_CASE("nothing is sought where nothing moves, or all moves together") {
  const Scene scene = small_wall(5, 4);
  State state = start_state(scene);
  const int all = update(scene, state);
  CHECK(all == count_of(state.pairs));
  const auto first = keys_of(state.contacts);
  CHECK(update(scene, state) == 0);
  CHECK_FALSE(renew_pairs(scene.blocks, scene.bonds, scene.layout, joint_laws(scene.model.joints),
                          {StepClock{1e-3}, state.rate}, Workers(), state));
  for (Vec2& d : state.displacement) d += Vec2{0.25, -0.5};
  CHECK(update(scene, state) == 0);
  CHECK(keys_of(state.contacts) == first);
  // one brick of the top course moves: the pairs it belongs to, no others
  const int moved = scene.blocks.count - 2;
  state.displacement[moved] += Vec2{0, 2e-3};
  int its_own = 0;
  for (const ContactPair& p : state.pairs) its_own += p.a == moved || p.b == moved;
  CHECK(update(scene, state) == its_own);
  CHECK(its_own >= 3);
}

TEST_CASE("a pair that comes together faster than it looks ahead is sought anew, and keeps its memory") {
  const Scene scene = small_wall(5, 4);
  State state = start_state(scene);
  update(scene, state);
  remember_all(state);
  const State before = state;
  const size_t fast = static_cast<size_t>(scene.blocks.count) - 2;
  state.rate[fast].a = {0, 20};  // 20 mm in a step, the margin is 14 mm
  int its_own = 0;
  for (const ContactPair& p : state.pairs)
    its_own += static_cast<size_t>(p.a) == fast || static_cast<size_t>(p.b) == fast;
  CHECK(update(scene, state) == its_own);
  REQUIRE(keys_of(state.contacts) == keys_of(before.contacts));
  for (size_t i = 0; i < state.contacts.size(); ++i) {
    CHECK(state.contacts[i].force == before.contacts[i].force);
    CHECK(state.contacts[i].memory == Contact::kWhole);
  }
}

TEST_CASE("how far a pair looks ahead is a matter of its two blocks") {
  const Scene scene = small_wall(5, 4);
  State state = start_state(scene);
  const size_t bullet = 3;
  state.rate[bullet].a = {100, 0};
  update(scene, state);
  int others = 0;
  for (const ContactPair& p : state.pairs) {
    const bool its_own = static_cast<size_t>(p.a) == bullet || static_cast<size_t>(p.b) == bullet;
    const double rest = 0.02 * std::min(scene.blocks.size[p.a], scene.blocks.size[p.b]);
    CHECK((its_own ? p.margin > 10 * rest : p.margin == rest));
    others += !its_own;
  }
  CHECK(others > 20);
}

TEST_CASE("`reuse` is never more than a quarter of the margin") {
  for (const bool wall : {true, false}) {
    const Scene scene = wall ? small_wall(5, 4) : small_pile(2);
    State state = start_state(scene);
    std::mt19937 random(4);
    for (int step = 0; step < 10; ++step) {
      update(scene, state);
      for (size_t i = 0; i < state.pairs.size(); ++i)
        CHECK(state.followed[i].reuse <= 0.25 * state.pairs[i].margin);
      move_at_random(random, 1e-3, state);
    }
  }
}

TEST_CASE("memory goes with the key, a corner that passes to the next edge keeps its force, not its anchor") {
  // a wedge with its tip on a floor of two edges that meet at a slight angle
  const Polygon floor{{-3, -1}, {3, -1}, {3, -0.02}, {0, 0}, {-3, -0.02}},
      wedge{{0.1, 0.002}, {0.6, 1}, {-0.4, 1}};
  const Scene scene = scene_of({floor, wedge});
  State state = start_state(scene);
  update(scene, state);
  REQUIRE(contacts_of(state, 0, 1).size() == 1);
  CHECK(state.contacts[0].memory == Contact::kNone);
  const ContactKey right = state.contacts[0].key;
  CHECK(right == ContactKey{1, 0, 0, 2});
  remember_all(state);
  const Contact known = state.contacts[0];

  State along = state;
  along.displacement[1] += Vec2{0.05, 0};
  CHECK(update(scene, along) == 1);
  CHECK(along.contacts.at(0).key == right);
  CHECK(along.contacts[0].memory == Contact::kWhole);
  CHECK(along.contacts[0].force == known.force);
  CHECK(along.contacts[0].anchor == known.anchor);
  CHECK(along.contacts[0].stretch == known.stretch);

  State over = state;
  over.displacement[1] += Vec2{-0.2, 0};
  CHECK(update(scene, over) == 1);
  REQUIRE(over.contacts.size() == 1);
  CHECK(over.contacts[0].key == ContactKey{1, 0, 0, 3});
  CHECK(over.contacts[0].memory == Contact::kPassed);
  CHECK(over.contacts[0].force == known.force);
  CHECK(over.contacts[0].stretch == known.stretch);
  CHECK(over.contacts[0].anchor != known.anchor);
  // lifted within the list of pairs: no contact; back again: a new one
  State lifted = state;
  lifted.displacement[1] += Vec2{0, 0.03};
  update(scene, lifted);
  CHECK(lifted.contacts.empty());
  CHECK(pair_of(lifted, 0, 1) != nullptr);
  lifted.displacement[1] = {};
  update(scene, lifted);
  REQUIRE(lifted.contacts.size() == 1);
  CHECK(lifted.contacts[0].memory == Contact::kNone);
}

TEST_CASE("a pair that leaves the list and comes back has no memory") {
  const Scene scene = scene_of({box_polygon(-3, -1, 3, 0), box_polygon(0, 0, 1, 1), box_polygon(1, 0, 2, 1)});
  State state = start_state(scene);
  update(scene, state);
  remember_all(state);
  const auto first = keys_of(state.contacts), others = keys_of(contacts_of(state, 0, 2));
  CHECK_FALSE(contacts_of(state, 0, 1).empty());
  state.displacement[1] = {0, 5};
  update(scene, state);
  CHECK(pair_of(state, 0, 1) == nullptr);
  CHECK(pair_of(state, 1, 2) == nullptr);
  CHECK(keys_of(contacts_of(state, 0, 2)) == others);
  for (const Contact& c : contacts_of(state, 0, 2)) CHECK(c.memory == Contact::kWhole);
  state.displacement[1] = {};
  update(scene, state);
  CHECK(keys_of(state.contacts) == first);
  for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 2)})
    for (const Contact& c : contacts_of(state, a, b)) {
      CHECK(c.memory == Contact::kNone);
      CHECK(c.force == std::array<double, 2>{0, 0});
    }
  check_order(state);
}

TEST_CASE("no contacts where faces hold, until they break") {
  const Scene scene =
      scene_of({box_polygon(-3, -1, 3, 0), box_polygon(0, 0, 1, 1), box_polygon(0, 1, 1, 2)}, 1e5);
  REQUIRE(scene.bonds.faces.size() == 2);
  State state = start_state(scene);
  CHECK(update(scene, state) == 0);
  CHECK(state.contacts.empty());
  CHECK(pair_of(state, 1, 2) != nullptr);
  std::mt19937 random(5);
  move_at_random(random, 1e-3, state);
  CHECK(update(scene, state) == 0);
  CHECK(state.contacts.empty());
  const size_t upper = scene.bonds.faces[0].block_a == 1 ? 0 : 1;
  state.face[upper].broken = true;
  CHECK(update(scene, state) == 1);
  CHECK(contacts_of(state, 1, 2).size() == 2);
  CHECK(contacts_of(state, 0, 1).empty());
  state.face[1 - upper].broken = true;
  CHECK(update(scene, state) == 1);
  CHECK(contacts_of(state, 0, 1).size() == 2);
  for (const Contact& c : state.contacts) CHECK(c.memory == Contact::kNone);
  check_order(state);
}

TEST_CASE("the list holds all pairs that are closer than the margin, however blocks move") {
  const Scene scene = small_pile(3);
  std::mt19937 random(6);
  State state = start_state(scene);
  int rebuilds = 0;
  for (int step = 0; step < 60; ++step) {
    rebuilds += renew_pairs(scene.blocks, scene.bonds, scene.layout, joint_laws(scene.model.joints),
                            {StepClock{1e-3}, state.rate}, Workers(), state);
    std::vector<Box> boxes;
    for (int i = 0; i < scene.blocks.count; ++i) boxes.push_back(bounding_box(corners_now(scene, state, i)));
    // of stones, which all are as large as each other
    for (const auto& [a, b] : close_pairs(boxes, 0.015)) CHECK(pair_of(state, a, b) != nullptr);
    move_at_random(random, 5e-3, state);
  }
  CHECK(rebuilds == state.candidates.rebuilds);
  CHECK(rebuilds > 2);
  CHECK(rebuilds < 60);
}

}  // namespace test_pairs
