#include "talus/contact/patch_rows.h"

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/contact/hard_contact.h"
#include "talus/contact/joint_state.h"

namespace talus {

namespace {

// Pairs to a chunk.
constexpr size_t kPatchRowGrain = 256;

class PatchRows {
 public:
  PatchRows(const PatchWorld& world, const ContactGive& give, const State& state,
            const std::vector<BlockRate>& before, const StepClock& clock, size_t first, RowSet& rows,
            std::vector<double>& gaps)
      : w_(world),
        state_(state),
        before_(before),
        clock_(clock),
        give_(give, world.blocks, clock),
        first_(first),
        rows_(rows),
        gaps_(gaps) {}

  void add(const ContactPair& pair) const {
    const double give = pair.count > 0 ? give_.between(pair.a, pair.b) : 0;
    for (int k = 0; k < pair.count; ++k) {
      const int i = pair.begin + k;
      std::array<std::array<double, 2>, 2> u{};
      for (const size_t end : {0U, 1U}) write(pair, i, end, give, u[end]);
      const size_t r = first_ + 2 * i;
      PointRows &one = rows_.points[r], &two = rows_.points[r + 1];
      if (!one.is_soft() && !two.is_soft()) continue;
      if (one.partner >= 0) {
        guess_compliant({&one, &two}, u, {&rows_.impulse[r], &rows_.impulse[r + 1]});
      } else {
        guess_compliant({&one, &one}, {u[0], u[0]}, {&rows_.impulse[r], &rows_.impulse[r]});
        guess_compliant({&two, &two}, {u[1], u[1]}, {&rows_.impulse[r + 1], &rows_.impulse[r + 1]});
      }
    }
  }

 private:
  // `give`: compliance where contacts give. `u`: gets the relative velocity half a step ago where the joint asks for it.
  void write(const ContactPair& pair, size_t i, size_t end, double give, std::array<double, 2>& u) const {
    const Patch& c = state_.patches[i];
    const int a = c.block_a, b = c.block_b;
    const JointLaw& law = c.joint < 0 ? none_ : w_.laws[c.joint];
    const size_t r = first_ + 2 * i + end;
    PointRows& p = rows_.points[r];
    p = kFreshRows;
    p.block_a = c.block_a, p.block_b = c.block_b, p.normal = c.normal;
    p.arm_a = acting_arm(w_.blocks, state_, a, c.arm_a[end]);
    p.arm_b = acting_arm(w_.blocks, state_, b, c.arm_b[end]);
    const double half_area = 0.5 * c.length * w_.blocks.thickness;
    const JointStrength bears = strength(c, law, end);
    p.friction = bears.friction, p.lower = 0, p.cohesion = 0;
    const double slop = w_.model.contact.slop * w_.blocks.smaller_size(c.block_a, c.block_b);
    gaps_[2 * i + end] = c.gap[end];
    // what a broken face keeps while it is in touch
    if (was_face(pair, c) && -c.closure[end] <= noticeable(w_.blocks, a, b))
      bound(bears.over(half_area * clock_.dt_kick), p);
    const bool soft = law.is_soft(0), springs = law.is_soft(), gives = give > 0 && !(soft && law.is_soft(1));
    const double gap = soft ? -c.closure[end] : c.allowed[end] - c.closure[end];
    p.row[0].bias = soft || gives ? gap / clock_.dt : hard_gap_bias(gap, slop, clock_.dt);
    p.row[1].bias =
        (law.is_soft(1) || gives ? c.stretch[end] : beyond_slop(c.stretch[end], slop)) / clock_.dt;
    if (springs) u = relative_velocity(p, before_);
    if (gives) {
      p.gives = {!soft, !law.is_soft(1)};
      for (size_t row = 0; row < 2; ++row)
        if (p.gives[row]) p.row[row].compliance = give;
    }
    if (springs) {
      p.partner = static_cast<int>(end == 0 ? r + 1 : r - 1);
      add_joint(c, law, half_area, u, p);
    }
    rows_.impulse[r] = {c.force[end][0] * clock_.dt_kick, c.force[end][1] * clock_.dt_kick};
    rows_.owner[r] = {Family::kContact, static_cast<int>(2 * i + end)};
  }

  // At an end, by what has slipped there: of its joint, mixed with the other one's where two meet.
  JointStrength strength(const Patch& c, const JointLaw& law, size_t end) const {
    const auto one = [&](const JointLaw& of) {
      return of.between(c.block_a, c.block_b, of.worn(c.slip[end]));
    };
    JointStrength s = one(law);
    if (c.other_share == 0) return s;
    const JointStrength other = one(c.other_joint < 0 ? none_ : w_.laws[c.other_joint]);
    const double z = c.other_share;
    s.friction = (1 - z) * s.friction + z * other.friction;
    s.cohesion = (1 - z) * s.cohesion + z * other.cohesion,
    s.tension = (1 - z) * s.tension + z * other.tension;
    return s;
  }

  // The two ends share the compliance 2/(k b t) [[2, -1], [-1, 2]] (eq. 3.4), that of a foundation (eq. 4.1a).
  void add_joint(const Patch& c, const JointLaw& law, double half_area, const std::array<double, 2>& u,
                 PointRows& p) const {
    for (int i = 0; i < 2; ++i)
      if (law.is_soft(i))
        make_compliant(mixed_stiffness(w_.laws, c, i, half_area),
                       mixed_damping_time(w_.blocks, w_.laws, c, i), true, clock_, u[i], p.row[i]);
  }

  // Whether a face that has broken lay on the sides of a patch.
  bool was_face(const ContactPair& pair, const Patch& c) const {
    if (pair.face < 0) return false;
    const std::vector<BondFace>& faces = w_.bonds.faces;
    for (int f = pair.face; f < count_of(faces); ++f) {
      if (faces[f].block_a != pair.a || faces[f].block_b != pair.b) break;
      if (state_.face[f].broken && faces[f].edge_a == c.side_a && faces[f].edge_b == c.side_b) return true;
    }
    return false;
  }

  const PatchWorld& w_;
  const State& state_;
  const std::vector<BlockRate>& before_;
  const StepClock& clock_;
  const RowGive give_;
  const size_t first_;
  RowSet& rows_;
  std::vector<double>& gaps_;
  const JointLaw none_;  // of contacts without a joint
};

}  // namespace

void add_patch_rows(const PatchWorld& world, const ContactGive& give, const State& state,
                    const std::vector<BlockRate>& before, const StepClock& clock, const Workers& workers,
                    RowSet& rows, std::vector<double>& gaps) {
  const size_t count = 2 * state.patches.size(), first = rows.add_more(Family::kContact, count);
  resize_sparingly(gaps, count);
  const PatchRows patch_rows(world, give, state, before, clock, first, rows, gaps);
  workers.for_chunks(state.pairs.size(), kPatchRowGrain, [&](size_t begin, size_t end) {
    for (size_t q = begin; q < end; ++q) patch_rows.add(state.pairs[q]);
  });
}

// Eq. 4.7.
void remember_patch(const BlockSet& blocks, const std::vector<JointLaw>& laws, const RowSet& rows, size_t r,
                    const std::array<double, 2>& u, const std::vector<BlockRate>& before,
                    const StepClock& clock, State& state) {
  const RowRange all = rows.range(Family::kContact);
  TALUS_ASSERT(all.size() == 2 * state.patches.size() && r >= all.begin && r < all.end);
  const PointRows& p = rows.points[r];
  const Impulse& impulse = rows.impulse[r];
  const size_t end = (r - all.begin) % 2;
  Patch& c = state.patches[(r - all.begin) / 2];
  const bool held = impulse[0] > 0 || bounds_of(p, 1, impulse[0]).upper > 0, slid = slides(p, impulse);
  if (slid) {
    // the law holds at a place between the two ends of the step; what is left of the step goes on from there
    const double damping_time = p.is_soft(1) ? mixed_damping_time(blocks, laws, c, 1) : 0;
    const double dashpot = clock.dashpot_time(damping_time);
    const double elastic = p.row[1].compliance > 0 ? elastic_slip(rows, r, clock, damping_time) : 0;
    const double u_before = p.is_soft(1) ? relative_velocity(p, before)[1] : 0;
    const double until = p.is_soft(1) ? clock.way_until(u_before, u[1]) : clock.dt * u[1];
    // what slips takes its rate from the dashpots, too
    const double gone = (c.stretch[end] + until + dashpot * clock.rate_then(u_before, u[1]) - elastic) /
                        (1 + dashpot / clock.dt);
    if (held) c.slip[end] += std::abs(gone), c.slip_signed[end] += gone;
    c.stretch[end] = held ? c.stretch[end] + clock.dt * u[1] - gone : 0;
  } else {
    c.stretch[end] += clock.dt * u[1];
  }
  c.touched = c.touched || held;
  c.force[end] = {impulse[0] / clock.dt_kick, impulse[1] / clock.dt_kick};
  push_out(c.closure[end], blocks.smaller_size(c.block_a, c.block_b), c.allowed[end]);
}

// Eq. 4.1b: of the two ends, of which a free one has its law and one at a bound bears what that is.
std::array<double, 2> dashpot_impulse(const BlockSet& blocks, const std::vector<JointLaw>& laws,
                                      const RowSet& rows, size_t r, const std::array<double, 2>& u,
                                      const std::vector<BlockRate>& before,
                                      const std::vector<BlockRate>& after, const StepClock& clock,
                                      const State& state) {
  const PointRows& p = rows.points[r];
  if (!p.is_soft()) return {0, 0};
  const Patch& c = state.patches[(r - rows.range(Family::kContact).begin) / 2];
  const int second = p.partner;
  const PointRows& q = rows.points[second];
  const auto is_free = [&](size_t row, size_t k) {
    const Impulse& impulse = rows.impulse[row];
    return k == 0 ? impulse[0] > rows.points[row].lower : !slides(rows.points[row], impulse);
  };
  std::array<double, 2> out{0, 0}, before_p{}, before_q{}, after_q{};
  bool looked = false;
  for (int k = 0; k < 2; ++k) {
    const int i = k;
    if (!p.is_soft(i) || !is_free(r, k)) continue;
    const double time = mixed_damping_time(blocks, laws, c, i);
    if (clock.dashpot_time(time) == 0) continue;
    if (!looked) {
      before_p = relative_velocity(p, before), before_q = relative_velocity(q, before);
      after_q = relative_velocity(q, after), looked = true;
    }
    const double scale =
        clock.dashpot_time(time) * clock.elastic_weights(time).position / (clock.dt * p.row[k].compliance);
    const double one = clock.rate_then(before_p[k], u[k]), two = clock.rate_then(before_q[k], after_q[k]);
    out[k] = -scale * (is_free(second, k) ? 4.0 / 3 * (one + 0.5 * two) : one);
    // what opens bears nothing, but for some digits of a solver
    if (k == 0 && rows.impulse[r][0] <= 1e-8 * std::abs(out[0])) out[0] = 0;
  }
  return out;
}

}  // namespace talus
