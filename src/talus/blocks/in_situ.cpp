#include "talus/blocks/in_situ.h"

namespace talus {

// Eq. 1.6.
Mat2 in_situ_stress(const InSituInput& input, Vec2 gravity, double height) {
  if (!input.with_depth) return input.stress;
  const double depth = input.level - height;
  const double vertical = input.pressure + input.density * norm(gravity) * depth;
  const double horizontal = std::isnan(input.k0)
                                ? input.horizontal_pressure + input.horizontal_gradient * depth
                                : input.k0 * vertical;
  return {-horizontal, 0, 0, -vertical};
}

std::vector<Mat2> initial_stresses(const Model& model, const BlockSet& blocks) {
  if (!model.in_situ.given) return {};
  std::vector<Mat2> stress(blocks.count);
  for (size_t i = 0; i < stress.size(); ++i)
    if (blocks.kind[i] == BlockKind::kDeformable)
      stress[i] = in_situ_stress(model.in_situ, model.gravity, blocks.centroid[i].y);
  return stress;
}

int block_above_ground(const Model& model, const BlockSet& blocks) {
  if (!model.in_situ.with_depth) return -1;
  for (int i = 0; i < blocks.count; ++i) {
    if (blocks.kind[i] == BlockKind::kDeformable && blocks.centroid[i].y > model.in_situ.level) return i;
  }
  return -1;
}

}  // namespace talus
