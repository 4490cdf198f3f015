#pragma once
// Patches and their joint law as rows, two to a patch, and what they carry to the next step.
// Theory: docs/theory.md 3.8, 4.6, 4.22.

#include "talus/contact/compliance.h"
#include "talus/contact/contact_give.h"
#include "talus/contact/patches.h"

namespace talus {

/// Rows of state.patches, appended: the ends of the chord of each, normal row and friction; compliant where the
/// joint has stiffness, the two ends coupled as those of a closure that is linear along the chord (eq. 3.4).
/// @param before  rates half a step ago
/// @param gaps    gets the gap of each end [2 n_patches] [m]
void add_patch_rows(const PatchWorld& world, const ContactGive& give, const State& state,
                    const std::vector<BlockRate>& before, const StepClock& clock, const Workers& workers,
                    RowSet& rows, std::vector<double>& gaps);

/// Stores force, elastic slip at the end of the step and slip of the end of a patch that row r stands for in the state.
/// @param u       its relative velocity after the kick [m/s]
/// @param before  rates half a step ago
void remember_patch(const BlockSet& blocks, const std::vector<JointLaw>& laws, const RowSet& rows, size_t r,
                    const std::array<double, 2>& u, const std::vector<BlockRate>& before,
                    const StepClock& clock, State& state);

/// What of the impulses of row r of a patch its dashpots bear, along the normal and the tangent [N s]: none where it slides or
/// opens, where the row bears what its bounds let it.
/// @param u  as above
std::array<double, 2> dashpot_impulse(const BlockSet& blocks, const std::vector<JointLaw>& laws,
                                      const RowSet& rows, size_t r, const std::array<double, 2>& u,
                                      const std::vector<BlockRate>& before,
                                      const std::vector<BlockRate>& after, const StepClock& clock,
                                      const State& state);

}  // namespace talus
