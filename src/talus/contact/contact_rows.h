#pragma once
// Contact points and their joint law as rows, and what they carry to the next step.

#include <map>
#include <vector>

#include "talus/contact/bonds.h"
#include "talus/contact/find.h"

namespace talus {

/// All contact points of blocks not tied by bonds, sorted by key.
std::vector<ContactPoint> find_contacts(const BlockSet& blocks, const BondSet& bonds, const State& state,
                                        double margin, CandidateFinder& candidates);

/// Rows of `contacts`: hard normal row, friction with a stick anchor. First guess and anchor come from the
/// contact of the same key in `state`.
/// @param dt       over which the rows' velocities act [s]
/// @param dt_kick  over which their impulses act [s]
void add_contact_rows(const BlockSet& blocks, const Layout& joints_of,
                      const std::vector<JointProperty>& joints, const std::vector<ContactPoint>& contacts,
                      const State& state, double dt, double dt_kick, RowSet& rows);

/// Stores force and anchor of each contact in the state.
/// @param first  index of the first contact row in `rows`
void remember_contacts(const std::vector<ContactPoint>& contacts, const RowSet& rows, size_t first,
                       double dt_kick, State& state);

}  // namespace talus
