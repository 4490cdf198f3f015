#include "talus/contact/contact_rows.h"

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

const ContactMemory* recall(const State& state, const ContactKey& key) {
  const auto it = std::lower_bound(state.contacts.begin(), state.contacts.end(), key,
                                   [](const ContactMemory& m, const ContactKey& k) { return m.key < k; });
  return it != state.contacts.end() && it->key == key ? &*it : nullptr;
}

// The same corner on another edge of the same block, when it has passed on to it.
const ContactMemory* recall_neighbour(const State& state, const ContactKey& key) {
  const ContactKey from{key.block_a, key.vertex, key.block_b, 0};
  const auto it = std::lower_bound(state.contacts.begin(), state.contacts.end(), from,
                                   [](const ContactMemory& m, const ContactKey& k) { return m.key < k; });
  const bool same = it != state.contacts.end() && it->key.block_a == key.block_a &&
                    it->key.vertex == key.vertex && it->key.block_b == key.block_b;
  return same ? &*it : nullptr;
}

// Tributary length of a contact that is no end of a face, as share of the smaller block: what a rounded
// corner has.
constexpr double kCornerLength = 0.02;

// Bias of a hard normal row: it may close the gap and not more; an overlap is pushed back except for the
// slop.
double hard_bias(double gap, double slop, double dt) {
  if (gap >= 0) return gap / dt;
  return std::min(gap + 0.5 * slop, 0.0) / dt;
}

}  // namespace

std::vector<ContactPoint> find_contacts(const BlockSet& blocks, const BondSet& bonds, const State& state,
                                        double margin, CandidateFinder& candidates, double look_ahead) {
  std::vector<ContactPoint> contacts;
  for (const auto& [a, b] : candidates.pairs(blocks, state, margin)) {
    if (!is_tied(bonds, state, a, b)) touch_blocks(blocks, state, a, b, margin, contacts, look_ahead);
  }
  std::sort(contacts.begin(), contacts.end(),
            [](const ContactPoint& x, const ContactPoint& y) { return x.key < y.key; });
  return contacts;
}

void add_contact_rows(const BlockSet& blocks, const Layout& joints_of, const Model& model,
                      const std::vector<ContactPoint>& contacts, const State& state,
                      const std::vector<BlockRate>& before, const RowTiming& timing, RowSet& rows) {
  const auto first = static_cast<int>(rows.points.size());
  for (const ContactPoint& c : contacts) {
    const auto a = static_cast<size_t>(c.key.block_a), b = static_cast<size_t>(c.key.block_b);
    const double size = std::min(blocks.size[a], blocks.size[b]);
    const int joint = joints_of.joint_at(c.key.block_a, c.face_edge_a, c.key.block_b,
                                         c.face_edge_b >= 0 ? c.face_edge_b : c.key.edge);
    const JointProperty property = joint < 0 ? JointProperty{} : model.joints[static_cast<size_t>(joint)];
    PointRows p;
    p.block_a = c.key.block_a, p.block_b = c.key.block_b;
    p.arm_a = acting_arm(blocks, state, a, c.arm_a);
    p.arm_b = acting_arm(blocks, state, b, c.arm_b);
    p.normal = c.normal;
    p.cone = true;
    p.friction = std::tan(property.friction_angle);
    p.row[0].lower = 0;
    const bool soft = property.normal_stiffness > 0;
    p.row[0].bias = soft ? c.gap / timing.dt : hard_bias(c.gap, model.contact.slop * size, timing.dt);

    Impulse guess{};
    const ContactMemory* m = recall(state, c.key);
    if (!m) m = recall_neighbour(state, c.key);
    if (m) {
      guess = {m->force[0] * timing.dt_kick, m->force[1] * timing.dt_kick};
      // NaN: the contact slid in the last step; it sticks anew where it is, its elastic slip apart
      const bool slid = std::isnan(m->anchor) || !(m->key == c.key);
      p.row[1].bias = (slid ? m->stretch : c.slip - m->anchor) / timing.dt;
    }
    const auto u = relative_velocity(p, before);
    if (property.restitution >= 0 && c.gap + timing.dt * u[0] <= 0 && u[0] < 0)
      p.row[0].bias = std::min(p.row[0].bias, property.restitution * u[0]);
    if (soft || property.shear_stiffness > 0) {
      const bool in_face = c.partner.block_a >= 0;
      const double length = in_face ? c.length : kCornerLength * size;
      add_compliance(property, length * blocks.thickness, in_face, timing, u, p);
    }
    rows.add(p, guess);
  }
  // the other end of each compliant face
  for (size_t i = 0; i < contacts.size(); ++i) {
    PointRows& p = rows.points[static_cast<size_t>(first) + i];
    if (p.cross[0] == 0 && p.cross[1] == 0) continue;
    const auto it = std::lower_bound(contacts.begin(), contacts.end(), contacts[i].partner,
                                     [](const ContactPoint& x, const ContactKey& k) { return x.key < k; });
    p.partner = first + static_cast<int>(it - contacts.begin());
  }
}

void remember_contacts(const std::vector<ContactPoint>& contacts, const RowSet& rows, size_t first,
                       const RowTiming& timing, State& state) {
  std::vector<ContactMemory> memory;
  memory.reserve(contacts.size());
  for (size_t i = 0; i < contacts.size(); ++i) {
    const PointRows& p = rows.points[first + i];
    const Impulse& impulse = rows.impulse[first + i];
    ContactMemory m;
    m.key = contacts[i].key;
    m.force = {impulse[0] / timing.dt_kick, impulse[1] / timing.dt_kick};
    double elastic = p.row[1].compliance * impulse[1];
    if (p.partner >= 0) elastic += p.cross[1] * rows.impulse[static_cast<size_t>(p.partner)][1];
    m.stretch = -elastic * timing.dt / position_factor(timing.alpha);
    const bool slid = slides(p, impulse);
    const ContactMemory* before = recall(state, m.key);
    m.anchor = slid                                    ? std::nan("")
               : before && !std::isnan(before->anchor) ? before->anchor
                                                       : contacts[i].slip - (before ? before->stretch : 0);
    memory.push_back(m);
  }
  state.contacts = std::move(memory);
}

}  // namespace talus
