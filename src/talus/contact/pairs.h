#pragma once
// Which blocks are near each other and where they touch, kept from step to step: a list of close pairs with a
// skin, and in each pair contact points that are sought anew only when the two have moved against each other.
// Theory: docs/theory.md 3.1, 13.6.

#include <algorithm>

#include "talus/base/parallel.h"
#include "talus/contact/bonds.h"
#include "talus/contact/find.h"
#include "talus/model/joint_law.h"

namespace talus {

/// How far the blocks of a step look ahead.
struct LookAhead {
  const StepClock& clock;
  const std::vector<BlockRate>& before;  // rates of the blocks half a step ago
};

/// Renews state.pairs when some block has moved half its skin since they were made, or looks further ahead
/// than then: all pairs (a < b), at least one moving freely, that may come into touch and are not glued for
/// good. Pairs and contacts known before stay. Returns whether it did.
bool renew_pairs(const BlockSet& blocks, const BondSet& bonds, const Layout& joints_of,
                 const std::vector<JointLaw>& joints, const LookAhead& ahead, const Workers& workers,
                 State& state);

/// How far the blocks of a pair move against each other in a step, at most: the smaller one as seen by the larger.
struct Approach {
  double of_margin = 0;           // as a multiple of how far ahead their contact points were sought
  double of_size = 0;             // as share of the smaller one
  int smaller = -1, larger = -1;  // of which pair that is

  Approach& operator+=(const Approach& o) {
    of_margin = std::max(of_margin, o.of_margin);
    if (o.of_size > of_size) of_size = o.of_size, smaller = o.smaller, larger = o.larger;
    return *this;
  }
};
/// @param rate  with which they move over dt
Approach approach_of(const BondSet& bonds, const BlockSet& blocks, const State& state,
                     const std::vector<BlockRate>& rate, double dt, const Workers& workers);

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
                             const std::vector<JointLaw>& joints, const LookAhead& ahead,
                             const Workers& workers, State& state);

/// All contact points of blocks not tied by bonds, pair by pair, from scratch.
/// @param margin  gaps up to which they are sought [m]
std::vector<ContactPoint> find_contacts(const BlockSet& blocks, const BondSet& bonds, const State& state,
                                        double margin, double look_ahead = 0);

}  // namespace talus
