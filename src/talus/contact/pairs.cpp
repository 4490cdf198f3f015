#include "talus/contact/pairs.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/rank.h"

namespace talus {

namespace {

// Skin of a block in the list of pairs, as share of its size, or of the median one where that is smaller.
constexpr double kSkin = 0.1;

double moved_since(const BlockSet& blocks, const State& state, const CandidateList& list, size_t i) {
  const Mat2 h = state.strain_part[i] - list.strain_part[i];
  return norm(state.displacement[i] - list.displacement[i]) + std::sqrt(contract(h, h)) * blocks.radius[i];
}

// How fast places of a block move at most [m/s].
double speed_of(const BlockSet& blocks, const std::vector<BlockRate>& rate, size_t i) {
  return norm(rate[i].a) + turning_speed(blocks, rate, i);
}

// Faces that rode up over their roughness are that far apart and in touch: the most that joints can rise [m]
// (theory 3.1).
double highest_rise(const std::vector<JointLaw>& joints, const State& state) {
  if (std::none_of(joints.begin(), joints.end(), [](const JointLaw& j) { return j.dilates(); })) return 0;
  double rise = 0;
  for (const Patch& p : state.patches)
    for (const double slip : p.slip)
      if (p.joint >= 0) rise = std::max(rise, joints[p.joint].rise(slip));
  return rise;
}

// How far block i has to look ahead: with the same of the other block at least the margin of their pair [m]
// (theory 3.1).
double reach_of(const BlockSet& blocks, const LookAhead& ahead, size_t i) {
  return std::max(0.5 * kMarginShare * blocks.size[i],
                  4 * ahead.clock.dt * speed_of(blocks, ahead.before, i));
}

// Theory 3.1.
bool list_holds(const BlockSet& blocks, const State& state, const LookAhead& ahead, double rise,
                const Workers& workers) {
  const CandidateList& list = state.candidates;
  if (count_of(list.reach) != blocks.count) return false;
  std::atomic<bool> holds{true};
  workers.for_chunks(list.displacement.size(), 2048, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end && holds.load(std::memory_order_relaxed); ++i)
      if (!(moved_since(blocks, state, list, i) < 0.5 * list.skin[i]) ||
          !(reach_of(blocks, ahead, i) + rise <= list.reach[i]))
        holds = false;
  });
  return holds;
}

int first_face(const BondSet& bonds, int a, int b) {
  const auto it = std::lower_bound(
      bonds.faces.begin(), bonds.faces.end(), std::pair(a, b),
      [](const BondFace& f, const std::pair<int, int>& p) { return std::pair(f.block_a, f.block_b) < p; });
  const bool found = it != bonds.faces.end() && it->block_a == a && it->block_b == b;
  return found ? static_cast<int>(it - bonds.faces.begin()) : -1;
}

// The joint of a pair where it is the same for all of its sides. Bonded ones go by edges: what meets a bonded edge from
// elsewhere is not of it.
int joint_of(const BlockSet& blocks, const Layout& layout, const std::vector<JointLaw>& laws, int a, int b) {
  const int given = layout.joint_of_pair(blocks.group[a], blocks.group[b]);
  if (given != Layout::kNoPair) return given;
  const std::vector<int>&of_a = layout.blocks[a].edge_joint, &of_b = layout.blocks[b].edge_joint;
  if (of_a.empty() && of_b.empty()) return layout.default_joint;
  const int joint = of_a.empty() || of_b.empty() ? layout.default_joint : of_a[0];
  const auto same = [&](int other) { return other == joint; };
  const bool one = std::all_of(of_a.begin(), of_a.end(), same) && std::all_of(of_b.begin(), of_b.end(), same);
  return one && !(joint >= 0 && laws[joint].bonded()) ? joint : ContactPair::kByEdges;
}

}  // namespace

double turning_speed(const BlockSet& blocks, const std::vector<BlockRate>& rate, size_t i) {
  return std::sqrt(contract(rate[i].G, rate[i].G)) * blocks.radius[i];
}

std::vector<Box> boxes_now(const BlockSet& blocks, const State& state) {
  std::vector<Box> boxes;
  const Vec2 origin = blocks.centroid[0];
  for (int i = 0; i < blocks.count; ++i) {
    const Vec2 from = blocks.centroid[i] - origin;
    Box box{from + offset_now(state, i, blocks.corner({i, 0})), {}};
    box.max = box.min;
    for (int v = 1; v < blocks.vertex_count(i); ++v) {
      const Vec2 p = from + offset_now(state, i, blocks.corner({i, v}));
      box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y)};
      box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y)};
    }
    boxes.push_back(box);
  }
  return boxes;
}

bool held_by_faces(const BondSet& bonds, const State& state, const ContactPair& pair) {
  if (pair.face < 0) return false;
  for (int f = pair.face; f < count_of(bonds.faces); ++f) {
    if (bonds.faces[f].block_a != pair.a || bonds.faces[f].block_b != pair.b) break;
    if (!state.face[f].broken) return true;
  }
  return false;
}

BySize by_size(const BlockSet& blocks, const ContactPair& p) {
  const int a = p.a, b = p.b;
  return blocks.radius[a] <= blocks.radius[b] ? BySize{a, b} : BySize{b, a};
}

void list_neighbours(const BlockSet& blocks, const std::vector<std::pair<int, int>>& close, Neighbours& out) {
  out.begin.assign(blocks.count + 1, 0);
  const auto both = [&](const auto& use) {
    for (const auto& [a, b] : close)
      if (!blocks.removed(a) && !blocks.removed(b)) use(a, b), use(b, a);
  };
  both([&](int i, int) { ++out.begin[i + 1]; });
  for (size_t i = 1; i < out.begin.size(); ++i) out.begin[i] += out.begin[i - 1];
  out.block.resize(out.begin.back());
  std::vector<int> next(out.begin.begin(), out.begin.end() - 1);
  both([&](int i, int j) { out.block[next[i]++] = j; });
}

Approach approach_of(const BondSet& bonds, const BlockSet& blocks, const State& state,
                     const std::vector<BlockRate>& rate, double dt, const Workers& workers) {
  return workers.sum_chunks<Approach>(
      state.pairs.size(), 2048, [&](size_t begin, size_t end, Approach& most) {
        for (size_t i = begin; i < end; ++i) {
          const ContactPair& pair = state.pairs[i];
          if (pair.count == 0 && held_by_faces(bonds, state, pair)) continue;
          const auto [small, large] = by_size(blocks, pair);
          const Vec2 arm = (blocks.centroid[small] - blocks.centroid[large]) +
                           (state.displacement[small] - state.displacement[large]);
          const Mat2 turning = rate[small].G - rate[large].G;
          const double together = dt * (norm(rate[small].a - rate[large].a - rate[large].G * arm) +
                                        std::sqrt(contract(turning, turning)) * blocks.radius[small]);
          most += {together / pair.margin, together / std::min(blocks.size[small], blocks.size[large]), small,
                   large};
        }
      });
}

// Theory 3.1.
bool renew_pairs(const BlockSet& blocks, const BondSet& bonds, const Layout& joints_of,
                 const std::vector<JointLaw>& joints, const LookAhead& ahead, const Workers& workers,
                 State& state) {
  TALUS_ASSERT(count_of(ahead.before) == blocks.count && state.face.size() == bonds.faces.size());
  const double rise = highest_rise(joints, state);
  if (blocks.count == 0 || list_holds(blocks, state, ahead, rise, workers)) return false;
  CandidateList& list = state.candidates;
  ++list.rebuilds;
  list.displacement = state.displacement;
  list.strain_part = state.strain_part;
  const double median_size = median(blocks.size);
  const int n = blocks.count;
  list.skin.resize(n), list.reach.resize(n);
  std::vector<Box> boxes = boxes_now(blocks, state);
  for (int i = 0; i < n; ++i) {
    list.skin[i] = kSkin * std::min(blocks.size[i], median_size);
    // twice what is needed now, where it is speed that asks for it, so that the list holds for a while
    const double now = reach_of(blocks, ahead, i), rest = 0.5 * kMarginShare * blocks.size[i];
    list.reach[i] = (now > rest ? 2 * now : rest) + 2 * rise;
    const double wider = list.reach[i] + 0.5 * list.skin[i];
    boxes[i] = {boxes[i].min - Vec2{wider, wider}, boxes[i].max + Vec2{wider, wider}};
  }

  const std::vector<ContactPair> before = std::move(state.pairs);
  std::vector<ContactPair> now;
  std::vector<Contact> contacts;
  std::vector<FollowedPair> followed;
  std::vector<Patch> patches;
  contacts.reserve(state.contacts.size() + state.contacts.size() / 32);
  patches.reserve(state.patches.size());
  auto known = before.begin();
  const std::vector<std::pair<int, int>> close = close_pairs(boxes, 0);
  list_neighbours(blocks, close, list.neighbours);
  for (const auto& [a, b] : close) {
    if (!blocks.interact(a, b)) continue;
    if (std::binary_search(bonds.tied.begin(), bonds.tied.end(), std::pair(a, b))) continue;
    while (known != before.end() && std::pair(known->a, known->b) < std::pair(a, b)) ++known;
    ContactPair pair;
    FollowedPair as_followed;
    if (known != before.end() && known->a == a && known->b == b) {
      pair = *known;
      pair.lead = 0;
      if (!state.followed.empty()) as_followed = state.followed[known - before.begin()];
    } else {
      pair.a = a, pair.b = b;
      pair.from_start = state.step == 0;
      pair.face = first_face(bonds, a, b);
      pair.shares_face = pair.from_start && pair.face >= 0;
      pair.joint = joint_of(blocks, joints_of, joints, a, b);
    }
    const int from = pair.begin;
    if (!state.patches.empty()) {
      pair.begin = count_of(patches);
      patches.insert(patches.end(), state.patches.begin() + from, state.patches.begin() + from + pair.count);
    } else {
      pair.begin = count_of(contacts);
      contacts.insert(contacts.end(), state.contacts.begin() + from,
                      state.contacts.begin() + from + pair.count);
    }
    now.push_back(pair);
    if (!state.followed.empty()) followed.push_back(as_followed);
  }
  now.shrink_to_fit();
  state.pairs = std::move(now);
  state.contacts = std::move(contacts);
  state.followed = std::move(followed);
  state.patches = std::move(patches);
  return true;
}

}  // namespace talus
