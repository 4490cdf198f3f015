#pragma once
// The patches of all close pairs of blocks, found anew in every step from how the blocks lie, and what each takes
// over from those before: memory goes by place. Theory: docs/theory.md 3.3 to 3.8.

#include "talus/base/parallel.h"
#include "talus/contact/bonds.h"
#include "talus/contact/contact_give.h"
#include "talus/contact/outlines.h"
#include "talus/contact/overlap.h"
#include "talus/contact/pairs.h"
#include "talus/contact/patch_world.h"

namespace talus {

/// Memory of the search from step to step; nothing of it matters to the result.
///
/// Nor does ContactPair::lead: by how much all ways of a pair were behind those of its patches when the list of pairs was
/// made, at least; 0: not known. What the two may have moved since then, and then what they move in a step, uses it up
/// (theory 3.3).
class PatchSearch {
 public:
  /// Brings state.patches up to date with how the blocks lie (theory 3.2 to 3.8).
  /// @pre  renew_pairs() has been called
  /// @return  pairs whose parts overlap or are near enough to touch
  int update(const PatchWorld& world, const LookAhead& ahead, const Workers& workers, State& state);

  /// In the last update() of a step from rest: how deep hard parts are in each other that were not in touch; share of the
  /// smaller block, largest.
  double unseen() const { return unseen_; }

 private:
  std::vector<Vec2> corner_, along_;  // of all parts as they lie, from each block's centroid
  struct BlockNow {
    Mat2 back;          // F inverted
    double reach;       // from its centroid, at most [m]
    double turning;     // how far its corners move in it beside the centroid, at most [m]
    PartMotion motion;  // in the step to come, from its centroid
    double turns;       // norm of how it turns
    double gone;        // of its centroid since the list of pairs was made [m]
    double turned;      // how far it has turned and deformed since then [-]
  };
  std::vector<BlockNow> now_;  // [blocks]
  // Of each side the block that an intact face ties it to, or one of these; of parts that are not bare.
  static constexpr int kFree = -1, kCut = -2;
  std::vector<int> tied_to_;
  std::vector<char> bare_;  // [parts] whether all sides are free
  struct Changed {
    std::vector<std::pair<size_t, int>> pair;  // and how many it has now
    std::vector<Patch> patch;
    int met = 0;
    double unseen = 0;
  };
  std::vector<Changed> changed_;
  double unseen_ = 0;

  void place_parts(const PatchWorld& world, const LookAhead& ahead, const Workers& workers,
                   const State& state);
  static int tied_to(const PatchWorld& world, const State& state, int block, const PartSide& side);
  void place_part(const PatchWorld& world, const State& state, size_t block, size_t part);
  void put_together(State& state);
  friend class PairSearch;
};

}  // namespace talus
