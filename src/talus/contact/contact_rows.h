#pragma once
// Contact points and their joint law as rows, and what they carry to the next step.

#include <map>
#include <vector>

#include "talus/contact/bonds.h"
#include "talus/contact/compliance.h"
#include "talus/contact/find.h"

namespace talus {

/// All contact points of blocks not tied by bonds, sorted by key; arguments as touch_blocks().
std::vector<ContactPoint> find_contacts(const BlockSet& blocks, const BondSet& bonds, const State& state,
                                        double margin, CandidateFinder& candidates, double look_ahead = 0);

/// Rows of `contacts`: normal row, friction with a stick anchor, compliant where the joint has stiffness.
/// First guess and anchor come from the contact of the same key in `state`; a corner that passed on to
/// another edge of the same block keeps its force.
/// @param before  rates half a step ago
void add_contact_rows(const BlockSet& blocks, const Layout& joints_of, const Model& model,
                      const std::vector<ContactPoint>& contacts, const State& state,
                      const std::vector<BlockRate>& before, const RowTiming& timing, RowSet& rows);

/// Stores force and anchor of each contact in the state.
/// @param first  index of the first contact row in `rows`
void remember_contacts(const std::vector<ContactPoint>& contacts, const RowSet& rows, size_t first,
                       const RowTiming& timing, State& state);

}  // namespace talus
