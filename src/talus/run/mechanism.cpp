#include "talus/run/mechanism.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace talus {

namespace {

// What goes less far than this share of the others, each by its size, is carried along, or gives.
constexpr double kGoes = 0.1;

// What is so much slower than the fastest, each by its size, stands beside it.
constexpr double kStands = 0.01;

// What the others bear of a mechanism that does not fall, as share of its weight or, without gravity, of all forces.
constexpr double kBorne = 0.01;

}  // namespace

double pace_of_many(const BlockSet& blocks, const State& state) {
  std::vector<std::pair<double, double>> pace;  // and area
  double all = 0;
  for (int i = 0; i < blocks.count; ++i) {
    if (!blocks.moves_freely(i)) continue;
    const double area = blocks.size[i] * blocks.size[i];
    all += area;
    if (!state.is_left_out(i)) pace.emplace_back(norm(state.rate[i].a) / blocks.size[i], area);
  }
  std::sort(pace.begin(), pace.end(), std::greater<>());
  double faster = 0;
  for (const auto& [p, area] : pace)
    if (faster += area; faster >= kMechanismShare * all) return p;
  return 0;
}

Mechanism find_mechanism(const Scene& scene, const State& state) {
  Mechanism m;
  const BlockSet& blocks = scene.blocks;
  double fastest = 0;
  for (int i = 0; i < blocks.count; ++i)
    if (blocks.moves_freely(i) && !state.is_left_out(i))
      fastest = std::max(fastest, norm(state.rate[i].a) / blocks.size[i]);
  // beside a crumb that goes by itself the others stand
  const double many = pace_of_many(blocks, state),
               least = kGoes * (many >= kStands * fastest ? many : fastest);
  const auto goes = [&](int i) {
    return blocks.moves_freely(i) && !state.is_left_out(i) && norm(state.rate[i].a) > 0 &&
           norm(state.rate[i].a) >= least * blocks.size[i];
  };
  double farthest = 0, all = 0;
  for (int i = 0; i < blocks.count; ++i) {
    if (!blocks.moves_freely(i)) continue;
    all += blocks.size[i] * blocks.size[i];
    if (const double way = norm(state.rate[i].a); goes(i) && way > farthest) farthest = way, m.farthest = i;
  }
  if (m.farthest < 0) return m;
  m.direction = state.rate[m.farthest].a / farthest;
  double weight = 0;
  for (int i = 0; i < blocks.count; ++i) {
    if (!goes(i)) continue;
    m.members.push_back(i);
    m.area += blocks.size[i] * blocks.size[i];
    weight += blocks.mass[i] * norm(scene.model.gravity);
  }
  m.share = m.area / all;
  double borne = 0, forces = 0;
  for (const Patch& p : state.patches) {
    const double force = std::hypot(p.force[0][0] + p.force[1][0], p.force[0][1] + p.force[1][1]);
    forces += force;
    if (!(force > 0) || goes(p.block_a) == goes(p.block_b)) continue;
    borne += force;
    if (p.joint < 0) continue;
    const std::string& name = scene.model.joints[p.joint].name;
    if (std::find(m.joints.begin(), m.joints.end(), name) == m.joints.end()) m.joints.push_back(name);
  }
  m.slides = borne > kBorne * (weight > 0 ? weight : forces);
  std::sort(m.joints.begin(), m.joints.end());
  return m;
}

std::string Mechanism::text(const Scene& scene, const State& state) const {
  const Vec2 at = scene.blocks.centroid[farthest] + state.displacement[farthest];
  const bool one = members.size() == 1;
  std::string on;
  if (slides && !joints.empty())
    on = fmt::format(", on joint{} \"{}\"", joints.size() == 1 ? "" : "s", fmt::join(joints, "\", \""));
  return fmt::format(
      "{} block{}, {:.3g} m2 ({:.3g} % of what can move), {}{}; farthest \"{}\" at ({:.4g}, {:.4g}), along ({:.2f}, {:.2f})",
      members.size(), one ? "" : "s", area, 100 * share,
      slides ? (one ? "slides" : "slide") : (one ? "falls" : "fall"), on, scene.blocks.name[farthest], at.x,
      at.y, direction.x, direction.y);
}

}  // namespace talus
