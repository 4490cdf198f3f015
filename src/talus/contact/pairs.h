#pragma once
// Which blocks are near each other and where they touch, kept from step to step: a list of close pairs with a
// skin, and in each pair contact points that are sought anew only when the two have moved against each other.
// Theory: docs/theory.md 3.7.

#include "talus/base/parallel.h"
#include "talus/contact/bonds.h"
#include "talus/contact/find.h"

namespace talus {

/// Renews state.pairs when some block has moved half the skin since they were made, or the margin [m] is
/// another: all pairs (a < b), at least one moving freely, that may be closer than the margin and are not
/// glued for good. Pairs and contacts known before stay. Returns whether it did.
bool renew_pairs(const BlockSet& blocks, const BondSet& bonds, double margin, const Workers& workers,
                 State& state);

struct SearchReport {
  int searched = 0;  // pairs whose contact points were sought anew
};

/// Brings the contact points of all pairs up to date (ContactSearch::touch): seeks them anew where the blocks
/// of a pair have moved against each other by more than its `reuse`, follows the known ones elsewhere.
/// Contacts with the key of one known before keep their memory; a corner that passed on to another edge of
/// the same block keeps its force.
SearchReport update_contacts(const BlockSet& blocks, const BondSet& bonds, const Layout& joints_of,
                             double margin, double look_ahead, const Workers& workers, State& state);

/// All contact points of blocks not tied by bonds, pair by pair, from scratch.
std::vector<ContactPoint> find_contacts(const BlockSet& blocks, const BondSet& bonds, const State& state,
                                        double margin, double look_ahead = 0);

}  // namespace talus
