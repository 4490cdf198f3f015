#pragma once
// Faces that are glued at the start: bonded joints, and frictional ones with cohesion or tensile strength
// until they break. Each face is tied at its two ends, by material points. Theory: docs/theory.md
// section 3.4.

#include <vector>

#include "talus/base/parallel.h"
#include "talus/blocks/state.h"
#include "talus/contact/compliance.h"
#include "talus/contact/contact_give.h"
#include "talus/model/joint_law.h"
#include "talus/rows/rows.h"

namespace talus {

/// Of the smaller block: faces of the reference shape further apart are not in touch, and one that ends this near a
/// corner ends there.
inline constexpr double kTouching = 1e-6;

struct BondFace {
  int block_a = -1, block_b = -1;
  int edge_a = -1;
  int edge_b = -1;          // its outward normal is the normal of the face
  Vec2 arm_a[2], arm_b[2];  // reference arms of the two ends, on a and on b
  Vec2 closure[2];          // at the two ends, by the stress of the ground: normal, tangential [m]
  double length = 0;        // [m]
  int joint = -1;
  bool unbreakable = false;
  bool elastic_shear = false;  // the joint has shear stiffness
  double memory = 0;  // [s] time over which forces are averaged before strength is judged: one block transit
};

struct BondSet {
  std::vector<BondFace> faces;            // sorted by (block_a, block_b)
  std::vector<std::pair<int, int>> tied;  // pairs of blocks whose contact is never looked for, sorted
};

/// Faces between all pairs of blocks whose joint is bonded or has strength, from the reference shape.
BondSet find_bonds(const Model& model, const Layout& layout, const BlockSet& blocks);

/// All faces that blocks share in the reference shape, with the joint along each: overlaps of antiparallel edges of
/// two blocks that touch, at least one of them moving freely. In the order of (block_a, block_b).
std::vector<BondFace> shared_faces(const Layout& layout, const BlockSet& blocks);

/// Whether contact between two blocks is left to intact bonds.
bool is_tied(const BondSet& bonds, const State& state, int a, int b);

/// Rows of all intact faces (two points each), with the first guess from the last step.
/// @param give    of faces that may break and whose joint has no stiffness: what hard contacts give
/// @param before  rates half a step ago
void add_bond_rows(const BlockSet& blocks, const BondSet& bonds, const std::vector<JointLaw>& laws,
                   const ContactGive& give, const State& state, const std::vector<BlockRate>& before,
                   const StepClock& clock, const Workers& workers, RowSet& rows);

/// After the solution: forces, and the slip of points that slide at the limit of an elastic shear.
void remember_bonds(const BlockSet& blocks, const BondSet& bonds, const RowSet& rows, const StepClock& clock,
                    const Workers& workers, State& state);

/// How far the tied points of a face are apart, material point from material point, counted from the joint
/// without force (the stress of the ground has closed it).
struct FaceOffset {
  Vec2 normal;           // of the face now, from b into a
  double opening[2];     // along the normal, > 0 apart [m]
  double tangential[2];  // motion of a along the tangent, as b sees it [m]
};
FaceOffset face_offset(const BlockSet& blocks, const State& state, const BondFace& face);

/// Follows the mean forces of breakable faces over a step of length dt and breaks those at their limit, or
/// open, at both ends. Returns the number broken.
int update_bonds(const BlockSet& blocks, const BondSet& bonds, const std::vector<JointLaw>& laws, double dt,
                 const Workers& workers, State& state);

}  // namespace talus
