#include "talus/results/reference.h"

#include "talus/base/index.h"

namespace talus {

PointMotion motion_of(const Instant& i, int block, Vec2 arm) {
  return {displacement_shown(i.state, block, arm),
          velocity_at(rate_now(i.work, i.state, block), acting_arm(i.scene.blocks, i.state, block, arm))};
}

std::vector<GroundMotion> ground_motions(const Instant& i) {
  std::vector<GroundMotion> out;
  const Model& model = i.scene.model;
  for (int s = 0; s < count_of(model.supports); ++s) {
    PointMotion mean;
    double count = 0;
    for (const SupportedPoint& p : i.scene.supported) {
      if (p.support != s) continue;
      const PointMotion motion = motion_of(i, p.block, p.arm);
      mean.displacement += motion.displacement, mean.velocity += motion.velocity, count += 1;
    }
    if (count > 0)
      out.push_back({model.supports[s].name, {}, {mean.displacement / count}, {mean.velocity / count}});
  }
  const FreeField& field = i.scene.boundaries.free_field;
  for (const GroundColumn& c : field.columns) {
    GroundMotion g;
    g.name = model.boundaries[c.boundary].name;
    for (int n = c.first_node; n <= c.first_node + c.elements; ++n) {
      g.height.push_back(field.height[n]);
      g.displacement.push_back(i.state.column_displacement[n]);
      g.velocity.push_back(i.work.columns.velocity[n]);
    }
    out.push_back(std::move(g));
  }
  return out;
}

Reference::Reference(const Scene& scene, const MonitorInput& m, double height) : height_(height) {
  const BlockSet& blocks = scene.blocks;
  for (const Vec2 point : m.relative_to_points) {
    const int block = block_of_point(scene.layout, point);
    parts_.push_back({block, point - blocks.centroid[block], 1});
  }
  if (!m.relative_to.empty()) refer_to(scene, m.relative_to);
  double sum = 0;
  for (const Part& p : parts_) sum += p.weight;
  for (Part& p : parts_) p.weight /= sum;
}

void Reference::refer_to(const Scene& scene, const std::string& name) {
  for (const SupportedPoint& p : scene.supported)
    if (scene.model.supports[p.support].name == name) parts_.push_back({p.block, p.arm, 1});
  const std::vector<GroundColumn>& columns = scene.boundaries.free_field.columns;
  for (size_t c = 0; c < columns.size() && parts_.empty(); ++c)
    if (scene.model.boundaries[columns[c].boundary].name == name) column_ = static_cast<int>(c);
  if (!parts_.empty() || column_ >= 0) return;
  for (const int b : scene.layout.blocks_called(name)) parts_.push_back({b, {}, scene.blocks.mass[b]});
}

PointMotion Reference::at(const Instant& i) const {
  if (column_ >= 0) {
    const FreeField& field = i.scene.boundaries.free_field;
    const GroundColumn& column = field.columns[column_];
    return {at_height(field, column, height_, i.state.column_displacement),
            at_height(field, column, height_, i.work.columns.velocity)};
  }
  PointMotion mean;
  for (const Part& p : parts_) {
    const PointMotion motion = motion_of(i, p.block, p.arm);
    mean.displacement += p.weight * motion.displacement;
    mean.velocity += p.weight * motion.velocity;
  }
  return mean;
}

}  // namespace talus
