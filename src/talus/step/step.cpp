#include "talus/step/step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"

namespace talus {

namespace {

// Contact points are sought this far ahead, as share of the smaller block; a point further away than a block
// can come in one step has no force and costs only its row.
constexpr double kMarginShare = 0.02;

double contact_margin(const BlockSet& blocks, const std::vector<BlockRate>& rate, double dt) {
  double least = blocks.size[0], fastest = 0;
  for (size_t i = 0; i < rate.size(); ++i) {
    least = std::min(least, blocks.size[i]);
    const double spread = std::sqrt(contract(rate[i].G, rate[i].G)) * blocks.size[i];
    fastest = std::max(fastest, norm(rate[i].a) + spread);
  }
  // rounded up to a power of two times the share, so that the candidate list survives small changes of speed
  double margin = kMarginShare * least;
  while (margin < 4 * fastest * dt) margin *= 2;
  return margin;
}

// Gravity and elastic resistance of a block (theory 4.1).
BlockForce force_without_rows(const BlockSet& b, Vec2 gravity, const State& state, size_t i) {
  BlockForce force{b.mass[i] * gravity, {}};
  if (b.kind[i] == BlockKind::kDeformable)
    force.Q = (-b.volume[i]) * piola_stress(b.moduli[i], state.strain_part[i]);
  return force;
}

// Norm of a generalised force as a force on the block's mass, sqrt(m F M^-1 F) [N]; the same in every frame.
double force_norm(const BlockSet& b, size_t i, const BlockForce& force) {
  return std::sqrt(b.mass[i] * std::max(0.0, work(force, accelerate(b, i, force))));
}

BlockRate operator+(const BlockRate& u, const BlockRate& v) { return {u.a + v.a, u.G + v.G}; }
BlockRate operator*(double s, const BlockRate& v) { return {s * v.a, s * v.G}; }

// Work of an impulse, 1/2 p (v0 + v1): `late` of p v1 belongs to the interval after it, the rest to the one
// before.
void tally(double& before, double& after, const BlockForce& impulse, const BlockRate& v0, const BlockRate& v1,
           double late) {
  const double later = late * work(impulse, v1);
  before += 0.5 * (work(impulse, v0) + work(impulse, v1)) - later;
  after += later;
}

class Kick {
 public:
  Kick(const Scene& scene, const StepSettings& settings, double dt, StepWork& work, State& state)
      : scene_(scene), blocks_(scene.blocks), settings_(settings), dt_(dt), work_(work), state_(state) {}

  StepReport run() {
    work_.dt_kick = 0.5 * (state_.dt_before + dt_);
    work_.work = {};
    work_.rate_before = state_.rate;
    const double damping = 0.5 * settings_.damping_mass * work_.dt_kick;
    scale_ = 1 / (1 + damping);

    predict(damping);
    gather_rows();
    solve();
    for (size_t i = 0; i < state_.rate.size(); ++i)
      work_.rate_now.push_back(state_.dt_before > 0 ? mean(work_.rate_before[i], state_.rate[i])
                                                    : work_.rate_before[i]);
    tally_loads_and_damping();
    tally_rows();
    measure_balance();
    tally_energy();
    remember();
    return report_;
  }

 private:
  RowTiming timing() const { return {dt_, work_.dt_kick, scene_.model.contact.alpha}; }
  double history_end() const { return state_.history_time + (settings_.histories_run ? dt_ : 0); }

  // Rates at the end of the kick as they would be without rows (theory 4.2), damping included.
  void predict(double damping) {
    work_.rate_now.clear();
    forces_.resize(state_.rate.size());
    local_damping_.assign(state_.rate.size(), {});
    const Model& model = scene_.model;
    load_ = load_acceleration(model, scene_.loaded, blocks_.count, state_.history_time);
    for (int i = 0; i < blocks_.count; ++i) {
      const auto k = static_cast<size_t>(i);
      if (!blocks_.moves_freely(i)) continue;
      forces_[k] = force_without_rows(blocks_, model.gravity + load_[k], state_, k);
      BlockRate& v = state_.rate[k];
      if (settings_.damping_local > 0) local_damping_[k] = local_damping_impulse(k);
      const BlockForce impulse = work_.dt_kick * forces_[k] + local_damping_[k];
      v = scale_ * ((1 - damping) * v + accelerate(blocks_, k, impulse));
    }
    drive_blocks(blocks_, scene_.model, scene_.layout, state_, history_end(), dt_, state_.rate);
    rate_free_ = state_.rate;
  }

  // Share of the unbalanced force, set against the motion of the whole block in the metric of its mass: the
  // same in every frame. Contact forces are those of the step before, as this step's are still unknown. It
  // never turns a motion round: like friction it stops it at most.
  BlockForce local_damping_impulse(size_t i) const {
    const BlockRate& v = state_.rate[i];
    const BlockForce moving = momentum(blocks_, i, v);
    const double speed = std::sqrt(std::max(0.0, work(moving, v)));
    if (speed == 0) return {};
    const BlockForce unbalanced = forces_[i] + state_.contact_force[i];
    const double push = std::sqrt(std::max(0.0, work(unbalanced, accelerate(blocks_, i, unbalanced))));
    const double share = std::min(settings_.damping_local * push * work_.dt_kick / speed, 1.0);
    return -share * moving;
  }

  void gather_rows() {
    work_.rows.clear();
    work_.bond_owner.clear();
    const Model& model = scene_.model;
    add_bond_rows(blocks_, scene_.bonds, model.joints, state_, work_.rate_before, timing(), work_.rows,
                  work_.bond_owner);
    work_.first_contact = work_.rows.points.size();
    const double margin = contact_margin(blocks_, state_.rate, dt_);
    work_.contacts = find_contacts(blocks_, scene_.bonds, state_, margin, work_.candidates, dt_);
    add_contact_rows(blocks_, scene_.layout, model, work_.contacts, state_, work_.rate_before, timing(),
                     work_.rows);
    work_.first_support = work_.rows.points.size();
    add_support_rows(blocks_, model, scene_.supported, state_, history_end(), dt_, work_.dt_kick, work_.rows);
    report_.contacts = static_cast<int>(work_.contacts.size());
    for (size_t i = 0; i < work_.contacts.size(); ++i)
      if (work_.rows.points[work_.first_contact + i].row[0].compliance == 0)
        report_.drift = std::max(report_.drift, -work_.contacts[i].gap);
  }

  // The chosen solver, then, where its result misses the tolerance, the other; the better of the two stays.
  void solve() {
    const SolverKind first = scene_.model.solver.method;
    work_.guess = work_.rows.impulse;
    work_.rate_free = rate_free_;
    work_.mobility_scale = scale_;
    solve_by(first);
    if (!report_.failed || scene_.model.contact.law == ContactLaw::kSmoothed) return;
    const StepReport kept = report_;
    const std::vector<Impulse> kept_impulse = work_.rows.impulse;
    work_.rows.impulse = work_.guess;
    solve_by(first == SolverKind::kNewton ? SolverKind::kGaussSeidel : SolverKind::kNewton);
    report_.second_solver = true;
    if (report_.error.worst <= kept.error.worst || std::isnan(kept.error.worst)) return;
    work_.rows.impulse = kept_impulse;
    report_ = kept;
    report_.second_solver = true;
    apply_rows();
  }

  void solve_by(SolverKind kind) {
    const SolverInput& options = scene_.model.solver;
    // the solvers stop earlier than the judge: it measures what is left after the result has been applied
    const double stop = 0.1 * settings_.tolerance;
    if (kind == SolverKind::kNewton)
      report_.solve = solve_newton(blocks_, rate_free_, scale_, options, stop / dt_, work_.rows, smoothing());
    else
      report_.solve = solve_gauss_seidel(blocks_, rate_free_, scale_, options, stop, dt_, work_.rows);
    apply_rows();
  }

  Smoothing smoothing() const {
    const ContactInput& c = scene_.model.contact;
    if (c.law == ContactLaw::kExact) return {};
    return {true, c.smoothing_force * work_.dt_kick, c.smoothing_slip / dt_};
  }

  void apply_rows() {
    row_force_.assign(state_.rate.size(), {});
    for (size_t r = 0; r < work_.rows.points.size(); ++r) {
      const PointRows& p = work_.rows.points[r];
      const Impulse& impulse = work_.rows.impulse[r];
      if (p.block_a >= 0) row_force_[static_cast<size_t>(p.block_a)] += impulse_on(p, impulse, 1);
      if (p.block_b >= 0) row_force_[static_cast<size_t>(p.block_b)] += impulse_on(p, impulse, -1);
    }
    for (size_t i = 0; i < state_.rate.size(); ++i)
      state_.rate[i] = rate_free_[i] + scale_ * accelerate(blocks_, i, row_force_[i]);
    report_.error = contact_error(blocks_, work_.rows, state_.rate, scale_, dt_);
    // the smoothed law misses the exact one by design: there the solver's own residual is the judge
    const bool smoothed = scene_.model.contact.law == ContactLaw::kSmoothed;
    report_.failed = smoothed ? !report_.solve.converged : !(report_.error.worst <= settings_.tolerance);
    if (report_.error.point >= 0)
      report_.worst = row_name(scene_, work_, static_cast<size_t>(report_.error.point));
  }

  void tally_loads_and_damping() {
    KickWork& w = work_.work;
    for (size_t i = 0; i < state_.rate.size(); ++i) {
      if (!blocks_.moves_freely(static_cast<int>(i))) continue;
      const BlockRate &v0 = work_.rate_before[i], &v1 = state_.rate[i];
      const BlockForce viscous =
          (-settings_.damping_mass * work_.dt_kick) * momentum(blocks_, i, mean(v0, v1));
      const BlockForce load{(work_.dt_kick * blocks_.mass[i]) * load_[i], {}};
      tally(w.before.loads, w.after.loads, load, v0, v1, late_share());
      tally(w.before.damping, w.after.damping, viscous + local_damping_[i], v0, v1, late_share());
    }
  }

  void tally_rows() {
    KickWork& w = work_.work;
    for (size_t r = 0; r < work_.rows.points.size(); ++r) {
      const PointRows& p = work_.rows.points[r];
      const Impulse& impulse = work_.rows.impulse[r];
      const auto u0 = relative_velocity(p, work_.rate_before), u1 = relative_velocity(p, state_.rate);
      const auto add = [&](size_t k, double WorkDone::*cause) {
        w.before.*cause += 0.5 * impulse[k] * u0[k];
        w.after.*cause += 0.5 * impulse[k] * u1[k];
      };
      if (r < work_.first_support && p.row[0].compliance + p.row[1].compliance > 0) {
        add(0, p.row[0].compliance > 0 ? &WorkDone::joints : &WorkDone::contact_closing);
        add(1, slides(p, impulse) ? &WorkDone::friction : &WorkDone::joints);
        if (impulse[0] != 0 || impulse[1] != 0) ++report_.closed;
      } else if (r < work_.first_contact) {
        add(0, &WorkDone::bonds), add(1, &WorkDone::bonds);
      } else if (r < work_.first_support) {
        add(0, &WorkDone::contact_closing), add(1, &WorkDone::friction);
        if (impulse[0] != 0 || impulse[1] != 0) ++report_.closed;
      } else {
        add(0, &WorkDone::supports), add(1, &WorkDone::supports);
      }
    }
    // a driven block passes on the work that its drive does against the rows
    for (size_t i = 0; i < state_.rate.size(); ++i) {
      if (blocks_.moves_freely(static_cast<int>(i))) continue;
      tally(w.before.supports, w.after.supports, -1.0 * row_force_[i], work_.rate_before[i], state_.rate[i],
            0.5);
    }
  }

  void measure_balance() {
    double worst = 0, sum = 0;
    int n = 0;
    for (size_t i = 0; i < state_.rate.size(); ++i) {
      if (!blocks_.moves_freely(static_cast<int>(i))) continue;
      const BlockForce rows = (1 / work_.dt_kick) * row_force_[i];
      state_.contact_force[i] = rows;
      worst = std::max(worst, force_norm(blocks_, i, forces_[i] + rows));
      sum += 0.5 * (force_norm(blocks_, i, forces_[i]) + force_norm(blocks_, i, rows));
      ++n;
    }
    report_.unbalanced = sum > 0 ? worst / (sum / n) : 0;
  }

  // Share of a kick that belongs to the step after it: half, unless the step length changes; all of it at the
  // start.
  double late_share() const { return 0.5 * dt_ / work_.dt_kick; }

  void tally_energy() {
    Energy& e = report_.energy;
    e = energy_now(blocks_, scene_.model.gravity, state_);
    e.work = state_.work;
    e.work += work_.work.before;
    // kinetic energy half a step ago, and the part of this kick that came before now: 1/2 v- M v+ for equal
    // steps
    e.kinetic = kinetic_energy(blocks_, work_.rate_before) + work_.work.before.total();
    for (size_t i = 0; i < forces_.size(); ++i) {
      if (!blocks_.moves_freely(static_cast<int>(i))) continue;
      // weight and elastic resistance, whose energies are taken from the positions
      const BlockForce own = work_.dt_kick * (forces_[i] + BlockForce{-blocks_.mass[i] * load_[i], {}});
      double before = 0, after = 0;
      tally(before, after, own, work_.rate_before[i], state_.rate[i], late_share());
      e.kinetic += before;
      // with unequal steps the energy that central differences conserve jumps, of second order in them: no
      // work
      state_.energy_start += before - (1 - late_share()) * work(own, work_.rate_before[i]);
    }
    e.left_over = e.kinetic + e.strain - state_.energy_start - e.gravity - e.work.total();
  }

  void remember() {
    for (size_t r = 0; r < work_.first_contact; ++r) {
      const Impulse& p = work_.rows.impulse[r];
      state_.bond_force[static_cast<size_t>(work_.bond_owner[r])] = {p[0] / work_.dt_kick,
                                                                     p[1] / work_.dt_kick};
    }
    remember_contacts(work_.contacts, work_.rows, work_.first_contact, timing(), state_);
    for (size_t i = 0; i < scene_.supported.size(); ++i) {
      const Impulse& p = work_.rows.impulse[work_.first_support + i];
      state_.support_force[i] = {p[0] / work_.dt_kick, -p[1] / work_.dt_kick};
    }
  }

  const Scene& scene_;
  const BlockSet& blocks_;
  const StepSettings& settings_;
  const double dt_;
  StepWork& work_;
  State& state_;
  StepReport report_;
  double scale_ = 1;
  std::vector<BlockForce> forces_, local_damping_, row_force_;
  std::vector<BlockRate> rate_free_;
  std::vector<Vec2> load_;  // acceleration by loads
};

}  // namespace

StepReport kick(const Scene& scene, const StepSettings& settings, double dt, StepWork& work, State& state) {
  return Kick(scene, settings, dt, work, state).run();
}

void drift(const Scene& scene, const StepSettings& settings, double dt, double time_end, const StepWork& work,
           State& state, StepReport& report) {
  const BlockSet& blocks = scene.blocks;
  for (int i = 0; i < blocks.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const BlockRate& v = state.rate[k];
    if (!is_finite(v.a) || !is_finite(v.G))
      throw NumericalError(fmt::format(
          "the motion of block \"{}\" is not finite at t = {:.9g} s, step {}; worst contact row: {}",
          blocks.name[k], state.time, state.step, report.worst));
    state.displacement[k] += dt * v.a;
    if (blocks.kind[k] == BlockKind::kDeformable) {
      state.strain_part[k] += dt * v.G;
      const double volume_ratio = det(kIdentity + state.strain_part[k]);
      if (!(volume_ratio > 0))
        throw NumericalError(
            fmt::format("block \"{}\" turned inside out (det F = {:.3g}) at t = {:.9g} s, step {}",
                        blocks.name[k], volume_ratio, time_end, state.step));
    } else {
      state.angle[k] += dt * v.G.yx;
      state.strain_part[k] = rotation_minus_identity(state.angle[k]);
      // the spin matrix acts on the turned arm: nothing to update
    }
  }
  state.work += work.work.before;
  state.work += work.work.after;
  report.broken_faces = update_bonds(scene.bonds, scene.model.joints, blocks.thickness, dt, state);
  state.time = time_end;
  if (settings.histories_run) state.history_time += dt;
  state.dt_before = dt;
  ++state.step;
}

std::string row_name(const Scene& scene, const StepWork& work, size_t row) {
  const PointRows& p = work.rows.points[row];
  const auto name = [&scene](int block) { return scene.blocks.name[static_cast<size_t>(block)]; };
  if (row < work.first_contact) return fmt::format("joint {} - {}", name(p.block_a), name(p.block_b));
  if (row < work.first_support) {
    const ContactKey& k = work.contacts[row - work.first_contact].key;
    return fmt::format("contact {} corner {} on {} edge {}", name(k.block_a), k.vertex, name(k.block_b),
                       k.edge);
  }
  const SupportedPoint& s = scene.supported[row - work.first_support];
  return fmt::format("support {} at {}", scene.model.supports[static_cast<size_t>(s.support)].name,
                     name(s.block));
}

}  // namespace talus
