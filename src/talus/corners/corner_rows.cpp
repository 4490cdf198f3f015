#include "talus/corners/corner_rows.h"

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/contact/hard_contact.h"

namespace talus {

namespace {

// Pairs to a chunk.
constexpr size_t kRowGrain = 256;

// How far a contact is from where it sticks, before the kick [m] (theory 4.19). One that slid in the last step (NaN), or
// that passed on from elsewhere, sticks anew where it is.
double off_anchor(const Contact& c, double slip) {
  return c.memory == Contact::kWhole && !std::isnan(c.anchor) ? slip - c.anchor : 0;
}

// Where it is along the edge, in the material of that [m].
double slip_of(const CornerEdge& over, Vec2 edge) { return -over.along * norm(edge); }

class CornerRows {
 public:
  CornerRows(const BlockSet& blocks, const Model& model, const std::vector<JointLaw>& laws,
             const State& state, const StepClock& clock, size_t first, RowSet& rows,
             std::vector<double>& gaps)
      : blocks_(blocks),
        model_(model),
        laws_(laws),
        state_(state),
        clock_(clock),
        first_(first),
        rows_(rows),
        gaps_(gaps) {}

  void add(const ContactPair& pair) const {
    for (int k = 0; k < pair.count; ++k) write(pair.begin + k);
  }

 private:
  void write(size_t i) const {
    const Contact& c = state_.contacts[i];
    const int a = c.key.block_a, b = c.key.block_b;
    const JointLaw& law = c.joint < 0 ? none_ : laws_[c.joint];
    const CornerEdge over = corner_over_edge(blocks_, state_, c.key.corner(), c.key.on());
    const Vec2 b0 = blocks_.corner({c.key.block_b, c.key.edge}), edge = blocks_.side(c.key.on());
    const double slop = model_.contact.slop * blocks_.smaller_size(c.key.block_a, c.key.block_b);
    gaps_[i] = over.gap;

    PointRows& p = rows_.points[first_ + i];
    p = kFreshRows;
    p.block_a = c.key.block_a, p.block_b = c.key.block_b;
    p.normal = over.normal;
    p.arm_a = acting_arm(blocks_, state_, a, blocks_.corner(c.key.corner()));
    p.arm_b = acting_arm(blocks_, state_, b, b0 + std::clamp(over.along, 0.0, 1.0) * edge);
    p.friction = law.between(c.key.block_a, c.key.block_b, law.worn(c.slip)).friction;
    p.lower = 0, p.cohesion = 0;
    p.row[0].bias = hard_gap_bias(over.gap + c.allowed, slop, clock_.dt);
    p.row[1].bias = beyond_slop(off_anchor(c, slip_of(over, edge)), slop) / clock_.dt;
    rows_.impulse[first_ + i] = {};
    if (c.memory != Contact::kNone)
      rows_.impulse[first_ + i] = {c.force[0] * clock_.dt_kick, c.force[1] * clock_.dt_kick};
    rows_.owner[first_ + i] = {Family::kContact, static_cast<int>(i)};
  }

  const BlockSet& blocks_;
  const Model& model_;
  const std::vector<JointLaw>& laws_;
  const State& state_;
  const StepClock& clock_;
  const size_t first_;
  RowSet& rows_;
  std::vector<double>& gaps_;
  const JointLaw none_;  // of contacts without a joint
};

}  // namespace

void add_corner_rows(const BlockSet& blocks, const Model& model, const std::vector<JointLaw>& laws,
                     const State& state, const StepClock& clock, const Workers& workers, RowSet& rows,
                     std::vector<double>& gaps) {
  TALUS_ASSERT(laws.size() == model.joints.size());
  const size_t first = rows.add_more(Family::kContact, state.contacts.size());
  resize_sparingly(gaps, state.contacts.size());
  const CornerRows corner_rows(blocks, model, laws, state, clock, first, rows, gaps);
  workers.for_chunks(state.pairs.size(), kRowGrain, [&](size_t begin, size_t end) {
    for (size_t q = begin; q < end; ++q) corner_rows.add(state.pairs[q]);
  });
}

// Eq. 4.7.
void remember_corners(const BlockSet& blocks, const RowSet& rows, RowRange range, const StepClock& clock,
                      State& state) {
  const RowRange all = rows.range(Family::kContact);
  TALUS_ASSERT(all.size() == state.contacts.size());
  TALUS_ASSERT(range.begin >= all.begin && range.end <= all.end);
  const double per_kick = 1 / clock.dt_kick;
  for (size_t r = range.begin; r < range.end; ++r) {
    const PointRows& p = rows.points[r];
    const Impulse& impulse = rows.impulse[r];
    Contact& c = state.contacts[r - all.begin];
    const CornerEdge over = corner_over_edge(blocks, state, c.key.corner(), c.key.on());
    const double at = slip_of(over, blocks.side(c.key.on()));
    const bool anchored = c.memory == Contact::kWhole && !std::isnan(c.anchor);
    const bool held = impulse[0] > 0 || bounds_of(p, 1, impulse[0]).upper > 0, slid = slides(p, impulse);
    c.touched = c.touched || held;
    if (held && slid) {
      const double gone = off_anchor(c, at) + clock.dt * relative_velocity(p, state.rate)[1];
      c.slip += std::abs(gone), c.slip_signed += gone;
    }
    if (slid)
      c.anchor = std::nan("");
    else if (!anchored)
      c.anchor = at;
    c.force = {impulse[0] * per_kick, impulse[1] * per_kick};
    push_out(-over.gap, blocks.smaller_size(c.key.block_a, c.key.block_b), c.allowed);
    c.memory = Contact::kWhole;
  }
}

}  // namespace talus
