#include "talus/step/step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/clock.h"
#include "talus/base/error.h"
#include "talus/contact/joint_state.h"
#include "talus/step/chunks.h"

namespace talus {

namespace {

// Travel of a block in one step, as share of its radius, at which a run ends: contacts could not be followed.
constexpr double kMostTravel = 10;

// Every pair would be a close one before the blow-up shows in a block turned inside out.
void check_travel(const BlockSet& blocks, const State& state, double dt) {
  for (size_t i = 0; i < state.rate.size(); ++i) {
    const double spread = std::sqrt(contract(state.rate[i].G, state.rate[i].G)) * blocks.size[i];
    const double speed = norm(state.rate[i].a) + spread;
    if (!(speed * dt <= kMostTravel * blocks.radius[i]))
      throw NumericalError(
          fmt::format("block \"{}\" moves {:.3g} times its own radius in one step at t = {:.9g} s, step {}: "
                      "the motion has "
                      "blown up, or the time step is far too long",
                      blocks.name[i], speed * dt / blocks.radius[i], state.time, state.step));
  }
}

// Norm of a generalised force as a force on the block's mass, sqrt(m F M^-1 F) [N]; the same in every frame.
double force_norm(const BlockSet& b, size_t i, const BlockForce& force) {
  return std::sqrt(b.mass[i] * std::max(0.0, work(force, accelerate(b, i, force))));
}

BlockRate operator+(const BlockRate& u, const BlockRate& v) { return {u.a + v.a, u.G + v.G}; }
BlockRate operator-(const BlockRate& u, const BlockRate& v) { return {u.a - v.a, u.G - v.G}; }

// Work of an impulse, 1/2 p (v0 + v1): `late` of p v1 belongs to the interval after it, the rest to the one
// before.
struct ImpulseWork {
  double before = 0, after = 0;
};
ImpulseWork work_of(const BlockForce& impulse, const BlockRate& v0, const BlockRate& v1, double late) {
  const double later = late * work(impulse, v1);
  return {0.5 * (work(impulse, v0) + work(impulse, v1)) - later, later};
}
void tally(KickWork& sum, Cause cause, const ImpulseWork& w) {
  sum.before[cause] += w.before, sum.after[cause] += w.after;
}

// Sums over the rows of a chunk.
struct RowSums {
  KickWork work;
  int closed = 0;
  double drift = 0;
  double closed_share = 0;  // the largest, and where
  int closed_row = -1;
  ContactError error;
  std::vector<std::pair<int, BlockForce>> on_still;  // impulses on blocks whose motion is prescribed

  RowSums& operator+=(const RowSums& o) {
    work.before += o.work.before, work.after += o.work.after;
    closed += o.closed, drift = std::max(drift, o.drift), error += o.error;
    if (o.closed_share > closed_share) closed_share = o.closed_share, closed_row = o.closed_row;
    on_still.insert(on_still.end(), o.on_still.begin(), o.on_still.end());
    return *this;
  }
};

// Sums over the blocks of a chunk.
struct BlockSums {
  KickWork work;
  double gravity = 0, strain = 0;  // energies of the positions
  double kinetic = 0;              // before the kick, and what weight and elasticity did of it before now
  double mean = 0, both = 0;       // kinetic energy of the mean velocity, mean of those before and after
  double jump = 0;                 // of the energy that central differences conserve
  double worst = 0, forces = 0;    // unbalanced force, and force
  double nudge = 0;                // kinetic energy that the forces would give in half a step
  int worst_block = -1;
  int moving = 0;

  BlockSums& operator+=(const BlockSums& o) {
    work.before += o.work.before, work.after += o.work.after;
    gravity += o.gravity, strain += o.strain, kinetic += o.kinetic, jump += o.jump;
    mean += o.mean, both += o.both;
    if (o.worst > worst) worst = o.worst, worst_block = o.worst_block;
    forces += o.forces, nudge += o.nudge, moving += o.moving;
    return *this;
  }
};

// Where the work of a point goes: along its normal, along its tangent.
std::array<Cause, 2> causes_of(Family family, const PointRows& p, const Impulse& impulse) {
  if (!is_joint(family) || !(p.row[0].compliance + p.row[1].compliance > 0)) return entry(family).cause;
  return {p.row[0].compliance > 0 ? Cause::kJoints : Cause::kContactClosing,
          slides(p, impulse) ? Cause::kFriction : Cause::kJoints};
}

class Kick {
 public:
  Kick(const Scene& scene, const StepSettings& settings, double dt, StepWork& work, State& state)
      : scene_(scene), blocks_(scene.blocks), settings_(settings), work_(work), state_(state) {
    work_.clock = {dt, 0.5 * (state.dt_before + dt), scene.model.contact.alpha, state.history_time,
                   settings.histories_run};
  }

  StepReport run() {
    work_.work = {};
    work_.laws = joint_laws(scene_.model.joints);
    work_.rate_before = state_.rate;
    damping_ = 0.5 * settings_.damping_mass * clock_.dt_kick;
    {
      const Timed timed(work_.profile.seconds[Profile::kIntegrate]);
      predict();
    }
    {
      const Timed timed(work_.profile.seconds[Profile::kDetect]);
      check_travel(blocks_, state_, clock_.dt);
      const LookAhead ahead{clock_, work_.rate_before};
      renew_pairs(blocks_, scene_.bonds, work_.laws, ahead, work_.workers, state_);
      report_.searched =
          update_contacts(blocks_, scene_.bonds, scene_.layout, work_.laws, ahead, work_.workers, state_)
              .searched;
    }
    {
      const Timed timed(work_.profile.seconds[Profile::kSetUp]);
      gather_rows();
    }
    {
      const Timed timed(work_.profile.seconds[Profile::kSolve]);
      solve();
    }
    const Timed timed(work_.profile.seconds[Profile::kIntegrate]);
    tally_rows();
    tally_blocks();
    remember();
    return report_;
  }

 private:
  double share() const { return 1 / (1 + damping_); }
  bool implicit(size_t i) const { return settings_.implicit && blocks_.kind[i] == BlockKind::kDeformable; }

  // Weight, elastic force and rates at the end of the kick as they would be without rows (theory 4.2),
  // damping included.
  void predict() {
    const Model& model = scene_.model;
    const size_t n = state_.rate.size();
    forces_.resize(n);
    elastic_.resize(n);
    local_damping_.resize(settings_.damping_local > 0 ? n : 0);
    push();
    const bool renew = settings_.implicit || work_.mobility.size() != n || work_.mobility_share != share();
    work_.mobility.resize(n);
    work_.workers.for_chunks(n, kBlocks, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) predict_block(i, renew);
    });
    work_.mobility_share = settings_.implicit ? 0 : share();
    drive_blocks(blocks_, model, scene_.layout, state_, clock_, state_.rate);
    work_.rate_free = state_.rate;
  }

  // Forces of all loads on the blocks, and the free field through the kick.
  void push() {
    const double time = state_.history_time;
    const std::vector<Vec2> acceleration = load_acceleration(scene_.model, scene_.loads, blocks_.count, time);
    load_.resize(acceleration.size());
    for (size_t k = 0; k < load_.size(); ++k) load_[k] = {blocks_.mass[k] * acceleration[k], {}};
    add_edge_and_point_loads(blocks_, scene_.model, scene_.loads, state_, time, load_);
    for (size_t k = 0; k < state_.kept_force.size(); ++k)
      load_[k] += (1 - state_.relaxed) * state_.kept_force[k];
    balance_bolts(state_);
    work_.bolt_forces.assign(state_.bolts.empty() ? 0 : load_.size(), {});
    if (!state_.bolts.empty()) add_bolt_forces(blocks_, state_, work_.bolt_forces);

    kick_free_field(acceleration);
  }

  void kick_free_field(const std::vector<Vec2>& acceleration) {
    work_.column_velocity = state_.column_rate;
    if (!clock_.histories_run) return;
    kick_columns(scene_.boundaries.free_field, scene_.model.histories, clock_, settings_.damping_mass,
                 scene_.model.inertia == Inertia::kLumped, acceleration, state_);
    if (state_.dt_before == 0) return;  // at the start: the velocity of the start
    for (size_t i = 0; i < state_.column_rate.size(); ++i)
      work_.column_velocity[i] = 0.5 * (work_.column_velocity[i] + state_.column_rate[i]);
  }

  void predict_block(size_t k, bool renew) {
    if (!blocks_.moves_freely(static_cast<int>(k))) {
      if (renew) work_.mobility[k] = {};
      return;
    }
    BlockForce& force = forces_[k];
    force = BlockForce{blocks_.mass[k] * scene_.model.gravity, {}} + load_[k];
    if (blocks_.kind[k] == BlockKind::kDeformable) {
      elastic_[k] = elastic_state(blocks_.moduli[k], state_.strain_part[k], initial_stress_of(state_, k));
      force.Q += (-blocks_.volume[k]) * elastic_[k].stress;
    }
    if (!work_.bolt_forces.empty()) force += work_.bolt_forces[k];
    if (implicit(k))
      work_.mobility[k] =
          mobility_implicit(blocks_, k, elastic_[k].rotation, share(), tangent_time2() + damping_time2());
    else if (renew)
      work_.mobility[k] = mobility_of(blocks_, k, share());
    BlockRate& v = state_.rate[k];
    BlockForce impulse = clock_.dt_kick * force;
    if (settings_.damping_local > 0) impulse += local_damping_[k] = local_damping_impulse(k);
    if (explicitly_damped(k)) impulse += stiffness_damping(k, v, v);
    if (!implicit(k) && damping_ == 0) {
      v = v + accelerate(blocks_, k, impulse);
      return;
    }
    // M_eff (v+ - v-) = impulse - what the terms of v+ in M_eff and of v- in the step's laws differ by
    impulse += (-2 * damping_) * momentum(blocks_, k, v);
    if (implicit(k))
      impulse += BlockForce{
          {}, (-(1 - clock_.old_share()) * tangent_time2() - 2 * damping_time2()) * tangent_force(k, v.G)};
    v = v + accelerate(work_.mobility[k], impulse);
  }

  // Block-implicit elasticity: the elastic force is -V [P + K (dt/k) (G+ - r^2 G-)], the alpha family of 4.6.
  double tangent_time2() const { return clock_.dt * clock_.dt_kick / clock_.position_factor(); }
  // Stiffness-proportional damping (4.5): of the rates before the kick where elasticity is explicit, of their
  // mean where it is implicit.
  double damping_time2() const { return 0.5 * settings_.damping_stiffness * clock_.dt_kick; }
  bool explicitly_damped(size_t i) const {
    return settings_.damping_stiffness > 0 && !settings_.implicit &&
           blocks_.kind[i] == BlockKind::kDeformable;
  }
  BlockForce stiffness_damping(size_t i, const BlockRate& before, const BlockRate& after) const {
    return {{}, (-damping_time2()) * tangent_force(i, before.G + after.G)};
  }

  // V K : G, the elastic tangent in the frame turned with the block.
  Mat2 tangent_force(size_t i, const Mat2& G) const {
    const Mat2 r = rotation(elastic_[i].rotation), e = transpose(r) * G;
    const PlaneModuli& c = blocks_.moduli[i];
    const double shear = c.c33 * (e.xy + e.yx);
    return blocks_.volume[i] *
           (r * Mat2{c.c11 * e.xx + c.c12 * e.yy, shear, shear, c.c12 * e.xx + c.c11 * e.yy});
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
    return -std::min(settings_.damping_local * push * clock_.dt_kick / speed, 1.0) * moving;
  }

  void gather_rows() {
    work_.rows.restart();
    const Model& model = scene_.model;
    add_bond_rows(blocks_, scene_.bonds, work_.laws, state_, work_.rate_before, clock_, work_.workers,
                  work_.rows);
    add_contact_rows(blocks_, model, work_.laws, state_, work_.rate_before, clock_, work_.workers, work_.rows,
                     work_.places);
    add_support_rows(blocks_, model, scene_.supported, state_, clock_, work_.rows);
    add_boundary_rows(blocks_, model, scene_.boundaries, state_, work_.rate_before, clock_,
                      work_.column_velocity, work_.rows);
    add_tie_rows(blocks_, scene_.boundaries.ties, state_, clock_, work_.rows);
    add_bolt_rows(blocks_, state_, work_.rate_before, clock_, work_.rows);
    work_.rows.finish();
    report_.contacts = static_cast<int>(state_.contacts.size());
  }

  void solve() {
    const StepProblem problem{work_.mobility, work_.rate_free, clock_.dt,
                              smoothing(),    work_.rows,      state_.rate};
    const Solved solved = solve_step(
        scene_.model, hard_ties(), settings_.tolerance, settings_.sharper, settings_.keep_guess,
        [this] {
          judge();
          return rows_.error;
        },
        work_.workers, work_.solvers, problem, work_.guess);
    report_.method = solved.method, report_.solve = solved.report;
    report_.error = solved.error, report_.failed = solved.failed;
    report_.second_solver = solved.second_solver;
    if (report_.error.point >= 0)
      report_.worst = row_name(scene_, state_, work_, static_cast<size_t>(report_.error.point));
  }

  // Points of faces that are tied without any give.
  size_t hard_ties() const {
    size_t count = 0;
    const RowRange faces = work_.rows.range(Family::kFace);
    for (size_t r = faces.begin; r < faces.end; ++r) count += work_.rows.points[r].row[0].compliance == 0;
    return count;
  }

  Smoothing smoothing() const {
    const ContactInput& c = scene_.model.contact;
    if (c.law == ContactLaw::kExact) return {};
    return {true, c.smoothing_force * clock_.dt_kick, c.smoothing_slip / clock_.dt};
  }

  // The error of the result, and in the same look at the rows the work they do.
  void judge() {
    rows_ = work_.workers.sum_chunks<RowSums>(work_.rows.points.size(), kRows,
                                              [this](size_t begin, size_t end, RowSums& s) {
                                                for (size_t r = begin; r < end; ++r) tally_row(r, s);
                                              });
  }

  void tally_rows() {
    work_.work.before += rows_.work.before, work_.work.after += rows_.work.after;
    report_.closed = rows_.closed;
    report_.drift = rows_.drift;
    report_.closed_share = rows_.closed_share, report_.closed_row = rows_.closed_row;
    // a driven block passes on the work that its drive does against the rows
    for (const auto& [block, impulse] : rows_.on_still) {
      const auto k = static_cast<size_t>(block);
      tally(work_.work, Cause::kSupports, work_of(-1.0 * impulse, work_.rate_before[k], state_.rate[k], 0.5));
    }
  }

  void tally_row(size_t r, RowSums& s) const {
    const PointRows& p = work_.rows.points[r];
    const Impulse& impulse = work_.rows.impulse[r];
    const RowOwner owner = work_.rows.owner[r];
    const bool contact = owner.family == Family::kContact;
    if (contact && p.row[0].compliance == 0) s.drift = std::max(s.drift, -work_.places[owner.at()].gap);
    if (contact && work_.places[owner.at()].closed > s.closed_share)
      s.closed_share = work_.places[owner.at()].closed, s.closed_row = static_cast<int>(r);
    const auto u1 = relative_velocity(p, state_.rate);
    s.error += {clock_.dt * point_error(work_.mobility, work_.rows, r, u1, s.error.worst / clock_.dt),
                static_cast<int>(r)};
    if (impulse[0] == 0 && impulse[1] == 0) return;
    for (const auto& [block, sign] : {std::pair(p.block_a, 1.0), std::pair(p.block_b, -1.0)})
      if (block >= 0 && !work_.mobility[static_cast<size_t>(block)].moves())
        s.on_still.emplace_back(block, impulse_on(p, impulse, sign));
    const auto u0 = relative_velocity(p, work_.rate_before);
    const std::array<Cause, 2> cause = causes_of(owner.family, p, impulse);
    for (size_t k = 0; k < 2; ++k) {
      s.work.before[cause[k]] += 0.5 * impulse[k] * u0[k];
      s.work.after[cause[k]] += 0.5 * impulse[k] * u1[k];
    }
    s.closed += contact || (is_joint(owner.family) && p.row[0].compliance + p.row[1].compliance > 0);
  }

  // Impulse that gives a block this change of its rates: the effective mass times it.
  BlockForce impulse_for(size_t i, const BlockRate& change) const {
    BlockForce impulse = (1 + damping_) * momentum(blocks_, i, change);
    if (implicit(i))
      impulse += BlockForce{{}, (tangent_time2() + damping_time2()) * tangent_force(i, change.G)};
    return impulse;
  }

  // Share of a kick that belongs to the step after it: half, unless the step length changes; all of it at the
  // start.
  double late_share() const { return 0.5 * clock_.dt / clock_.dt_kick; }

  void tally_blocks() {
    const BlockSums sums = work_.workers.sum_chunks<BlockSums>(
        state_.rate.size(), kBlocks, [this](size_t begin, size_t end, BlockSums& s) {
          for (size_t i = begin; i < end; ++i) tally_block(i, s);
        });
    work_.work.before += sums.work.before, work_.work.after += sums.work.after;
    report_.worst_block = sums.worst_block, report_.worst_force = sums.worst;
    report_.unbalanced = sums.forces > 0 ? sums.worst / (sums.forces / sums.moving) : 0;
    report_.nudge = sums.nudge;

    Energy& e = report_.energy;
    e.gravity = sums.gravity, e.strain = sums.strain;
    e.work = state_.work;
    e.work += work_.work.before;
    // kinetic energy half a step ago, and the part of this kick that came before now: 1/2 v- M v+ for equal
    // steps
    const double ledger = sums.kinetic + work_.work.before.total();
    e.kinetic = sums.mean, e.moving = sums.both, e.between = ledger - e.kinetic;
    // with unequal steps the energy that central differences conserve jumps, of second order in them: no work
    state_.energy_start += sums.jump;
    e.left_over = ledger + e.strain - state_.energy_start - e.gravity - e.work.total();
  }

  void tally_block(size_t i, BlockSums& s) {
    const BlockRate &v0 = work_.rate_before[i], &v1 = state_.rate[i];
    if (!blocks_.moves_freely(static_cast<int>(i))) return;
    const double late = late_share(), kick = clock_.dt_kick;
    const BlockForce viscous = (-settings_.damping_mass * kick) * momentum(blocks_, i, mean(v0, v1));
    tally(s.work, Cause::kLoads, work_of(kick * load_[i], v0, v1, late));
    tally(s.work, Cause::kDamping, work_of(viscous, v0, v1, late));
    if (settings_.damping_local > 0) tally(s.work, Cause::kDamping, work_of(local_damping_[i], v0, v1, late));

    if (settings_.damping_stiffness > 0 && blocks_.kind[i] == BlockKind::kDeformable)
      tally(s.work, Cause::kDamping, work_of(stiffness_damping(i, v0, implicit(i) ? v1 : v0), v0, v1, late));

    BlockForce force = forces_[i];
    if (implicit(i)) {
      const BlockForce more{{}, (-tangent_time2()) * tangent_force(i, v1.G - clock_.old_share() * v0.G)};
      tally(s.work, Cause::kImplicit, work_of(more, v0, v1, late));
      force += (1 / kick) * more;
    }
    const BlockForce rows = (1 / kick) * impulse_for(i, v1 - work_.rate_free[i]);
    state_.contact_force[i] = rows;
    const double unbalanced = force_norm(blocks_, i, force + rows);
    if (unbalanced > s.worst) s.worst = unbalanced, s.worst_block = static_cast<int>(i);
    const double acting = 0.5 * (force_norm(blocks_, i, force) + force_norm(blocks_, i, rows));
    s.forces += acting;
    s.nudge += 0.125 * kick * kick * acting * acting / blocks_.mass[i];
    ++s.moving;

    s.gravity += blocks_.mass[i] * dot(scene_.model.gravity, state_.displacement[i]);
    s.strain += blocks_.volume[i] * elastic_[i].density;
    const double energy_0 = 0.5 * work(momentum(blocks_, i, v0), v0);
    s.kinetic += energy_0;
    // at the start v0 is the velocity of this instant, later that of half a step ago
    const BlockRate now = state_.dt_before > 0 ? talus::mean(v0, v1) : v0;
    s.mean += 0.5 * work(momentum(blocks_, i, now), now);
    s.both += 0.5 * energy_0 + 0.25 * work(momentum(blocks_, i, v1), v1);
    // weight and elastic resistance, whose energies are taken from the positions
    BlockForce own = kick * (forces_[i] + (-1) * load_[i]);
    if (!work_.bolt_forces.empty()) {
      const BlockForce bars = kick * work_.bolt_forces[i];
      tally(s.work, Cause::kBolts, work_of(bars, v0, v1, late));
      own += (-1) * bars;
    }
    const double before = work_of(own, v0, v1, late).before;
    s.kinetic += before;
    s.jump += before - (1 - late) * work(own, v0);
  }

  void remember() {
    remember_bonds(blocks_, scene_.bonds, work_.rows, clock_, work_.workers, state_);
    remember_contacts(work_.rows, work_.places, clock_, work_.workers, state_);
    for (auto* force : {&state_.support_force, &state_.boundary_force, &state_.tie_force})
      std::fill(force->begin(), force->end(), std::array{0.0, 0.0});
    for (size_t r = work_.rows.range(Family::kSupport).begin; r < work_.rows.range(Family::kTie).end; ++r) {
      const RowOwner owner = work_.rows.owner[r];
      const Impulse& p = work_.rows.impulse[r];
      const std::array<double, 2> force{p[0] / clock_.dt_kick, p[1] / clock_.dt_kick};
      if (owner.family == Family::kSupport) state_.support_force[owner.at()] = {force[0], -force[1]};
      if (owner.family == Family::kBoundary) state_.boundary_force[owner.at()] = force;
      if (owner.family == Family::kTie) state_.tie_force[owner.at()] = force;
    }
    remember_bolts(work_.rows, clock_, state_);
  }

  const Scene& scene_;
  const BlockSet& blocks_;
  const StepSettings& settings_;
  StepWork& work_;
  const StepClock& clock_ = work_.clock;
  State& state_;
  StepReport report_;
  RowSums rows_;
  double damping_ = 0;  // half the share of its momentum that mass-proportional damping takes in the step
  std::vector<BlockForce>& forces_ = work_.forces;
  std::vector<BlockForce>& local_damping_ = work_.local_damping;
  std::vector<ElasticState>& elastic_ = work_.elastic;
  std::vector<BlockForce> load_;  // by loads
};

}  // namespace

BlockRate rate_now(const StepWork& work, const State& state, size_t i) {
  return state.dt_before > 0 ? mean(work.rate_before[i], state.rate[i]) : work.rate_before[i];
}

StepReport kick(const Scene& scene, const StepSettings& settings, double dt, StepWork& work, State& state) {
  StepReport report;
  work.workers.together([&] { report = Kick(scene, settings, dt, work, state).run(); });
  return report;
}

std::string row_name(const Scene& scene, const State& state, const StepWork& work, size_t row) {
  const PointRows& p = work.rows.points[row];
  const auto name = [&scene](int block) { return scene.blocks.name[static_cast<size_t>(block)]; };
  const RowOwner owner = work.rows.owner[row];
  const std::string kind = entry(owner.family).name;
  const auto at = [&](const std::string& what) {
    return fmt::format("{} {} at {}", kind, what, name(p.block_a));
  };
  const auto boundary = [&scene](int which) {
    return scene.model.boundaries[static_cast<size_t>(which)].name;
  };
  switch (owner.family) {
    case Family::kFace:
      break;
    case Family::kContact: {
      const ContactKey& k = state.contacts[owner.at()].key;
      return fmt::format("{} {} corner {} on {} edge {}", kind, name(k.block_a), k.vertex, name(k.block_b),
                         k.edge);
    }
    case Family::kSupport:
      return at(scene.model.supports[static_cast<size_t>(scene.supported[owner.at()].support)].name);
    case Family::kBoundary:
      return at(boundary(scene.boundaries.points[owner.at()].boundary));
    case Family::kTie:
      return at(boundary(scene.boundaries.ties[owner.at()].boundary));
    case Family::kBolt:
      return fmt::format("{} {} between {} and {}", kind,
                         scene.model.bolts[static_cast<size_t>(state.bolts[owner.at()].input)].name,
                         name(p.block_a), name(p.block_b));
  }
  return fmt::format("{} {} - {}", kind, name(p.block_a), name(p.block_b));
}

}  // namespace talus
