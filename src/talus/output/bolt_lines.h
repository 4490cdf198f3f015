#pragma once
// Rock bolts in result files: pieces of bar as lines for ParaView and for the picture of the blocks.

#include <array>
#include <string>
#include <vector>

#include "talus/base/vec2.h"
#include "talus/output/columns.h"

namespace talus {

inline constexpr std::array<const char*, 3> kBoltConditions{"elastic", "yielded", "ruptured"};

/// A piece of a bolt as it lies; forces of one bolt.
struct BoltLine {
  std::string bolt;
  int piece = 0;          // along the bolt
  bool crossing = false;  // of a joint
  Vec2 from, to;          // [m]
  double axial = 0;       // > 0: tension [N]
  double shear = 0;       // [N]
  double elongation = 0;  // [m]
  int condition = 0;      // index in kBoltConditions
};

/// Lines with force and condition, and their time [s].
std::string bolts_vtp(const std::vector<BoltLine>& lines, double time);

/// A row of bolts.csv.
struct BoltRow {
  const BoltLine& line;
  const std::string& stage;
  double time;  // [s]
};
const Columns<BoltRow, Cell>& bolt_columns();

}  // namespace talus
