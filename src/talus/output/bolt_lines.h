#pragma once
// Rock bolts in result files: pieces of bar as lines for ParaView and for the picture of the blocks.

#include <string>
#include <vector>

#include "talus/base/vec2.h"

namespace talus {

/// A piece of a bolt as it lies; forces of one bolt.
struct BoltLine {
  std::string bolt;
  int piece = 0;          // along the bolt
  bool crossing = false;  // of a joint
  Vec2 from, to;          // [m]
  double axial = 0;       // > 0: tension [N]
  double shear = 0;       // [N]
  double elongation = 0;  // [m]
  int condition = 0;      // 0 elastic, 1 yielded, 2 ruptured
};

/// Lines with force and condition, and their time [s].
std::string bolts_vtp(const std::vector<BoltLine>& lines, double time);

/// Titles and rows of bolts.csv; `stage` goes into the first column.
std::string bolts_csv_head();
std::string bolts_csv_rows(const std::string& stage, double time, const std::vector<BoltLine>& lines);

}  // namespace talus
