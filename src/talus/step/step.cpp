#include "talus/step/step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/blocks/validate.h"
#include "talus/corners/corner_rows.h"
#include "talus/rows/validate_rows.h"
#include "talus/step/blows.h"
#include "talus/step/chunks.h"
#include "talus/step/parts.h"

namespace talus {

namespace {

// Travel of a block in one step, as share of its radius, at which a run ends: contacts could not be followed.
constexpr double kMostTravel = 10;

// Every pair would be a close one before the blow-up shows in a block turned inside out. Of the rates that the search
// looks ahead by: those without the rows say nothing, as what rows hold back may be large in a long step.
void check_travel(const BlockSet& blocks, const std::vector<BlockRate>& rate, const State& state, double dt) {
  for (size_t i = 0; i < rate.size(); ++i) {
    const double spread = std::sqrt(contract(rate[i].G, rate[i].G)) * blocks.size[i];
    const double speed = norm(rate[i].a) + spread;
    if (!(speed * dt <= kMostTravel * blocks.radius[i]))
      throw NumericalError(
          fmt::format("block \"{}\" moves {:.3g} times its own radius in one step at t = {:.9g} s, step {}: "
                      "the motion has blown up, or the time step is far too long",
                      blocks.name[i], speed * dt / blocks.radius[i], state.time, state.step));
  }
}

PatchWorld patch_world(const Scene& scene) {
  return {scene.blocks, scene.outlines, scene.bonds, scene.layout, scene.model, scene.laws};
}

void seek_contacts(const Scene& scene, StepWork& work, State& state, StepReport& report) {
  const std::vector<BlockRate>& expected = work.clock.from_rest ? work.rate_expected : work.rate_before;
  // a step from rest that goes far is taken again
  if (!work.clock.from_rest) check_travel(scene.blocks, expected, state, work.clock.dt);
  const LookAhead ahead{work.clock, expected};
  renew_pairs(scene.blocks, scene.bonds, scene.layout, scene.laws, ahead, work.workers, state);
  if (scene.by_patches()) {
    const InPart part(work.profile, Profile::kSearch);
    report.searched = work.patches.update(patch_world(scene), ahead, work.workers, state);
    report.contacts = static_cast<int>(2 * state.patches.size());
    return;
  }
  const SearchReport sought =
      update_contacts(scene.blocks, scene.bonds, scene.layout, ahead, work.workers, state);
  // threads seek side by side
  work.profile.move(Profile::kMargins, Profile::kSearch, sought.seconds / work.workers.threads());
  work.profile.sought += report.searched = sought.searched;
  report.contacts = count_of(state.contacts);
}

// Family by family, in their order.
void gather_rows(const Scene& scene, StepWork& work, const State& state) {
  const BlockSet& blocks = scene.blocks;
  const Model& model = scene.model;
  const std::vector<BlockRate>& before = work.rate_before;
  const StepClock& clock = work.clock;
  RowSet& rows = work.rows;
  rows.restart();
  work.profile.go_on_with(Profile::kRows);
  add_bond_rows(blocks, scene.bonds, scene.laws, scene.give, state, before, clock, work.workers, rows);
  if (scene.by_patches())
    add_patch_rows(patch_world(scene), scene.give, state, before, clock, work.workers, rows, work.gaps);
  else
    add_corner_rows(blocks, model, scene.laws, state, clock, work.workers, rows, work.gaps);
  work.profile.go_on_with(Profile::kHeld);
  add_support_rows(blocks, model, scene.supported, state, clock, rows);
  add_boundary_rows(blocks, model, scene.boundaries, state, before, clock, work.columns, rows);
  add_tie_rows(blocks, scene.boundaries.ties, state, clock, rows);
  work.profile.go_on_with(Profile::kBolts);
  add_bolt_rows(blocks, state, before, clock, rows);
  rows.finish();
}

Smoothing smoothing(const Model& model, const StepClock& clock) {
  const ContactInput& contact = model.contact;
  if (contact.law == ContactLaw::kExact) return {};
  const bool printed = model.formulation == Formulation::kAsPrinted;
  return {true,
          printed,
          printed ? contact.smoothing_force : contact.smoothing_force * clock.dt_kick,
          contact.smoothing_slip / clock.dt,
          clock.dt,
          clock.dt_kick};
}

void solve_rows(const Scene& scene, const StepSettings& settings, StepWork& work, State& state,
                StepReport& report) {
  const StepProblem problem{work.mobility,
                            work.rate_given(),
                            work.clock.dt,
                            smoothing(scene.model, work.clock),
                            work.rows,
                            state.rate,
                            work.profile,
                            scene.blocks.tile,
                            work.clock.from_rest,
                            settings.near_expected ? &work.rate_expected : nullptr};
  RowKinds kinds = row_kinds(scene, work);
  kinds.by_all = settings.by_all;
  const Solved solved = solve_step(scene.model, kinds, settings.tolerance, settings.limit, settings.sharper,
                                   settings.keep_guess, work.workers, work.solvers, problem, work.guess);
  report.method = solved.method, report.solve = solved.report;
  report.error = solved.error;
  // of the smoothed law the error says nothing
  report.loose =
      solved.failed && scene.model.contact.law == ContactLaw::kExact && solved.error.worst <= settings.limit;
  report.failed = solved.failed && !report.loose;
  report.attempts = solved.attempts;
  if (report.error.point >= 0) report.worst = row_name(scene, state, work, report.error.point);
}

// The work of the rows, and in the same look what contacts carry to the step after.
RowSums settle_rows(const Scene& scene, const StepWork& work, State& state) {
  const BlockSet& blocks = scene.blocks;
  const RowRange contacts = work.rows.range(Family::kContact);
  return work.workers.sum_chunks<RowSums>(
      work.rows.size(), kChunkOfRows, [&](size_t begin, size_t end, RowSums& s) {
        for (size_t r = begin; r < end; ++r) {
          const std::array<double, 2> u = relative_velocity(work.rows.points[r], state.rate);
          tally_row(blocks, work, state, r, u, s);
          if (!scene.by_patches() || r < contacts.begin || r >= contacts.end) continue;
          tally_dashpots(work, r, u,
                         dashpot_impulse(blocks, scene.laws, work.rows, r, u, work.rate_before, state.rate,
                                         work.clock, state),
                         s);
          remember_patch(blocks, scene.laws, work.rows, r, u, work.rate_before, work.clock, state);
        }
        const RowRange here{std::max(begin, contacts.begin), std::min(end, contacts.end)};
        if (!scene.by_patches() && here.begin < here.end)
          remember_corners(blocks, work.rows, here, work.clock, state);
      });
}

// What the other rows carried, for the step after.
void remember(const Scene& scene, const StepWork& work, State& state) {
  remember_bonds(scene.blocks, scene.bonds, work.rows, work.clock, work.workers, state);
  for (auto* points : {&state.supports, &state.boundaries, &state.ties})
    for (HeldPoint& p : *points) p.force = {0, 0};
  for (size_t r = work.rows.range(Family::kSupport).begin; r < work.rows.range(Family::kTie).end; ++r) {
    const RowOwner owner = work.rows.owner[r];
    const Impulse& p = work.rows.impulse[r];
    const std::array<double, 2> force{p[0] / work.clock.dt_kick, p[1] / work.clock.dt_kick};
    if (owner.family == Family::kSupport) state.supports[owner.at()].force = {force[0], -force[1]};
    if (owner.family == Family::kBoundary) state.boundaries[owner.at()].force = force;
    if (owner.family == Family::kTie) state.ties[owner.at()].force = force;
  }
  remember_bolts(work.rows, work.clock, state);
}

// What both solutions of a step have to say: the worse in what is told of errors, and who failed.
void add_report(const StepReport& first, StepReport& report) {
  report.solve.iterations += first.solve.iterations;
  if (!(report.error.worst >= first.error.worst)) report.error = first.error, report.worst = first.worst;
  if (first.failed && !report.failed) report.method = first.method, report.attempts = first.attempts;
  report.failed = report.failed || first.failed, report.loose = report.loose || first.loose;
}

// Forces of the rows. Where hard contacts close that were apart they act from then on only, and what bore until then does not let
// go a step before it (theory 4.7).
void solve_forces(const Scene& scene, const StepSettings& settings, StepWork& work, State& state,
                  StepReport& report) {
  RowSet& rows = work.rows;
  Meeting& meeting = work.meeting;
  meeting = {};
  std::vector<size_t> closing;
  if (settings.dynamic && scene.by_patches() && scene.model.contact.law == ContactLaw::kExact)
    closing = closing_rows(scene, work, state);
  if (closing.empty()) return solve_rows(scene, settings, work, state, report);
  report.rings = rings(scene, work, state, closing);
  for (const size_t r : closing) rows.points[r].upper = 0, rows.impulse[r] = {0, 0};
  solve_rows(scene, settings, work, state, report);
  for (const size_t r : closing) rows.points[r].upper = PointRows{}.upper;
  if (report.failed && settings.may_shorten) return;
  const StepReport first = report;
  const std::vector<BlockRate> before_blows = state.rate;
  find_blows(scene, work, state);
  // of contacts that can only push the forces until then stay; all others are those of the whole step
  RowSet stay;
  std::vector<size_t> of_row;
  for (size_t r = rows.range(Family::kContact).begin; r < rows.range(Family::kContact).end; ++r) {
    const PointRows& p = rows.points[r];
    if (p.is_soft() || p.lower != 0 || p.cohesion != 0 || rows.impulse[r][0] == 0) continue;
    stay.add(p, rows.impulse[r], {Family::kContact, 0}), of_row.push_back(r);
    rows.impulse[r] = {0, 0};
  }
  std::vector<BlockRate> rate = work.rate_free;
  apply_impulses(work.mobility, stay, rate);
  for (size_t i = 0; i < rate.size(); ++i) rate[i] = rate[i] + (state.rate[i] - before_blows[i]);
  meeting.rate = std::move(rate);
  // what they give by stays with them, as part of what they give by in all
  const auto give_on = [&](double sign) {
    for (size_t k = 0; k < of_row.size(); ++k)
      for (Row& row : rows.points[of_row[k]].row)
        row.bias += sign * row.compliance * stay.impulse[k][&row - rows.points[of_row[k]].row];
  };
  give_on(1);
  solve_rows(scene, settings, work, state, report);
  give_on(-1);
  for (size_t k = 0; k < of_row.size(); ++k)
    for (size_t i = 0; i < 2; ++i) rows.impulse[of_row[k]][i] += stay.impulse[k][i];
  add_report(first, report);
  report.loose = report.loose || (meeting.failed && !report.failed);
}

// For results. The state does not keep blows: they are no guess for the forces of the step after.
void remember_blows(StepWork& work, State& state) {
  const size_t first = work.rows.range(Family::kContact).begin;
  for (const Meeting::Blow& blow : work.meeting.blows) {
    for (size_t i = 0; i < 2; ++i) work.rows.impulse[blow.row][i] += blow.impulse[i];
    if (work.rows.owner[blow.row].family == Family::kContact)
      state.patches[(blow.row - first) / 2].touched = true;
  }
}

// The recipe (eq. 2.1).
StepReport take_kick(const Scene& scene, const StepSettings& settings, double dt, StepWork& work,
                     State& state) {
  StepReport report;
  // alpha = 1 weights the end of the step alone (eq. 14.1)
  work.clock = {dt,
                settings.from_rest ? dt : 0.5 * (state.dt_before + dt),
                settings.from_rest ? 1 : scene.model.contact.alpha,
                state.history_time,
                settings.dynamic ? dt : settings.history_dt,
                settings.dynamic,
                settings.from_rest};
  work.work = {};
  const Scheme scheme{scene.blocks, settings, work.clock, work.elastic};
  Profile& profile = work.profile;
  const InPart part(profile, Profile::kBlocks);
  if (settings.from_rest) {
    work.rate_expected = state.rate;
    std::fill(state.rate.begin(), state.rate.end(), BlockRate{});
  }
  work.column_rate_before = state.column_rate;
  add_forces(scene, settings, work, state);
  predict(scene, scheme, work, state);
  profile.go_on_with(Profile::kMargins);
  seek_contacts(scene, work, state, report);
  gather_rows(scene, work, state);
  ++profile.steps;
  profile.points += static_cast<int64_t>(work.rows.size());
  profile.go_on_with(Profile::kRest);
  solve_forces(scene, settings, work, state, report);
  if (report.failed && settings.may_shorten) {
    state.rate = work.rate_before, state.column_rate = work.column_rate_before;
    report.taken = false;
    return report;
  }
  profile.go_on_with(Profile::kRemember);
  RowSums rows = settle_rows(scene, work, state);
  remember(scene, work, state);
  profile.go_on_with(Profile::kLedger);
  if (!work.meeting.blows.empty()) rows += tally_blows(scene, work, state);
  tally(scene, scheme, rows, work, state, report);
  remember_blows(work, state);
  return report;
}

}  // namespace

StepReport kick(const Scene& scene, const StepSettings& settings, double dt, StepWork& work, State& state) {
  StepReport report;
  TALUS_ASSERT(dt > 0);
  work.workers.together([&] { report = take_kick(scene, settings, dt, work, state); });
  TALUS_VALIDATE(scene.blocks);
  TALUS_VALIDATE(state, scene.blocks);
  TALUS_VALIDATE(work.rows, scene.blocks.count);
  return report;
}

Unseen unseen(const Scene& scene, double time_end, StepWork& work, const State& state, StepReport report) {
  if (!scene.by_patches()) return {};
  State end = state;
  drift(scene, time_end, work, end, report);
  // a face that breaks at the end has borne its joint until then: patches that take over from it hold what it took
  for (size_t f = 0; report.broken_faces > 0 && f < end.face.size(); ++f)
    end.face[f].broken = state.face[f].broken;
  seek_contacts(scene, work, end, report);
  return {work.patches.unseen(), unpaid_energy(patch_world(scene), state, end)};
}

}  // namespace talus
