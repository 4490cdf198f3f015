#pragma once
// Pictures of the blocks of one frame of a run: coloured by a quantity, with joints that slipped or stand
// open and bolts over them. Made from the files in fields/ alone.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "talus/base/vec2.h"
#include "talus/geometry/polygon.h"
#include "talus/output/read_frames.h"

namespace talus::plot {

struct BlockPicture {
  std::string title;
  double time = 0;  // [s]
  Shapes shapes;
  BlockFrame blocks;  // of these shapes
  std::optional<ContactPoints> contacts;
  std::optional<BoltPieces> bolts;        // of the same time
  std::string quantity = "displacement";  // one of block_quantities(), "" : none, blocks are pale
  double deformation = 1;                 // displacements are drawn so many times
  std::optional<Box> window;              // what is shown [m]; none: all blocks
};

/// Names of what may colour blocks: displacement, velocity, stress_xx ...
const std::vector<std::string>& block_quantities();

/// Draws the picture in true proportion and writes `stem` + ".svg" and ".png". Throws FileError when an array
/// is missing or a file cannot be written, std::runtime_error when it cannot be drawn.
void write_block_picture(const BlockPicture& picture, const std::filesystem::path& stem);

}  // namespace talus::plot
