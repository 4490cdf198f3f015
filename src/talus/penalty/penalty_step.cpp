#include "talus/penalty/penalty_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/corners/follow.h"
#include "talus/rows/rows.h"
#include "talus/supports/loads.h"

namespace talus {

namespace {

// Solutions of an iteration in which friction may find its pressure.
constexpr int kMostFrictionTurns = 60;
constexpr double kLeastShare = 1.0 / 16;

// Change of the pressure that friction goes by, as share of it, below which it has found it.
constexpr double kSamePressure = 1e-3;

// Iterations after which gaps and slips that are none (springs.h) double from iteration to iteration, and how often.
constexpr int kFirmIterations = 6, kWidenings = 9;

Six part_of(const std::vector<double>& x, size_t block) {
  Six d;
  std::copy_n(x.begin() + (6 * block), 6, d.begin());
  return d;
}

Mat2 shape_of(const State& state, size_t i) { return kIdentity + state.strain_part[i]; }

// Velocity of a block in its shape of now; the spin of one that does not deform is that already.
Six velocity_of(const BlockSet& blocks, const State& state, size_t i) {
  const BlockRate& v = state.rate[i];
  return six_of(v.a, blocks.kind[i] == BlockKind::kDeformable ? v.G * inverse(shape_of(state, i)) : v.G);
}

}  // namespace

void begin_penalty(const Scene& scene, const Newmark& scheme, State& state) {
  const int n = scene.blocks.count;
  state.carried_stress.resize(n);
  for (int i = 0; i < n; ++i) state.carried_stress[i] = initial_stress_of(state, i);
  // Shi's scheme does not ask for them
  if (scheme.beta != 0.5 || scheme.gamma != 1) state.acceleration.resize(n);
}

PenaltyReport PenaltySteps::step(const PenaltySettings& settings, double end, bool dynamic, State& state) {
  PenaltyReport report;
  report.parts = 0;
  int cuts = 0;
  double part = end - state.time;
  const State begun = state;
  try {
    while (state.time < end) {
      const double left = end - state.time;
      // the last part ends on the step's end
      const double dt = part >= left * (1 - 1e-9) ? left : part;
      State before = state;
      if (try_part(settings, dt, dynamic, state, report)) {
        state.time = dt == left ? end : before.time + dt;
        ++report.parts;
        if (cuts > 0) --cuts, part = std::min(3 * part, end - state.time);
        continue;
      }
      state = before;
      if (++cuts > settings.most_cuts)
        throw NumericalError(fmt::format(
            "open-close iteration does not end at t = {:.9g} s, step {}, in a {} of the step: {} contacts. A smaller "
            "time_step or another penalty stiffness may help",
            state.time, state.step, fmt::format("{:.2g}th", std::pow(3.0, settings.most_cuts)),
            springs_.size()));
      part = dt / 3;
    }
  } catch (const NumericalError&) {
    state = begun;  // what is left is the instant at which the step began
    throw;
  }
  if (report.parts > 1) {
    // forces are those of the last part; what is made of them, impulses and accelerations, is of the whole step
    const double whole = end - begun.time;
    state.dt_before = whole, state.rate_old = work_.rate_before = begun.rate;
    work_.clock = {whole, whole, 0, begun.history_time, dynamic ? whole : 0, dynamic, false};
    show(settings, whole, state);
  }
  ++state.step;
  state.judged.iterations = report.iterations;
  return report;
}

void PenaltySteps::seek_contacts(State& state) {
  const LookAhead ahead{work_.clock, work_.rate_before};
  renew_pairs(scene_.blocks, scene_.bonds, scene_.layout, scene_.laws, ahead, work_.workers, state);
  update_contacts(scene_.blocks, scene_.bonds, scene_.layout, ahead, work_.workers, state);
}

void PenaltySteps::stand(const PenaltySettings& settings, double dt, State& state) {
  // as the step before has left them, whatever the steps of this stage
  const double before = state.dt_before > 0 ? state.dt_before : dt;
  work_.clock = {before, before, 0, state.history_time, 0, false, false};
  work_.rate_before = state.rate_old.empty() ? state.rate : state.rate_old;
  // blocks that the stage takes out, or the first instant of all
  if (state.candidates.reach.empty()) seek_contacts(state);
  show(settings, before, state);
}

// Rows and places of an instant, with what contacts and supports remember.
void PenaltySteps::show(const PenaltySettings& settings, double dt, State& state) {
  gather_springs(scene_, state, settings.stiffness, springs_);
  for (Spring& s : springs_) {
    const int k = s.index;
    s.force = s.glued ? state.bond_force[k] : state.contacts[k].force;
    s.gap_after = s.gap;
  }
  write_rows(dt, state);
}

void PenaltySteps::gather(const PenaltySettings& settings, double dt, State& state) {
  const BlockSet& blocks = scene_.blocks;
  const Model& model = scene_.model;
  const int n = blocks.count;
  work_.rate_before = state.rate;
  seek_contacts(state);
  gather_springs(scene_, state, settings.stiffness, springs_);
  rows_.resize(springs_.size());
  for (size_t k = 0; k < springs_.size(); ++k) rows_[k] = rows_of(springs_[k], blocks);

  const double time = work_.clock.history_end();
  const std::vector<Vec2> acceleration = load_acceleration(model, scene_.loads, blocks.count, time);
  std::vector<BlockForce> load(n);
  add_edge_and_point_loads(blocks, model, scene_.loads, state, time, load);

  own_.assign(n, Tile{}), pushed_.assign(n, Six{}), outside_.assign(n, Six{});
  const auto [beta, gamma] = settings.scheme;
  for (int i = 0; i < n; ++i) {
    Tile& k = own_[i];
    const int block = i;
    if (!blocks.moves_freely(block)) continue;  // below
    const Mat2 F = shape_of(state, i);
    const bool deforms = blocks.kind[i] == BlockKind::kDeformable;
    Tile mass = mass_tile(blocks.mass[i], F * blocks.inertia[i] * transpose(F));
    if (!deforms)
      for (size_t a = 0; a < 6; ++a)
        for (size_t b = 0; b < 6; ++b)
          if (a > 2 || b > 2) mass[6 * a + b] = a == b ? blocks.mass[i] : 0;
    const Six v = velocity_of(blocks, state, i);
    for (size_t j = 0; j < 36; ++j) k[j] = mass[j] / (beta * dt * dt);
    const BlockForce push{load[i].f + blocks.mass[i] * (model.gravity + acceleration[i]), load[i].Q};
    outside_[i] = six_of(push, deforms ? F : kIdentity);  // of others forces are on arms as they lie
    Six a0{};
    if (!state.acceleration.empty()) {
      if (state.dt_before == 0) {  // at the start by what acts then; contacts are not asked yet
        BlockForce all = push;
        if (deforms)
          all.Q += (-blocks.volume[i] * det(F)) * (state.carried_stress[i] * transpose(inverse(F)));
        const BlockRate begins = accelerate(blocks, i, all);
        state.acceleration[i] = {begins.a, deforms ? begins.G * inverse(F) : begins.G};
      }
      a0 = six_of(state.acceleration[i].a, state.acceleration[i].G);
    }
    Six force = outside_[i];
    force += mass * ((1 / (beta * dt)) * v);
    force += mass * ((0.5 / beta - 1) * a0);
    if (deforms) {
      const double volume = blocks.volume[i] * det(F);
      const Tile elastic = elastic_tile(blocks.moduli[i], volume);
      for (size_t j = 0; j < 36; ++j) k[j] += elastic[j];
      force += stress_force(state.carried_stress[i], volume);
    } else {
      force[3] = force[4] = force[5] = 0;
    }
    pushed_[i] = force;
  }
  // rows of what does not move: in the scale of the others
  double scale = 0;
  for (const Tile& k : own_) scale = std::max(scale, k[0]);
  for (int i = 0; i < n; ++i)
    if (!blocks.moves_freely(i))
      for (size_t j = 0; j < 6; ++j) own_[i][7 * j] = scale > 0 ? scale : 1;
  held_.clear();
  for (int p = 0; p < count_of(scene_.supported); ++p) {
    const SupportedPoint& point = scene_.supported[p];
    const int i = point.block;
    if (!point.active || !blocks.moves_freely(point.block)) continue;
    const SupportInput& input = model.supports[point.support];
    const Vec2 arm = shape_of(state, i) * point.arm,
               moved = displacement_at(state, i, point.arm) - state.supports[p].hold;
    Held held;
    held.point = p;
    const auto hold = [&](size_t k, const Motion& motion, Vec2 axis, double at) {
      if (motion.kind == Motion::kFree) return;
      held.row[k] = along(axis, arm);
      if (blocks.kind[i] == BlockKind::kRigid) held.row[k][3] = held.row[k][4] = held.row[k][5] = 0;
      held.stiffness[k] = settings.support_stiffness;
      held.off[k] = at - motion.displacement_at(time, model.histories);
      add(own_[i], held.row[k], held.row[k], held.stiffness[k]);
      pushed_[i] += (-held.stiffness[k] * held.off[k]) * held.row[k];
    };
    hold(0, input.x, {1, 0}, moved.x), hold(1, input.y, {0, 1}, moved.y);
    held_.push_back(held);
  }
  find_pattern();
}

// Which blocks have springs between them: the factor is analysed anew only where that changes.
void PenaltySteps::find_pattern() {
  std::vector<std::array<int, 2>> pairs;
  pair_of_.assign(springs_.size(), -1);
  const BlockSet& blocks = scene_.blocks;
  for (const Spring& s : springs_)
    if (blocks.moves_freely(s.block_a) && blocks.moves_freely(s.block_b))
      pairs.push_back({std::min(s.block_a, s.block_b), std::max(s.block_a, s.block_b)});
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (size_t k = 0; k < springs_.size(); ++k) {
    const Spring& s = springs_[k];
    const std::array<int, 2> pair{std::min(s.block_a, s.block_b), std::max(s.block_a, s.block_b)};
    const auto it = std::lower_bound(pairs.begin(), pairs.end(), pair);
    if (it != pairs.end() && *it == pair) pair_of_[k] = static_cast<int>(it - pairs.begin());
  }
  if (pairs == pairs_ && diagonal_.size() == own_.size()) return;
  pairs_ = std::move(pairs);
  factor_.analyse(pairs_, blocks.centroid);
  diagonal_.resize(own_.size());
}

// A force along a row of a block, onto the right-hand side.
void PenaltySteps::push(int block, const Six& row, double force) {
  if (!scene_.blocks.moves_freely(block)) return;
  for (size_t j = 0; j < 6; ++j) solution_[6 * block + j] += force * row[j];
}

void PenaltySteps::assemble(const BlockSet& blocks) {
  diagonal_ = own_;
  beside_.assign(pairs_.size(), Tile{});
  solution_.assign(6 * own_.size(), 0);
  for (size_t i = 0; i < pushed_.size(); ++i)
    std::copy(pushed_[i].begin(), pushed_[i].end(), solution_.begin() + (6 * i));
  for (size_t k = 0; k < springs_.size(); ++k) {
    const Spring& s = springs_[k];
    if (s.state == SpringState::kOpen) continue;
    const SpringRows& rows = rows_[k];
    const std::array<double, 2> off{s.gap, s.slip};
    for (size_t r = 0; r < 2; ++r) {
      if (r == 1 && s.state == SpringState::kSliding) continue;  // friction: solve_with_friction()
      const double p = s.stiffness[r];
      if (blocks.moves_freely(s.block_a)) add(diagonal_[s.block_a], rows.a[r], rows.a[r], p);
      if (blocks.moves_freely(s.block_b)) add(diagonal_[s.block_b], rows.b[r], rows.b[r], p);
      if (pair_of_[k] >= 0) {
        const bool in_order = s.block_a < s.block_b;
        add(beside_[pair_of_[k]], in_order ? rows.a[r] : rows.b[r], in_order ? rows.b[r] : rows.a[r], p);
      }
      push(s.block_a, rows.a[r], -p * off[r]), push(s.block_b, rows.b[r], -p * off[r]);
    }
  }
}

// Solves with the states as they are, again while friction does not go by the pressure that it makes (theory 13.4); false
// where it does not find it.
bool PenaltySteps::solve_with_friction() {
  const std::vector<double> without = solution_;
  double share = 1, apart = std::numeric_limits<double>::infinity();
  for (int turn = 0; turn <= kMostFrictionTurns; ++turn) {
    if (turn > 0) solution_ = without;
    for (size_t k = 0; k < springs_.size(); ++k) {
      const Spring& s = springs_[k];
      if (s.state != SpringState::kSliding) continue;
      const double friction = -s.side * s.bears.limit(s.pressing);
      push(s.block_a, rows_[k].a[1], friction), push(s.block_b, rows_[k].b[1], friction);
    }
    factor_.solve(solution_, work_.workers);
    for (size_t i = 0; i < displacement_.size(); ++i) displacement_[i] = part_of(solution_, i);
    bool same = true;
    double off = 0;
    pressure_.assign(springs_.size(), 0);
    for (size_t k = 0; k < springs_.size(); ++k) {
      const Spring& s = springs_[k];
      if (s.state != SpringState::kSliding) continue;
      pressure_[k] = pressure_after(displacement_[s.block_a], displacement_[s.block_b], rows_[k], s);
      const double change = std::abs(pressure_[k] - s.pressing);
      same = same && change <= kSamePressure * pressure_[k] + s.stiffness[0] * s.same[0];
      off = std::max(off, s.bears.friction * change);
    }
    if (same) return true;
    // friction that takes its own pressure away swings about it: go a part of the way
    if (off > 0.7 * apart) share = std::max(0.5 * share, kLeastShare);
    apart = off;
    for (size_t k = 0; k < springs_.size(); ++k)
      if (Spring& s = springs_[k]; s.state == SpringState::kSliding)
        s.pressing += share * (pressure_[k] - s.pressing);
  }
  return false;
}

bool PenaltySteps::try_part(const PenaltySettings& settings, double dt, bool dynamic, State& state,
                            PenaltyReport& report) {
  const BlockSet& blocks = scene_.blocks;
  work_.clock = {dt, dt, 0, state.history_time, dynamic ? dt : 0, dynamic, false};
  gather(settings, dt, state);
  const int n = blocks.count;
  displacement_.resize(n);
  for (int turn = 0; turn < settings.most_iterations; ++turn) {
    assemble(blocks);
    if (!factor_.factorize(diagonal_, beside_, work_.workers))
      throw NumericalError(
          fmt::format("the stiffness matrix of step {} at t = {:.9g} s is not positive definite", state.step,
                      state.time));
    const bool friction = solve_with_friction();
    ++report.iterations;
    if (turn >= kFirmIterations && turn < kFirmIterations + kWidenings)
      for (Spring& s : springs_) s.same[0] *= 2, s.same[1] *= 2;
    int changes = 0;
    for (size_t k = 0; k < springs_.size(); ++k)
      changes += follow(displacement_[springs_[k].block_a], displacement_[springs_[k].block_b], rows_[k],
                        springs_[k]);
    report.changes += changes;
    if (changes > 0 || !friction) continue;
    double farthest = 0;
    for (int i = 0; i < n; ++i)
      farthest = std::max(farthest, std::hypot(displacement_[i][0], displacement_[i][1]));
    if (farthest > settings.largest_displacement) return false;
    report.largest_displacement = std::max(report.largest_displacement, farthest);
    report.condition = std::max(report.condition, factor_.pivot_ratio());
    finish(settings, dt, state, report);
    return true;
  }
  return false;
}

// Theory 13.5.
void PenaltySteps::finish(const PenaltySettings& settings, double dt, State& state, PenaltyReport& report) {
  const BlockSet& blocks = scene_.blocks;
  const int n = blocks.count;
  const auto [beta, gamma] = settings.scheme;
  WorkDone& work = state.work;
  state.judged.unbalanced = state.judged.worst_force = state.judged.moving = state.judged.nudge = 0,
  state.judged.worst_block = -1;
  double forces = 0;
  int moving = 0;
  std::vector<double> by_springs(n, 0);
  for (const Spring& s : springs_)
    for (const int block : {s.block_a, s.block_b}) by_springs[block] += std::hypot(s.force[0], s.force[1]);
  for (int i = 0; i < n; ++i) {
    if (!blocks.moves_freely(i)) continue;
    const Six& d = displacement_[i];
    for (const double v : d)
      if (!std::isfinite(v))
        throw NumericalError(fmt::format("the motion of block \"{}\" is not finite at t = {:.9g} s, step {}",
                                         blocks.name[i], state.time, state.step));
    const Mat2 F = shape_of(state, i);
    const Six v0 = velocity_of(blocks, state, i);
    Six a0{};
    if (!state.acceleration.empty()) a0 = six_of(state.acceleration[i].a, state.acceleration[i].G);
    Six v1 = (gamma / (beta * dt)) * d, a1 = (1 / (beta * dt * dt)) * d;
    v1 += (1 - gamma / beta) * v0, v1 += (dt * (1 - 0.5 * gamma / beta)) * a0;
    a1 += (-1 / (beta * dt)) * v0, a1 += (1 - 0.5 / beta) * a0;

    const bool deforms = blocks.kind[i] == BlockKind::kDeformable;
    const Mat2 second = F * blocks.inertia[i] * transpose(F);
    const Six inertia = mass_tile(blocks.mass[i], second) * a1;
    const double unbalanced =
        std::hypot(inertia[0], inertia[1]) + std::abs(inertia[2]) / std::max(blocks.size[i], 1e-300);
    if (unbalanced > state.judged.worst_force)
      state.judged.worst_force = unbalanced, state.judged.worst_block = i;
    const double acting = 0.5 * (std::hypot(outside_[i][0], outside_[i][1]) + by_springs[i]);
    forces += acting, ++moving;
    state.judged.nudge += 0.125 * dt * dt * acting * acting / blocks.mass[i];
    state.judged.moving += 0.5 * dot((1 / dt) * d, mass_tile(blocks.mass[i], second) * ((1 / dt) * d));

    const Six weight{
        blocks.mass[i] * scene_.model.gravity.x, blocks.mass[i] * scene_.model.gravity.y, 0, 0, 0, 0};
    work[Cause::kLoads] += dot(outside_[i], d) - dot(weight, d);
    if (deforms) {
      const double volume = blocks.volume[i] * det(F);
      const Mat2 more = stress_by(blocks.moduli[i], d);
      state.strain_work += -dot(stress_force(state.carried_stress[i] + 0.5 * more, volume), d);
      Mat2 stress = state.carried_stress[i] + more;
      if (settings.exact_rotation) {
        const Mat2 r = kIdentity + rotation_minus_identity(d[2]);
        stress = r * stress * transpose(r);
      }
      state.carried_stress[i] = stress;
      state.strain_part[i] = deformed(F, d, settings.exact_rotation) - kIdentity;
      if (!(det(shape_of(state, i)) > 0))
        throw NumericalError(fmt::format("block \"{}\" turned inside out at t = {:.9g} s, step {}",
                                         blocks.name[i], state.time, state.step));
    } else {
      state.angle[i] += d[2];
      state.strain_part[i] = rotation_minus_identity(state.angle[i]);
    }
    state.displacement[i] += Vec2{d[0], d[1]};
    const Six v = settings.dynamic_factor * v1;
    state.rate[i] = {{v[0], v[1]}, gradient_of(v) * (deforms ? shape_of(state, i) : kIdentity)};
    if (!deforms) state.rate[i].G = spin_matrix(v[2]);
    if (!state.acceleration.empty()) {
      const Six a = settings.dynamic_factor * a1;
      state.acceleration[i] = {{a[0], a[1]}, gradient_of(a)};
    }
    const Six lost = v1;
    const double share = 1 - settings.dynamic_factor * settings.dynamic_factor;
    if (share > 0) work[Cause::kDamping] -= share * 0.5 * dot(lost, mass_tile(blocks.mass[i], second) * lost);
  }
  state.judged.unbalanced = forces > 0 ? state.judged.worst_force / (forces / moving) : 0;
  for (const Held& held : held_) {
    const int i = scene_.supported[held.point].block;
    std::array<double, 2> force{};
    for (size_t k = 0; k < 2; ++k) {
      const double moved = dot(held.row[k], displacement_[i]);
      force[k] = -held.stiffness[k] * (held.off[k] + moved);
      work[Cause::kSupports] += force[k] * moved;
    }
    state.supports[held.point].force = force;
  }
  for (const Spring& s : springs_) {
    const double closing = s.gap_after - s.gap;
    if (s.glued) {
      work[Cause::kBonds] += s.force[0] * closing + s.force[1] * s.slip_step;
      state.bond_force[s.index] = s.force;
      continue;
    }
    work[Cause::kContactClosing] += s.force[0] * closing;
    work[s.state == SpringState::kSliding ? Cause::kFriction : Cause::kJoints] += s.force[1] * s.slip_step;
    if (s.force[0] > 0) report.penetration = std::max(report.penetration, -s.gap_after);
    Contact& c = state.contacts[s.index];
    c.force = s.force;
    const bool closed = s.state != SpringState::kOpen;
    c.touched = c.touched || closed;
    c.memory = closed ? Contact::kWhole : Contact::kNone;
    c.stretch = 0;
    if (s.state == SpringState::kSliding) {
      c.stretch = -s.force[1] / s.stiffness[1];
      c.anchor = std::numeric_limits<double>::quiet_NaN();
      c.slip += std::abs(s.slip_step), c.slip_signed += s.slip_step;
    } else if (closed) {
      c.stretch = s.slip + s.slip_step;
      const CornerEdge over = corner_over_edge(blocks, state, c.key.corner(), c.key.on());
      const Vec2 edge = blocks.corner(blocks.end_of(c.key.on())) - blocks.corner({c.key.block_b, c.key.edge});
      c.anchor = -over.along * norm(edge) - (s.slip + s.slip_step);
    }
  }
  update_bonds(blocks, scene_.bonds, scene_.laws, dt, work_.workers, state);
  state.history_time = work_.clock.history_end();
  state.dt_before = dt;
  state.rate_old = work_.rate_before;
  show(settings, dt, state);
}

// What the springs carry as rows, which observers read.
void PenaltySteps::write_rows(double dt, State& state) {
  const BlockSet& blocks = scene_.blocks;
  RowSet& rows = work_.rows;
  rows.restart();
  work_.gaps.assign(state.contacts.size(), 0);
  state.row_force.assign(blocks.count, {});
  for (const Spring& s : springs_) {
    PointRows p;
    p.block_a = s.block_a, p.block_b = s.block_b;
    const int a = s.block_a, b = s.block_b;
    // springs hang on arms as they lay before the step: in the reference of a deformable block
    const auto acting = [&](size_t i, Vec2 arm) {
      return blocks.kind[i] == BlockKind::kDeformable ? inverse(shape_of(state, i)) * arm : arm;
    };
    p.arm_a = acting(a, s.arm_a), p.arm_b = acting(b, s.arm_b);
    p.normal = s.normal;
    p.lower = s.glued ? -std::numeric_limits<double>::infinity() : 0;
    p.friction = s.bears.friction, p.cohesion = s.bears.cohesion * dt;
    for (size_t k = 0; k < 2; ++k) p.row[k].compliance = 1 / (s.stiffness[k] * dt * dt);
    rows.add(p, {s.force[0] * dt, s.force[1] * dt}, {s.glued ? Family::kFace : Family::kContact, s.index});
    if (!s.glued) work_.gaps[s.index] = s.gap_after;
  }
  for (int i = 0; i < count_of(scene_.supported); ++i) {
    const SupportedPoint& point = scene_.supported[i];
    if (!point.active || !blocks.moves_freely(point.block)) continue;
    PointRows p;
    p.block_a = point.block;
    p.arm_a = acting_arm(blocks, state, point.block, point.arm);
    p.normal = {1, 0};
    const auto& force = state.supports[i].force;
    rows.add(p, {force[0] * dt, -force[1] * dt}, {Family::kSupport, i});
  }
  rows.finish();
}

StepReport PenaltySteps::report(const State& state) const {
  const BlockSet& blocks = scene_.blocks;
  StepReport r;
  r.contacts = count_of(state.contacts);
  for (const Contact& c : state.contacts) r.closed += c.force[0] != 0;
  r.solve.iterations = state.judged.iterations;
  const RowRange contacts = work_.rows.range(Family::kContact);
  for (size_t row = contacts.begin; row < contacts.end; ++row) {
    const PointRows& p = work_.rows.points[row];
    const double thin = std::min(blocks.thinness[p.block_a], blocks.thinness[p.block_b]);
    const double closed = -work_.gaps[work_.rows.owner[row].at()] / thin;
    if (closed > r.closed_share) r.closed_share = closed, r.closed_row = static_cast<int>(row);
  }
  r.unbalanced = state.judged.unbalanced, r.worst_force = state.judged.worst_force,
  r.worst_block = state.judged.worst_block, r.nudge = state.judged.nudge;
  Energy& e = r.energy;
  e.kinetic = kinetic_energy(blocks, state.rate);
  e.moving = std::max(state.judged.moving, e.kinetic);
  e.strain = state.strain_work;
  for (int i = 0; i < count_of(state.displacement); ++i)
    if (blocks.moves_freely(i))
      e.gravity += blocks.mass[i] * dot(scene_.model.gravity, state.displacement[i]);
  e.work = state.work;
  e.left_over = e.kinetic + e.strain - state.energy_start - e.gravity - e.work.total();
  return r;
}

}  // namespace talus
