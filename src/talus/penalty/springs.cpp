#include "talus/penalty/springs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/index.h"
#include "talus/blocks/in_situ.h"
#include "talus/corners/find.h"

namespace talus {

namespace {

// Gaps and slips that are none: this share of the smaller block (rounding), and of what the springs give under the force
// that its blocks are measured by. What hardly touches would open and close without end.
constexpr double kSamePlace = 1e-13, kSameForce = 1e-4;

Vec2 arm_now(const State& state, int block, Vec2 X) { return X + state.strain_part[block] * X; }

// Whether nothing holds it, whatever presses.
bool is_smooth(const Spring& s) { return s.bears.limit(1) == 0; }

// A joint's own stiffness where it has one over an area, else the penalty.
double stiffness_of(const JointLaw& law, int k, double area, double penalty) {
  return law.is_soft(k) && area > 0 ? law.stiffness(k, area) : penalty;
}

void gather_face(const Scene& scene, const State& state, size_t f, const std::array<double, 2>& stiffness,
                 std::vector<Spring>& springs) {
  const BondFace& face = scene.bonds.faces[f];
  const FaceOffset apart = face_offset(scene.blocks, state, face);
  const double area = 0.5 * face.length * scene.blocks.thickness;
  for (size_t end = 0; end < 2; ++end) {
    Spring s;
    s.block_a = face.block_a, s.block_b = face.block_b;
    s.index = static_cast<int>(2 * f + end);
    s.glued = true, s.state = SpringState::kStuck;
    s.normal = apart.normal;
    s.arm_a = arm_now(state, face.block_a, face.arm_a[end]);
    s.arm_b = arm_now(state, face.block_b, face.arm_b[end]);
    s.gap = apart.opening[end], s.slip = apart.tangential[end];
    s.stiffness = stiffness;
    if (!face.unbreakable) {
      const JointLaw& law = scene.laws[face.joint];
      for (int k = 0; k < 2; ++k) s.stiffness[k] = stiffness_of(law, k, area, s.stiffness[k]);
    }
    springs.push_back(s);
  }
}

// Closure and elastic slip by which springs begin with the stress of the ground (theory 1.7) [m].
Vec2 closure_of(const Scene& scene, const ContactPair& pair, const Contact& c, const Spring& s, Vec2 edge,
                Vec2 at) {
  const Model& model = scene.model;
  const bool carries = pair.shares_face || (pair.from_start && c.length > 0);
  const double area = c.length * scene.blocks.thickness;
  if (!carries || !model.in_situ.given || area <= 0) return {};
  const double height = scene.blocks.centroid[c.key.block_b].y + at.y;
  const Vec2 normal = turn_right(edge) / norm(edge),
             traction = in_situ_stress(model.in_situ, model.gravity, height) * normal;
  return {dot(normal, traction) * area / s.stiffness[0],
          dot(turn_right(normal), traction) * area / s.stiffness[1]};
}

// What the forces on each block are measured by: the largest pressure of its contacts, or its weight [N].
std::vector<double> force_of(const Scene& scene, const State& state) {
  const double g = norm(scene.model.gravity);
  std::vector<double> force(scene.blocks.mass.size());
  for (size_t i = 0; i < force.size(); ++i) force[i] = scene.blocks.mass[i] * g;
  for (const Contact& c : state.contacts)
    for (const int block : {c.key.block_a, c.key.block_b}) force[block] = std::max(force[block], c.force[0]);
  for (int i = 0; i < count_of(force); ++i)  // what does not move says nothing
    if (!scene.blocks.moves_freely(i)) force[i] = std::numeric_limits<double>::infinity();
  return force;
}

void gather_contact(const Scene& scene, const State& state, const ContactPair& pair, size_t i,
                    const std::array<double, 2>& stiffness, const std::vector<double>& force,
                    std::vector<Spring>& springs) {
  static const JointLaw kNone;
  const BlockSet& blocks = scene.blocks;
  const Contact& c = state.contacts[i];
  const JointLaw& law = c.joint < 0 ? kNone : scene.laws[c.joint];
  const CornerEdge over = corner_over_edge(blocks, state, c.key.corner(), c.key.on());
  const Vec2 b0 = blocks.corner({c.key.block_b, c.key.edge}),
             edge = blocks.corner(blocks.end_of(c.key.on())) - b0,
             foot = b0 + std::clamp(over.along, 0.0, 1.0) * edge;
  const double area = c.length * blocks.thickness;
  Spring s;
  s.block_a = c.key.block_a, s.block_b = c.key.block_b;
  s.index = static_cast<int>(i);
  s.normal = over.normal;
  s.arm_a = arm_now(state, c.key.block_a, blocks.corner(c.key.corner()));
  s.arm_b = arm_now(state, c.key.block_b, foot);
  const int a = s.block_a, b = s.block_b;
  for (int k = 0; k < 2; ++k) {
    s.stiffness[k] = stiffness_of(law, k, area, stiffness[k]);
    s.same[k] = kSamePlace * std::min(blocks.size[a], blocks.size[b]) +
                kSameForce * std::min(force[a], force[b]) / s.stiffness[k];
  }
  const Vec2 closure = closure_of(scene, pair, c, s, edge, foot);
  s.gap = over.gap + closure.x;
  const double place = -over.along * norm(edge);
  s.bears = law.between(c.key.block_a, c.key.block_b, law.worn(c.slip)).over(area);
  s.pressing = std::max(0.0, c.force[0]);
  if (c.memory == Contact::kNone) {
    // what touches from the start sticks with the stress of the ground
    s.slip = state.dt_before == 0 ? closure.y : 0;
    s.state = state.dt_before == 0 && s.gap < 0 ? SpringState::kStuck : SpringState::kOpen;
    s.pressing = state.dt_before == 0 ? std::max(0.0, -s.stiffness[0] * s.gap) : 0;
  } else if (c.force[0] > 0 || s.gap < 0) {
    const bool slid = std::isnan(c.anchor) || c.memory == Contact::kPassed;
    s.state = is_smooth(s) || (slid && c.force[1] != 0) ? SpringState::kSliding : SpringState::kStuck;
    if (slid) s.side = c.force[1] > 0 ? -1 : 1;  // friction opposes it
    s.slip = slid ? -c.force[1] / s.stiffness[1] : place - c.anchor;
  }
  springs.push_back(s);
}

double gap_after(const Six& a, const Six& b, const SpringRows& rows, const Spring& s) {
  return s.gap + dot(rows.a[0], a) + dot(rows.b[0], b);
}

}  // namespace

void gather_springs(const Scene& scene, const State& state, const std::array<double, 2>& stiffness,
                    std::vector<Spring>& springs) {
  springs.clear();
  for (size_t f = 0; f < scene.bonds.faces.size(); ++f) {
    const BondFace& face = scene.bonds.faces[f];
    if (!state.face[f].broken && scene.blocks.interact(face.block_a, face.block_b))
      gather_face(scene, state, f, stiffness, springs);
  }
  const std::vector<double> force = force_of(scene, state);
  for (const ContactPair& pair : state.pairs)
    for (int k = 0; k < pair.count; ++k)
      gather_contact(scene, state, pair, pair.begin + k, stiffness, force, springs);
}

SpringRows rows_of(const Spring& spring, const BlockSet& blocks) {
  SpringRows rows{};
  const std::array<Vec2, 2> direction{spring.normal, turn_right(spring.normal)};
  const auto row = [&blocks](int block, Vec2 n, Vec2 arm) {
    Six r{};
    if (!blocks.moves_freely(block)) return r;
    r = along(n, arm);
    if (blocks.kind[block] == BlockKind::kRigid) r[3] = r[4] = r[5] = 0;
    return r;
  };
  for (size_t k = 0; k < 2; ++k) {
    rows.a[k] = row(spring.block_a, direction[k], spring.arm_a);
    rows.b[k] = -1.0 * row(spring.block_b, direction[k], spring.arm_b);
  }
  return rows;
}

double pressure_after(const Six& a, const Six& b, const SpringRows& rows, const Spring& s) {
  return std::max(0.0, -s.stiffness[0] * gap_after(a, b, rows, s));
}

// Theory 13.4.
bool follow(const Six& a, const Six& b, const SpringRows& rows, Spring& s) {
  s.gap_after = gap_after(a, b, rows, s);
  s.slip_step = dot(rows.a[1], a) + dot(rows.b[1], b);
  const double normal = -s.stiffness[0] * s.gap_after, shear = -s.stiffness[1] * (s.slip + s.slip_step);
  if (s.glued) {
    s.force = {normal, shear};
    return false;
  }
  s.force = {};
  switch (s.state) {
    case SpringState::kOpen:
      if (s.gap_after >= -s.same[0]) return false;
      // it sticks where it comes in, unless it has slid in this step, or nothing would hold it
      s.state = s.side != 0 || is_smooth(s) ? SpringState::kSliding : SpringState::kStuck;
      s.slip = 0, s.pressing = 0;
      return true;
    case SpringState::kStuck:
      if (normal <= -s.bears.tension - s.stiffness[0] * s.same[0]) {
        s.state = SpringState::kOpen;
        return true;
      }
      s.force = {normal, shear};
      if (std::abs(shear) <= s.bears.limit(normal) + s.stiffness[1] * s.same[1]) return false;
      s.state = SpringState::kSliding, s.side = shear > 0 ? -1 : 1;
      s.pressing = std::max(0.0, normal);
      return true;
    case SpringState::kSliding: {
      if (s.gap_after > s.same[0]) {
        s.state = SpringState::kOpen;
        return true;
      }
      const double friction = s.bears.limit(s.pressing);
      s.force = {normal, -s.side * friction};
      if (s.slip_step * s.side >= -s.same[1] || is_smooth(s)) return false;
      // it came back: it sticks, with the force that it slid with
      s.state = SpringState::kStuck, s.slip = s.side * friction / s.stiffness[1];
      return true;
    }
  }
  return false;
}

}  // namespace talus
