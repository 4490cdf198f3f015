// The ways of a pair that all others are known to be behind: what is looked at less is found the same.

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "support/block_scene.h"
#include "talus/blocks/state_fields.h"
#include "talus/step/step.h"

namespace test_lead {

using namespace talus;
using namespace talus::test;

namespace {

constexpr size_t kSlider = 24;

// Stones of 4 to 20 corners, which fall, spin and roll, every fifth of them long, and a box that slides, all over a floor of
// several blocks.
Scene falling_stones(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  Model model = jointed_rock();
  model.gravity = {0, -9.81};
  if (seed % 2 == 0) model.joints[0].normal_stiffness = model.joints[0].shear_stiffness = 1e9;
  std::vector<ScenePart> stones;
  for (size_t k = 0; k < kSlider; ++k)
    stones.push_back(
        {box_polygon(-6 + 0.7 * static_cast<double>(k), -3, -5.3 + 0.7 * static_cast<double>(k), -0.8),
         BlockKind::kFixed});
  stones.push_back({box_polygon(-5, -0.8, -4, -0.2), BlockKind::kRigid});
  for (int k = 0; k < 30; ++k) {
    const int corners = 4 + 4 * (k % 5);
    const double phase = 3 * unit(random), high = k % 5 == 0 ? 0.15 : 0.45;
    Polygon stone;
    for (int i = 0; i < corners; ++i) {
      const double angle = phase + 2 * M_PI * (i + 0.2 * unit(random)) / corners;
      stone.push_back({1.1 * (k % 6) + 0.45 * std::cos(angle), 1.1 * (k / 6) + high * std::sin(angle)});
    }
    stones.push_back({stone, k % 2 == 0 ? BlockKind::kRigid : BlockKind::kDeformable});
  }
  return block_scene(std::move(model), stones);
}

std::vector<double> numbers_of(const State& state) {
  std::vector<double> all;
  const auto put = [&](const char*, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, Vec2>)
      all.insert(all.end(), {value.x, value.y});
    else if constexpr (std::is_arithmetic_v<Value>)
      all.push_back(static_cast<double>(value));
    else
      for (const auto v : value) all.push_back(v);
  };
  for (const Patch& p : state.patches) each_field(p, put);
  return all;
}

}  // namespace

TEST_CASE("patches: looking at the ways that lead alone finds the same bits as looking at all") {
  const double dt = 1e-3;
  long led = 0, looked = 0, changed = 0;
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const Scene scene = falling_stones(seed);
    std::mt19937 random(100 + seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    State leading = start_state(scene);
    leading.rate[kSlider].a = {3, 0};
    for (size_t i = kSlider + 1; i < leading.rate.size(); ++i) {
      const double spin = 6 * unit(random);
      leading.rate[i] = {{unit(random), unit(random)}, {0, -spin, spin, 0}};
    }
    State all = leading;
    StepSettings settings;
    settings.tolerance = 1e-9, settings.implicit = true;
    StepWork work, work_of_all;
    std::vector<int> way;
    for (int step = 0; step < 1500; ++step) {
      for (const ContactPair& p : leading.pairs) led += p.count > 0 && p.lead > 0, looked += p.count;
      for (ContactPair& p : all.pairs) p.lead = 0;
      for (auto& [state, step_work] : {std::pair<State*, StepWork*>{&leading, &work}, {&all, &work_of_all}}) {
        StepReport report = kick(scene, settings, dt, *step_work, *state);
        drift(scene, state->time + dt, *step_work, *state, report);
      }
      REQUIRE(numbers_of(leading) == numbers_of(all));
      if (way.size() == leading.patches.size())
        for (size_t k = 0; k < way.size(); ++k) changed += way[k] != leading.patches[k].way;
      way.clear();
      for (const Patch& p : leading.patches) way.push_back(p.way);
    }
  }
  // both happen
  CHECK(led > looked / 3);
  CHECK(changed > 50);
  MESSAGE(led, " of ", looked, " patches led, ", changed, " changed their way");
}

}  // namespace test_lead
