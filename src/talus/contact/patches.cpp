#include "talus/contact/patches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/blocks/in_situ.h"
#include "talus/contact/patch_memory.h"

namespace talus {

namespace {

// Pairs to a chunk.
constexpr size_t kPatchGrain = 256;

// What coordinates are rounded to, a hundred times.
constexpr double kRounding = 1e-14;

// Copied where a patch begins: cheaper than to begin its many fields one by one.
const Patch kFresh;

}  // namespace

// One pair of blocks on its way to patches.
class PairSearch {
 public:
  PairSearch(const PatchWorld& world, const LookAhead& ahead, const PatchSearch& search, const State& state)
      : w_(world), ahead_(ahead), search_(search), state_(state), memory_(world, state) {
    all_laws_elastic_ = is_elastic(w_.layout.default_joint);
    for (const JointLaw& law : w_.laws) {
      all_laws_elastic_ = all_laws_elastic_ && law.is_soft(0);
      any_rises_ = any_rises_ || law.dilates();
    }
  }

  // The patches of a pair, in the order of their parts; returns how far ahead they were sought [m].
  double look(const ContactPair& pair, std::vector<Patch>& out) {
    out.clear();
    pair_ = &pair, elastic_ = all_elastic(pair);
    const int a = pair.a, b = pair.b;
    shift_ =
        (w_.blocks.centroid[b] - w_.blocks.centroid[a]) + (state_.displacement[b] - state_.displacement[a]);
    known_ = {state_.patches.data() + pair.begin, static_cast<size_t>(pair.count)};
    memory_.look_at(pair, known_, shift_);
    size_ = std::min(w_.blocks.size[a], w_.blocks.size[b]);
    const auto &now_a = search_.now_[a], &now_b = search_.now_[b];
    closing_ = norm(now_a.motion.way - now_b.motion.way);
    approach_ = closing_ + now_a.turning + now_b.turning;
    highest_ = 0;
    for (const Patch& p : any_rises_ ? known_ : std::span<const Patch>{})
      highest_ = std::max({highest_, rise(p, 0), rise(p, 1)});
    distance_ = norm(shift_);
    rounding_ = kRounding * (distance_ + w_.blocks.radius[a] + w_.blocks.radius[b]);
    margin_ = std::max(kMarginShare * size_, 2 * approach_ + 2 * highest_);
    gone_ = gone_since_list();
    lead_ = std::numeric_limits<double>::infinity();
    const Outlines& o = w_.outlines;
    for (int p = o.part_begin[a]; p < o.part_begin[a + 1]; ++p)
      for (int q = o.part_begin[b]; q < o.part_begin[b + 1]; ++q) look_at_parts(p, q, out);
    return margin_;
  }

  // ContactPair::lead of the pair that was looked at, rounded down.
  float lead() const { return static_cast<float>((1 - 1e-6) * std::max(0.0, lead_)); }

  // Of all pairs that were looked at.
  double unseen() const { return unseen_; }

 private:
  bool is_elastic(int joint) const { return joint >= 0 && w_.laws[joint].is_soft(0); }

  // Whether all sides of the pair have joints that are elastic along the normal.
  bool all_elastic(const ContactPair& pair) const {
    return pair.joint == ContactPair::kByEdges ? all_laws_elastic_ : is_elastic(pair.joint);
  }

  // By how much a way must be behind another to stay so in this step: twice what any place of one block moves at most as the
  // other one sees it.
  double behind(double lifted) const {
    const auto &a = search_.now_[pair_->a], &b = search_.now_[pair_->b];
    return 2 * (closing_ + (a.turns + b.turns) * (distance_ + lifted + a.reach + b.reach)) + kLevel * size_;
  }

  // By how much one way may have come nearer to another since the list of pairs was made: twice what any place of one block
  // moves at most as the other one sees it, whose sides turn too.
  double gone_since_list() const {
    const auto &a = search_.now_[pair_->a], &b = search_.now_[pair_->b];
    return 2 * (a.gone + b.gone + 2 * (a.turned + b.turned) * (distance_ + a.reach + b.reach));
  }

  const PartMotion& motion(int block) const { return search_.now_[block].motion; }

  // On block a [N].
  static Vec2 force_of(const Patch& p) {
    return (p.force[0][0] + p.force[1][0]) * p.normal +
           (p.force[0][1] + p.force[1][1]) * turn_right(p.normal);
  }

  double rise(const Patch& p, size_t end) const {
    return p.joint < 0 ? 0 : w_.laws[p.joint].rise(p.slip[end]);
  }

  PartNow part_now(int part, int other, std::vector<SideRole>& roles) const {
    const Outlines& o = w_.outlines;
    const size_t begin = o.corner_begin[part], n = o.corners_of(part);
    roles.clear();
    if (!search_.bare_[part])
      for (size_t k = 0; k < n; ++k) roles.push_back(role_of(search_.tied_to_[begin + k], other));
    return {{search_.corner_.data() + begin, n}, {search_.along_.data() + begin, n}, roles};
  }

  static SideRole role_of(int tied_to, int other) {
    if (tied_to == PatchSearch::kFree) return SideRole::kOut;
    if (tied_to == PatchSearch::kCut) return SideRole::kCut;
    return tied_to == other ? SideRole::kTiedHere : SideRole::kTied;
  }

  // Whether a side of a part goes on in line with the next or the one before.
  bool goes_on(int part, const PartNow& now, size_t k) const {
    const int begin = w_.outlines.corner_begin[part];
    const auto in_line = [&](size_t other) {
      return w_.outlines.side[begin + other].edge >= 0 &&
             std::abs(cross(now.along[k], now.along[other])) <= kOneSide;
    };
    return in_line((k + 1) % now.size()) || in_line((k + now.size() - 1) % now.size());
  }

  // Whether a bond ties a whole side of one part to the other part: convex parts share no more than that.
  bool tied_along_side(int p, const PartNow& a, int q, const PartNow& b) const {
    const Outlines& o = w_.outlines;
    const auto face = [&](int part, size_t k) { return o.side[o.corner_begin[part] + k].face; };
    for (size_t k = 0; k < a.role.size(); ++k) {
      if (a.role[k] != SideRole::kTiedHere) continue;
      for (size_t m = 0; m < b.role.size(); ++m)
        if (b.role[m] == SideRole::kTiedHere && face(p, k) == face(q, m) &&
            (!goes_on(p, a, k) || !goes_on(q, b, m)))
          return true;
    }
    return false;
  }

  void look_at_parts(int p, int q, std::vector<Patch>& out) {
    const PartNow a = part_now(p, pair_->b, roles_a_), b = part_now(q, pair_->a, roles_b_);
    if (pair_->face >= 0 && tied_along_side(p, a, q, b)) return;
    const Patch* before = nullptr;  // of several, which ties leave, the largest
    bool several = false;
    for (const Patch& known : known_) {
      if (known.part_a != p || known.part_b != q) continue;
      several = before;
      if (!before || known.area > before->area) before = &known;
    }
    Vec2 shift = shift_;
    double lifted = 0;  // both ends alike
    if (before && highest_ > 0)
      lifted = 0.5 * (rise(*before, 0) + rise(*before, 1)), shift += lifted * before->normal;
    const bool measured = elastic_ && before && before->overlaps;
    LookFirst first{.way = before ? before->way : 0, .strip = measured};
    if (!measured) first.behind = behind(lifted);
    const bool ahead = !measured && before && !several && before->way != 0 && lifted == 0 && a.role.empty() &&
                       b.role.empty() && static_cast<double>(pair_->lead) - gone_ > first.behind;
    if (ahead) first.near = near_ways(*before);
    const PartsMet& met = meeting_.look(a, b, shift, margin_, rounding_, first);
    if (met.kind == PartsMet::kFar) return;
    // an overlap of elastic joints has its normal and sides from its cells
    if (met.kind == PartsMet::kApart || !elastic_) choose_way(before, shift, p, q);
    if (met.kind == PartsMet::kFar) return;
    const auto own = [&] { return several ? known_near(p, q, 0.5 * (met.begin + met.end)) : before; };
    const bool overlaps = met.kind == PartsMet::kOverlap;
    int joint = -1;
    bool soft = elastic_;
    if (!elastic_ || !overlaps) joint = joint_met(p, q), soft = is_elastic(joint);
    if (soft && overlaps) {
      for (bool any = meeting_.measure_overlap(); any; any = meeting_.measure_next_piece()) {
        Patch& patch = begin_patch(met, p, q, out);
        patch.area = met.area, patch.way = elastic_ ? met.way : 0;
        mix_joints(met, p, q, patch);
        // a hair at the end of a tie whose nearest sides have no stiffness: left to the tie
        if (met.beside_tie && !is_elastic(patch.joint))
          out.pop_back();
        else
          finish(met, own(), shift, lifted, soft, patch);
      }
      return;
    }
    if (met.tied || met.at_corner || !meeting_.face_ends(margin_)) return;
    if (!overlaps && met.length() <= kLevel * size_) return;
    Patch& patch = begin_patch(met, p, q, out);
    patch.joint = joint, patch.way = met.way;
    if (ahead)
      take_lead(first.near, pair_->lead, patch);
    else
      take_lead(meeting_.near_ways(), lifted > 0 ? 0 : meeting_.lead() - gone_, patch);
    finish(met, own(), shift, lifted, soft, patch);
  }

  // The ways of a patch that all others are behind, in the order in which they are looked at: those of b first.
  static std::array<int, 2> near_ways(const Patch& p) {
    const bool first =
        p.also == 0 || ((p.way > 0) == (p.also > 0) ? std::abs(p.way) < std::abs(p.also) : p.way > 0);
    return first ? std::array<int, 2>{p.way, p.also} : std::array<int, 2>{p.also, p.way};
  }

  void take_lead(std::array<int, 2> near, double lead, Patch& patch) {
    const int also = near[0] == patch.way ? near[1] : near[0];
    patch.also = static_cast<int16_t>(also);
    lead_ = std::min(lead_, patch.also == also ? lead : 0);
  }

  // Of hard contacts without the ways that a third block fills.
  void choose_way(const Patch* before, Vec2 shift, int p, int q) {
    const WayBefore known{before ? before->way : 0, kLevel * size_, before ? force_of(*before) : Vec2{}};
    const PartMotion &a = motion(pair_->a), &b = motion(pair_->b);
    meeting_.choose_way(a, b, known);
    if (elastic_) return;
    const std::span<CornerSide> sides = meeting_.sides_at_corner(known.by);
    if (sides.empty() || is_elastic(joint_met(p, q))) return;
    for (CornerSide& s : sides)
      s.filled = is_in_third(s.of_b, s.behind[0], shift) && is_in_third(s.of_b, s.behind[1], shift);
    if (meeting_.leave_out_filled()) meeting_.choose_way(a, b, known);
  }

  // Whether a place, seen from block a, is in a block near one of the two. One that a tie moves with the other of them does
  // not count: it goes out of the way with that.
  bool is_in_third(bool near_b, Vec2 x, Vec2 shift) const {
    const int own = near_b ? pair_->b : pair_->a, other = near_b ? pair_->a : pair_->b;
    const Vec2 from_own = x - (near_b ? shift : Vec2{});
    for (const int third : state_.candidates.neighbours.of(own)) {
      if (third == other || w_.blocks.removed(third)) continue;
      const Vec2 place = from_own - (w_.blocks.centroid[third] - w_.blocks.centroid[own]) -
                         (state_.displacement[third] - state_.displacement[own]);
      if (norm(place) <= search_.now_[third].reach && is_in_block(third, place) &&
          !is_tied(w_.bonds, state_, std::min(third, other), std::max(third, other)))
        return true;
    }
    return false;
  }

  // Whether a place, seen from the centroid of a block, is in one of its parts.
  bool is_in_block(size_t block, Vec2 place) const {
    const Outlines& o = w_.outlines;
    for (int p = o.part_begin[block]; p < o.part_begin[block + 1]; ++p) {
      bool inside = true;
      for (int k = o.corner_begin[p]; inside && k < o.corner_begin[p + 1]; ++k)
        inside = cross(search_.along_[k], place - search_.corner_[k]) >= 0;
      if (inside) return true;
    }
    return false;
  }

  Patch& begin_patch(const PartsMet& met, int p, int q, std::vector<Patch>& out) const {
    Patch& patch = out.emplace_back(kFresh);
    patch.block_a = pair_->a, patch.block_b = pair_->b, patch.part_a = p, patch.part_b = q;
    patch.side_a = edge_of(p, met.side_a), patch.side_b = edge_of(q, met.side_b);
    patch.overlaps = met.kind == PartsMet::kOverlap;
    return patch;
  }

  // Place, memory and closures of what has been found.
  void finish(const PartsMet& met, const Patch* before, Vec2 shift, double lifted, bool soft, Patch& patch) {
    write_place(met, shift, patch);
    for (size_t end = 0; end < 2; ++end) patch.gap[end] = lifted - met.closure[end];
    memory_.recall(before, patch);
    if (state_.step == 0) stretch_by_ground(patch);
    for (size_t end = 0; end < 2; ++end)
      if (lifted > 0) patch.closure[end] += rise(patch, end) - lifted;
    if (soft)
      measure(met, before, patch), count_from_ground(lifted > 0, patch);
    else if (!before || dot(before->normal, patch.normal) < kSameWay)
      for (size_t end = 0; end < 2; ++end) {
        const double deep = std::max(0.0, patch.closure[end]);
        if (goes_out_at_once())
          unseen_ = std::max(unseen_, deep / size_);
        else
          patch.allowed[end] = deep;
      }
  }

  // Whether a step leaves no overlap of hard blocks: where it ends at rest, what is pushed out has no speed. What is drawn
  // with an overlap keeps it.
  bool goes_out_at_once() const { return ahead_.clock.from_rest && state_.step > 0; }

  // Of the patches that two parts had the one nearest to a place, seen from block a.
  const Patch* known_near(int p, int q, Vec2 place) const {
    const auto off = [&](const Patch& c) { return norm(memory_.middle_of(c) - place); };
    const Patch* nearest = nullptr;
    for (const Patch& c : known_)
      if (c.part_a == p && c.part_b == q && (!nearest || off(c) < off(*nearest))) nearest = &c;
    return nearest;
  }

  int edge_of(int part, int side) const {
    if (side < 0) return -1;
    return w_.outlines.side[w_.outlines.corner_begin[part] + side].edge;
  }

  int joint_met(int p, int q) const {
    if (pair_->joint != ContactPair::kByEdges) return pair_->joint;
    const PartsMet& met = meeting_.met();
    return joint_between(edge_of(p, met.side_a), edge_of(q, met.side_b));
  }

  // Joint between an edge of a and one of b. Where a glued edge meets a third block, the joint of the other one.
  int joint_between(int edge_a, int edge_b) const {
    if (pair_->joint != ContactPair::kByEdges) return pair_->joint;
    const Layout& l = w_.layout;
    const auto glued = [&](int joint) { return joint >= 0 && w_.laws[joint].bonded(); };
    int joint = l.joint_by_edges({pair_->a, edge_a}, {pair_->b, edge_b});
    if (glued(joint)) joint = l.joint_by_edges({pair_->a, -1}, {pair_->b, edge_b});
    return glued(joint) && l.default_joint >= 0 ? l.default_joint : joint;
  }

  // The joint of most of an overlap, and the next one with its share (theory 3.8).
  void mix_joints(const PartsMet& met, int p, int q, Patch& patch) {
    patch.joint = joint_between(patch.side_a, patch.side_b);
    if (pair_->joint != ContactPair::kByEdges || (met.cells_a.size() == 1 && met.cells_b.size() == 1)) return;
    shares_.clear();
    double all = 0;
    const auto add = [&](int joint, double area) {
      all += area;
      for (auto& [known, sum] : shares_)
        if (known == joint) return void(sum += area);
      shares_.emplace_back(joint, area);
    };
    for (const SideCell& c : met.cells_a) add(joint_between(edge_of(p, c.side), patch.side_b), c.area);
    for (const SideCell& c : met.cells_b) add(joint_between(patch.side_a, edge_of(q, c.side)), c.area);
    std::stable_sort(shares_.begin(), shares_.end(),
                     [](const auto& x, const auto& y) { return x.second > y.second; });
    patch.joint = shares_[0].first;
    if (shares_.size() > 1) patch.other_joint = shares_[1].first, patch.other_share = shares_[1].second / all;
  }

  void write_place(const PartsMet& met, Vec2 shift, Patch& patch) const {
    const int a = patch.block_a, b = patch.block_b;
    patch.normal = met.normal, patch.length = met.length();
    patch.closure = {met.closure[0], met.closure[1]};
    const std::array<Vec2, 2> x{met.begin, met.end};
    for (size_t end = 0; end < 2; ++end)
      patch.arm_a[end] = search_.now_[a].back * x[end],
      patch.arm_b[end] = search_.now_[b].back * (x[end] - met.across[end] * met.normal - shift);
  }

  // What the stress of the ground has closed and slipped at an end, along normal and tangent (theory 1.7).
  Vec2 ground_at(const Patch& patch, size_t end) const {
    if (!w_.model.in_situ.given || patch.joint < 0 || !pair_->shares_face) return {};
    const double height = w_.blocks.centroid[patch.block_b].y + patch.arm_b[end].y;
    const Vec2 closure = w_.laws[patch.joint].closure(
        in_situ_stress(w_.model.in_situ, w_.model.gravity, height), patch.normal);
    return {-closure.x, closure.y};
  }

  // Elastic slip by the stress of the ground, at the start (theory 3.5).
  void stretch_by_ground(Patch& patch) const {
    patch.stretch = {ground_at(patch, 0).y, ground_at(patch, 1).y};
  }

  // Normal closure less what the patch keeps for good (theory 3.5).
  void measure(const PartsMet& met, const Patch* before, Patch& patch) const {
    if (!patch.overlaps) return;
    const double root = std::sqrt(std::max(0.0, met.energy));
    if (!before && state_.step == 0 && w_.model.in_situ.given) keep_start(met, root, patch);
    if (patch.root_kept == 0 || !(root > 0)) return;
    const double share = 1 - patch.root_kept / root;
    for (double& c : patch.closure) c *= share;
  }

  // Gaps of elastic patches count from what the stress of the ground has closed; closures hold the rise of each end.
  void count_from_ground(bool lifted, Patch& patch) const {
    for (size_t end = 0; end < 2; ++end)
      patch.gap[end] = (lifted ? rise(patch, end) : 0) + ground_at(patch, end).x - patch.closure[end];
  }

  // At the start a patch bears what the stress of the ground asks of the faces there, a crossing nothing.
  void keep_start(const PartsMet& met, double root, Patch& patch) const {
    const double wanted = closed_by_ground(patch);
    patch.root_kept = met.force > 0 ? root * (1 - wanted / met.force) : 0;
  }

  // Where along an edge of block b the sides of a part lie that are of that edge of its block: a span that is
  // empty, if there are none [m].
  struct Span {
    double from = std::numeric_limits<double>::infinity(), to = -std::numeric_limits<double>::infinity();
  };
  Span span_of(int part, int edge, Vec2 shift, Vec2 from, Vec2 along) const {
    const Outlines& o = w_.outlines;
    const int begin = o.corner_begin[part], n = o.corners_of(part);
    Span out;
    for (int k = 0; k < n; ++k)
      if (o.side[begin + k].edge == edge)
        for (const size_t c : {k, (k + 1) % n}) {
          const double s = dot(along, o.corner[begin + c] + shift - from);
          out.from = std::min(out.from, s), out.to = std::max(out.to, s);
        }
    return out;
  }

  // Integral of the closure by the stress of the ground over the face that two parts share in the reference
  // shape [m2].
  double closed_by_ground(const Patch& patch) const {
    if (!pair_->shares_face || patch.side_a < 0 || patch.side_b < 0) return 0;
    const int a = patch.block_a, b = patch.block_b;
    const BlockEdge edge{patch.block_b, patch.side_b};
    const Vec2 from = w_.blocks.corner({edge.block, edge.edge}),
               side = w_.blocks.corner(w_.blocks.end_of(edge)) - from;
    const double length = norm(side);
    const Vec2 along = side / length;
    const Span of_a = span_of(patch.part_a, patch.side_a, w_.blocks.centroid[a] - w_.blocks.centroid[b], from,
                              along),
               of_b = span_of(patch.part_b, patch.side_b, {}, from, along);
    const Vec2 apart = w_.blocks.centroid[a] - w_.blocks.centroid[b];
    const BlockEdge other{patch.block_a, patch.side_a};
    const double s0 = dot(along, w_.blocks.corner({other.block, other.edge}) + apart - from),
                 s1 = dot(along, w_.blocks.corner(w_.blocks.end_of(other)) + apart - from);
    const double low = std::max({0.0, of_a.from, of_b.from, std::min(s0, s1)}),
                 high = std::min({length, of_a.to, of_b.to, std::max(s0, s1)});
    if (!(high > low)) return 0;
    const double height = w_.blocks.centroid[b].y + from.y + 0.5 * (low + high) * along.y;
    const Mat2 stress = in_situ_stress(w_.model.in_situ, w_.model.gravity, height);
    const JointLaw& law = w_.laws[patch.joint];
    return std::max(0.0, -(high - low) * law.closure(stress, turn_right(along)).x);
  }

  const PatchWorld& w_;
  const LookAhead& ahead_;
  const PatchSearch& search_;
  const State& state_;
  PartsMeeting meeting_;
  PatchMemory memory_;
  const ContactPair* pair_ = nullptr;
  Vec2 shift_;
  bool all_laws_elastic_ = false, elastic_ = false;  // all joints, those of this pair
  bool any_rises_ = false;                           // some joint does
  std::span<const Patch> known_;
  double unseen_ = 0;
  double size_ = 0, approach_ = 0, highest_ = 0, margin_ = 0, rounding_ = 0;
  double distance_ = 0;         // of the two centroids
  double closing_ = 0;          // of these in the step to come, at most
  double gone_ = 0, lead_ = 0;  // that of all patches
  std::vector<SideRole> roles_a_, roles_b_;
  std::vector<std::pair<int, double>> shares_;
};

// Whom a side is tied to now, for tied_to_.
int PatchSearch::tied_to(const PatchWorld& world, const State& state, int block, const PartSide& side) {
  if (side.edge < 0) return kCut;
  if (side.face < 0 || state.face[side.face].broken) return kFree;
  const BondFace& f = world.bonds.faces[side.face];
  if (!world.blocks.interact(f.block_a, f.block_b)) return kFree;
  return f.block_a == block ? f.block_b : f.block_a;
}

// Parts as they lie, from the centroid of their block.
void PatchSearch::place_parts(const PatchWorld& world, const LookAhead& ahead, const Workers& workers,
                              const State& state) {
  const Outlines& o = world.outlines;
  const BlockSet& blocks = world.blocks;
  const CandidateList& list = state.candidates;
  corner_.resize(o.corner.size()), along_.resize(o.corner.size());
  if (std::find(o.plain.begin(), o.plain.end(), false) != o.plain.end()) tied_to_.resize(o.corner.size());
  bare_.resize(o.plain.size());
  now_.resize(state.strain_part.size());
  workers.for_chunks(blocks.count, 1024, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Mat2& h = state.strain_part[i];
      const Mat2 turned = kIdentity + h, back = inverse(turned);
      const BlockRate& v = ahead.before[i];
      // G of a deformable block acts on the reference arm
      const Mat2 turn = ahead.clock.dt * (blocks.kind[i] == BlockKind::kDeformable ? v.G * back : v.G);
      now_[i] = {back,
                 norm(turned) * blocks.radius[i],
                 ahead.clock.dt * turning_speed(blocks, ahead.before, i),
                 {ahead.clock.dt * v.a, turn},
                 norm(turn),
                 norm(state.displacement[i] - list.displacement[i]),
                 norm(h - list.strain_part[i]) * norm(back)};
      for (int p = o.part_begin[i]; p < o.part_begin[i + 1]; ++p) place_part(world, state, i, p);
    }
  });
}

void PatchSearch::place_part(const PatchWorld& world, const State& state, size_t block, size_t part) {
  const Outlines& o = world.outlines;
  const Mat2& h = state.strain_part[block];
  const int first = o.corner_begin[part], last = o.corner_begin[part + 1];
  for (int k = first; k < last; ++k) corner_[k] = o.corner[k] + h * o.corner[k];
  for (int k = first; k < last; ++k) {
    const Vec2 side = o.corner[k + 1 == last ? first : k + 1] - o.corner[k], now = side + h * side;
    along_[k] = now / norm(now);
  }
  bare_[part] = true;
  for (int k = first; k < last && !o.plain[part]; ++k) {
    tied_to_[k] = tied_to(world, state, static_cast<int>(block), o.side[k]);
    bare_[part] = bare_[part] && tied_to_[k] == kFree;
  }
}

int PatchSearch::update(const PatchWorld& world, const LookAhead& ahead, const Workers& workers,
                        State& state) {
  TALUS_ASSERT(count_of(world.outlines.part_begin) == world.blocks.count + 1);
  place_parts(world, ahead, workers, state);
  const size_t n = state.pairs.size();
  changed_.resize((n + kPatchGrain - 1) / kPatchGrain);
  workers.for_chunks(n, kPatchGrain, [&](size_t begin, size_t end) {
    Changed& changed = changed_[begin / kPatchGrain];
    changed.pair.clear(), changed.patch.clear(), changed.met = 0, changed.unseen = 0;
    PairSearch search(world, ahead, *this, state);
    std::vector<Patch> found;
    for (size_t i = begin; i < end; ++i) {
      ContactPair& pair = state.pairs[i];
      if (state.step == 0)
        pair.shares_face =
            pair.from_start && std::binary_search(world.outlines.closed.begin(), world.outlines.closed.end(),
                                                  std::pair(pair.a, pair.b));
      pair.margin = search.look(pair, found);
      pair.lead = search.lead();
      changed.met += !found.empty();
      if (count_of(found) == pair.count) {
        std::copy(found.begin(), found.end(), state.patches.begin() + pair.begin);
        continue;
      }
      changed.pair.emplace_back(i, count_of(found));
      changed.patch.insert(changed.patch.end(), found.begin(), found.end());
    }
    changed.unseen = search.unseen();
  });
  unseen_ = 0;
  int met = 0;
  bool any = false;
  for (const Changed& c : changed_) {
    met += c.met, any = any || !c.pair.empty();
    unseen_ = std::max(unseen_, c.unseen);
  }
  if (any) put_together(state), changed_.clear();  // at the start it holds all patches
  return met;
}

// Patches of all pairs one after the other again.
void PatchSearch::put_together(State& state) {
  size_t count = state.patches.size();
  for (const Changed& c : changed_) {
    count += c.patch.size();
    for (const auto& [pair, now] : c.pair) count -= state.pairs[pair].count;
  }
  std::vector<Patch> all;
  all.reserve(count);
  for (size_t c = 0; c < changed_.size(); ++c) {
    auto changed = changed_[c].pair.begin();
    auto from = changed_[c].patch.begin();
    for (size_t i = c * kPatchGrain; i < std::min(state.pairs.size(), (c + 1) * kPatchGrain); ++i) {
      ContactPair& pair = state.pairs[i];
      const auto begin = count_of(all);
      if (changed != changed_[c].pair.end() && changed->first == i) {
        all.insert(all.end(), from, from + changed->second);
        from += changed->second, pair.count = changed->second, ++changed;
      } else {
        const auto old = state.patches.begin() + pair.begin;
        all.insert(all.end(), old, old + pair.count);
      }
      pair.begin = begin;
    }
  }
  state.patches = std::move(all);
}

}  // namespace talus
