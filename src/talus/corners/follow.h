#pragma once
// Contact points of all close pairs, kept from step to step: sought anew only when the two blocks of a pair have moved
// against each other. Theory: docs/theory.md 13.6.

#include "talus/contact/pairs.h"
#include "talus/corners/find.h"

namespace talus {

struct SearchReport {
  int searched = 0;    // pairs whose contact points were sought anew
  double seconds = 0;  // that took, all threads together
};

/// Brings the contact points of all pairs up to date (ContactSearch::touch): seeks them anew where the blocks
/// of a pair have moved against each other, or against a third block that covers their sides, by more than
/// its `reuse`, or look further ahead; follows the known ones elsewhere. How far ahead points are sought is a
/// matter of the two blocks: 2 % of the smaller one, or what they come together by in two steps. Memory
/// passes by place: to the same key, to the end of the same interface, to a corner that passed on to another
/// edge of the same block.
SearchReport update_contacts(const BlockSet& blocks, const BondSet& bonds, const Layout& joints_of,
                             const LookAhead& ahead, const Workers& workers, State& state);

/// All contact points of blocks not tied by bonds, pair by pair, from scratch.
/// @param margin  gaps up to which they are sought [m]
std::vector<ContactPoint> find_contacts(const BlockSet& blocks, const BondSet& bonds, const State& state,
                                        double margin, double look_ahead = 0);

}  // namespace talus
