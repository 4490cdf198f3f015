#pragma once
// Which blocks are near each other, kept from step to step: a list of close pairs with a skin. Theory: docs/theory.md 3.1.

#include <algorithm>

#include "talus/base/parallel.h"
#include "talus/contact/bonds.h"
#include "talus/geometry/polygon.h"
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

/// Contact is sought this far ahead, as share of the smaller block; what is further away than the two come together by
/// in one step has no force and costs only its row.
inline constexpr double kMarginShare = 0.02;

/// The smaller block of a pair and the larger one.
struct BySize {
  int small, large;
};
BySize by_size(const BlockSet& blocks, const ContactPair& pair);

/// Whether a face between the two is intact: they have no contacts then.
bool held_by_faces(const BondSet& bonds, const State& state, const ContactPair& pair);

/// How fast the outermost places of a block move against its centroid at most [m/s].
double turning_speed(const BlockSet& blocks, const std::vector<BlockRate>& rate, size_t i);

/// Boxes around the blocks as they lie [count].
std::vector<Box> boxes_now(const BlockSet& blocks, const State& state);

/// Who is near whom, blocks that have been taken out left aside.
void list_neighbours(const BlockSet& blocks, const std::vector<std::pair<int, int>>& close, Neighbours& out);

}  // namespace talus
