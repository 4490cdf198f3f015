#include "talus/step/change.h"

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/model/joint_law.h"

namespace talus {

namespace {

void set_value(double& value, double to) {
  if (!std::isnan(to)) value = to;
}

// Returns whether masses or moduli change.
bool apply(const ChangeInput& change, Scene& scene) {
  if (change.joint >= 0) {
    JointProperty& joint = scene.model.joints[change.joint];
    joint = changed(joint, change);
    return false;
  }
  if (change.block.empty()) {
    Material& material = scene.model.materials[change.material];
    set_value(material.density, change.density);
    set_value(material.young, change.young);
    set_value(material.poisson, change.poisson);
    return true;
  }
  for (const int i : scene.layout.blocks_called(change.block)) {
    if (change.material >= 0) scene.layout.blocks[i].material = change.material;
    if (change.kind == ChangeInput::kFixed) scene.blocks.kind[i] = BlockKind::kFixed;
    if (change.kind == ChangeInput::kFree) scene.blocks.kind[i] = scene.layout.blocks[i].kind;
  }
  return change.material >= 0;
}

void activate(int stage, Scene& scene) {
  const Model& model = scene.model;
  const BlockSet& blocks = scene.blocks;
  const auto acts = [stage](const auto& list, int i) { return list[i].acts_in(stage); };
  for (SupportedPoint& p : scene.supported)
    p.active = acts(model.supports, p.support) && blocks.moves_freely(p.block);
  for (BoundaryPoint& p : scene.boundaries.points)
    p.active = acts(model.boundaries, p.boundary) && blocks.moves_freely(p.block);
  for (TiePoint& t : scene.boundaries.ties) t.active = blocks.interact(t.block_a, t.block_b);
  for (LoadedPoint& p : scene.loads.points)
    p.active = acts(model.loads, p.load) && blocks.moves_freely(p.block);
  scene.loads.active.clear();
  for (const LoadInput& l : model.loads) scene.loads.active.push_back(l.acts_in(stage));
}

// Eq. 2.3.
BlockForce own_force(const Scene& scene, size_t k, const Mat2& stress) {
  BlockForce force{scene.blocks.mass[k] * scene.model.gravity, {}};
  if (scene.blocks.kind[k] == BlockKind::kDeformable) force.Q += (-scene.blocks.volume[k]) * stress;
  return force;
}

}  // namespace

void change_scene(int stage, Scene& scene) {
  bool rebuild = false;
  for (const ChangeInput& change : scene.model.changes)
    if (change.stage == stage) rebuild = apply(change, scene) || rebuild;
  scene.laws = joint_laws(scene.model.joints);
  const std::vector<char> out = excavated_blocks(scene, stage);
  for (size_t i = 0; i < out.size(); ++i)
    if (out[i]) scene.blocks.kind[i] = BlockKind::kRemoved;
  if (rebuild) {
    std::vector<BlockKind> kinds = std::move(scene.blocks.kind);
    scene.blocks = build_blocks(scene.model, scene.layout);
    scene.blocks.kind = std::move(kinds);
  }
  activate(stage, scene);
}

bool blocks_change(const Model& model) {
  return !model.changes.empty() || std::any_of(model.stages.begin(), model.stages.end(),
                                               [](const StageInput& s) { return !s.excavate.empty(); });
}

std::vector<char> excavated_blocks(const Scene& scene, int stage) {
  std::vector<char> out(scene.blocks.count);
  for (const std::string& name : scene.model.stages[stage].excavate)
    for (const int i : scene.layout.blocks_called(name)) out[i] = 1;
  return out;
}

// Theory 2.7.
std::vector<BlockForce> forces_of_blocks(const StepWork& work, const std::vector<char>& blocks) {
  std::vector<BlockForce> force(blocks.size());
  const RowSet& rows = work.rows;
  for (size_t r = 0; r < rows.points.size(); ++r) {
    const PointRows& p = rows.points[r];
    if (p.block_a < 0 || p.block_b < 0) continue;
    const int a = p.block_a, b = p.block_b;
    if (blocks[a] == blocks[b]) continue;
    const bool on_a = blocks[b] != 0;
    force[on_a ? a : b] += (1 / work.clock.dt_kick) * impulse_on(p, rows.impulse[r], on_a ? 1 : -1);
  }
  return force;
}

// Theory 2.7.
void adapt_state(const BlockSet& before, const std::vector<SupportedPoint>& supported_before,
                 const Scene& scene, State& state) {
  TALUS_ASSERT(before.count == scene.blocks.count && supported_before.size() == scene.supported.size());
  const BlockSet& now = scene.blocks;
  for (int i = 0; i < now.count; ++i) {
    if (before.moves_freely(i) && !now.moves_freely(i)) state.rate[i] = {}, state.row_force[i] = {};
    if (scene.layout.blocks[i].kind != BlockKind::kDeformable) continue;
    const Mat2 stress = initial_stress_for(before.moduli[i], now.moduli[i], state.strain_part[i],
                                           initial_stress_of(state, i));
    if (state.initial_stress.empty() && contract(stress, stress) > 0) state.initial_stress.resize(now.count);
    if (!state.initial_stress.empty()) state.initial_stress[i] = stress;
  }
  for (size_t f = 0; f < scene.bonds.faces.size(); ++f) {
    if (now.interact(scene.bonds.faces[f].block_a, scene.bonds.faces[f].block_b)) continue;
    state.bond_force[2 * f] = state.bond_force[2 * f + 1] = {};
    state.face[f].mean_force = {};
  }
  for (size_t i = 0; i < scene.supported.size(); ++i) {
    const SupportedPoint& p = scene.supported[i];
    if (!p.active || supported_before[i].active) continue;
    const SupportInput& s = scene.model.supports[p.support];
    const auto prescribed = [&](const Motion& m) {
      return m.displacement_at(state.history_time, scene.model.histories);
    };
    state.supports[i].hold = displacement_at(state, p.block, p.arm) - Vec2{prescribed(s.x), prescribed(s.y)};
  }
  // pairs with blocks that have gone leave the list, others may have come to matter
  if (before.kind != now.kind) state.candidates.reach.clear();
}

void stop_motion(const Scene& scene, State& state) {
  const double before = ledger_energy(scene, state);
  std::fill(state.rate.begin(), state.rate.end(), BlockRate{});
  state.dt_before = 0;
  state.work[Cause::kDamping] += ledger_energy(scene, state) - before;
}

// Eq. 2.3.
double ledger_energy(const Scene& scene, const State& state) {
  const BlockSet& blocks = scene.blocks;
  double sum = 0;
  for (int i = 0; i < blocks.count; ++i) {
    if (!blocks.moves_freely(i)) continue;
    const BlockRate& v = state.rate[i];
    // conventional DDA: everything is of one instant, strains have their own sum
    if (!state.carried_stress.empty()) {
      sum += 0.5 * work(momentum(blocks, i, v), v) -
             blocks.mass[i] * dot(scene.model.gravity, state.displacement[i]);
      continue;
    }
    const ElasticState elastic =
        blocks.kind[i] == BlockKind::kDeformable
            ? elastic_state(blocks.moduli[i], state.strain_part[i], initial_stress_of(state, i))
            : ElasticState{};
    // velocities are half a step behind: what weight and elasticity do until now counts too
    const BlockForce own = own_force(scene, i, elastic.stress);
    sum += 0.5 * work(momentum(blocks, i, v), v) + 0.5 * state.dt_before * work(own, v) +
           blocks.volume[i] * elastic.density -
           blocks.mass[i] * dot(scene.model.gravity, state.displacement[i]);
  }
  return sum;
}

}  // namespace talus
