#pragma once
// Contact points and their joint law as rows, and what they carry to the next step.

#include <vector>

#include "talus/contact/compliance.h"
#include "talus/contact/contact_give.h"
#include "talus/contact/contact_place.h"
#include "talus/corners/follow.h"

namespace talus {

/// Rows of state.contacts, appended: normal row, friction with a stick anchor, compliant where the joint has
/// stiffness. First guess and anchor come from the memory of each contact.
/// @param laws    of the model's joints
/// @param give    of those that have no stiffness
/// @param before  rates half a step ago
/// @param place   gets gap and slip of each contact [n_contacts]
void add_contact_rows(const BlockSet& blocks, const Model& model, const std::vector<JointLaw>& laws,
                      const ContactGive& give, const State& state, const std::vector<BlockRate>& before,
                      const StepClock& clock, const Workers& workers, RowSet& rows,
                      std::vector<ContactPlace>& place);

/// Stores force, anchor and slip of the contacts of some rows in the state.
/// @pre  state.rate are the rates after the kick
void remember_contacts(const RowSet& rows, RowRange range, const std::vector<ContactPlace>& place,
                       const StepClock& clock, State& state);

}  // namespace talus
