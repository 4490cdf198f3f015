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

}  // namespace

std::vector<ContactPoint> find_contacts(const BlockSet& blocks, const BondSet& bonds, const State& state,
                                        double margin, CandidateFinder& candidates) {
  std::vector<ContactPoint> contacts;
  for (const auto& [a, b] : candidates.pairs(blocks, state, margin)) {
    if (!is_tied(bonds, state, a, b)) touch_blocks(blocks, state, a, b, margin, contacts);
  }
  std::sort(contacts.begin(), contacts.end(),
            [](const ContactPoint& x, const ContactPoint& y) { return x.key < y.key; });
  return contacts;
}

void add_contact_rows(const BlockSet& blocks, const Layout& joints_of,
                      const std::vector<JointProperty>& joints, const std::vector<ContactPoint>& contacts,
                      const State& state, double dt, double dt_kick, RowSet& rows) {
  for (const ContactPoint& c : contacts) {
    const auto a = static_cast<size_t>(c.key.block_a), b = static_cast<size_t>(c.key.block_b);
    PointRows p;
    p.block_a = c.key.block_a, p.block_b = c.key.block_b;
    p.arm_a = acting_arm(blocks, state, a, c.arm_a);
    p.arm_b = acting_arm(blocks, state, b, c.arm_b);
    p.normal = c.normal;
    p.row[0].lower = 0;
    p.row[0].bias = c.gap / dt;

    const int joint = joints_of.joint_between(blocks.group[a], blocks.group[b]);
    p.cone = true;
    p.friction = joint < 0 ? 0 : std::tan(joints[static_cast<size_t>(joint)].friction_angle);
    Impulse guess{};
    if (const ContactMemory* m = recall(state, c.key)) {
      guess = {m->force[0] * dt_kick, m->force[1] * dt_kick};
      // NaN: the contact slid in the last step, so it sticks anew where it is
      if (!std::isnan(m->anchor)) p.row[1].bias = (c.slip - m->anchor) / dt;
    }
    rows.add(p, guess);
  }
}

void remember_contacts(const std::vector<ContactPoint>& contacts, const RowSet& rows, size_t first,
                       double dt_kick, State& state) {
  std::vector<ContactMemory> memory;
  memory.reserve(contacts.size());
  for (size_t i = 0; i < contacts.size(); ++i) {
    const PointRows& p = rows.points[first + i];
    const Impulse& impulse = rows.impulse[first + i];
    ContactMemory m;
    m.key = contacts[i].key;
    m.force = {impulse[0] / dt_kick, impulse[1] / dt_kick};
    const double limit = bounds_of(p, 1, impulse[0]).upper;
    const bool slides = std::abs(impulse[1]) >= limit * (1 - 1e-12);
    const ContactMemory* before = recall(state, m.key);
    m.anchor = slides                                  ? std::nan("")
               : before && !std::isnan(before->anchor) ? before->anchor
                                                       : contacts[i].slip;
    memory.push_back(m);
  }
  state.contacts = std::move(memory);
}

}  // namespace talus
