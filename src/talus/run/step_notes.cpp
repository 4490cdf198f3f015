#include "talus/run/step_notes.h"

#include <fmt/format.h>

#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/run/resolution.h"

namespace talus {

namespace {

// Overlap of a contact, as share of the thinner block, at which a run ends.
constexpr double kMostClosed = 0.25;

// "80 iterations of gauss_seidel, 6 of primal_newton".
std::string attempts_text(const Attempts& attempts) {
  std::string text;
  for (size_t i = 0; i < attempts.count; ++i)
    text += fmt::format("{}{} {}of {}", i == 0 ? "" : ", ", attempts.list[i].iterations,
                        i > 0                              ? ""
                        : attempts.list[i].iterations == 1 ? "iteration "
                                                           : "iterations ",
                        name_of(attempts.list[i].solver));
  return text;
}

}  // namespace

StepNotes::StepNotes(const Scene& scene, const StepWork& work, RunResult& result)
    : scene_(scene),
      work_(work),
      result_(result),
      shakes_(largest_input(scene.model) > 0 && joints_give(scene.laws)) {}

void StepNotes::note(const StepReport& r, const StepSettings& settings, const State& state) {
  ++result_.steps;
  result_.iterations += r.solve.iterations;
  result_.most_contacts = std::max(result_.most_contacts, r.contacts);
  result_.most_iterations = std::max(result_.most_iterations, r.solve.iterations);
  if (std::isnan(r.error.worst) || r.error.worst > result_.worst_error) {
    result_.worst_error = r.error.worst;
    result_.worst_error_time = state.time;
    result_.worst_error_row = r.worst;
  }
  result_.second_solver_steps += r.attempts.several();
  ++result_.steps_by[place_of(r.method)];
  result_.deepest_drift = std::max(result_.deepest_drift, r.drift);
  result_.energy = r.energy;
  result_.largest_left_over = std::max(result_.largest_left_over, std::abs(r.energy.left_over));
  result_.largest_energy = std::max(result_.largest_energy, r.energy.largest());
  if (r.closed_share > result_.closed_share) {
    result_.closed_share = r.closed_share, result_.closed_time = state.time;
    result_.closed_row = closed_text(r, state);
  }
  if (r.closed_share > kMostClosed)
    throw NumericalError(
        fmt::format("step {} at t = {:.9g} s: {}", state.step, state.time, result_.closed_row));
  if (settings.dynamic && shakes_ && r.jolt > result_.jolt) note_jolt(r, state);
  result_.loose_steps += r.loose;
  result_.ringing_steps += r.rings && !(settings.damping_stiffness > 0);
  if (!r.failed) return;
  ++result_.failed_steps;
  if (scene_.model.solver.stop_on_failure) {
    throw NumericalError(fmt::format(
        "step {} at t = {:.9g} s: the contact equations were not solved; error {:.3g} m after {}, "
        "allowed {:.3g} m; worst at {}. A smaller time step, more solver.max_iterations or a "
        "wider solver.{} may help; solver.on_failure = \"continue\" counts such steps instead of "
        "stopping",
        state.step, state.time, r.error.worst, attempts_text(r.attempts), settings.limit, r.worst,
        scene_.model.contact.law == ContactLaw::kExact ? "limit" : "tolerance"));
  }
}

// Hard contacts push by a speed over the step: their accelerations say nothing (theory 7.2).
void StepNotes::note_jolt(const StepReport& r, const State& state) {
  size_t most = work_.rows.size();
  double largest = 0;
  for (size_t k = 0; k < work_.rows.size(); ++k) {
    const PointRows& p = work_.rows.points[k];
    if (p.block_a != r.jolted && p.block_b != r.jolted) continue;
    if (const double push = std::hypot(work_.rows.impulse[k][0], work_.rows.impulse[k][1]); push > largest)
      largest = push, most = k;
  }
  if (most == work_.rows.size() || !is_joint(work_.rows.owner[most].family) ||
      !work_.rows.points[most].is_soft(0))
    return;
  result_.jolt = r.jolt, result_.jolt_time = state.time;
  result_.jolt_row =
      fmt::format("{} ({})", scene_.blocks.name[r.jolted], row_name(scene_, state, work_, most));
}

// How deep a contact has gone, where, and what would keep it from it.
std::string StepNotes::closed_text(const StepReport& r, const State& state) const {
  const int row = r.closed_row;
  const size_t owner = work_.rows.owner[row].at();
  int of_joint = -1;
  Vec2 at;
  if (scene_.by_patches()) {
    const Patch& c = state.patches[owner / 2];
    const int a = c.block_a;
    of_joint = c.joint, at = scene_.blocks.centroid[a] + offset_now(state, a, c.arm_a[owner % 2]);
  } else {
    const Contact& c = state.contacts[owner];
    const int a = c.key.block_a;
    of_joint = c.joint;
    at = scene_.blocks.centroid[a] + offset_now(state, a, scene_.blocks.corner(c.key.corner()));
  }
  const JointProperty* joint = of_joint < 0 ? nullptr : &scene_.model.joints[of_joint];
  const std::string cure =
      joint && joint->normal_stiffness > 0
          ? fmt::format("normal_stiffness = {:.2g} Pa/m of joint \"{}\" would keep it at 1 %",
                        joint->normal_stiffness * r.closed_share / 0.01, joint->name)
      : scene_.model.formulation == Formulation::kPenalty
          ? "a larger penalty.normal_stiffness keeps blocks apart"
          : "a smaller time step keeps hard contacts apart";
  return fmt::format("{} at ({:.4g}, {:.4g}) has closed by {:.2g} % of the thinner block{}; {}",
                     row_name(scene_, state, work_, row), at.x, at.y, 100 * r.closed_share,
                     r.closed_share > kMostClosed
                         ? ", more than a quarter: the geometry is no longer that of the model"
                         : "",
                     cure);
}

}  // namespace talus
