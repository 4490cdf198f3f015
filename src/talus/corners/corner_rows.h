#pragma once
// Corners over edges as rows of hard contacts with friction, and what they carry to the next step: of the equations as
// printed (theory 5.9), which know no other joints.

#include <vector>

#include "talus/corners/follow.h"

namespace talus {

/// Rows of state.contacts, appended: normal row and friction with a stick anchor. First guess and anchor come from the
/// memory of each contact.
/// @param laws   of the model's joints
/// @param gaps  gets that of each contact [n_contacts] [m]
void add_corner_rows(const BlockSet& blocks, const Model& model, const std::vector<JointLaw>& laws,
                     const State& state, const StepClock& clock, const Workers& workers, RowSet& rows,
                     std::vector<double>& gaps);

/// Stores force, anchor and slip of the contacts of some rows in the state.
/// @pre  state.rate are the rates after the kick, and the blocks lie as they did when the rows were made
void remember_corners(const BlockSet& blocks, const RowSet& rows, RowRange range, const StepClock& clock,
                      State& state);

}  // namespace talus
