#pragma once
// Everything that a step changes. Copying a State is a checkpoint.

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "talus/base/vec2.h"
#include "talus/blocks/block_set.h"
#include "talus/blocks/bolt.h"
#include "talus/blocks/work_done.h"

namespace talus {

/// Rate of motion of a block: velocity of the centroid a [m/s] and of the deformation gradient G [1/s].
/// For blocks that do not deform, G is the spin matrix and acts on the arm as it lies now.
struct BlockRate {
  Vec2 a;
  Mat2 G;
};

inline BlockRate operator+(const BlockRate& u, const BlockRate& v) { return {u.a + v.a, u.G + v.G}; }
inline BlockRate operator-(const BlockRate& u, const BlockRate& v) { return {u.a - v.a, u.G - v.G}; }

/// Generalised force on a block: resultant f [N] and Q = sum of f X^T - V P [N m]. Conjugate to BlockRate.
struct BlockForce {
  Vec2 f;
  Mat2 Q;

  BlockForce& operator+=(const BlockForce& o) {
    f += o.f;
    Q += o.Q;
    return *this;
  }
};

inline BlockForce operator*(double s, const BlockForce& p) { return {s * p.f, s * p.Q}; }
inline BlockForce operator+(BlockForce p, const BlockForce& q) { return p += q; }
/// Power of a force, or energy of an impulse, at a rate.
inline double work(const BlockForce& p, const BlockRate& v) { return dot(p.f, v.a) + contract(p.Q, v.G); }
inline BlockRate mean(const BlockRate& u, const BlockRate& v) {
  return {0.5 * (u.a + v.a), 0.5 * (u.G + v.G)};
}

/// A contact is recognised from step to step by the corner of `block_a` and the edge of `block_b` it lies on;
/// edge k runs from corner k to corner k + 1.
struct ContactKey {
  int block_a = -1, vertex = -1, block_b = -1, edge = -1;

  BlockCorner corner() const { return {block_a, vertex}; }
  BlockEdge on() const { return {block_b, edge}; }

  friend bool operator==(const ContactKey&, const ContactKey&) = default;
  friend auto operator<=>(const ContactKey&, const ContactKey&) = default;
};

/// An interface is two antiparallel sides in touch; each of its two ends is one place, whichever block's
/// corner lies there now. Sides are named by their first edges.
struct FaceEnd {
  int side_lo = -1, side_hi = -1;  // of the lower and the higher block id; -1: no end of an interface
  int end = 0;                     // 0: the first one along the lower block's side

  friend bool operator==(const FaceEnd&, const FaceEnd&) = default;
};

/// One contact point and what it carries to the next step. Its memory belongs to its place: the end of an
/// interface keeps it when another corner comes to lie there. A corner that passed on to another edge keeps
/// its force but not its anchor.
struct Contact {
  ContactKey key;
  enum Memory : char { kNone, kPassed, kWhole };
  friend constexpr Memory last_of(Memory) { return kWhole; }

  int joint = -1;        // -1: hard and frictionless
  int16_t partner = -1;  // the other end of its face: its place in the list of the pair, -1: none
  Memory memory = kNone;
  bool touched = false;  // the two have been in touch here
  FaceEnd face;
  double allowed = 0;  // [m] overlap it was born with and may keep for now, as a gap it is counted from
  double length = 0;   // [m] half that face
  std::array<double, 2> force{};  // normal, tangential [N]
  double stretch = 0;             // elastic slip [m]
  double anchor = 0;              // slip coordinate at which it sticks [m]; NaN: it slid
  double slip = 0;                // [m] beyond the elastic one, both ways added up
  double slip_signed = 0;         // [m] the same with its sign: > 0 along the tangent
};

/// Where two convex parts of two blocks touch or nearly do, and what that place carries to the next step. It is
/// known by the two parts, where ties leave several pieces by its place too; what it remembers lies along its chord, whose
/// ends are material points of both.
struct Patch {
  int block_a = -1, block_b = -1;    // a < b
  int part_a = -1, part_b = -1;      // of Outlines
  int side_a = -1, side_b = -1;      // edges of the blocks that have most of it; -1: none in particular
  int joint = -1, other_joint = -1;  // -1: hard and frictionless; the other one where two meet
  double other_share = 0;            // of the other one
  int way = 0;            // side of the parts along which it keeps them apart: of b > 0, of a < 0; of what
                          // elastic joints measure, the face of b of a strip
  bool touched = false;   // the two have been in touch here
  bool overlaps = false;  // they do
  int16_t also = 0;       // with way the only ones that ContactPair::lead leaves; 0: none
  Vec2 normal;            // unit, from b into a; the tangent is the normal turned clockwise
  std::array<Vec2, 2> arm_a, arm_b;  // reference arms of the chord's ends, the first along the tangent first
  std::array<double, 2> closure{};   // at the ends, of what it bears; < 0: a gap [m]
  std::array<double, 2> gap{};       // at the ends, of positions: > 0 apart [m]
  std::array<double, 2> allowed{};   // of hard contacts: overlap it was born with and may keep for now [m]
  double length = 0;                 // of the chord [m]
  double area = 0;                   // of the overlap [m2]
  double root_kept = 0;              // sqrt(U/(k t)) of what it keeps for good (theory 3.5)
  std::array<std::array<double, 2>, 2> force{};  // at the ends: normal, tangential [N]
  std::array<double, 2> stretch{};               // elastic slip at the ends [m]
  std::array<double, 2> slip{};                  // [m] beyond the elastic one, both ways added up
  std::array<double, 2> slip_signed{};           // [m] the same with its sign: > 0 along the tangent
};

/// A third block that covers a side of a pair: a place beside that side lies in it.
struct Cover {
  int block = -1;     // -1: none
  bool of_b = false;  // the side is one of block b of the pair
  Vec2 at;            // the place, as a reference arm of that block [m]

  friend bool operator==(const Cover&, const Cover&) = default;
};

/// Two blocks near each other.
struct ContactPair {
  int a = -1, b = -1;        // a < b
  int begin = 0, count = 0;  // of State::patches, or of State::contacts
  int face = -1;             // first of their faces in the bond set, -1: none
  int joint = -1;            // of any two sides of theirs; kByEdges: each has its own
  static constexpr int kByEdges = -3;
  // Joints carry the stress of the ground between blocks that share a face since the first step, and where
  // blocks that were near each other then come to share one.
  bool from_start = false, shares_face = false;
  float lead = 0;     // [m] see PatchSearch
  double margin = 0;  // [m] gaps up to which they were sought
};

/// Contact points of a pair are sought anew when its blocks have moved against each other by more than `reuse`
/// since; until then the same points are followed.
struct alignas(64) FollowedPair {  // every step reads them all: what covers sides only where there is any
  double reuse = -1;               // [m]; < 0: not sought yet
  Vec2 arm;                    // reference arm, on the larger block, of the centroid of the smaller one then
  Mat2 turn;                   // F of the larger block, inverted, times F of the smaller one then
  std::array<Cover, 4> cover;  // of sides of the two
  int covers = 0;              // how many of these
};

/// Blocks near each block, those that are glued to it or do not move among them: [begin[i], begin[i + 1]).
struct Neighbours {
  std::vector<int> begin, block;

  std::span<const int> of(int i) const {
    if (begin.empty()) return {};
    return {block.data() + begin[i], static_cast<size_t>(begin[i + 1] - begin[i])};
  }
};

/// Where the blocks were when the list of pairs was made.
struct CandidateList {
  std::vector<Vec2> displacement;
  std::vector<Mat2> strain_part;
  std::vector<double> skin,
      reach;  // [count] how far a block may move, and look, before a new list is due [m]
  Neighbours neighbours;
  int rebuilds = 0;
};

/// Condition of a face that was intact at the start and may break.
struct FaceState {
  bool broken = false;
  int64_t broken_step = -1;            // State::step before which it broke
  std::array<double, 2> offset{};      // tangential, of the tied points when it broke, less slip [m]
  std::array<double, 4> mean_force{};  // running mean of normal, tangential of point 0 and of point 1 [N]
  std::array<double, 2> slip{};        // along the tangent, of points at the limit of their shear [m]
};

/// A point held from outside, by a support, a boundary or a tie.
struct HeldPoint {
  std::array<double, 2> force{};  // of its two rows, in all [N]
  Vec2 hold;                      // displacement at which it is held [m]
  std::array<double, 2> kept{};   // of the force, the reaction kept from a static stage [N]

  friend bool operator==(const HeldPoint&, const HeldPoint&) = default;
};

/// How a static stage comes to rest, looked at every 250 steps.
struct RestWatch {
  int64_t steps = 0;     // since the stage began
  double best = 0;       // least of the measure of rest (theory.md 4.8) since the last look; 0: none
  double before = 0;     // the same between the last two looks
  double sharper = 1;    // share of the solver's tolerance to which steps are solved
  int stuck = 0;         // looks in a row that stall or, at the sharpest, are without any progress
  double length = 0;     // of the next step of a stage from rest [s]
  int whole = 0;         // such steps in a row that were not halved
  double gone = 0;       // no block has gone further in them, as share of its size
  double gone_many = 0;  // and blocks of a hundredth of the area no less far
  // of a stage along a path; of others it is looked for once
  int64_t begin_steps = 0;  // steps of the stage before the present balance is looked for
  double begin = 0;         // when that began [s]
  double pace = 0;          // by how much the histories go on in a second of its steps [-]
  double moved = 0;         // sum of the longest way of a block in each of its steps, as share of its size
  int balances = 0;         // found so far
};

/// What an implicit step leaves out of balance, and how it moved (of conventional DDA).
struct StepJudged {
  double unbalanced = 0;   // largest unbalanced force of a block / mean force on blocks
  double worst_force = 0;  // [N]
  double moving = 0;       // kinetic energy of the way of the step [J]
  double nudge = 0;        // StepReport::nudge [J]
  int worst_block = -1, iterations = 0;
};

struct State {
  // made and taken apart in one file: here every file of the program would hold that code
  State();
  State(const State&);
  State(State&&) noexcept;
  State& operator=(const State&);
  State& operator=(State&&) noexcept;
  ~State();

  double time = 0;   // [s]
  int64_t step = 0;  // steps completed
  double history_time =
      0;                 // [s] clock of the histories: time spent in dynamic stages, and paths of static ones
  double dt_before = 0;  // length of the step before [s]; 0 at the start, which makes the first half step

  std::vector<Vec2> displacement;  // [count] c - c0 [m]
  std::vector<Mat2> strain_part;   // [count] F - I
  std::vector<double> angle;       // [count] rotation of blocks that do not deform [rad]
  std::vector<BlockRate> rate;     // [count] at the middle of the step before; the initial rate at the start
  std::vector<BlockForce> row_force;  // [count] of all rows, at the step before [N], [N m]

  std::vector<std::array<double, 2>> bond_force;  // [n_bond_points] normal, tangential [N]
  std::vector<FaceState> face;                    // [n_bond_faces]
  std::vector<HeldPoint> supports;    // [n_supported_points] force along x, y; hold: where the support began
  std::vector<HeldPoint> boundaries;  // [n_boundary_points] normal, tangential; hold: of static stages
  std::vector<HeldPoint> ties;        // [n_ties] normal, tangential on the first side
  std::vector<Bolt> bolts;            // installed so far, in the order of installation
  std::vector<Vec2> column_displacement;  // [n_column_nodes] of the free field, dynamic part [m]
  std::vector<Vec2> column_rate;          // [n_column_nodes] at the middle of the step before [m/s]
  CandidateList candidates;
  std::vector<ContactPair> pairs;      // sorted by (a, b)
  std::vector<Contact> contacts;       // pair by pair, of formulations that go by corners
  std::vector<FollowedPair> followed;  // [pairs] of these; empty else
  std::vector<Patch> patches;          // pair by pair, of the one that goes by patches

  std::vector<Mat2>
      initial_stress;  // [count] T0 in the frame of the block, symmetric [Pa] (theory 1.7); empty: none
  std::vector<BlockForce> kept_force;    // [count] of excavated blocks on the others; empty: none
  double relaxed = 1;                    // share of it that is gone
  std::vector<Vec2> displacement_start;  // [count] from which displacements are counted; empty: 0 [m]
  std::vector<Mat2> strain_part_start;   // [count] the same of F - I

  // of conventional DDA (theory 13), empty else: Cauchy stress that blocks carry from step to step [count] [Pa],
  // acceleration and its gradient in the shape of now, where the scheme goes by it [count]
  std::vector<Mat2> carried_stress;
  std::vector<BlockRate> acceleration;
  std::vector<BlockRate> rate_old;  // rates before the last step
  StepJudged judged;                // the last step, which the instant after it is judged by
  double strain_work = 0;           // work that went into strains since the start [J]

  WorkDone work;               // through the middle of the step before
  double energy_start = 0;     // kinetic + strain - gravity work at the start [J]
  double largest_kinetic = 0;  // since the start of the stage [J]
  RestWatch rest;
  std::vector<int>
      left_out;  // blocks that fall or slide and that the rest of a stage does not wait for, in order
  bool is_left_out(size_t block) const {
    return std::binary_search(left_out.begin(), left_out.end(), static_cast<int>(block));
  }
};

/// T0 of block i [Pa].
inline Mat2 initial_stress_of(const State& s, size_t i) {
  return s.initial_stress.empty() ? Mat2{} : s.initial_stress[i];
}

/// State at rest position with the initial velocities of the layout.
State initial_state(const BlockSet& blocks, const Layout& layout);

/// Where arm X of block i is now, relative to the block's reference centroid [m]: d + X + (F - I) X.
inline Vec2 offset_now(const State& s, size_t i, Vec2 X) {
  return s.displacement[i] + X + s.strain_part[i] * X;
}

/// Displacement of the material point at arm X of block i [m]; no digits are lost far from the origin.
inline Vec2 displacement_at(const State& s, size_t i, Vec2 X) {
  return s.displacement[i] + s.strain_part[i] * X;
}

/// The same since displacements were last reset, for results.
inline Vec2 displacement_shown(const State& s, size_t i, Vec2 X) {
  const Vec2 u = displacement_at(s, i, X);
  return s.displacement_start.empty() ? u : u - (s.displacement_start[i] + s.strain_part_start[i] * X);
}

/// Gradient of the displacement shown, against places in the state from which it counts: (F - F0) F0^-1.
inline Mat2 gradient_shown(const State& s, size_t i) {
  const Mat2& e = s.strain_part[i];
  if (s.displacement_start.empty()) return e;
  const Mat2& e0 = s.strain_part_start[i];
  return (e - e0) * inverse(kIdentity + e0);
}

/// The arm on which G acts: X of a deformable block, the turned arm of any other.
inline Vec2 acting_arm(const BlockSet& b, const State& s, size_t i, Vec2 X) {
  return b.kind[i] == BlockKind::kDeformable ? X : X + s.strain_part[i] * X;
}

/// Velocity at an acting arm (eq. 1.1).
inline Vec2 velocity_at(const BlockRate& v, Vec2 acting) { return v.a + v.G * acting; }

/// What the shape of a deformable block says of its elastic state.
struct ElasticState {
  Mat2 stress;         // first Piola-Kirchhoff stress P [Pa]
  double density = 0;  // strain energy per reference volume [J/m3]
  Vec2 rotation;       // (cos, sin) of the rotation of F
};

/// @param H   F - I
/// @param T0  stress at H = 0, symmetric [Pa]; density counts from there
ElasticState elastic_state(const PlaneModuli& c, const Mat2& H, const Mat2& T0 = {});

/// T0 for other moduli such that the stress at H stays as it is.
Mat2 initial_stress_for(const PlaneModuli& before, const PlaneModuli& now, const Mat2& H, const Mat2& T0);

/// First Piola-Kirchhoff stress P of a deformable block: linear elastic in the rotated frame (theory 1.5)
/// [Pa].
/// @param H  F - I
Mat2 piola_stress(const PlaneModuli& c, const Mat2& H);

/// Strain energy of the same law per reference volume [J/m3].
double strain_energy_density(const PlaneModuli& c, const Mat2& H);

/// Cauchy stress P F^T / det F [Pa]; zero for blocks that do not deform.
Mat2 cauchy_stress(const BlockSet& blocks, const State& state, int i);

/// Rotation matrix minus identity, without cancellation for small angles.
Mat2 rotation_minus_identity(double angle);

}  // namespace talus
