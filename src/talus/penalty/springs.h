#pragma once
// Contacts and glued faces of conventional DDA: a normal and a shear spring at each point, and the rules by which a
// contact opens, sticks or slides from iteration to iteration (Shi 1988, chapter 4). Theory: docs/theory.md section 13.

#include <vector>

#include "talus/penalty/displacement_block.h"
#include "talus/step/scene.h"

namespace talus {

enum class SpringState : char { kOpen, kStuck, kSliding };

/// Springs at one pair of material points, for the displacements of one step.
struct Spring {
  int block_a = -1, block_b = -1;
  int index = -1;                     // of State::contacts, or 2 * face + end of BondSet::faces
  bool glued = false;                 // at the end of a glued face: never opens, never slides
  Vec2 normal;                        // from b into a; the tangent is the normal turned clockwise
  Vec2 arm_a, arm_b;                  // from the centroids, as the blocks lie now [m]
  std::array<double, 2> stiffness{};  // normal, shear [N/m]
  double gap = 0;                     // before the step, > 0 apart [m]
  double slip = 0;                    // elastic slip before the step of what sticks [m]
  JointStrength bears;                // forces [N]
  std::array<double, 2> same{};       // gaps and slips that are none [m]
  SpringState state = SpringState::kOpen;
  double side = 0;      // +-1: which way it slides
  double pressing = 0;  // normal force that friction goes by [N]

  // what the displacements of an iteration make of it
  double gap_after = 0, slip_step = 0;  // [m]
  std::array<double, 2> force{};        // on block a, along normal and tangent [N]
};

/// Springs at the places of now: glued faces, then contacts.
/// @param stiffness  normal and shear, of contacts whose joint has none [N/m]
void gather_springs(const Scene& scene, const State& state, const std::array<double, 2>& stiffness,
                    std::vector<Spring>& springs);

/// Normal and tangential row over the six of block a, and over those of block b.
struct SpringRows {
  std::array<Six, 2> a, b;
};
SpringRows rows_of(const Spring& spring, const BlockSet& blocks);

/// Normal force that the displacements of an iteration make of a closed contact, 0 where they open it [N].
double pressure_after(const Six& a, const Six& b, const SpringRows& rows, const Spring& spring);

/// Gap, slip, forces and state that the displacements of an iteration make. @return whether the state changed
bool follow(const Six& a, const Six& b, const SpringRows& rows, Spring& spring);

}  // namespace talus
