#pragma once
// Pictures of the blocks for `talus plot`: of chosen times, coloured by a quantity.

#include <filesystem>
#include <string>
#include <vector>

namespace talus::app {

struct BlockPlotArguments {
  std::vector<std::string> quantities;  // "none": blocks are pale, joints and bolts stand out
  std::vector<double> times;            // [s]; empty: the last frame
  std::vector<double> window;           // x0 y0 x1 y1 [m]; empty: all blocks
  double deformation = 1;
  std::string against;                // support, free field, group or block; "": the start
  std::vector<std::string> overlays;  // of plot::overlay_names()
  int frames = 60;                    // of an animation, at most
  double seconds = 0.1;               // that each is shown
  std::string title;
};

/// Draws each quantity at each time as STEM_QUANTITY_t_TIME, or as STEM alone where there is one picture and
/// `exact`. Prints what it wrote. Throws FileError where the folder has no frames or none near a time.
void plot_blocks(const std::filesystem::path& folder, const BlockPlotArguments& args,
                 const std::filesystem::path& stem, bool exact);

/// Draws the first quantity over the run as a moving PNG, or where `path` ends in .mp4 as a film, which takes ffmpeg.
void animate_blocks(const std::filesystem::path& folder, const BlockPlotArguments& args,
                    const std::filesystem::path& path);

/// The pictures of a plot without choice: displacement, and joints with bolts where there are any, at the
/// end.
void plot_blocks_at_end(const std::filesystem::path& folder, const std::filesystem::path& plots);

}  // namespace talus::app
