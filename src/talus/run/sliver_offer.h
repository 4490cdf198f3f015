#pragma once
// What merging slivers would buy: a longer step for stages with explicit elasticity.

#include <string>
#include <vector>

#include "talus/cut/cut.h"
#include "talus/run/run.h"

namespace talus {

struct SliverOffer {
  int merged = 0;                  // blocks inside the rock that would go
  std::vector<std::string> along;  // what cut.merge_along must name for it
  std::string stage;               // whose step is the shortest
  double step = 0, now = 0;        // [s] with them merged; as it is
};

/// Offers that lengthen the shortest step by a tenth or more, the one that interrupts fewer joints first:
/// none, one or two. None when slivers are not kept or no step hangs on a block.
/// @param cut  of the model of `run`
std::vector<SliverOffer> sliver_offers(const PreparedRun& run, const Cut& cut);

/// The same in words, a line each; "" when there is none.
std::string sliver_offer_text(const std::vector<SliverOffer>& offers);

}  // namespace talus
