#pragma once
// What a cut gave, in words, tables and as a machine-readable summary.

#include <string>
#include <vector>

#include "talus/blocks/block_set.h"
#include "talus/cut/layout.h"

namespace talus {

/// Percentiles of one quantity over all blocks.
struct Spread {
  double min = 0, p1 = 0, p5 = 0, median = 0, mean = 0, p95 = 0, max = 0;
};

struct BlockStatistics {
  int count = 0;
  double total_area = 0;  // [m2]
  Spread area;            // [m2]
  Spread width;           // [m]
  Spread aspect;          // length over width, of the rectangle with the same second moments
  Spread edges;
  Spread step;             // stable step of each deformable block on its own [s]; 0 when none deforms
  std::string step_block;  // the block that sets the smallest step; "" when none deforms
};

/// @pre materials of all blocks are complete
BlockStatistics block_statistics(const Model& model, const std::vector<BlockShape>& blocks);

/// Statistics of a cut before anything was merged or taken out, and of what is left.
struct CutStatistics {
  BlockStatistics before, after;
};

CutStatistics cut_statistics(const Model& model, const Cut& cut);

/// The report of `talus cut`: joint sets, dead ends, slivers, blocks, step limits.
std::string cut_report(const Model& model, const Cut& cut, const CutStatistics& statistics);

/// The same numbers as JSON.
std::string cut_summary(const Model& model, const Cut& cut, const CutStatistics& statistics);

/// What may be asked of a block before any run.
struct BlockRow {
  Vec2 centroid;
  double area = 0, width = 0, aspect = 0;  // [m2], [m], length over width
  double step = 0;                         // stable step on its own [s]; infinite where it does not deform
};
/// [blocks] @pre materials of all blocks are complete
std::vector<BlockRow> block_rows(const Model& model, const std::vector<BlockShape>& blocks);

/// One row per block: name, place, area, width, aspect, edges, stable step.
std::string cut_blocks_csv(const Model& model, const std::vector<BlockShape>& blocks);

/// One row per sliver: what it was and what was done.
std::string slivers_csv(const Cut& cut);

}  // namespace talus
