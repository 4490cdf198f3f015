#include "talus_engine.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/base/version.h"

namespace talus::bench {

Scene talus_scene(const BenchScene& scene, const EngineOptions& options) {
  Model model;
  model.materials.push_back({"rock", scene.density, 5e9, 0.29});
  JointProperty joint;
  joint.name = "joint";
  joint.friction_angle = std::atan(scene.friction);
  joint.normal_stiffness = joint.shear_stiffness = options.stiffness;
  model.joints.push_back(joint);
  model.default_joint = 0;
  model.gravity = {0, -kGravity};
  model.solver.method = options.method;
  model.solver.max_sweeps = options.sweeps;
  model.solver.tolerance = options.tolerance;
  model.solver.second_solver = false;
  Layout layout;
  layout.default_joint = 0;
  layout.groups = {"blocks"};
  layout.group_where.emplace_back();
  for (const BenchBlock& b : scene.blocks) {
    BlockShape shape;
    shape.name = fmt::format("b{}", layout.blocks.size());
    shape.polygon = b.corners;
    shape.kind = b.fixed ? BlockKind::kFixed : options.rigid ? BlockKind::kRigid : BlockKind::kDeformable;
    layout.blocks.push_back(std::move(shape));
  }
  return build_scene(std::move(model), std::move(layout));
}

TalusEngine::TalusEngine(const BenchScene& scene, const EngineOptions& options)
    : scene_(talus_scene(scene, options)), state_(start_state(scene_)) {
  settings_.tolerance =
      options.tolerance * *std::min_element(scene_.blocks.size.begin(), scene_.blocks.size.end());
  settings_.implicit = options.implicit;
  settings_.damping_local = options.damping_local;
  work_.workers = Workers(options.threads);
}

std::string TalusEngine::name() const { return fmt::format("talus-{}", kVersion); }

void TalusEngine::step(double dt) {
  const Timed timed(wall_);
  report_ = kick(scene_, settings_, dt, work_, state_);
  drift(scene_, state_.time + dt, work_, state_, report_);
}

std::vector<BenchBlock> TalusEngine::blocks() const {
  std::vector<BenchBlock> list;
  for (int i = 0; i < scene_.blocks.count; ++i) {
    BenchBlock b{!scene_.blocks.moves_freely(i), {}};
    for (int v = 0; v < scene_.blocks.vertex_count(i); ++v)
      b.corners.push_back(scene_.blocks.centroid[i] + offset_now(state_, i, scene_.blocks.corner({i, v})));
    list.push_back(std::move(b));
  }
  return list;
}

std::vector<BenchContact> TalusEngine::contacts() const {
  std::vector<BenchContact> list;
  const RowRange range = work_.rows.range(Family::kContact);
  for (size_t r = range.begin; r < range.end; ++r) {
    const PointRows& p = work_.rows.points[r];
    const int a = p.block_a;
    const auto u = relative_velocity(p, state_.rate);
    BenchContact c;
    c.a = p.block_b, c.b = p.block_a;
    c.point = scene_.blocks.centroid[a] + state_.displacement[a] + p.arm_a;
    c.normal = p.normal;
    c.normal_impulse = work_.rows.impulse[r][0], c.tangent_impulse = -work_.rows.impulse[r][1];
    c.relative_velocity = u[0] * p.normal + u[1] * turn_right(p.normal);
    list.push_back(c);
  }
  return list;
}

}  // namespace talus::bench
