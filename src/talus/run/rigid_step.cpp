#include "talus/run/rigid_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/blocks/given_motion.h"
#include "talus/corners/follow.h"
#include "talus/run/resolution.h"

namespace talus {

namespace {

// Blocks nearer than this share of the smallest one stand on each other.
constexpr double kTouch = 0.02;

// Steps, as share of sqrt(h/g): where blocks knock on each other when is known to a step, and the swings of rocking blocks
// are off in proportion to it, 0.9 % (rms) at the shorter one and 3.4 % at the longer one; motion that only leads to rest takes that,
// and conventional formulations.
constexpr double kKnocking = 0.005, kSettling = 0.02;

// Which blocks a chain of blocks in touch, bonds, supports and boundaries holds.
std::vector<char> held_blocks(const Scene& scene) {
  const BlockSet& blocks = scene.blocks;
  const int n = blocks.count;
  std::vector<std::vector<int>> beside(n);
  const auto join = [&](int a, int b) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  };
  for (const ContactPoint& c :
       find_contacts(blocks, scene.bonds, start_state(scene), kTouch * smallest_size(blocks)))
    join(c.key.block_a, c.key.block_b);
  for (const BondFace& f : scene.bonds.faces)
    if (blocks.interact(f.block_a, f.block_b)) join(f.block_a, f.block_b);

  std::vector<char> held(n, 0);
  std::vector<int> next;
  const auto hold = [&](int i) {
    if (held[i]) return;
    held[i] = 1;
    next.push_back(i);
  };
  for (int i = 0; i < blocks.count; ++i)
    if (!blocks.moves_freely(i)) hold(i);
  for (const SupportedPoint& p : scene.supported) hold(p.block);
  for (const BoundaryPoint& p : scene.boundaries.points) hold(p.block);
  while (!next.empty()) {
    const int i = next.back();
    next.pop_back();
    for (const int j : beside[i]) hold(j);
  }
  return held;
}

// How fast a block that nothing holds may fall, from where it is to the lowest place of the model, in this
// time [m/s].
double fastest_fall(const Scene& scene, double duration) {
  const BlockSet& blocks = scene.blocks;
  const double g = norm(scene.model.gravity);
  if (g == 0) return 0;
  const Vec2 down = scene.model.gravity / g;
  const auto depth_of = [&](int i) {
    double depth = -std::numeric_limits<double>::infinity();
    for (int v = 0; v < blocks.vertex_count(i); ++v)
      depth = std::max(depth, dot(down, blocks.centroid[i] + blocks.corner({i, v})));
    return depth;
  };
  const std::vector<char> held = held_blocks(scene);
  double lowest = -std::numeric_limits<double>::infinity(), highest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < blocks.count; ++i) {
    if (blocks.removed(i)) continue;
    lowest = std::max(lowest, depth_of(i));
    if (!held[i]) highest = std::min(highest, depth_of(i));
  }
  return std::isinf(highest) ? 0 : std::min(std::sqrt(2 * g * (lowest - highest)), g * duration);
}

}  // namespace

double rigid_step(const Scene& scene, const StageInput& stage) {
  const BlockSet& blocks = scene.blocks;
  double thickness = std::numeric_limits<double>::infinity();
  for (int i = 0; i < blocks.count; ++i)
    if (blocks.moves_freely(i)) thickness = std::min(thickness, blocks.thinness[i]);
  double step = std::numeric_limits<double>::infinity();
  const bool dynamic = stage.kind == StageKind::kDynamic;
  if (const double g = norm(scene.model.gravity); g > 0)
    step = (dynamic && scene.model.formulation == Formulation::kContactForces ? kKnocking : kSettling) *
           std::sqrt(thickness / g);
  if (const double v = fastest_given(scene.model, scene.layout, blocks) + fastest_fall(scene, stage.duration);
      v > 0)
    step = std::min(step, 0.1 * thickness / v);
  if (dynamic)
    for (const History& h : scene.model.histories)
      if (const double f = highest_frequency(h, InputKind::kForce); f > 0)
        step = std::min(step, 1 / (50 * f));
  return step;
}

}  // namespace talus
