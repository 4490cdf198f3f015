#include "talus/penalty/penalty_settings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/index.h"

namespace talus {

namespace {

// Penalty over the largest Young's modulus: in the middle of what is usual, 10 to 100.
constexpr double kPenaltyOfYoung = 40;

// Where no block deforms: under its weight the heaviest that moves sinks by this share of its size. Of 122 comparisons of
// the cases A2, A3d and A6 (blocks of some 20 kN) 58 hold on springs of 1e9 Pa, 69 of 1e10, 105 of 1e11, 117 of 1e12, 115 of
// 3e12, 117 of 1e14.
constexpr double kSinking = 3e-8;

double penalty_of(const Scene& scene) {
  double young = 0;
  for (const BlockShape& b : scene.layout.blocks) {
    if (b.kind != BlockKind::kDeformable || b.material < 0) continue;
    const double e = scene.model.materials[b.material].young;
    if (e > young) young = e;
  }
  if (young > 0) return kPenaltyOfYoung * young * scene.blocks.thickness;
  double stiffness = 0;
  const double g = std::max(norm(scene.model.gravity), 1.0);
  for (int i = 0; i < count_of(scene.blocks.mass); ++i)
    if (scene.blocks.moves_freely(i))
      stiffness = std::max(stiffness, scene.blocks.mass[i] * g / (kSinking * scene.blocks.size[i]));
  return stiffness;
}

// Half the height of what the blocks cover [m].
double half_height(const BlockSet& blocks) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int i = 0; i < blocks.count; ++i)
    for (int v = 0; v < blocks.vertex_count(i); ++v) {
      const double y = blocks.centroid[i].y + blocks.corner({i, v}).y;
      low = std::min(low, y), high = std::max(high, y);
    }
  return high > low ? 0.5 * (high - low) : std::numeric_limits<double>::infinity();
}

}  // namespace

PenaltySettings penalty_settings(const Scene& scene, const StageInput& stage) {
  const PenaltyInput& in = scene.model.penalty;
  const double thickness = scene.blocks.thickness;
  PenaltySettings s;
  const double normal = std::isnan(in.normal_stiffness) ? penalty_of(scene) : in.normal_stiffness * thickness;
  s.stiffness = {normal, in.shear_share * normal};
  s.support_stiffness = std::isnan(in.support_stiffness) ? normal : in.support_stiffness * thickness;
  if (in.mean_acceleration) s.scheme = {0.25, 0.5};
  s.exact_rotation = in.exact_rotation;
  s.most_iterations = in.most_iterations;
  s.dynamic_factor = stage.kind == StageKind::kStatic ? 0 : in.dynamic_factor;
  s.largest_displacement = in.largest_displacement * half_height(scene.blocks);
  return s;
}

}  // namespace talus
