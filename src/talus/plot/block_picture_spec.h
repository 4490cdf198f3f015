#pragma once
// What a picture of blocks is asked for.

#include <optional>
#include <string>
#include <vector>

#include "talus/geometry/polygon.h"
#include "talus/output/read_frames.h"
#include "talus/plot/scale.h"

namespace talus::plot {

/// What may be laid over the blocks.
enum class Overlay { kPrincipal, kForces, kSlip };
struct BlockPicture {
  std::string title;
  double time = 0;  // [s]
  Shapes shapes;
  BlockFrame blocks;  // of these shapes
  std::optional<ContactPoints> contacts;
  std::optional<BoltPieces> bolts;        // of the same time
  std::string quantity = "displacement";  // one of block_quantities(), "" : none, blocks are coloured by kind
  double deformation = 1;                 // displacements are drawn so many times
  std::optional<Against> against;  // what displacements and velocities are told against; none: the start
  std::string against_name;
  std::vector<Overlay> overlays;
  std::optional<Box> window;     // what is shown [m]; none: all blocks
  std::optional<Range> colours;  // the range of the colours; none: that of the blocks in sight
};

}  // namespace talus::plot
