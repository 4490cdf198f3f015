#include "talus/contact/contact_rows.h"

#include <algorithm>
#include <cmath>

#include "talus/blocks/in_situ.h"
#include "talus/contact/joint_state.h"

namespace talus {

namespace {

// Tributary length of a contact that is no end of a face, as share of the smaller block: what a rounded
// corner has.
constexpr double kCornerLength = 0.02;

// Contacts to a chunk.
constexpr size_t kGrain = 1024;

// Bias of a hard normal row: it may close the gap and not more; an overlap is pushed back except for the
// slop.
double hard_bias(double gap, double slop, double dt) {
  if (gap >= 0) return gap / dt;
  return std::min(gap + 0.5 * slop, 0.0) / dt;
}

// What of a distance lies beyond half the slop. Contacts that stick redundantly, as two corners at one place
// do, have anchors that differ by what was left of the errors of earlier steps; no motion brings both home,
// and forces would grow without end over it.
double beyond(double off, double slop) {
  if (std::abs(off) <= 0.5 * slop) return 0;
  return off > 0 ? off - 0.5 * slop : off + 0.5 * slop;
}

// How far a contact is from where it sticks, before the kick [m].
double off_anchor(const Contact& c, double slip) {
  // NaN: the contact slid in the last step; it sticks anew where it is, its elastic slip apart
  const bool anew = c.memory == Contact::kPassed || std::isnan(c.anchor);
  if (c.memory == Contact::kNone) return 0;
  return anew ? c.stretch : slip - c.anchor;
}

}  // namespace

void add_contact_rows(const BlockSet& blocks, const Model& model, const State& state,
                      const std::vector<BlockRate>& before, const RowTiming& timing, const Workers& workers,
                      RowSet& rows, std::vector<ContactPlace>& place) {
  const size_t first = rows.add_more(state.contacts.size());
  resize_sparingly(place, state.contacts.size());
  // the last: neither friction nor stiffness
  std::vector<JointProperty> joints = model.joints;
  joints.emplace_back();
  std::vector<double> friction;
  for (const JointProperty& j : joints) friction.push_back(std::tan(j.friction_after()));
  const size_t plain = joints.size() - 1;

  using Velocity = std::array<double, 2>;
  const auto add = [&](const ContactPair& pair, size_t i, Velocity& u) {
    const Contact& c = state.contacts[i];
    const auto a = static_cast<size_t>(c.key.block_a), b = static_cast<size_t>(c.key.block_b);
    const size_t joint = c.joint < 0 ? plain : static_cast<size_t>(c.joint);
    const JointProperty& property = joints[joint];
    const CornerEdge over =
        corner_over_edge(blocks, state, c.key.block_a, c.key.vertex, c.key.block_b, c.key.edge);
    const int next = c.key.edge + 1 == blocks.vertex_count(c.key.block_b) ? 0 : c.key.edge + 1;
    const Vec2 b0 = blocks.corner(c.key.block_b, c.key.edge), edge = blocks.corner(c.key.block_b, next) - b0;
    const double slip = -over.along * norm(edge);
    Vec2 closure;
    const bool carries = pair.shares_face || (pair.from_start && c.length > 0);
    if (carries && model.in_situ.given && joint != plain) {
      const double height = blocks.centroid[b].y + b0.y + std::clamp(over.along, 0.0, 1.0) * edge.y;
      closure = in_situ_closure(property, in_situ_stress(model.in_situ, model.gravity, height),
                                turn_right(edge) / norm(edge));
    }
    // only what was never disturbed sticks with the stress of the ground
    const double elastic = state.step == 0 ? closure.y : 0;
    const double rise = dilation_rise(property, c.slip), gap = over.gap - rise;
    place[i] = {over.gap, c.memory == Contact::kNone ? slip - elastic : slip};

    PointRows p;
    p.block_a = c.key.block_a, p.block_b = c.key.block_b;
    p.arm_a = acting_arm(blocks, state, a, blocks.corner(c.key.block_a, c.key.vertex));
    p.arm_b = acting_arm(blocks, state, b, b0 + std::clamp(over.along, 0.0, 1.0) * edge);
    p.normal = over.normal;
    p.friction = friction[joint];
    p.lower = 0, p.cohesion = 0;
    const bool soft = property.normal_stiffness > 0;
    const double size = std::min(blocks.size[a], blocks.size[b]), slop = model.contact.slop * size;
    p.row[0].bias = soft ? (gap + closure.x) / timing.dt : hard_bias(gap, slop, timing.dt);
    // what a broken face keeps, end by end, while it is in touch
    if (pair.face >= 0 && gap <= noticeable(blocks, a, b)) {
      const double impulse = c.length * blocks.thickness * timing.dt_kick;
      p.lower = -property.residual_tensile_strength * impulse;
      p.cohesion = property.residual_cohesion * impulse;
    }

    Impulse guess{};
    if (c.memory == Contact::kNone) {
      p.row[1].bias = elastic / timing.dt;
    } else {
      guess = {c.force[0] * timing.dt_kick, c.force[1] * timing.dt_kick};
      const double off = off_anchor(c, slip);
      p.row[1].bias = (property.shear_stiffness > 0 ? off : beyond(off, slop)) / timing.dt;
    }
    if (property.restitution >= 0 || soft || property.shear_stiffness > 0) {
      u = relative_velocity(p, before);
      if (property.restitution >= 0 && gap + timing.dt * u[0] <= 0 && u[0] < 0)
        p.row[0].bias = std::min(p.row[0].bias, property.restitution * u[0]);
      if (soft || property.shear_stiffness > 0) {
        // two ends with different joints close on their own
        const bool in_face =
            c.partner >= 0 && state.contacts[static_cast<size_t>(pair.begin + c.partner)].joint == c.joint;
        const double length = c.length > 0 ? c.length : kCornerLength * size;
        add_compliance(property, length * blocks.thickness, in_face, timing, u, p);
        if (in_face) p.partner = static_cast<int>(first) + pair.begin + c.partner;
      }
    }
    rows.points[first + i] = p;
    rows.impulse[first + i] = guess;
  };
  workers.for_chunks(state.pairs.size(), kGrain / 4, [&](size_t begin, size_t end) {
    std::vector<Velocity> u;
    for (size_t q = begin; q < end; ++q) {
      const ContactPair& pair = state.pairs[q];
      const auto at = static_cast<size_t>(pair.begin), count = static_cast<size_t>(pair.count);
      u.resize(count);
      for (size_t k = 0; k < count; ++k) add(pair, at + k, u[k]);
      for (size_t k = 0; k < count; ++k) {
        const PointRows& p = rows.points[first + at + k];
        const size_t other = p.partner < 0 ? k : static_cast<size_t>(p.partner) - first - at;
        if (other < k) continue;
        const size_t i = first + at + k, j = first + at + other;
        guess_compliant({&p, &rows.points[j]}, {u[k], u[other]}, {&rows.impulse[i], &rows.impulse[j]});
      }
    }
  });
}

void remember_contacts(const RowSet& rows, size_t first, const std::vector<ContactPlace>& place,
                       const RowTiming& timing, const Workers& workers, State& state) {
  workers.for_chunks(state.contacts.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const PointRows& p = rows.points[first + i];
      const Impulse& impulse = rows.impulse[first + i];
      Contact& c = state.contacts[i];
      const double elastic = elastic_slip(rows, first + i, timing);
      const bool anchored = c.memory == Contact::kWhole && !std::isnan(c.anchor);
      const bool held = impulse[0] > 0 || bounds_of(p, 1, impulse[0]).upper > 0;
      c.touched = c.touched || held;
      if (held && slides(p, impulse)) {
        // the place where it would stick goes along with the slip that is not elastic
        const double gone =
            off_anchor(c, place[i].slip) + timing.dt * relative_velocity(p, state.rate)[1] - elastic;
        c.slip += std::abs(gone), c.slip_signed += gone;
      }
      if (slides(p, impulse))
        c.anchor = std::nan("");
      else if (!anchored)
        c.anchor = place[i].slip - (c.memory == Contact::kNone ? 0 : c.stretch);
      c.force = {impulse[0] / timing.dt_kick, impulse[1] / timing.dt_kick};
      c.stretch = elastic;
      c.memory = Contact::kWhole;
    }
  });
}

}  // namespace talus
