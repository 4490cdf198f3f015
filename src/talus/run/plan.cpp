#include "talus/run/plan.h"
#include "talus/run/path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "talus/base/index.h"
#include "talus/base/rank.h"
#include "talus/model/joint_law.h"
#include "talus/run/resolution.h"
#include "talus/run/rigid_step.h"
#include "talus/step/change.h"

namespace talus {

namespace {

constexpr double kWarnClampShare = 0.03;
constexpr double kMostSteps = 1e12;

bool deforms(const BlockSet& blocks, int i) { return blocks.kind[i] == BlockKind::kDeformable; }

// Value that a share of some blocks is below; infinite without any.
double value_of_share(const BlockSet& blocks, double share, bool (*counts)(const BlockSet&, int),
                      const std::function<double(int)>& value) {
  std::vector<double> values;
  for (int i = 0; i < blocks.count; ++i)
    if (counts(blocks, i)) values.push_back(value(i));
  if (values.empty()) return std::numeric_limits<double>::infinity();
  const auto n = static_cast<double>(values.size());
  return value_at_rank(std::move(values), static_cast<size_t>(std::min(share * n, n - 1)));
}

double median_of_deformable(const BlockSet& blocks, const std::function<double(int)>& value) {
  return value_of_share(blocks, 0.5, deforms, value);
}

double median_step(const BlockSet& blocks) {
  return median_of_deformable(blocks, [&](int i) { return stable_step_of(blocks, i); });
}

// Time in which a pressure wave crosses two blocks of median size: the step at which errors of time and of
// sub-division are of one size.
double crossing_time(const BlockSet& b) {
  return median_of_deformable(
      b, [&b](int i) { return 2 * b.size[i] / std::sqrt(b.moduli[i].c11 * b.volume[i] / b.mass[i]); });
}

// Step without local damping, in inverse angular frequencies of a block on its joints: three to a swing; six where blocks that
// do not deform knock on them.
constexpr double kJointSteps = 2, kRigidJointSteps = 1;

// Steps of implicit elasticity in the shortest period of what shakes or pushes, from which on it loses little of that: the damping
// ratio is alpha times pi over them, 0.6 % at the default (theory 4.9).
constexpr double kSlow = 100;
// Stiffness-proportional damping of blocks that are shaken with implicit elasticity where none is given [s], 1.6 % of critical at
// 10 Hz; and the most of critical that it may take of what shakes them: faster histories are waves that are looked for
// (theory 4.9).
constexpr double kBlockDamping = 0.5e-3, kMostDamped = 0.05;

// Share of the blocks whose swing on their joints a step need not resolve: slivers.
constexpr double kUnresolved = 0.1;

// Inverse angular frequency of nearly the quickest block, of those that deform or, where none does, of those that move, on
// the elastic joints around it: the longest step in which local damping, which opposes the force of now, still brakes and
// does not drive. Infinite without such joints.
double joint_time(const Scene& scene, const BlockSet& b) {
  const auto stiffness_of = [&](int joint, double area) {
    if (joint < 0) return 0.0;
    const JointLaw& law = scene.laws[joint];
    return !law.bonded() && law.is_soft(0) ? law.stiffness(0, area) : 0.0;
  };
  // joints between groups go before those of sides
  const auto of_group = [&](int group, double area) {
    double most = 0;
    for (const auto& [pair, joint] : scene.layout.pair_joint)
      if (pair.first == group || pair.second == group) most = std::max(most, stiffness_of(joint, area));
    return most;
  };
  const bool any_deforms = std::count(b.kind.begin(), b.kind.end(), BlockKind::kDeformable) > 0;
  const auto moves = [](const BlockSet& blocks, int i) { return blocks.moves_freely(i); };
  return value_of_share(b, kUnresolved, any_deforms ? deforms : +moves, [&](int i) {
    const std::vector<int>& joints = scene.layout.blocks[i].edge_joint;
    double stiffness = 0;
    const int corners = b.vertex_begin[i + 1] - b.vertex_begin[i];
    for (int e = 0; e < corners; ++e) {
      const double area = scene.model.thickness * norm(b.corner({i, (e + 1) % corners}) - b.corner({i, e}));
      const int joint = e < count_of(joints) ? joints[e] : scene.layout.default_joint;
      stiffness += std::max(stiffness_of(joint, area), of_group(b.group[i], area));
    }
    // half of the sides hold it along either direction
    return stiffness > 0 ? std::sqrt(b.mass[i] / (0.5 * stiffness)) : std::numeric_limits<double>::infinity();
  });
}

// Shortest period of what shakes or pushes in a stage.
double period_of_histories(const Scene& scene, const StageInput& stage) {
  double highest = 0;
  if (stage.kind == StageKind::kDynamic)
    for (const Resolution& r : resolutions(scene)) highest = std::max(highest, r.frequency);
  return highest > 0 ? 1 / highest : std::numeric_limits<double>::infinity();
}

// Conventional DDA has no stable limit, and damps what a step does not resolve. Static stages know no inertia: a block of
// median size falls by some thousandths of itself in a step.
double step_by_penalty(const Model& model, const BlockSet& blocks, const StageInput& stage, double crossing) {
  constexpr double kFiner = 8, kShareOfFall = 0.02;
  if (stage.kind == StageKind::kDynamic) return crossing / kFiner;
  const double size = median_of_deformable(blocks, [&blocks](int i) { return blocks.size[i]; });
  const double g = norm(model.gravity);
  return g > 0 && std::isfinite(size) ? kShareOfFall * std::sqrt(size / g) : crossing;
}

void limit_by_column(const Scene& scene, const StageInput& stage, const ColumnStep& column, StagePlan& plan,
                     Findings& findings) {
  if (column.dt < plan.dt_bound) {
    plan.dt_bound = column.dt;
    plan.bound_block = -1, plan.bound_column = column.boundary;
  }
  if (plan.dt >= column.dt)
    findings.error(stage.where_step, "stage." + stage.name + ".time_step",
                   fmt::format("{:.4g} s is above the stable limit {:.4g} s of the {}", plan.dt, column.dt,
                               bound_name(scene, plan)),
                   "use \"auto\", a smaller step or elasticity = \"implicit\": no moment clamp helps there");
}

}  // namespace

std::string bound_name(const Scene& scene, const StagePlan& plan) {
  if (plan.bound_column >= 0) return "free field of " + scene.model.boundaries[plan.bound_column].name;
  return plan.bound_block >= 0 ? scene.blocks.name[plan.bound_block] : "";
}

double yields_more(const Scene& scene, const std::vector<StagePlan>& plans) {
  std::vector<double> masses;
  for (int i = 0; i < scene.blocks.count; ++i)
    if (scene.blocks.moves_freely(i)) masses.push_back(scene.blocks.mass[i]);
  const double per_force = scene.give.per_force(scene.blocks.thickness);
  if (masses.empty() || plans.empty() || per_force == 0) return 0;
  const auto middle = masses.begin() + (masses.size() / 2);
  std::nth_element(masses.begin(), middle, masses.end());
  double dt = std::numeric_limits<double>::infinity();
  for (const StagePlan& plan : plans) dt = std::min(dt, plan.dt);
  return std::max(kLeastYield, kYield / *middle * dt * dt / per_force);
}

namespace {

StagePlan plan_stage(const Scene& scene, const Scene& staged, const StageInput& stage, Findings& findings) {
  const BlockSet& blocks = staged.blocks;
  const StableStep undamped = stable_step(blocks);
  StableStep bound = undamped;
  const std::string block_name = bound.block >= 0 ? blocks.name[bound.block] : "";
  // local damping adds up to its share to the force that turns a motion back: stiffness (1 + share),
  // theory 4.5
  StagePlan plan;
  plan.dt_undamped = undamped.dt / std::sqrt(1 + stage.damping_local);
  // 4.5: 2/w (sqrt(1 + z^2) - z) with z = damping_stiffness w / 2
  const double beta = stage.damping_stiffness;
  bound.dt = beta > 0 && bound.block >= 0 ? std::hypot(beta, plan.dt_undamped) - beta : plan.dt_undamped;
  plan.dt_bound = bound.dt;
  plan.bound_block = bound.block;
  const std::string path = "stage." + stage.name;
  // the free field has a limit of its own where its elasticity is explicit
  const ColumnStep column =
      stage.kind == StageKind::kDynamic && !stage.implicit
          ? stable_step(scene.boundaries.free_field, scene.model.inertia == Inertia::kLumped)
          : ColumnStep{};
  double wanted =
      std::min(stage.implicit ? crossing_time(blocks) : stage.safety * bound.dt, stage.safety * column.dt);
  const bool rigid = bound.block < 0;
  const double by_joints = (stage.damping_local > 0 ? 1
                            : rigid                 ? kRigidJointSteps
                                                    : kJointSteps) *
                           joint_time(scene, blocks);
  if (scene.model.formulation == Formulation::kPenalty)
    wanted = step_by_penalty(scene.model, blocks, stage, wanted);
  else if (stage.implicit)
    wanted = std::min({wanted, by_joints, period_of_histories(scene, stage) / kStepsPerPeriod});
  if (!std::isnan(stage.time_step)) {
    wanted = stage.time_step;
  } else if (rigid) {
    wanted = std::min(rigid_step(staged, stage), stage.safety * column.dt);
    if (scene.model.formulation == Formulation::kContactForces) wanted = std::min(wanted, by_joints);
    if (std::isinf(wanted)) {
      findings.error(
          stage.where, path + ".time_step",
          "\"auto\" finds nothing in this model that sets a time: no deformable block, no gravity, "
          "nothing that moves",
          "give a time_step, for example \"0.1 ms\"");
      wanted = stage.duration;
    }
  }
  if (stage.duration / wanted > kMostSteps) {
    findings.error(std::isnan(stage.time_step) ? stage.where : stage.where_step, path + ".time_step",
                   fmt::format("{:.3g} s makes {:.3g} steps, more than {:g}", wanted, stage.duration / wanted,
                               kMostSteps),
                   "is a unit missing?");
    wanted = stage.duration;
  }
  plan.steps = std::max<int64_t>(1, static_cast<int64_t>(std::ceil(stage.duration / wanted * (1 - 1e-12))));
  plan.dt = stage.duration / static_cast<double>(plan.steps);
  if (stage.from_rest) plan.steps *= kMostShortened;
  if (stage.implicit) {
    plan.dt_bound = plan.dt_undamped = std::numeric_limits<double>::infinity();
    plan.bound_block = -1;
  } else if (plan.dt >= bound.dt && stage.moment_clamp) {
    const double clamp_dt = std::sqrt(plan.dt * (plan.dt + 2 * beta) * (1 + stage.damping_local));
    if (clamp_dt > median_step(blocks)) {
      findings.error(stage.where_step, path + ".time_step",
                     fmt::format("{:.4g} s is above the stable limit of a block of median size, {:.4g} s: "
                                 "the moment clamp would change the model, not its slivers",
                                 plan.dt, median_step(blocks)),
                     "use a smaller step");
    }
    BlockSet clamped = blocks;
    clamp_moments(clamped, clamp_dt);
    plan.clamp_dt = clamp_dt;
    plan.clamped = clamped.clamped, plan.largest_clamp = clamped.largest_clamp;
    if (plan.clamped > kWarnClampShare * scene.blocks.count)
      findings.warning(stage.where_step, path + ".moment_clamp",
                       fmt::format("clamps {} of {} blocks", plan.clamped, scene.blocks.count),
                       "a smaller time_step clamps fewer");
  } else if (plan.dt >= bound.dt) {
    findings.error(stage.where_step, path + ".time_step",
                   fmt::format("{:.4g} s is above the stable limit {:.4g} s, set by block \"{}\"", plan.dt,
                               bound.dt, block_name),
                   "use \"auto\", a smaller step, elasticity = \"implicit\", or moment_clamp = true if a "
                   "few slivers set the limit");
  }
  limit_by_column(scene, stage, column, plan, findings);
  return plan;
}

}  // namespace

void choose_elasticity(Scene& scene) {
  if (scene.model.formulation != Formulation::kContactForces) return;
  const bool better = slivers_rule(scene.blocks) || deforming_blocks_meet(scene);
  const double step = std::min(crossing_time(scene.blocks), kJointSteps * joint_time(scene, scene.blocks));
  for (StageInput& stage : scene.model.stages) {
    if (stage.kind != StageKind::kDynamic) continue;
    // what strikes without a history has waves as short as a block
    const double period = period_of_histories(scene, stage);
    if (better && stage.elasticity_auto && std::isfinite(period) && period >= kSlow * step)
      stage.implicit = true;
    const double ratio = std::numbers::pi * kBlockDamping / period;
    if (stage.implicit && stage.damping_auto && ratio > 0 && ratio <= kMostDamped)
      stage.damping_stiffness = kBlockDamping;
  }
}

std::string damping_text(const StageInput& stage) {
  return stage.damping_stiffness > 0
             ? fmt::format(", blocks damped by {:.3g} ms", 1e3 * stage.damping_stiffness)
             : "";
}

std::vector<StagePlan> plan_stages(const Scene& scene, Findings& findings) {
  std::vector<StagePlan> plans;
  std::optional<Scene> changed;
  if (blocks_change(scene.model)) changed = scene;
  for (const StageInput& stage : scene.model.stages) {
    const int index = count_of(plans);
    if (changed) change_scene(index, *changed);
    const Scene& staged = changed ? *changed : scene;
    StagePlan plan = plan_stage(scene, staged, stage, findings);
    if (stage.path > 0) {
      plan.balances = count_of(path_goals(scene, index));
      plan.steps *= plan.balances;
    }
    if (stage.may_follow) {
      StageInput moving = stage;
      moving.go_by_motion();
      const StagePlan follow = plan_stage(scene, staged, moving, findings);
      plan.dt_follow = follow.dt, plan.steps_follow = follow.steps, plan.bound_follow = follow.dt_bound;
    }
    plans.push_back(plan);
  }
  return plans;
}

}  // namespace talus
