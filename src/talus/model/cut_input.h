#pragma once
// What the user asked the cutter for: regions of rock or masonry and the traces that divide them. Plain data
// in SI units; angles counter-clockwise from +x. Lengths that have to be given are 1 until they are: where one is wrong
// that is told, and nothing that would follow from 0.

#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "talus/geometry/polygon.h"
#include "talus/schema/findings.h"
#include "talus/schema/scattered.h"

namespace talus {

enum class BlockKind { kDeformable, kRigid, kFixed, kDriven, kRemoved };  // kRemoved: excavated

/// A piece of the section that is cut into blocks.
struct RegionInput {
  std::string name;
  Polygon polygon;
  std::vector<std::string> sides;  // name of each edge of the polygon
  int material = -1;
  int joint = -1;
  BlockKind kind = BlockKind::kDeformable;
  double sliver_area = std::numeric_limits<double>::quiet_NaN();   // [m2] NaN: that of the cut
  double sliver_width = std::numeric_limits<double>::quiet_NaN();  // [m]
  Where where;
};

/// A ring of voussoirs: a region that brings its own joints.
struct ArchInput {
  std::string name;
  Vec2 center;                             // [m]
  double radius = 1;                       // of the intrados [m]
  double thickness = 1;                    // [m]
  double from = 0, to = std::numbers::pi;  // [rad]
  int voussoirs = 1;
  int material = -1;
  int joint = -1;
  BlockKind kind = BlockKind::kDeformable;
  Where where;
};

struct JointSetInput {
  std::string name;
  int region = -1;  // -1: all
  Scattered angle;  // [rad] of the trace in the section
  bool in_space = false;
  double dip = 0, dip_direction = 0;  // [rad] when in_space
  double fisher = 0;                  // concentration of the poles; 0: no scatter
  Scattered spacing;       // [m] along the normal; of the planes when in_space, of the traces otherwise
  Scattered trace_length;  // [m] mean 0: through-going
  Scattered gap;           // [m]
  Vec2 origin;             // [m]
  Scattered offset;        // [m] of the first line from the origin
  Scattered start;         // [m] of the first trace along each line
  int joint = -1;
  Where where, where_spacing, where_length;
};

struct FaultInput {
  std::string name;
  std::vector<Vec2> points;
  int joint = -1;
  Where where;
};

/// Joints of one set as they were surveyed.
struct TracesInput {
  std::string name;
  std::vector<Polyline> lines;  // [m]
  int joint = -1;
  Where where;
};

enum class OpeningShape { kCircle, kHorseshoe, kPolygon };

struct OpeningInput {
  std::string name;
  OpeningShape shape = OpeningShape::kPolygon;
  Polygon polygon;     // the outline, whatever the shape
  double sagitta = 0;  // [m] of the facets of a curve; 0: none
  bool kept = false;
  int joint = -1;
  Where where;
};

struct TessellationInput {
  std::string name;
  int region = -1;
  bool triangles = false;
  double size = 1;            // [m]
  double irregularity = 0.5;  // 0 to 1
  int joint = -1;
  Where where;
};

struct MasonryInput {
  std::string name;
  int region = -1;
  double length = 1, height = 1;  // of a block [m]
  double overlap = 0.5;           // share of the length by which every second course is shifted
  Vec2 origin;                    // [m]
  int bed_joint = -1, head_joint = -1;
  Where where;
};

enum class SliverPolicy { kKeep, kMerge, kDelete };

struct CutInput {
  double section_azimuth = std::numeric_limits<double>::quiet_NaN();  // [rad] of +x, clockwise from north
  double grid = std::numeric_limits<double>::quiet_NaN();             // [m], NaN: automatic
  uint64_t seed = 1;
  SliverPolicy slivers = SliverPolicy::kKeep;
  std::vector<std::string> merge_along;      // joint sets whose lines that reach a free face may be parted
  double sliver_area = 0, sliver_width = 0;  // [m2], [m]
  double sliver_area_share = 0.02, sliver_width_share = 0.3;  // of the median block of the region
  std::string blocks_file;                                    // cut before; "" cut now
  Where where, where_file, where_grid, where_slivers;
};

}  // namespace talus
