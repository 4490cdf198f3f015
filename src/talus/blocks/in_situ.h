#pragma once
// Stress of the ground before the first stage. Theory: docs/theory.md 1.7.

#include "talus/blocks/state.h"

namespace talus {

/// Stress at a height, tension > 0 [Pa].
/// @param gravity  of the model [m/s2]
Mat2 in_situ_stress(const InSituInput& input, Vec2 gravity, double height);

/// T0 of all deformable blocks, each that of its centroid [count] [Pa]; empty when the model gives none.
std::vector<Mat2> initial_stresses(const Model& model, const BlockSet& blocks);

/// The first deformable block above the level from which depth counts, -1: none.
int block_above_ground(const Model& model, const BlockSet& blocks);

}  // namespace talus
