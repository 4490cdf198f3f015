#pragma once
// The blocks that a model is cut into, and what became of slivers. Theory: docs/theory.md section 10.

#include <array>
#include <string>
#include <vector>

#include "talus/cut/traces.h"

namespace talus {

/// A block of the partition. Corners are shared with its neighbours exactly; some are flat (the end of a
/// joint on the other side).
struct CutBlock {
  int id = 0;  // number in its name; does not change when others are merged or taken out
  int region = 0;
  int opening = -1;        // -1: in none
  std::vector<int> point;  // corners, counter-clockwise
  std::vector<int> edge;   // edge[k] runs from point[k] to point[k + 1]
};

/// Needles have no joint of their own, or lie between two that are one, and are merged without asking.
enum class SliverAction { kNeedle, kMerged, kDeleted, kKept };

/// A block below a limit, and what was done.
struct Sliver {
  int id = 0;
  double area = 0, width = 0;  // [m2], [m] when it was judged
  Vec2 at;                     // centroid [m]
  SliverAction action = SliverAction::kKept;
  int into = -1;  // id of the receiver
};

/// Below which a block of one region is a sliver.
struct SliverLimits {
  double median_area = 0, median_width = 0;  // of all its blocks before [m2], [m]; 0: it has none
  double area = 0, width = 0;                // [m2], [m]
};

struct SliverTable {
  std::vector<SliverLimits> limits;  // [regions]
  std::vector<Sliver> rows;
  int needles = 0, merged = 0, deleted = 0, kept = 0;
  int receivers = 0;        // blocks that took up slivers
  std::vector<int> opened;  // edges along which slivers with joints were merged
  double deleted_area = 0;  // [m2]
};

struct Cut {
  // made and taken apart in one file: here every file of the program would hold that code
  Cut();
  Cut(const Cut&);
  Cut(Cut&&) noexcept;
  Cut& operator=(const Cut&);
  Cut& operator=(Cut&&) noexcept;
  ~Cut();

  double grid = 0;                    // [m]
  std::vector<CutRegion> regions;     // regions, then arches
  std::vector<std::string> openings;  // names
  std::vector<Origin> origins;
  std::vector<Vec2> point;               // [n_points]
  std::vector<std::array<int, 2>> edge;  // [n_edges] points
  std::vector<int> edge_origin;          // [n_edges]
  std::vector<int> edge_line;            // [n_edges] which of the lines cut along; empty: read from a file
  std::vector<CutBlock> whole;           // all blocks before anything was merged or taken out, by id
  std::vector<CutBlock> blocks;          // what is left
  std::vector<JointSetNote> joint_sets;
  std::vector<SurveyNote> surveys;
  std::vector<Polyline> dead_ends;  // parts of traces that bound no block
  double dead_end_length = 0;       // [m]
  int bridges = 0;                  // cuts added where a block had a hole
  int taken_out = 0;                // blocks of removed openings
  SliverTable slivers;

  Polygon polygon(const CutBlock& block) const;
  /// "rock[12]", "tunnel[12]"
  std::string name(const CutBlock& block) const;
};

}  // namespace talus
