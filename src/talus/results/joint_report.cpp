#include "talus/results/joint_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/blocks/in_situ.h"
#include "talus/contact/bonds.h"
#include "talus/corners/find.h"
#include "talus/run/resolution.h"
#include "talus/run/run.h"

namespace talus {

namespace {

static_assert(count_of(kJointStates) == place_of(last_of(JointState())) + 1);

constexpr double kMoved = 0.1;  // of its size: a block that has gone so far is one that moved

// What an edge of a block was cut along.
std::string set_of(const Scene& scene, int block, int edge) {
  const std::vector<int>& origin = scene.layout.blocks[block].edge_origin;
  if (origin.empty() || edge < 0) return {};
  const int which = origin[edge];
  return which < 0 ? std::string() : scene.layout.origins[which];
}

// An intact end of a face: what parts it is elastic, unless it stands open or slid at its limit.
std::optional<JointPoint> face_point(const Scene& scene, const Instant& i, size_t owner) {
  const BondFace& face = scene.bonds.faces[owner / 2];
  if (face.unbreakable) return std::nullopt;
  JointPoint out;
  out.face = true;
  out.id = fmt::format("face {} end {}", owner / 2, owner % 2);
  out.joint = face.joint;
  out.set = set_of(scene, face.block_b, face.edge_b);
  out.length = 0.5 * face.length;
  out.state = place_of(JointState::kIntact);
  out.opening = std::max(0.0, face_offset(scene.blocks, i.state, face).opening[owner % 2]);
  out.slip_signed = i.state.face[owner / 2].slip[owner % 2], out.slip = std::abs(out.slip_signed);
  return out;
}

// The pair of blocks that a contact belongs to.
const ContactPair& pair_of(const State& state, size_t contact) {
  const auto after =
      std::upper_bound(state.pairs.begin(), state.pairs.end(), contact,
                       [](size_t k, const ContactPair& p) { return std::cmp_less(k, p.begin); });
  auto pair = after - 1;
  while (pair->count == 0) --pair;  // those without points begin where the next one does
  return *pair;
}

// Whether the corner of a contact lay at its side when the run began: else it has no place there to count from.
bool lay_there(const BlockSet& blocks, const ContactKey& key) {
  constexpr double kNear = 0.02;  // of the smaller block, as far as contacts are sought
  const int a = key.block_a, b = key.block_b;
  const Vec2 from = blocks.corner({key.block_b, key.edge}),
             side = blocks.corner(blocks.end_of(key.on())) - from;
  const Vec2 at = (blocks.centroid[a] - blocks.centroid[b]) + blocks.corner(key.corner()) - from;
  const double length = norm(side), near = kNear * std::min(blocks.size[a], blocks.size[b]);
  return std::abs(cross(side, at)) <= near * length && dot(side, at) >= -near * length &&
         dot(side, at) <= (length + near) * length;
}

// Slip that is left: how far the corner has gone along the side from where it was at the start, elastic slip apart. By
// the places of the blocks and not by adding up steps, so that what a joint went while it stood open counts too.
// Contacts of blocks that met later have no such place: theirs is added up (theory 4.19).
double residual_slip(const Scene& scene, const Instant& i, size_t k) {
  const State& state = i.state;
  const Contact& c = state.contacts[k];
  const ContactPair& pair = pair_of(state, k);
  if (!pair.from_start || !lay_there(scene.blocks, c.key)) return c.slip_signed;
  const BlockSet& blocks = scene.blocks;
  const int a = c.key.block_a, b = c.key.block_b;
  const Vec2 corner = blocks.corner(c.key.corner()), b0 = blocks.corner({c.key.block_b, c.key.edge}),
             edge = blocks.corner(blocks.end_of(c.key.on())) - b0;
  const CornerEdge over = corner_over_edge(blocks, state, c.key.corner(), c.key.on());
  // as block b sees it: against the place of b where the corner was
  const Vec2 there = (blocks.centroid[a] - blocks.centroid[b]) + corner;
  const Vec2 gone = displacement_at(state, a, corner) - displacement_at(state, b, there);
  double closure = 0;  // elastic slip by the stress of the ground, at the start
  if (scene.model.in_situ.given && c.joint >= 0 && (pair.shares_face || c.length > 0)) {
    const double height = blocks.centroid[b].y + b0.y + std::clamp(over.along, 0.0, 1.0) * edge.y;
    closure = scene.laws[c.joint]
                  .closure(in_situ_stress(scene.model.in_situ, scene.model.gravity, height),
                           turn_right(edge) / norm(edge))
                  .y;
  }
  // what contacts remember is already that of the end of the step
  const PointRows& row = i.work.rows.points[i.work.rows.range(Family::kContact).begin + k];
  const bool at_once = !state.carried_stress.empty();  // conventional DDA remembers the instant itself
  const double to_come = at_once ? 0 : i.work.clock.dt * relative_velocity(row, state.rate)[1];
  return dot(turn_right(over.normal), gone) + to_come + closure - c.stretch;
}

// Whether a place lies on an edge of a block in the reference shape; seen from its centroid.
bool lies_on(const BlockSet& blocks, BlockEdge edge, Vec2 place, double near) {
  if (edge.edge < 0) return false;
  const Vec2 from = blocks.corner({edge.block, edge.edge}), side = blocks.corner(blocks.end_of(edge)) - from,
             at = place - from;
  const double length = norm(side);
  return std::abs(cross(side, at)) <= near * length && dot(side, at) >= -near * length &&
         dot(side, at) <= (length + near) * length;
}

bool is_corner(const BlockSet& blocks, int block, Vec2 arm) {
  const double same = 2e-3 * blocks.size[block];  // chords end a closure off
  for (int v = 0; v < blocks.vertex_count(block); ++v)
    if (norm(blocks.corner({block, v}) - arm) <= same) return true;
  return false;
}

// The same of an end of a patch: of the material point of one of the two that lay on the side of the other when the
// run began.
double residual_slip(const Scene& scene, const Instant& i, const Patch& c, size_t end, size_t row) {
  const State& state = i.state;
  const BlockSet& blocks = scene.blocks;
  const int a = c.block_a, b = c.block_b;
  const double near = 0.02 * std::min(blocks.size[a], blocks.size[b]);
  const Vec2 apart = blocks.centroid[a] - blocks.centroid[b];
  // on the side of b where the end is a corner of a; level ends are corners of both
  const bool of_a = is_corner(blocks, c.block_a, c.arm_a[end]),
             of_b = is_corner(blocks, c.block_b, c.arm_b[end]);
  if (!of_a && !of_b) return c.slip_signed[end];
  const bool on_b = !of_b;
  const Vec2 in_a = on_b ? c.arm_a[end] : c.arm_b[end] - apart, in_b = in_a + apart;
  const bool lay_there = on_b ? lies_on(blocks, {c.block_b, c.side_b}, in_b, near)
                              : lies_on(blocks, {c.block_a, c.side_a}, in_a, near);
  if (!lay_there) return c.slip_signed[end];
  const Vec2 gone = displacement_at(state, a, in_a) - displacement_at(state, b, in_b);
  double closure = 0;  // elastic slip by the stress of the ground, at the start
  if (scene.model.in_situ.given && c.joint >= 0 && c.side_b >= 0 &&
      std::binary_search(scene.outlines.closed.begin(), scene.outlines.closed.end(),
                         std::pair(c.block_a, c.block_b))) {
    const BlockEdge edge{c.block_b, c.side_b};
    const Vec2 side = blocks.corner(blocks.end_of(edge)) - blocks.corner({edge.block, edge.edge});
    const Mat2 stress =
        in_situ_stress(scene.model.in_situ, scene.model.gravity, blocks.centroid[b].y + in_b.y);
    closure = scene.laws[c.joint].closure(stress, turn_right(side) / norm(side)).y;
  }
  // what patches remember is already that of the end of the step
  const double to_come = i.work.clock.dt * relative_velocity(i.work.rows.points[row], state.rate)[1];
  return dot(turn_right(c.normal), gone) + to_come + closure - c.stretch[end];
}

JointPoint patch_point(const Scene& scene, const Instant& i, size_t k) {
  const Patch& c = i.state.patches[k / 2];
  const size_t end = k % 2;
  JointPoint out;
  out.id = fmt::format("{}:{} on {}:{} end {}", c.block_a, c.side_a, c.block_b, c.side_b, end);
  out.joint = c.joint;
  out.set = set_of(scene, c.block_b, c.side_b);
  if (out.set.empty()) out.set = set_of(scene, c.block_a, c.side_a);
  out.length = 0.5 * c.length;
  out.slip = c.slip[end];
  out.slip_signed = residual_slip(scene, i, c, end, i.work.rows.range(Family::kContact).begin + k);
  if (c.joint >= 0) out.rise = scene.laws[c.joint].rise(c.slip[end]);
  out.opening = std::max(0.0, i.work.gaps[k] - out.rise);
  const double noticed = noticeable(scene.blocks, c.block_a, c.block_b);
  out.state = place_of(joint_state(c.touched, c.force[end][0], out.slip, out.opening, noticed));
  return out;
}

JointPoint contact_point(const Scene& scene, const Instant& i, size_t k) {
  if (scene.by_patches()) return patch_point(scene, i, k);
  const Contact& c = i.state.contacts[k];
  JointPoint out;
  out.id = fmt::format("{}:{} on {}:{}", c.key.block_a, c.key.vertex, c.key.block_b, c.key.edge);
  out.joint = c.joint;
  out.set = set_of(scene, c.key.block_b, c.key.edge);
  if (out.set.empty()) out.set = set_of(scene, c.key.block_a, c.key.vertex);
  out.length = c.length;
  out.slip = c.slip, out.slip_signed = residual_slip(scene, i, k);
  if (c.joint >= 0) out.rise = scene.laws[c.joint].rise(c.slip);
  out.opening = std::max(0.0, i.work.gaps[k] - out.rise);
  const double noticed = noticeable(scene.blocks, c.key.block_a, c.key.block_b);
  out.state = place_of(joint_state(c.touched, c.force[0], out.slip, out.opening, noticed));
  return out;
}

}  // namespace

std::pair<int, int> patch_numbers(const Scene& scene, const std::vector<Patch>& patches, size_t k, int end) {
  const Patch& c = patches[k];
  const auto same_parts = [&](const Patch& o) { return o.part_a == c.part_a && o.part_b == c.part_b; };
  int piece = 0;
  for (size_t i = k; i > 0 && same_parts(patches[i - 1]); --i) ++piece;
  const std::vector<int>& first = scene.outlines.part_begin;
  const int part = c.part_a - first[c.block_a];
  return {2 * (part + piece * scene.outlines.parts_of(c.block_a)) + end, -2 - (c.part_b - first[c.block_b])};
}

int law_number(const Patch& patch) {
  constexpr int kTwo = -2;
  return patch.other_share > 0 ? kTwo : patch.joint;
}

double closing_at(const Instant& i, size_t row) {
  const PointRows& p = i.work.rows.points[row];
  const StepClock& clock = i.work.clock;
  const double before = relative_velocity(p, i.work.rate_before)[0],
               after = relative_velocity(p, i.state.rate)[0];
  if (!p.is_soft(0)) {
    const std::vector<Meeting::Blow>& blows = i.work.meeting.blows;
    const auto blow = std::ranges::lower_bound(blows, row, {}, &Meeting::Blow::row);
    const double blown = blow != blows.end() && blow->row == row ? blow->approach : 0;
    return clock.dt * std::max({0.0, -before, -after, blown});
  }
  const RowOwner owner = i.work.rows.owner[row];
  double closing = -clock.way_until(before, after);
  if (owner.family == Family::kContact && i.scene.by_patches())
    closing -= clock.dashpot_time(
                   mixed_damping_time(i.scene.blocks, i.scene.laws, i.state.patches[owner.at() / 2], 0)) *
               clock.rate_then(before, after);
  return closing;
}

Vec2 point_now(const Scene& scene, const State& state, const PointRows& p) {
  const int a = p.block_a;
  // the acting arm of a deformable block is the reference one
  const bool deforms = scene.blocks.kind[a] == BlockKind::kDeformable;
  const Vec2 from_centroid = deforms ? p.arm_a + state.strain_part[a] * p.arm_a : p.arm_a;
  return scene.blocks.centroid[a] + state.displacement[a] + from_centroid;
}

namespace {

// Number of a family in kPointKinds: ties are counted with the boundaries.
int kind_of(Family family) {
  constexpr int kKind[] = {1, 0, 2, 3, 3, 4};
  static_assert(std::size(kKind) == kFamilies.size());
  return kKind[place_of(family)];
}

// What any row tells of its point.
void take_row(const Scene& scene, const Instant& i, size_t r, FramePoint& out) {
  const RowSet& rows = i.work.rows;
  const PointRows& p = rows.points[r];
  out.point = point_now(scene, i.state, p);
  out.force = impulse_on(p, rows.impulse[r], 1).f / i.work.clock.dt_kick;
  out.normal_force = rows.impulse[r][0] / i.work.clock.dt_kick;
  out.shear_force = rows.impulse[r][1] / i.work.clock.dt_kick;
  out.block_a = p.block_a, out.block_b = p.block_b;
  const RowOwner owner = rows.owner[r];
  out.kind = kind_of(owner.family);
  if (owner.family == Family::kFace) {
    out.corner = owner.index;
    out.law = scene.bonds.faces[owner.at() / 2].joint;
  } else if (owner.family == Family::kContact) {
    if (scene.by_patches()) {
      const Patch& c = i.state.patches[owner.at() / 2];
      std::tie(out.corner, out.edge) =
          patch_numbers(scene, i.state.patches, owner.at() / 2, static_cast<int>(owner.at() % 2));
      out.law = law_number(c), out.closure = c.closure[owner.at() % 2], out.closing = closing_at(i, r);
    } else {
      const ContactKey& key = i.state.contacts[owner.at()].key;
      out.corner = key.vertex, out.edge = key.edge;
      out.law = i.state.contacts[owner.at()].joint;
    }
    out.gap = i.work.gaps[owner.at()];
  } else {  // number among those of its kind that act
    const Family first = owner.family == Family::kTie ? Family::kBoundary : owner.family;
    out.corner = static_cast<int>(r - rows.range(first).begin);
  }
}

}  // namespace

std::optional<JointPoint> joint_point(const Scene& scene, const Instant& i, size_t row) {
  const RowOwner owner = i.work.rows.owner[row];
  if (!is_joint(owner.family)) return std::nullopt;
  std::optional<JointPoint> out =
      owner.family == Family::kFace ? face_point(scene, i, owner.at()) : contact_point(scene, i, owner.at());
  if (out) take_row(scene, i, row, *out);
  return out;
}

std::vector<FramePoint> frame_points(const Scene& scene, const Instant& i) {
  std::vector<FramePoint> out;
  const RowSet& rows = i.work.rows;
  out.reserve(rows.points.size());
  for (size_t r = 0; r < rows.points.size(); ++r) {
    if (const auto joint = joint_point(scene, i, r)) {
      out.push_back(*joint);
      continue;
    }
    out.emplace_back();
    take_row(scene, i, r, out.back());
  }
  for (const auto& [row, other] : joint_ends(i)) {
    if (std::max(row, other) >= out.size()) continue;
    out[row].partner = static_cast<int>(other), out[other].partner = static_cast<int>(row);
  }
  return out;
}

std::vector<std::pair<size_t, size_t>> joint_ends(const Instant& i) {
  std::vector<std::pair<size_t, size_t>> out;
  const RowRange bonds = i.work.rows.range(Family::kFace);
  const size_t first = i.work.rows.range(Family::kContact).begin;
  for (size_t r = bonds.begin; r < bonds.end; r += 2) out.emplace_back(r, r + 1);  // the two ends of a face
  for (size_t k = 0; k < i.state.patches.size(); ++k) out.emplace_back(first + 2 * k, first + 2 * k + 1);
  if (!i.state.patches.empty()) return out;
  for (const ContactPair& pair : i.state.pairs) {
    for (int k = 0; k < pair.count && !i.state.contacts.empty(); ++k) {
      const int partner = i.state.contacts[pair.begin + k].partner;
      if (partner > k) out.emplace_back(first + pair.begin + k, first + pair.begin + partner);
    }
  }
  return out;
}

void JointSummary::look(const Scene& scene, const State& state) {
  std::map<std::string, double> by_set;
  for (size_t f = 0; f < state.face.size(); ++f) {
    if (!state.face[f].broken) continue;
    const BondFace& face = scene.bonds.faces[f];
    broken += face.length;
    by_set[set_of(scene, face.block_b, face.edge_b)] += face.length;
  }
  broken_by_set.assign(by_set.begin(), by_set.end());
  for (int b = 0; b < scene.blocks.count; ++b) {
    if (scene.blocks.removed(b)) continue;
    const double share = norm(state.displacement[b]) / scene.blocks.size[b];
    if (share > moved_share) moved_share = share, moved_most = b;
    if (const double way = norm(state.displacement[b]); way > moved_way) moved_way = way, moved_far = b;
    if (share < kMoved) continue;
    moved_area += scene.blocks.size[b] * scene.blocks.size[b];
    ++moved_blocks;
  }
}

void JointSummary::add(const JointPoint& p) {
  ++points;
  slip_area += p.slip * p.length;
  const auto take = [&p](auto& by_set, double slip) {
    const auto at =
        std::find_if(by_set.begin(), by_set.end(), [&p](const auto& one) { return one.first == p.set; });
    if (at == by_set.end())
      by_set.emplace_back(p.set, slip);
    else
      at->second = std::max(at->second, slip);
  };
  if (!p.face && p.slip > 0) take(slip_by_set, p.slip), take(residual_by_set, p.residual_slip());
  intact += p.is(JointState::kIntact);
  slipped += p.is(JointState::kSlipped);
  open += p.is(JointState::kOpen);
  if (!p.face && p.slip > largest.slip) largest = p;  // faces have not slipped before they break
  if (p.is(JointState::kOpen)) widest = std::max(widest, p.opening);
}

namespace {

void exchange_point(auto& x, auto& p, const std::string& name) {
  x(name + ".face", p.face), x(name + ".id", p.id);
  x(name + ".block_a", p.block_a), x(name + ".block_b", p.block_b);
  x(name + ".joint", p.joint), x(name + ".set", p.set), x(name + ".point", p.point);
  x(name + ".length", p.length), x(name + ".state", p.state);
  x(name + ".normal_force", p.normal_force);
  x(name + ".shear_force", p.shear_force);
  x(name + ".slip", p.slip), x(name + ".slip_signed", p.slip_signed);
  x(name + ".opening", p.opening), x(name + ".rise", p.rise);
}

// More sets than this no model has: a count of a damaged state.
constexpr size_t kMostSets = 100000;

void resize_for_loading(const Loader&, auto& list, size_t count) {
  if (count > kMostSets) throw FileError("the saved state has more joint sets than there can be");
  list.resize(count);
}
void resize_for_loading(const Saver&, const auto&, size_t) {}

void exchange_sets(auto& x, auto& list, const std::string& name) {
  size_t sets = list.size();
  x(name + "s", sets);
  resize_for_loading(x, list, sets);
  for (size_t i = 0; i < sets; ++i) {
    x(fmt::format("{}.{}", name, i), list[i].first);
    x(fmt::format("{}.{}.value", name, i), list[i].second);
  }
}

void exchange_summary(auto& x, auto& s, const std::string& name) {
  x(name + ".time", s.time), x(name + ".points", s.points), x(name + ".intact", s.intact);
  x(name + ".slipped", s.slipped), x(name + ".open", s.open), x(name + ".widest", s.widest);
  x(name + ".slipped_joints", s.slipped_joints);
  x(name + ".slip_area", s.slip_area), x(name + ".broken", s.broken);
  x(name + ".moved_area", s.moved_area), x(name + ".moved_blocks", s.moved_blocks);
  x(name + ".moved_most", s.moved_most), x(name + ".moved_share", s.moved_share);
  x(name + ".moved_far", s.moved_far), x(name + ".moved_way", s.moved_way);
  exchange_sets(x, s.broken_by_set, name + ".broken_set"),
      exchange_sets(x, s.slip_by_set, name + ".slip_set"),
      exchange_sets(x, s.residual_by_set, name + ".residual_set");
  exchange_point(x, s.largest, name + ".largest");
  exchange_point(x, s.most_residual, name + ".most_residual");
}

}  // namespace

void JointSummary::save(Saver& to, const std::string& name) const { exchange_summary(to, *this, name); }

void JointSummary::load(Loader& from, const std::string& name, const Scene& scene) {
  exchange_summary(from, *this, name);
  const auto known = [&scene](const JointPoint& p) {
    return p.block_a >= 0 && p.block_a < scene.blocks.count && p.block_b >= 0 &&
           p.block_b < scene.blocks.count && p.joint >= -1 && p.joint < count_of(scene.model.joints);
  };
  // the others have no place
  if ((!(largest.slip <= 0) && !known(largest)) || (slipped_joints != 0 && !known(most_residual)) ||
      moved_most < -1 || moved_most >= scene.blocks.count || moved_far < -1 ||
      moved_far >= scene.blocks.count)
    throw FileError(
        fmt::format("\"{}\" of the saved state speaks of blocks or joints that there are not", name));
}

const Columns<JointRow, Cell>& joint_columns() {
  static const Columns<JointRow, Cell> columns = [] {
    const auto block = [](const JointRow& r, int b) { return r.scene.blocks.name[b]; };
    Columns<JointRow, Cell> out{
        {"stage", "", [](const JointRow& r) { return r.stage; }},
        {"time", "s", [](const JointRow& r) { return r.time; }},
        {"id", "", [](const JointRow& r) { return r.point.id; }},
        {"block_a", "", [block](const JointRow& r) { return block(r, r.point.block_a); }},
        {"block_b", "", [block](const JointRow& r) { return block(r, r.point.block_b); }},
        {"joint", "",
         [](const JointRow& r) { return r.point.joint < 0 ? "" : r.scene.model.joints[r.point.joint].name; }},
        {"x", "m", [](const JointRow& r) { return r.point.point.x; }},
        {"y", "m", [](const JointRow& r) { return r.point.point.y; }}};
    for (const ContactColumn& c : contact_columns())
      if (c.in_joints_csv)
        out.push_back({c.name, c.unit, [&c](const JointRow& r) { return c.of(r.point); }, c.over, c.digits});
    out.push_back({"state", "", [](const JointRow& r) { return kJointStates.at(r.point.state); }});
    return out;
  }();
  return columns;
}

std::string jolt_text(const Scene& scene, const RunResult& result) {
  // what stands amplifies its ground by less; a blow at 0.1 m/s on stiff rock has hundreds of m/s2
  constexpr double kTooMuch = 10;
  if (!(result.jolt > 0)) return "";
  // weight that is taken on at once is no blow
  const double given = std::max(largest_input(scene.model), norm(scene.model.gravity));
  if (!(result.jolt > kTooMuch * given)) return "";
  return fmt::format(
      "accelerations: {} with {:.3g} m/s2 at t = {:.4g} s, {:.2g} times the largest that is given, gravity included ({:.3g} m/s2): blows on "
      "joints with stiffness. Their damping_time rules them; half the step tells whether they do what is looked for",
      result.jolt_row, result.jolt, result.jolt_time, result.jolt / given, given);
}

std::string free_field_side(const Scene& scene, const JointSummary& joints) {
  if (joints.slipped_joints == 0) return "";
  const JointPoint& p = joints.most_residual;
  for (const BoundaryPoint& side : scene.boundaries.points) {
    const BoundaryInput& input = scene.model.boundaries[side.boundary];
    if (input.kind == BoundaryKind::kFreeField && (side.block == p.block_a || side.block == p.block_b))
      return input.name;
  }
  return "";
}

}  // namespace talus
