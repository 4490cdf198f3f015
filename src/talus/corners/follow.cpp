#include "talus/corners/follow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/clock.h"
#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/corners/hand_over.h"

namespace talus {

namespace {

// Overlaps up to this share of the thinner of two blocks are seen.
constexpr double kDepthShare = 0.5;

// Contact points of a pair are followed, not sought, while the two have moved against each other by less than
// half of what could change them, at most this share of the smaller block: faces stay faces and normals turn
// by less than a thousandth meanwhile.
constexpr double kReuse = 1e-3;

// Pairs to a chunk.
constexpr size_t kPairGrain = 256;

// Contact points of two blocks: as many as Contact::partner can tell apart.
constexpr size_t kMostPoints = 32767;

// How far the two have moved against each other since their contact points were sought, at the worst place of
// the smaller block, where they touch (theory 13.6).
double moved_apart(const BlockSet& blocks, const State& s, const ContactPair& p, const FollowedPair& then) {
  const auto [small, large] = by_size(blocks, p);
  const Vec2 off = (blocks.centroid[small] - blocks.centroid[large] - then.arm) +
                   (s.displacement[small] - s.displacement[large] - s.strain_part[large] * then.arm);
  // F of the smaller block less what it would be had it gone along with the larger one
  const Mat2 turn = (kIdentity + s.strain_part[small]) - (kIdentity + s.strain_part[large]) * then.turn;
  return norm(off) + std::sqrt(contract(turn, turn)) * blocks.radius[small];
}

void keep_cover(const std::vector<Cover>& cover, FollowedPair& p) {
  p.covers = static_cast<int>(std::min(cover.size(), p.cover.size()));
  p.cover = {};
  std::copy_n(cover.begin(), p.covers, p.cover.begin());
}

// Whether a block that covers a side of the pair has gone, or left that side (theory 13.6).
bool uncovered(const BlockSet& blocks, const State& s, const ContactPair& p, const FollowedPair& then) {
  return std::any_of(then.cover.begin(), then.cover.begin() + then.covers,
                     [&](const Cover& c) { return !covers(blocks, s, p.a, p.b, c); });
}

void keep_pose(const BlockSet& blocks, const State& s, const ContactPair& p, FollowedPair& now_at) {
  const auto [small, large] = by_size(blocks, p);
  const Vec2 now =
      (blocks.centroid[small] - blocks.centroid[large]) + (s.displacement[small] - s.displacement[large]);
  const Mat2 back = inverse(kIdentity + s.strain_part[large]);
  now_at.arm = back * now;
  now_at.turn = back * (kIdentity + s.strain_part[small]);
}

// Where the corner of a contact lies now, seen from the reference centroid of block a of its pair.
Vec2 place_of(const BlockSet& blocks, const State& s, int from, const ContactKey& key) {
  const int k = key.block_a;
  return (blocks.centroid[k] - blocks.centroid[from]) + offset_now(s, k, blocks.corner(key.corner()));
}

// How far a known contact is now from where it sticks, along its tangent [m]; NaN where it slid.
double off_now(const BlockSet& blocks, const State& s, const Contact& c) {
  const ContactKey& k = c.key;
  const CornerEdge over = corner_over_edge(blocks, s, k.corner(), k.on());
  const Vec2 edge = blocks.corner(blocks.end_of(k.on())) - blocks.corner({k.block_b, k.edge});
  return -over.along * norm(edge) - c.anchor;
}

// Which known contact a found point goes on from: the one with its key, else the one at its end of the same
// interface, else the one of the same corner that has passed on from another edge, else one at the same
// place.
struct Origin {
  const Contact* contact = nullptr;
  enum Kind { kNothing, kKey, kPlace, kPassed } kind = kNothing;
};

class Memory {
 public:
  Memory(const BlockSet& blocks, const State& s, const ContactPair& pair,
         const std::vector<ContactPoint>& found)
      : blocks_(blocks),
        state_(s),
        pair_(pair),
        found_(found),
        known_(s.contacts.data() + pair.begin, pair.count),
        same_(2 * kSamePlace * std::min(blocks.size[pair.a], blocks.size[pair.b])) {}

  Origin of(const ContactPoint& point) const {
    for (const Contact& c : known_)
      if (c.key == point.key) return {c.memory == Contact::kNone ? nullptr : &c, Origin::kKey};
    if (point.face.side_lo >= 0)
      for (const Contact& c : known_)
        if (c.memory != Contact::kNone && c.face == point.face && !stays(c)) return {&c, Origin::kPlace};
    for (const Contact& c : known_)
      if (c.memory != Contact::kNone && c.key.block_a == point.key.block_a &&
          c.key.vertex == point.key.vertex && !stays(c))
        return {&c, Origin::kPassed};
    const Vec2 place = place_of(blocks_, state_, pair_.a, point.key);
    for (const Contact& c : known_)
      if (c.memory != Contact::kNone && c.key.block_a != point.key.block_a && !stays(c) &&
          norm(place_of(blocks_, state_, pair_.a, c.key) - place) <= same_)
        return {&c, Origin::kPlace};
    return {};
  }

 private:
  // a corner that keeps its edge beside the new one has not passed on
  bool stays(const Contact& c) const {
    return std::any_of(found_.begin(), found_.end(), [&](const ContactPoint& p) { return p.key == c.key; });
  }

  const BlockSet& blocks_;
  const State& state_;
  const ContactPair& pair_;
  const std::vector<ContactPoint>& found_;
  const std::span<const Contact> known_;
  const double same_;
};

// A found point with what a known one at the same place remembers. `plain`: every straight side is one edge
// (theory 13.6, memory).
Contact contact_of(const BlockSet& blocks, const State& s, const ContactPoint& point, const Memory& memory,
                   bool plain, const Layout& joints_of) {
  Contact c;
  c.key = point.key;
  c.partner = static_cast<int16_t>(point.partner), c.length = point.length, c.face = point.face;
  const ContactKey& key = point.key;
  const auto [from, kind] = memory.of(point);
  if (from && plain && kind == Origin::kKey && from->face == point.face)
    c.joint = from->joint;  // the same two edges
  else
    c.joint = point.face_edge_b >= 0
                  ? joints_of.joint_at({key.block_a, point.face_edge_a}, {key.block_b, point.face_edge_b})
                  : joints_of.joint_at_corner(key.corner(), key.on());
  if (!from) {
    if (kind == Origin::kNothing) c.allowed = std::max(0.0, -point.gap);
    return c;
  }
  c.force = from->force, c.stretch = from->stretch;
  c.slip = from->slip, c.slip_signed = from->slip_signed, c.touched = from->touched;
  c.allowed = from->allowed;
  c.anchor = 0, c.memory = Contact::kPassed;
  if (kind == Origin::kKey) {
    c.anchor = from->anchor, c.memory = from->memory;
  } else if (kind == Origin::kPlace && from->memory == Contact::kWhole) {
    // counted from another corner now, and as far from where it sticks as before; the same number from either
    // block
    c.anchor = point.slip - off_now(blocks, s, *from), c.memory = Contact::kWhole;
  }
  return c;
}

// New lists of contact points of pairs whose number changed, found by one chunk.
struct Changed {
  std::vector<std::pair<size_t, int>> pair;  // and how many
  std::vector<Contact> contact;
};

class Updater {
 public:
  Updater(const BlockSet& blocks, const BondSet& bonds, const Layout& joints_of, const LookAhead& ahead,
          State& state)
      : blocks_(blocks), bonds_(bonds), joints_of_(joints_of), ahead_(ahead), state_(state) {}

  SearchReport run(const Workers& workers) {
    turning_.resize(blocks_.count);
    workers.for_chunks(turning_.size(), 4096, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) turning_[i] = turning_speed(blocks_, ahead_.before, i);
    });
    const size_t n = state_.pairs.size();
    state_.followed.resize(n);
    changed_.resize((n + kPairGrain - 1) / kPairGrain);
    sought_.assign(changed_.size(), {});
    workers.for_chunks(n, kPairGrain, [&](size_t begin, size_t end) { look_at(begin, end); });
    SearchReport report;
    bool any = false;
    for (size_t c = 0; c < changed_.size(); ++c) {
      report.searched += sought_[c].searched, report.seconds += sought_[c].seconds;
      any = any || !changed_[c].pair.empty();
    }
    if (any) put_together(workers);
    return report;
  }

 private:
  // How far ahead the points of a pair have to be sought in this step [m].
  double needed(const ContactPair& pair) const {
    const int a = pair.a, b = pair.b;
    const std::vector<BlockRate>& rate = ahead_.before;
    return 2 * ahead_.clock.dt * (norm(rate[a].a - rate[b].a) + turning_[a] + turning_[b]);
  }

  void look_at(size_t begin, size_t end) {
    Changed& changed = changed_[begin / kPairGrain];
    ContactSearch search;
    const State& s = state_;
    for (size_t i = begin; i < end; ++i) {
      ContactPair& pair = state_.pairs[i];
      if (held_by_faces(bonds_, s, pair))
        continue;  // and so since it was made: intact faces have no contacts
      FollowedPair& followed = state_.followed[i];
      const double need = needed(pair);
      if (followed.reuse >= 0 && need <= pair.margin &&
          moved_apart(blocks_, s, pair, followed) <= followed.reuse && !uncovered(blocks_, s, pair, followed))
        continue;
      SearchReport& report = sought_[begin / kPairGrain];
      ++report.searched;
      const Timed timed(report.seconds);
      const auto [small, large] = by_size(blocks_, pair);
      const double size = std::min(blocks_.size[small], blocks_.size[large]);
      // a power of two times the share: small changes of speed are no reason to seek anew
      pair.margin = kMarginShare * size;
      while (pair.margin < need) pair.margin *= 2;
      SearchRange range;
      range.margin = pair.margin;
      range.depth = kDepthShare * std::min(blocks_.thinness[small], blocks_.thinness[large]);
      range.look_ahead = ahead_.clock.dt;
      range.before = &ahead_.before;
      range.neighbours = &s.candidates.neighbours;
      range.known = {s.contacts.data() + pair.begin, static_cast<size_t>(pair.count)};
      const Found& sought = search.touch(blocks_, s, pair.a, pair.b, range);
      const auto& found = sought.points;
      const Memory memory(blocks_, s, pair, found);
      keep_pose(blocks_, s, pair, followed);
      keep_cover(sought.cover, followed);
      // what velocities decided is asked again in the next step
      followed.reuse =
          sought.this_step_only || sought.cover.size() > followed.cover.size()
              ? -1
              : std::min(0.25 * pair.margin,
                         std::max(0.5 * kSamePlace * size, std::min(0.5 * sought.clearance, kReuse * size)));
      if (found.size() > kMostPoints)
        throw NumericalError(
            fmt::format("blocks \"{}\" and \"{}\" touch at {} points at t = {:.9g} s; at most {} can "
                        "be followed: give them fewer corners",
                        blocks_.name[pair.a], blocks_.name[pair.b], found.size(), s.time, kMostPoints));
      const size_t at = changed.contact.size();
      for (const ContactPoint& p : found)
        changed.contact.push_back(contact_of(blocks_, s, p, memory, sought.plain, joints_of_));
      if (pair.from_start && s.step == 0)
        pair.shares_face =
            std::any_of(found.begin(), found.end(), [](const ContactPoint& p) { return p.length > 0; });
      hand_over(blocks_, bonds_, s, pair, changed.contact.data() + at, found.size());
      if (count_of(found) == pair.count) {
        std::copy(changed.contact.begin() + at, changed.contact.end(), state_.contacts.begin() + pair.begin);
        changed.contact.resize(at);
      } else {
        changed.pair.emplace_back(i, count_of(found));
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
      const size_t end = std::min(state_.pairs.size(), (c + 1) * kPairGrain);
      const ContactPair& last = state_.pairs[end - 1];
      count += last.begin + last.count - state_.pairs[c * kPairGrain].begin;
      for (const auto& [pair, now] : changed_[c].pair) count += now - state_.pairs[pair].count;
    }
    std::vector<std::vector<Run>> runs(changed_.size());
    workers.for_chunks(state_.pairs.size(), kPairGrain, [&](size_t begin, size_t end) {
      const size_t c = begin / kPairGrain;
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
    state_.contacts.resize(count);
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
    const Changed& c = changed_[begin / kPairGrain];
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
  const LookAhead& ahead_;
  State& state_;
  std::vector<double> turning_;  // [count] how fast places move against the centroid [m/s]
  std::vector<Changed> changed_;
  std::vector<SearchReport> sought_;  // by each chunk
};

}  // namespace

// Theory 13.6.
SearchReport update_contacts(const BlockSet& blocks, const BondSet& bonds, const Layout& joints_of,
                             const LookAhead& ahead, const Workers& workers, State& state) {
  TALUS_ASSERT(count_of(joints_of.blocks) == blocks.count);
  return Updater(blocks, bonds, joints_of, ahead, state).run(workers);
}

std::vector<ContactPoint> find_contacts(const BlockSet& blocks, const BondSet& bonds, const State& state,
                                        double margin, double look_ahead) {
  std::vector<ContactPoint> contacts;
  ContactSearch search;
  Neighbours neighbours;
  const std::vector<std::pair<int, int>> close = close_pairs(boxes_now(blocks, state), margin);
  list_neighbours(blocks, close, neighbours);
  for (const auto& [a, b] : close) {
    if (!blocks.interact(a, b) || is_tied(bonds, state, a, b)) continue;
    SearchRange range;
    range.margin = range.depth = margin;
    range.look_ahead = look_ahead;
    range.neighbours = &neighbours;
    const auto& found = search.touch(blocks, state, a, b, range).points;
    contacts.insert(contacts.end(), found.begin(), found.end());
  }
  return contacts;
}

}  // namespace talus
