#include "talus/contact/pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "talus/base/error.h"
#include "talus/contact/hand_over.h"

namespace talus {

namespace {

// Skin of the list of pairs, as share of the smallest block.
constexpr double kSkin = 0.1;

// Contact points of a pair are followed, not sought, while the two have moved against each other by less than
// half of what could change them, at most this share of the smaller block: faces stay faces and normals turn
// by less than a thousandth meanwhile.
constexpr double kReuse = 1e-3;

// Pairs to a chunk.
constexpr size_t kGrain = 256;

// Contact points of two blocks: as many as Contact::partner can tell apart.
constexpr size_t kMostPoints = 32767;

double moved_since(const BlockSet& blocks, const State& state, const CandidateList& list, size_t i) {
  const Mat2 h = state.strain_part[i] - list.strain_part[i];
  return norm(state.displacement[i] - list.displacement[i]) + std::sqrt(contract(h, h)) * blocks.radius[i];
}

bool list_holds(const BlockSet& blocks, const State& state, double margin, const Workers& workers) {
  const CandidateList& list = state.candidates;
  if (list.margin != margin || list.displacement.size() != static_cast<size_t>(blocks.count)) return false;
  std::atomic<bool> holds{true};
  workers.for_chunks(list.displacement.size(), 2048, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end && holds.load(std::memory_order_relaxed); ++i)
      if (!(moved_since(blocks, state, list, i) < 0.5 * list.skin)) holds = false;
  });
  return holds;
}

std::vector<Box> boxes_now(const BlockSet& blocks, const State& state) {
  std::vector<Box> boxes;
  const Vec2 origin = blocks.centroid[0];
  for (int i = 0; i < blocks.count; ++i) {
    const auto k = static_cast<size_t>(i);
    const Vec2 from = blocks.centroid[k] - origin;
    Box box{from + offset_now(state, k, blocks.corner(i, 0)), {}};
    box.max = box.min;
    for (int v = 1; v < blocks.vertex_count(i); ++v) {
      const Vec2 p = from + offset_now(state, k, blocks.corner(i, v));
      box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y)};
      box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y)};
    }
    boxes.push_back(box);
  }
  return boxes;
}

int first_face(const BondSet& bonds, int a, int b) {
  const auto it = std::lower_bound(
      bonds.faces.begin(), bonds.faces.end(), std::pair(a, b),
      [](const BondFace& f, const std::pair<int, int>& p) { return std::pair(f.block_a, f.block_b) < p; });
  const bool found = it != bonds.faces.end() && it->block_a == a && it->block_b == b;
  return found ? static_cast<int>(it - bonds.faces.begin()) : -1;
}

bool held_by_faces(const BondSet& bonds, const State& state, const ContactPair& pair) {
  if (pair.face < 0) return false;
  for (auto f = static_cast<size_t>(pair.face); f < bonds.faces.size(); ++f) {
    if (bonds.faces[f].block_a != pair.a || bonds.faces[f].block_b != pair.b) break;
    if (!state.face[f].broken) return true;
  }
  return false;
}

// The smaller block of a pair and the larger one.
struct BySize {
  size_t small, large;
};
BySize by_size(const BlockSet& blocks, const ContactPair& p) {
  const auto a = static_cast<size_t>(p.a), b = static_cast<size_t>(p.b);
  return blocks.radius[a] <= blocks.radius[b] ? BySize{a, b} : BySize{b, a};
}

// How far the two have moved against each other since their contact points were sought, at the worst place of
// the smaller block, where they touch.
double moved_apart(const BlockSet& blocks, const State& s, const ContactPair& p) {
  const auto [small, large] = by_size(blocks, p);
  const Vec2 off = (blocks.centroid[small] - blocks.centroid[large] - p.arm) +
                   (s.displacement[small] - s.displacement[large] - s.strain_part[large] * p.arm);
  // F of the smaller block less what it would be had it gone along with the larger one
  const Mat2 turn = (kIdentity + s.strain_part[small]) - (kIdentity + s.strain_part[large]) * p.turn;
  return norm(off) + std::sqrt(contract(turn, turn)) * blocks.radius[small];
}

void keep_pose(const BlockSet& blocks, const State& s, ContactPair& p) {
  const auto [small, large] = by_size(blocks, p);
  const Vec2 now =
      (blocks.centroid[small] - blocks.centroid[large]) + (s.displacement[small] - s.displacement[large]);
  const Mat2 back = inverse(kIdentity + s.strain_part[large]);
  p.arm = back * now;
  p.turn = back * (kIdentity + s.strain_part[small]);
}

// A found point with what a known one at the same place remembers.
Contact contact_of(const ContactPoint& point, const std::vector<ContactPoint>& all, const Layout& joints_of,
                   const Contact* known, int n_known) {
  Contact c;
  c.key = point.key;
  c.partner = static_cast<int16_t>(point.partner), c.length = point.length;
  const ContactKey& key = point.key;
  c.joint = point.face_edge_b >= 0
                ? joints_of.joint_at(key.block_a, point.face_edge_a, key.block_b, point.face_edge_b)
                : joints_of.joint_at_corner(key.block_a, key.vertex, key.block_b, key.edge);
  const Contact* from = nullptr;
  for (int i = 0; i < n_known && !(from && from->key == c.key); ++i) {
    const ContactKey& k = known[i].key;
    if (k.block_a != c.key.block_a || k.vertex != c.key.vertex || known[i].memory == Contact::kNone) continue;
    // a corner that keeps its edge beside the new one has not passed on
    const bool stays = !(k == c.key) &&
                       std::any_of(all.begin(), all.end(), [&](const ContactPoint& p) { return p.key == k; });
    if ((!from && !stays) || k == c.key) from = &known[i];
  }
  if (!from) return c;
  const bool same = from->key == c.key;
  c.force = from->force, c.stretch = from->stretch;
  c.slip = from->slip, c.slip_signed = from->slip_signed, c.touched = from->touched;
  c.anchor = same ? from->anchor : 0;
  c.memory = same ? from->memory : Contact::kPassed;
  return c;
}

// New lists of contact points of pairs whose number changed, found by one chunk.
struct Changed {
  std::vector<std::pair<size_t, int>> pair;  // and how many
  std::vector<Contact> contact;
};

class Updater {
 public:
  Updater(const BlockSet& blocks, const BondSet& bonds, const Layout& joints_of, double margin,
          double look_ahead, State& state)
      : blocks_(blocks),
        bonds_(bonds),
        joints_of_(joints_of),
        margin_(margin),
        look_ahead_(look_ahead),
        state_(state) {}

  SearchReport run(const Workers& workers) {
    const size_t n = state_.pairs.size();
    changed_.resize((n + kGrain - 1) / kGrain);
    searched_.assign(changed_.size(), 0);
    workers.for_chunks(n, kGrain, [&](size_t begin, size_t end) { look_at(begin, end); });
    SearchReport report;
    bool any = false;
    for (size_t c = 0; c < changed_.size(); ++c) {
      report.searched += searched_[c];
      any = any || !changed_[c].pair.empty();
    }
    if (any) put_together(workers);
    return report;
  }

 private:
  void look_at(size_t begin, size_t end) {
    Changed& changed = changed_[begin / kGrain];
    ContactSearch search;
    const State& s = state_;
    for (size_t i = begin; i < end; ++i) {
      ContactPair& pair = state_.pairs[i];
      if (held_by_faces(bonds_, s, pair))
        continue;  // and so since it was made: intact faces have no contacts
      if (pair.reuse >= 0 && moved_apart(blocks_, s, pair) <= pair.reuse) continue;
      ++searched_[begin / kGrain];
      double clearance = 0;
      const auto& found = search.touch(blocks_, s, pair.a, pair.b, margin_, look_ahead_, clearance);
      keep_pose(blocks_, s, pair);
      const auto [small, large] = by_size(blocks_, pair);
      const double size = std::min(blocks_.size[small], blocks_.size[large]);
      // what velocities decided is asked again in the next step
      pair.reuse = clearance < 0
                       ? -1
                       : std::min(0.25 * margin_, std::max(0.5 * kSamePlace * size,
                                                           std::min(0.5 * clearance, kReuse * size)));
      if (found.size() > kMostPoints)
        throw NumericalError(
            fmt::format("blocks \"{}\" and \"{}\" touch at {} points at t = {:.9g} s; at most {} can "
                        "be followed: give them fewer corners",
                        blocks_.name[static_cast<size_t>(pair.a)], blocks_.name[static_cast<size_t>(pair.b)],
                        found.size(), s.time, kMostPoints));
      const Contact* known = state_.contacts.data() + pair.begin;
      const size_t at = changed.contact.size();
      for (const ContactPoint& p : found)
        changed.contact.push_back(contact_of(p, found, joints_of_, known, pair.count));
      if (pair.from_start && s.step == 0)
        pair.shares_face =
            std::any_of(found.begin(), found.end(), [](const ContactPoint& p) { return p.length > 0; });
      hand_over(blocks_, bonds_, s, pair, changed.contact.data() + at, found.size());
      if (static_cast<int>(found.size()) == pair.count) {
        std::copy(changed.contact.begin() + static_cast<std::ptrdiff_t>(at), changed.contact.end(),
                  state_.contacts.begin() + pair.begin);
        changed.contact.resize(at);
      } else {
        changed.pair.emplace_back(i, static_cast<int>(found.size()));
      }
    }
  }

  // Points of neighbouring pairs whose number stayed: they move together.
  struct Run {
    int from, count, to;
  };

  // Every pair's points one after the other again, in place: lists of contacts are much of a run's memory.
  void put_together(const Workers& workers) {
    std::vector<int> chunk_begin(changed_.size());
    int count = 0;
    for (size_t c = 0; c < changed_.size(); ++c) {
      chunk_begin[c] = count;
      const size_t end = std::min(state_.pairs.size(), (c + 1) * kGrain);
      const ContactPair& last = state_.pairs[end - 1];
      count += last.begin + last.count - state_.pairs[c * kGrain].begin;
      for (const auto& [pair, now] : changed_[c].pair) count += now - state_.pairs[pair].count;
    }
    std::vector<std::vector<Run>> runs(changed_.size());
    workers.for_chunks(state_.pairs.size(), kGrain, [&](size_t begin, size_t end) {
      const size_t c = begin / kGrain;
      move_pairs(begin, end, chunk_begin[c], runs[c]);
    });

    // no run moves over one that has not moved yet: those to the left first, from the left, then the others
    const auto move = [this](const Run& r) {
      const auto from = state_.contacts.begin() + r.from;
      const auto to = state_.contacts.begin() + r.to;
      r.to < r.from ? std::copy(from, from + r.count, to)
                    : std::copy_backward(from, from + r.count, to + r.count);
    };
    const auto old_size = state_.contacts.size();
    resize_sparingly(state_.contacts, std::max(old_size, static_cast<size_t>(count)));
    for (const auto& chunk : runs)
      for (const Run& r : chunk)
        if (r.to < r.from) move(r);
    for (auto chunk = runs.rbegin(); chunk != runs.rend(); ++chunk)
      for (auto r = chunk->rbegin(); r != chunk->rend(); ++r)
        if (r->to > r->from) move(*r);
    state_.contacts.resize(static_cast<size_t>(count));
    for (const Changed& c : changed_) {
      auto from = c.contact.begin();
      for (const auto& [pair, now] : c.pair) {
        std::copy(from, from + now, state_.contacts.begin() + state_.pairs[pair].begin);
        from += now;
      }
    }
  }

  // New places of the points of pairs [begin, end), which start at `at`.
  void move_pairs(size_t begin, size_t end, int at, std::vector<Run>& runs) {
    const Changed& c = changed_[begin / kGrain];
    auto changed = c.pair.begin();
    bool go_on = false;  // with the run before
    for (size_t i = begin; i < end; ++i) {
      ContactPair& pair = state_.pairs[i];
      if (changed != c.pair.end() && changed->first == i) {
        pair.count = changed++->second;
        go_on = false;
      } else if (go_on) {
        runs.back().count += pair.count;
      } else {
        runs.push_back({pair.begin, pair.count, at});
        go_on = true;
      }
      pair.begin = at;
      at += pair.count;
    }
  }

  const BlockSet& blocks_;
  const BondSet& bonds_;
  const Layout& joints_of_;
  const double margin_, look_ahead_;
  State& state_;
  std::vector<Changed> changed_;
  std::vector<int> searched_;
};

}  // namespace

bool renew_pairs(const BlockSet& blocks, const BondSet& bonds, double margin, const Workers& workers,
                 State& state) {
  if (blocks.count == 0 || list_holds(blocks, state, margin, workers)) return false;
  CandidateList& list = state.candidates;
  const bool same_margin = list.margin == margin;
  ++list.rebuilds;
  list.margin = margin;
  list.displacement = state.displacement;
  list.strain_part = state.strain_part;
  list.skin = kSkin * smallest_size(blocks);

  const std::vector<ContactPair> before = std::move(state.pairs);
  std::vector<ContactPair> now;
  std::vector<Contact> contacts;
  contacts.reserve(state.contacts.size() + state.contacts.size() / 32);
  auto known = before.begin();
  for (const auto& [a, b] : close_pairs(boxes_now(blocks, state), margin + list.skin)) {
    if (!blocks.interact(a, b)) continue;
    if (std::binary_search(bonds.tied.begin(), bonds.tied.end(), std::pair(a, b))) continue;
    while (known != before.end() && std::pair(known->a, known->b) < std::pair(a, b)) ++known;
    ContactPair pair;
    if (known != before.end() && known->a == a && known->b == b) {
      pair = *known;
      // another margin may find other points
      if (!same_margin) pair.reuse = -1;
    } else {
      pair.a = a, pair.b = b;
      pair.from_start = state.step == 0;
      pair.face = first_face(bonds, a, b);
      pair.shares_face = pair.from_start && pair.face >= 0;
    }
    const auto from = state.contacts.begin() + pair.begin;
    pair.begin = static_cast<int>(contacts.size());
    contacts.insert(contacts.end(), from, from + pair.count);
    now.push_back(pair);
  }
  now.shrink_to_fit();
  state.pairs = std::move(now);
  state.contacts = std::move(contacts);
  return true;
}

SearchReport update_contacts(const BlockSet& blocks, const BondSet& bonds, const Layout& joints_of,
                             double margin, double look_ahead, const Workers& workers, State& state) {
  return Updater(blocks, bonds, joints_of, margin, look_ahead, state).run(workers);
}

std::vector<ContactPoint> find_contacts(const BlockSet& blocks, const BondSet& bonds, const State& state,
                                        double margin, double look_ahead) {
  std::vector<ContactPoint> contacts;
  ContactSearch search;
  for (const auto& [a, b] : close_pairs(boxes_now(blocks, state), margin)) {
    if (!blocks.interact(a, b) || is_tied(bonds, state, a, b)) continue;
    double clearance = 0;
    const auto& found = search.touch(blocks, state, a, b, margin, look_ahead, clearance);
    contacts.insert(contacts.end(), found.begin(), found.end());
  }
  return contacts;
}

}  // namespace talus
