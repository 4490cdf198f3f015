#include "talus/contact/bonds.h"

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/blocks/in_situ.h"
#include "talus/contact/joint_state.h"

namespace talus {

namespace {

// A face breaks when the running mean of its forces reaches this share of the limit: the mean of forces that
// are cut off at the limit comes to the limit only in infinite time.
constexpr double kAtLimit = 0.99999;

// Faces to a chunk.
constexpr size_t kFaceGrain = 256;

bool holds(const std::vector<JointLaw>& laws, int joint) { return joint >= 0 && laws[joint].holds(); }

// Overlaps of antiparallel edges of two blocks in contact, as faces (theory 3.4).
void add_faces(const BlockSet& blocks, int a, int b, double touching, std::vector<BondFace>& faces) {
  const double near = std::max(touching, kTouching * std::min(blocks.size[a], blocks.size[b]));
  const Vec2 shift = blocks.centroid[a] - blocks.centroid[b];
  for (int eb = 0; eb < blocks.vertex_count(b); ++eb) {
    const Vec2 b0 = blocks.corner({b, eb}), b1 = blocks.corner({b, (eb + 1) % blocks.vertex_count(b)});
    const double length_b = norm(b1 - b0);
    const Vec2 along = (b1 - b0) / length_b, n = turn_right(along);
    for (int ea = 0; ea < blocks.vertex_count(a); ++ea) {
      // ends of a's edge seen from b; antiparallel: a's second corner comes first along b
      const Vec2 a0 = blocks.corner({a, ea}), a1 = blocks.corner({a, (ea + 1) % blocks.vertex_count(a)});
      const Vec2 r0 = a0 + shift - b0, r1 = a1 + shift - b0;
      // ends of the shorter from the line of the longer: that of the shorter, drawn out, is off by as much more
      const double length_a = norm(a1 - a0);
      const Vec2 na = turn_right(a1 - a0) / length_a;
      const double off = length_a <= length_b
                             ? std::max(std::abs(dot(n, r0)), std::abs(dot(n, r1)))
                             : std::max(std::abs(dot(na, r0)), std::abs(dot(na, b1 - b0 - r0)));
      if (off > near || dot(along, a1 - a0) >= 0) continue;
      const double from = std::max(dot(along, r1), 0.0), to = std::min(dot(along, r0), length_b);
      if (to - from <= near) continue;
      BondFace face;
      face.block_a = a, face.block_b = b, face.edge_a = ea, face.edge_b = eb;
      face.length = to - from;
      for (int end = 0; end < 2; ++end) {
        const double s = end == 0 ? from : to;
        face.arm_b[end] = b0 + s * along;
        face.arm_a[end] = face.arm_b[end] - shift;
      }
      faces.push_back(face);
    }
  }
}

// Blocks of a bonded body that meet at a corner only are tied when a fan of bonded faces around that corner
// joins them: their neighbours hold them, and a contact would only say the same again (theory 3.4).
void tie_around_corners(const Layout& layout, const BlockSet& blocks,
                        const std::vector<std::pair<int, int>>& pairs, BondSet& bonds) {
  std::vector<std::vector<int>> neighbours(blocks.count);
  for (const auto& [a, b] : bonds.tied) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  const auto touches = [&](int block, Vec2 point) {
    return contains(layout.blocks[block].polygon, point,
                    std::max(layout.touching, kTouching * blocks.size[block]));
  };
  std::vector<std::pair<int, int>> joined;
  for (const auto& [a, b] : pairs) {
    bool found = false;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      for (const Vec2 corner : layout.blocks[from].polygon) {
        if (found || !touches(to, corner)) continue;
        // walk from face to face through the blocks around this corner
        std::vector<int> reached{from};
        for (size_t i = 0; i < reached.size(); ++i)
          for (const int next : neighbours[reached[i]])
            if (touches(next, corner) && std::find(reached.begin(), reached.end(), next) == reached.end())
              reached.push_back(next);
        found = std::find(reached.begin(), reached.end(), to) != reached.end();
      }
    }
    if (found) joined.emplace_back(a, b);
  }
  bonds.tied.insert(bonds.tied.end(), joined.begin(), joined.end());
  std::sort(bonds.tied.begin(), bonds.tied.end());
}

bool has_edge_joints(const Layout& layout, int block) { return !layout.blocks[block].edge_joint.empty(); }

bool has_bonded_edge(const std::vector<JointLaw>& laws, const Layout& layout, int block) {
  for (const int j : layout.blocks[block].edge_joint)
    if (j >= 0 && laws[j].bonded()) return true;
  return false;
}

double transit_time(const Model& model, const BlockSet& blocks, int i) {
  if (blocks.kind[i] != BlockKind::kDeformable) return 0;
  const double density = model.materials[blocks.material[i]].density;
  return blocks.size[i] / std::sqrt(blocks.moduli[i].c11 / density);
}

// Theory 1.7.
void close_face(const Model& model, const BlockSet& blocks, const JointLaw& law, BondFace& face) {
  const Vec2 along = face.arm_b[1] - face.arm_b[0];
  for (int end = 0; end < 2; ++end) {
    const double height = blocks.centroid[face.block_b].y + face.arm_b[end].y;
    face.closure[end] =
        law.closure(in_situ_stress(model.in_situ, model.gravity, height), turn_right(along) / norm(along));
  }
}

// What two ends without tensile strength show when they part, and a face without cohesion when it slips
// (theory 3.5).
bool stands_open(const JointLaw& law, double opening, double noticed) {
  return law.peak().tension == 0 && opening > noticed;
}

// Whether a face has come to its limit at both ends: pulled or open, or at the limit of its shear
// (theory 3.5).
bool is_at_limit(const BlockSet& blocks, const BondFace& face, const JointLaw& law, const FaceState& now,
                 const FaceOffset& offset) {
  const double half_area = 0.5 * face.length * blocks.thickness;
  const double noticed = noticeable(blocks, face.block_a, face.block_b);
  const JointStrength peak = law.between(face.block_a, face.block_b, law.peak());
  const JointStrength bears = peak.over(half_area);
  const double most_pull = peak.over(kAtLimit).over(half_area).tension;
  int pulled = 0;                               // ends at their tensile strength, or open
  double shear = 0, shear_limit = 0, slip = 0;  // of the other ends
  for (size_t end = 0; end < 2; ++end) {
    const double normal = now.mean_force[2 * end], along = now.mean_force[2 * end + 1];
    if (stands_open(law, offset.opening[end], noticed) || (normal < 0 && normal <= -most_pull)) {
      ++pulled;
      continue;
    }
    shear += along;
    shear_limit += bears.limit(normal);
    slip = std::max(slip, std::abs(offset.tangential[end] - law.give(1, -along, half_area)));
  }
  // shear as a resultant: how two rigid blocks share it between the ends of a face is not determined
  const bool sheared = shear != 0 && std::abs(shear) >= kAtLimit * shear_limit;
  // without cohesion the limit falls to nothing wherever nothing presses, which breaks nothing
  return pulled == 2 || (sheared && (bears.cohesion > 0 || slip > noticed));
}

}  // namespace

// Theory 3.4.
BondSet find_bonds(const Model& model, const Layout& layout, const BlockSet& blocks) {
  TALUS_ASSERT(count_of(layout.blocks) == blocks.count);
  BondSet bonds;
  const std::vector<JointLaw> laws = joint_laws(model.joints);
  std::vector<Box> boxes;
  for (const BlockShape& b : layout.blocks) boxes.push_back(bounding_box(b.polygon));
  // near enough for the largest pair; each pair is then judged by its own size
  const double largest = *std::max_element(blocks.size.begin(), blocks.size.end());
  std::vector<std::pair<int, int>> without_face;
  for (const auto& [a, b] : close_pairs(boxes, std::max(layout.touching, kTouching * largest))) {
    if (!blocks.moves_freely(a) && !blocks.moves_freely(b)) continue;
    const int pair = layout.joint_of_pair(blocks.group[a], blocks.group[b]);
    const bool by_edges = pair == Layout::kNoPair && has_edge_joints(layout, a) && has_edge_joints(layout, b);
    const int whole = pair == Layout::kNoPair ? layout.default_joint : pair;
    if (!by_edges && !holds(laws, whole)) continue;
    const bool may_be_tied = by_edges ? has_bonded_edge(laws, layout, a) && has_bonded_edge(laws, layout, b)
                                      : laws[whole].bonded();
    std::vector<BondFace> faces;
    add_faces(blocks, a, b, layout.touching, faces);
    bool all_bonded = !faces.empty();
    for (BondFace& face : faces) {
      face.joint = layout.joint_at({a, face.edge_a}, {b, face.edge_b});
      const JointLaw law = face.joint < 0 ? JointLaw() : laws[face.joint];
      face.unbreakable = law.bonded();
      if (model.in_situ.given && face.joint >= 0 && !face.unbreakable) close_face(model, blocks, law, face);
      face.elastic_shear = law.is_soft(1);
      face.memory = std::max(transit_time(model, blocks, a), transit_time(model, blocks, b));
      all_bonded = all_bonded && face.unbreakable;
      if (holds(laws, face.joint)) bonds.faces.push_back(face);
    }
    if (all_bonded) bonds.tied.emplace_back(a, b);
    if (faces.empty() && may_be_tied) without_face.emplace_back(a, b);
  }
  tie_around_corners(layout, blocks, without_face, bonds);
  return bonds;
}

std::vector<BondFace> shared_faces(const Layout& layout, const BlockSet& blocks) {
  std::vector<BondFace> faces;
  if (blocks.count == 0) return faces;
  std::vector<Box> boxes;
  for (const BlockShape& b : layout.blocks) boxes.push_back(bounding_box(b.polygon));
  const double largest = *std::max_element(blocks.size.begin(), blocks.size.end());
  for (const auto& [a, b] : close_pairs(boxes, std::max(layout.touching, kTouching * largest)))
    if (blocks.moves_freely(a) || blocks.moves_freely(b)) add_faces(blocks, a, b, layout.touching, faces);
  for (BondFace& face : faces)
    face.joint = layout.joint_at({face.block_a, face.edge_a}, {face.block_b, face.edge_b});
  return faces;
}

FaceOffset face_offset(const BlockSet& blocks, const State& state, const BondFace& face) {
  const int a = face.block_a, b = face.block_b;
  const Vec2 edge =
      blocks.corner(blocks.end_of({face.block_b, face.edge_b})) - blocks.corner({face.block_b, face.edge_b});
  const Vec2 now = edge + state.strain_part[b] * edge;
  FaceOffset out;
  out.normal = turn_right(now) / norm(now);
  for (int end = 0; end < 2; ++end) {
    const Vec2 apart =
        displacement_at(state, a, face.arm_a[end]) - displacement_at(state, b, face.arm_b[end]);
    out.opening[end] = dot(out.normal, apart) + face.closure[end].x;
    out.tangential[end] = dot(turn_right(out.normal), apart) + face.closure[end].y;
  }
  return out;
}

bool is_tied(const BondSet& bonds, const State& state, int a, int b) {
  if (std::binary_search(bonds.tied.begin(), bonds.tied.end(), std::pair(a, b))) return true;
  const auto before = [](const BondFace& f, const std::pair<int, int>& p) {
    return std::pair(f.block_a, f.block_b) < p;
  };
  auto it = std::lower_bound(bonds.faces.begin(), bonds.faces.end(), std::pair(a, b), before);
  for (; it != bonds.faces.end() && it->block_a == a && it->block_b == b; ++it)
    if (!state.face[it - bonds.faces.begin()].broken) return true;
  return false;
}

// Theory 3.5, 4.6.
void add_bond_rows(const BlockSet& blocks, const BondSet& bonds, const std::vector<JointLaw>& laws,
                   const ContactGive& give, const State& state, const std::vector<BlockRate>& before,
                   const StepClock& clock, const Workers& workers, RowSet& rows) {
  TALUS_ASSERT(state.face.size() == bonds.faces.size() && state.bond_force.size() == 2 * bonds.faces.size());
  TALUS_ASSERT(rows.size() == 0 && count_of(before) == blocks.count);
  const auto holds = [&](size_t f) {
    const BondFace& face = bonds.faces[f];
    return !state.face[f].broken && blocks.interact(face.block_a, face.block_b);
  };
  size_t count = 0;
  for (size_t f = 0; f < bonds.faces.size(); ++f) count += holds(f);
  size_t next = rows.add_more(Family::kFace, 2 * count);
  for (size_t f = 0; f < bonds.faces.size(); ++f) {
    if (!holds(f)) continue;
    for (const size_t end : {0U, 1U}) rows.owner[next++] = {Family::kFace, static_cast<int>(2 * f + end)};
  }

  const RowGive row_give(give, blocks, clock);
  const auto add = [&](size_t f, size_t at) {
    const BondFace& face = bonds.faces[f];
    const int a = face.block_a, b = face.block_b;
    const FaceOffset apart = face_offset(blocks, state, face);
    std::array<std::array<double, 2>, 2> u{};
    for (size_t end = 0; end < 2; ++end) {
      PointRows& p = rows.points[at + end];
      p = kFreshRows;
      p.block_a = face.block_a, p.block_b = face.block_b;
      p.arm_a = acting_arm(blocks, state, a, face.arm_a[end]);
      p.arm_b = acting_arm(blocks, state, b, face.arm_b[end]);
      p.normal = apart.normal;
      p.row[0].bias = apart.opening[end] / clock.dt;
      p.row[1].bias = (apart.tangential[end] - state.face[f].slip[end]) / clock.dt;
      if (!face.unbreakable) {
        const JointLaw& law = laws[face.joint];
        const double half_area = 0.5 * face.length * blocks.thickness;
        bound(law.between(face.block_a, face.block_b, law.peak()).over(half_area).over(clock.dt_kick), p);
        if (stands_open(law, apart.opening[end], noticeable(blocks, a, b))) p.cohesion = 0;
        if (law.is_soft()) {
          u[end] = relative_velocity(p, before);
          add_compliance(law, half_area, true, clock, u[end], p);
          p.partner = static_cast<int>(end == 0 ? at + 1 : at);
        }
        const double most = row_give.between(face.block_a, face.block_b);
        p.gives = {most > 0 && !law.is_soft(0), most > 0 && !law.is_soft(1)};
        for (size_t row = 0; row < 2; ++row)
          if (p.gives[row]) p.row[row].compliance = most;
      }
      // the two tangential rows of a face between rigid blocks say the same: from equal guesses they stay
      // equal. Where a block deforms, unequal ones belong to a balance that must not be disturbed
      const auto& force = state.bond_force[2 * f + end];
      const bool rigid = blocks.kind[a] != BlockKind::kDeformable && blocks.kind[b] != BlockKind::kDeformable;
      const double shear =
          rigid ? 0.5 * (state.bond_force[2 * f][1] + state.bond_force[2 * f + 1][1]) : force[1];
      rows.impulse[at + end] = {force[0] * clock.dt_kick, shear * clock.dt_kick};
    }
    guess_compliant({&rows.points[at], &rows.points[at + 1]}, u, {&rows.impulse[at], &rows.impulse[at + 1]});
  };
  workers.for_chunks(rows.size() / 2, kFaceGrain, [&](size_t begin, size_t end) {
    for (size_t at = 2 * begin; at < 2 * end; at += 2) add(rows.owner[at].at() / 2, at);
  });
}

// Theory 3.5.
void remember_bonds(const BlockSet& blocks, const BondSet& bonds, const RowSet& rows, const StepClock& clock,
                    const Workers& workers, State& state) {
  const RowRange range = rows.range(Family::kFace);
  const auto remember = [&](size_t r) {
    const PointRows& p = rows.points[r];
    const Impulse& impulse = rows.impulse[r];
    const size_t point = rows.owner[r].at();
    state.bond_force[point] = {impulse[0] / clock.dt_kick, impulse[1] / clock.dt_kick};
    if (p.row[1].compliance == 0 || !slides(p, impulse)) return;
    // what is off after the step, but for the elastic slip under its force
    state.face[point / 2].slip[point % 2] =
        face_offset(blocks, state, bonds.faces[point / 2]).tangential[point % 2] +
        clock.dt * relative_velocity(p, state.rate)[1] - elastic_slip(rows, r, clock);
  };
  workers.for_chunks(range.size(), 2 * kFaceGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) remember(range.begin + i);
  });
}

namespace {

// Follows the mean forces of a face over a step of length dt; whether it has come to its limit (theory 3.5).
bool follow_face(const BlockSet& blocks, const BondSet& bonds, const JointLaw& law, double dt, size_t f,
                 State& state) {
  const BondFace& face = bonds.faces[f];
  FaceState& now = state.face[f];
  const double share = dt / (face.memory + dt);
  for (size_t end = 0; end < 2; ++end)
    for (size_t k = 0; k < 2; ++k) {
      double& mean = now.mean_force[2 * end + k];
      mean += share * (state.bond_force[2 * f + end][k] - mean);
    }
  const FaceOffset offset = face_offset(blocks, state, face);
  if (!is_at_limit(blocks, face, law, now, offset)) return false;
  now.broken = true;
  now.broken_step = state.step;
  now.offset = {offset.tangential[0] - now.slip[0], offset.tangential[1] - now.slip[1]};
  state.bond_force[2 * f] = state.bond_force[2 * f + 1] = {};
  return true;
}

}  // namespace

int update_bonds(const BlockSet& blocks, const BondSet& bonds, const std::vector<JointLaw>& laws, double dt,
                 const Workers& workers, State& state) {
  TALUS_ASSERT(state.face.size() == bonds.faces.size());
  return workers.sum_chunks<int>(bonds.faces.size(), kFaceGrain, [&](size_t begin, size_t end, int& broken) {
    for (size_t f = begin; f < end; ++f) {
      if (bonds.faces[f].unbreakable || state.face[f].broken) continue;
      const int j = bonds.faces[f].joint;
      broken += follow_face(blocks, bonds, laws[j], dt, f, state);
    }
  });
}

}  // namespace talus
