#pragma once
// Pictures of the blocks of one frame of a run: coloured by a quantity or by kind, with joints that slipped or stand
// open, bolts, and what else is asked for over them. The one drawer of blocks: of `talus plot`, of what a run leaves and
// of the mechanism of a collapse.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "talus/plot/block_picture_spec.h"

namespace talus::plot {

/// "principal", "forces", "slip"; in the order of the enumerators.
const std::vector<std::string>& overlay_names();

/// Names of what may colour blocks: displacement, velocity, stress_xx ...
const std::vector<std::string>& block_quantities();

/// Draws the picture in true proportion and writes `stem` + ".svg" and ".png". Throws FileError when a file cannot
/// be written or it cannot be drawn.
void write_block_picture(const BlockPicture& picture, const std::filesystem::path& stem);
/// The same as the text of an SVG.
std::string block_picture_svg(const BlockPicture& picture);

/// Where all blocks lie as drawn, and the range of their values but for 2 % at either end.
struct Extent {
  Box box;
  Range values;
};
Extent extent_of(const BlockPicture& picture);

/// One picture after the other, `seconds` each, as `path`: a moving PNG, or where it ends in .mp4 a film by ffmpeg.
/// Throws FileError. @param make  the picture with a number, below `count`; of one window and range of colours
void write_animation(const std::function<BlockPicture(size_t)>& make, size_t count, double seconds,
                     const std::filesystem::path& path);

}  // namespace talus::plot
