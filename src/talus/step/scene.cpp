#include "talus/step/scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/base/error.h"
#include "talus/blocks/in_situ.h"
#include "talus/model/joint_law.h"
#include "talus/step/energy.h"

namespace talus {

Scene::Scene() = default;
Scene::Scene(const Scene&) = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene&) = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

namespace {

// Whether a deformable block may meet another over a joint with friction; without give, if it has to be hard.
bool may_meet(const Scene& scene, bool hard_only) {
  const Layout& layout = scene.layout;
  if (layout.blocks.size() < 2 || std::none_of(scene.blocks.kind.begin(), scene.blocks.kind.end(),
                                               [](BlockKind k) { return k == BlockKind::kDeformable; }))
    return false;
  const auto meets = [&](int joint) {
    if (joint < 0) return false;
    const JointLaw& law = scene.laws[joint];
    return !law.bonded() && !(hard_only && law.is_soft(0)) && law.residual().friction > 0;
  };
  if (meets(layout.default_joint)) return true;
  for (const auto& [pair, joint] : layout.pair_joint)
    if (meets(joint)) return true;
  for (const BlockShape& b : layout.blocks)
    if (std::any_of(b.edge_joint.begin(), b.edge_joint.end(), meets)) return true;
  return false;
}

// Whether hard faces with strength give nothing (contact.stiffness = "none"): where they close loops Newton's method in
// velocities does not solve them.
bool ties_without_give(const Scene& scene) {
  if (scene.give.stress > 0) return false;
  return std::ranges::any_of(scene.bonds.faces, [&](const BondFace& f) {
    const JointLaw& law = scene.laws[f.joint];
    return !law.bonded() && !(law.is_soft(0) && law.is_soft(1));
  });
}

// Stable step of the smallest block, as share of the median one's, below which a few slivers would rule the
// step of all; share of the blocks that are few, and what counts as small among them.
constexpr double kRuled = 1.0 / 7, kFew = 0.25, kSmall = 0.25;

}  // namespace

bool deforming_blocks_meet(const Scene& scene) { return may_meet(scene, false); }

// Where small blocks are many, as in a graded mesh, they are what waves travel through.
bool slivers_rule(const BlockSet& blocks) {
  std::vector<double> step;
  for (int i = 0; i < blocks.count; ++i)
    if (const double dt = stable_step_of(blocks, i); std::isfinite(dt)) step.push_back(dt);
  if (step.empty()) return false;
  std::sort(step.begin(), step.end());
  const double median = step[step.size() / 2];
  const auto small = std::lower_bound(step.begin(), step.end(), kSmall * median) - step.begin();
  return step.front() < kRuled * median &&
         (small == 1 || static_cast<double>(small) < kFew * static_cast<double>(step.size()));
}

Scene build_scene(Model model, Layout layout, Findings& findings) {
  TALUS_ASSERT(layout.sound);
  Scene scene;
  scene.model = std::move(model);
  scene.layout = std::move(layout);
  scene.blocks = build_blocks(scene.model, scene.layout);
  scene.laws = joint_laws(scene.model.joints);
  scene.give = contact_give(scene.model, scene.layout, scene.blocks);
  scene.bonds = find_bonds(scene.model, scene.layout, scene.blocks);
  if (scene.by_patches())
    scene.outlines = build_outlines(scene.model, scene.layout, scene.blocks, scene.bonds, scene.laws);
  scene.supported = supported_points(scene.model, scene.layout, scene.blocks);
  scene.boundaries = build_boundaries(scene.model, scene.layout, scene.blocks, findings);
  check_bolts(scene.model, scene.layout, scene.blocks, findings);
  for (StageInput& stage : scene.model.stages) {
    // explicit elasticity lets blocks on hard contacts ring for ever and lose their friction (theory 4.9)
    if (stage.elasticity_auto)
      stage.implicit =
          may_meet(scene, true) || (stage.kind == StageKind::kStatic && slivers_rule(scene.blocks));
    if (!stage.from_rest_auto || !scene.by_patches() || ties_without_give(scene)) continue;
    stage.go_from_rest_first();
  }
  if (scene.model.formulation == Formulation::kAsPrinted)
    for (StageInput& stage : scene.model.stages) stage.implicit = false, stage.from_rest = false;
  if (scene.model.formulation == Formulation::kPenalty)
    for (StageInput& stage : scene.model.stages) stage.implicit = true, stage.from_rest = false;
  scene.loads = build_loads(scene.model, scene.layout, scene.blocks);
  if (const int above = block_above_ground(scene.model, scene.blocks); above >= 0) {
    findings.error(
        scene.model.in_situ.where_level, "in_situ.level",
        fmt::format("{:g} m is below the centroid of \"{}\", which is at {:g} m", scene.model.in_situ.level,
                    scene.blocks.name[above], scene.blocks.centroid[above].y),
        "give the height of the surface, or of the highest deformable block");
  }
  return scene;
}

Scene build_scene(Model model, Layout layout) {
  Findings findings(model.file, model.text);
  Scene scene = build_scene(std::move(model), std::move(layout), findings);
  findings.throw_if_errors();
  return scene;
}

State start_state(const Scene& scene) {
  State state = initial_state(scene.blocks, scene.layout);
  state.bond_force.resize(2 * scene.bonds.faces.size());
  state.face.resize(scene.bonds.faces.size());
  state.supports.resize(scene.supported.size());
  state.initial_stress = initial_stresses(scene.model, scene.blocks);
  const BoundarySet& b = scene.boundaries;
  state.boundaries.resize(b.points.size());
  state.ties.resize(b.ties.size());
  state.column_displacement.resize(b.free_field.height.size());
  state.column_rate.resize(b.free_field.height.size());
  state.energy_start = kinetic_energy(scene.blocks, state.rate);
  return state;
}

}  // namespace talus
